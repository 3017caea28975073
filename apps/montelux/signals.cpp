#include "signals.h"

#include <signal.h>
#include <unistd.h>

namespace montelux::cli {

namespace {

// A handler can speak to the program by such a flag alone.
volatile sig_atomic_t stop_signal = 0;

extern "C" void note_stop(int signal) {
  if (stop_signal != 0) _exit(128 + signal);
  stop_signal = signal;
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
