// Sequences of pictures: which frames, when the shutter is open in each, and how their files are called.
#pragma once
#include <optional>
#include <string>

#include "api/scene.h"
#include "math/result.h"

namespace montelux {

// Frames first, ..., last. The time of the scene's transforms falls into equal frames: those of the range, or, with
// `of`, that many, counted from 0. With `fps`, a frame lasts 1 / fps of the scene's unit of time instead.
struct FrameRange {
  int first = 0, last = 0;
  std::optional<int> of;
  std::optional<double> fps;
  int count() const { return last - first + 1; }
};

// "A:B" or "A:B/N" with 0 <= A <= B (< N) below a million.
Result<FrameRange> parse_frames(const std::string& text);

// In the scene's unit of time.
struct ShutterTimes {
  double open = 0, close = 0;
};

// By equal frames, the scene's whole time, its shutter with it, is drawn together into that of the frame: slice i of n
// of [t0, t1] with the shutter of the scene from a to b looks from t0 + (i (t1 - t0) + a - t0) / n to the same with b.
// By fps, the shutter of frame f is the scene's, f / fps later.
ShutterTimes frame_shutter(const SceneInfo& scene, const FrameRange& range, int frame);

// The seed of a frame of a sequence: a hash of both, so that frames are independent realisations. It is below 2^31, and
// rendering the frame alone with it gives the same bits, but for integrators that go on from picture to picture.
std::uint32_t frame_seed(std::uint32_t seed, int frame);

// The file of a frame: its number takes the place of a run of # (with leading zeros, as wide as the run at least) or of
// %d, %4d, %04d; where there is neither, it goes before the extension, with four digits. Fails where there is more than
// one such place.
Result<std::string> frame_file(const std::string& pattern, int frame);

}  // namespace montelux
