// Ending early by a signal: SIGINT (Ctrl-C), SIGTERM, SIGHUP (the terminal was closed) and SIGPIPE (nobody reads).
#pragma once

namespace montelux::cli {

// Must be called first in main(). From then on a signal ends the process with a message and status 128 + its number,
// and temporary files are removed. SIGPIPE does not end the process; the write fails, as it does beyond a file size
// limit (SIGXFSZ). SIGHUP and SIGPIPE stay ignored if they were (nohup). Closed standard streams are opened, so that no
// other file gets their numbers; writing to them fails.
void prepare_process();

// During its lifetime, the first signal only sets a flag; the second one, unless it is SIGPIPE, ends the process as
// above. Only one instance at a time.
class StopSignals {
 public:
  StopSignals();
  ~StopSignals();
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  // The received signal; 0: none.
  int received() const;
};

}  // namespace montelux::cli
