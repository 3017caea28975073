#include "signals.h"

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <string_view>

#include "api/images.h"

namespace montelux::cli {

namespace {

constexpr int unwatched = -1, none = 0;

// The state of StopSignals: unwatched, none, or the received signal. The handler runs on any thread and other threads
// read the value: a lock-free atomic serves both.
std::atomic<int> stop_signal = unwatched;
static_assert(std::atomic<int>::is_always_lock_free);

// The following runs in the handler: only system calls and its own memory (signal-safety(7)).

void say(std::string_view text) {
  if (write(STDERR_FILENO, text.data(), text.size()) < 0) return;  // nobody is reading
}

// "/proc/self/fd/12" for 12.
struct DescriptorName {
  char text[32] = "/proc/self/fd/";
  explicit DescriptorName(int number) {
    char* end = text + 14;
    for (int power = 10000; power > 0; power /= 10)
      if (number >= power || power == 1) *end++ = char('0' + number / power % 10);
  }
};

// Temporary files are open as long as they exist: the table of open files lists them.
void remove_temporaries() {
  constexpr int max_descriptors = 4096;
  for (int i = 0; i < max_descriptors; ++i) {
    char path[4096];
    const ssize_t length = readlink(DescriptorName(i).text, path, sizeof path - 1);
    if (length <= 0) continue;
    path[length] = 0;
    const std::string_view name = std::string_view(path).substr(std::string_view(path).rfind('/') + 1);
    if (name.starts_with(temporary_prefix)) unlink(path);
  }
}

extern "C" void note_stop(int signal) {
  const int error = errno;
  int before = none;
  if (!stop_signal.compare_exchange_strong(before, signal) && signal != SIGPIPE) {
    remove_temporaries();
    say(before == unwatched ? "montelux: error: interrupted before anything was done\n"
                            : "montelux: error: interrupted a second time; unfinished files keep their old content\n");
    _exit(128 + signal);
  }
  errno = error;
}

void handle(int signal) {
  struct sigaction action {};
  action.sa_handler = note_stop;
  action.sa_flags = SA_RESTART;
  sigemptyset(&action.sa_mask);
  sigaction(signal, &action, nullptr);
}

bool is_ignored(int signal) {
  struct sigaction action {};
  return sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

}  // namespace

void prepare_process() {
  for (int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (fcntl(stream, F_GETFD) < 0 && errno == EBADF) open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY);
  for (int signal : {SIGINT, SIGTERM}) handle(signal);
  for (int signal : {SIGHUP, SIGPIPE})
    if (!is_ignored(signal)) handle(signal);
  signal(SIGXFSZ, SIG_IGN);
}

StopSignals::StopSignals() { stop_signal = none; }
StopSignals::~StopSignals() { stop_signal = unwatched; }
int StopSignals::received() const { return stop_signal; }

}  // namespace montelux::cli
