#include "guard.h"

#include <sys/resource.h>
#include <sys/time.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

namespace montelux::fuzz {
namespace {

#if defined(__SANITIZE_ADDRESS__)
constexpr bool sanitized = true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
constexpr bool sanitized = true;
#else
constexpr bool sanitized = false;
#endif
#else
constexpr bool sanitized = false;
#endif

// A signal handler can be handed nothing.
std::array<char, 4096> running_name{}, kept_name{};
std::array<char, 1 << 16> other_stack{};

void say(const char* text) { [[maybe_unused]] const ssize_t written = ::write(2, text, std::strlen(text)); }

extern "C" void on_fatal(int signal) {
  const bool late = signal == SIGPROF || signal == SIGALRM;
  say(late ? "fuzz: HANG, the input is kept as " : "fuzz: CRASH, the input is kept as ");
  if (kept_name[0] != 0) ::rename(running_name.data(), kept_name.data());
  say(kept_name.data());
  say("\n");
  ::_exit(late ? 4 : 5);
}

void copy(const std::filesystem::path& path, std::array<char, 4096>& to) {
  std::snprintf(to.data(), to.size(), "%s", path.c_str());
}

void set_timers(int seconds) {
  itimerval timer{};
  timer.it_value.tv_sec = seconds;
  ::setitimer(ITIMER_PROF, &timer, nullptr);
  ::alarm(unsigned(12 * seconds));
}

}  // namespace

void guard_process(std::size_t memory) {
  if (memory > 0 && !sanitized) {
    const rlimit limit{memory, memory};
    ::setrlimit(RLIMIT_AS, &limit);
  }
  const rlimit no_core{0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
  stack_t stack{};
  stack.ss_sp = other_stack.data(), stack.ss_size = other_stack.size();
  ::sigaltstack(&stack, nullptr);
  struct sigaction action {};
  action.sa_handler = on_fatal;
  action.sa_flags = SA_ONSTACK;
  for (int signal : {SIGABRT, SIGALRM, SIGPROF}) ::sigaction(signal, &action, nullptr);
  // The address sanitizer reports these itself and then aborts.
  if (!sanitized)
    for (int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL}) ::sigaction(signal, &action, nullptr);
}

void guard_run(const std::filesystem::path& running, const std::filesystem::path& kept, int seconds) {
  copy(running, running_name), copy(kept, kept_name);
  set_timers(seconds);
}

void end_run() {
  set_timers(0);
  kept_name[0] = 0;
}

}  // namespace montelux::fuzz
