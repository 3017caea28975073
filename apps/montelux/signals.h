// Ending early, by a signal: SIGINT (Ctrl-C), SIGTERM, SIGHUP (the terminal is gone) and SIGPIPE (nobody reads).
#pragma once

namespace montelux::cli {

// To be called first in main(). From then on a signal ends the process with a message and status 128 + its number, and
// temporary files are removed. SIGPIPE ends nothing, the write fails; so it does beyond a limit of the size of files
// (SIGXFSZ). SIGHUP and SIGPIPE that were ignored stay ignored (nohup). Standard streams that are closed are opened, so
// that no other file takes their numbers; writing to them fails.
void prepare_process();

// While it lives, the first signal only sets a flag; the second one, unless it is SIGPIPE, ends the process as above.
// One at a time.
class StopSignals {
 public:
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  // The signal that came; 0: none.
  int received() const;
};

}  // namespace montelux::cli
