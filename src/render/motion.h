// Motion vectors of a picture: where what a pixel shows was in the picture before.
#pragma once
#include "accel/accel.h"
#include "camera/shutter.h"
#include "image/pixel_buffer.h"
#include "image/pixel_sample.h"
#include "scene/scene.h"

namespace montelux {

struct MotionRequest {
  PixelBounds bounds;
  Shutter now, before;
  int threads = 0;  // 0: all of the machine
};

// Channels X and Y, in pixels, x to the right and y up: the way from the pixel's centre to where its surface point was,
// half-way through the exposure of each picture, seen through the centre of the lens. The point is that of the first
// surface, whatever it is made of; where there is none, what is very far away in that direction. Points that were
// behind the camera have no motion. Round an equirectangular picture it is the shorter way; an equal-area one is not
// wrapped.
PixelBuffer motion_vectors(const Scene& scene, const Accel& accel, const MotionRequest& request);

}  // namespace montelux
