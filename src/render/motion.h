// Motion vectors: the offset from a pixel to the place where its surface point was in the previous image.
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

// Channels X and Y, in pixels, x to the right and y up: the offset from the pixel's centre to the earlier place of its
// surface point, at the middle of the exposure of each image, through the centre of the lens. The point is on the first
// surface of any material; without a surface it is very far away in that direction. Points that were behind the camera
// have no motion. In an equirectangular image the offset is the shorter of both ways around; an equal-area image is not
// wrapped.
PixelBuffer motion_vectors(const Scene& scene, const Accel& accel, const MotionRequest& request);

}  // namespace montelux
