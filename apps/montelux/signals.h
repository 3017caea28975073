// Ending a render early, by Ctrl-C or by a request to terminate.
#pragma once

namespace montelux::cli {

// While it lives, the first SIGINT or SIGTERM only sets a flag; the second one ends the process at once, and no file is
// touched. Afterwards signals do what they did before. One at a time.
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
