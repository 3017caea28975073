// Sequences of pictures: which frames, when the shutter is open in each, and how their files are called.
#pragma once
#include <optional>
#include <string>

#include "api/frame_range.h"
#include "api/scene.h"
#include "math/result.h"

namespace montelux {

// "A:B" or "A:B/N" with 0 <= A <= B (< N) below a million.
Result<FrameRange> parse_frames(const std::string& text);

// By equal frames, the scene's whole time, its shutter with it, is drawn together into that of the frame: slice i of n
// of [t0, t1] with the shutter of the scene from a to b looks from t0 + (i (t1 - t0) + a - t0) / n to the same with b.
// By fps, the shutter of frame f is the scene's, f / fps later; so it is by the scene's own frame rate, where it has
// one and neither fps nor `of` is stated.
ShutterTimes frame_shutter(const SceneInfo& scene, const FrameRange& range, int frame);

// The seed of a frame of a sequence: a hash of both, so that frames are independent realisations. It is below 2^31, and
// rendering the frame alone with it gives the same bits, but for integrators that go on from picture to picture.
std::uint32_t frame_seed(std::uint32_t seed, int frame);

// The file of a frame: its number takes the place of a run of # (with leading zeros, as wide as the run at least) or of
// %d, %4d, %04d; where there is neither, it goes before the extension, with four digits. Fails where there is more than
// one such place.
Result<std::string> frame_file(const std::string& pattern, int frame);

}  // namespace montelux
