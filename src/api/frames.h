// Sequences of images: their frames, the exposure of each, and their file names.
#pragma once
#include <optional>
#include <string>

#include "api/frame_range.h"
#include "api/scene.h"
#include "math/result.h"

namespace montelux {

// "A:B" or "A:B/N" with 0 <= A <= B (< N) below a million.
Result<FrameRange> parse_frames(const std::string& text);

// With equal frames, the scene's whole time including its shutter is scaled to that of the frame: slice i of n of [t0,
// t1] with the scene's shutter from a to b is exposed from t0 + (i (t1 - t0) + a - t0) / n to the same with b. With
// fps, the shutter of frame f is the scene's, shifted by f / fps; the same applies with the scene's own frame rate, if
// it has one and neither fps nor `of` is stated.
ShutterTimes frame_shutter(const SceneInfo& scene, const FrameRange& range, int frame);

// The seed of a frame of a sequence: a hash of both, so that frames are independent realisations. It is below 2^31, and
// rendering only the frame with it gives the same bits, except for integrators that continue from image to image.
std::uint32_t frame_seed(std::uint32_t seed, int frame);

// The file of a frame: its number replaces a run of # (with leading zeros, at least as wide as the run) or
// %d, %4d, %04d; without a placeholder it is inserted before the extension, with four digits. Fails if there is more
// than one placeholder.
Result<std::string> frame_file(const std::string& pattern, int frame);

}  // namespace montelux
