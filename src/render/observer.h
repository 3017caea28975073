// What the caller of a render receives while it runs.
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "film/picture_error.h"

namespace montelux {

// Seconds until a film has a requested error, as expected and with an interval for about 95 %.
struct TimeToTarget {
  double seconds = 0, low = 0, high = 0;
};

// For a film that is continued, this includes the passes and the time that it had before.
struct Progress {
  double fraction = 0;   // of the work, or of the time, in [0, 1]
  double elapsed = 0;    // seconds
  double remaining = 0;  // seconds, estimated
  std::uint64_t samples = 0;
  ErrorEstimate error;
  std::optional<TimeToTarget> to_target;  // as far as it is known
  bool finished = false;
};

// Receives progress several times a second, from one thread; may request a stop.
class RenderObserver {
 public:
  virtual ~RenderObserver() = default;
  virtual void progress(const Progress&) {}
  // One sentence that the user should read before the work starts.
  virtual void announce(const std::string&) {}
  virtual bool stop_requested() { return false; }
};

}  // namespace montelux
