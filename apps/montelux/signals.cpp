#include "signals.h"

#include <signal.h>
#include <unistd.h>

#include <atomic>

namespace montelux::cli {

namespace {

// The handler runs on any thread and is asked from others: a lock-free atomic serves both.
std::atomic<int> stop_signal = 0;
static_assert(std::atomic<int>::is_always_lock_free);

extern "C" void note_stop(int signal) {
  if (stop_signal.exchange(signal) != 0) _exit(128 + signal);
}

void handle(int signal, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  sigemptyset(&action.sa_mask);
  sigaction(signal, &action, nullptr);
}

}  // namespace

StopSignals::StopSignals() {
  stop_signal = 0;
  handle(SIGINT, note_stop);
  handle(SIGTERM, note_stop);
}

StopSignals::~StopSignals() {
  handle(SIGINT, SIG_DFL);
  handle(SIGTERM, SIG_DFL);
}

int StopSignals::received() const { return stop_signal; }

}  // namespace montelux::cli
