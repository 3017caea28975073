// The frames of a sequence, and exposure intervals: plain data.
#pragma once
#include <optional>

namespace montelux {

// Frames first, ..., last. The time of the scene's transforms is divided into equal frames: those of the range or, with
// `of`, that many, counted from 0. With `fps`, a frame lasts 1 / fps of the scene's unit of time instead.
struct FrameRange {
  int first = 0, last = 0;
  std::optional<int> of;
  std::optional<double> fps;
  int count() const { return last - first + 1; }
};

// In the scene's unit of time.
struct ShutterTimes {
  double open = 0, close = 0;
};

}  // namespace montelux
