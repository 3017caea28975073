// Earlier images of a sequence, as the present one would show them.
#pragma once
#include "denoise/denoise.h"

namespace montelux {

// For each pixel the offset in pixels to the place, in the image before, of what the pixel shows: x to the right, y up.
struct MotionPlanes {
  Plane x, y;
};

// For each pixel, the pixel of `earlier` in which what it shows was, by `motion`; that has the share 0 where there is
// none. Pixels are not interpolated: their noise stays what it is known to be.
NoisyImage reprojected(const NoisyImage& earlier, const MotionPlanes& motion);

// From the present image to the one before the image to which `motion` leads, by the motion of that one. Offsets are
// not finite where they lead out of the image.
MotionPlanes composed(const MotionPlanes& motion, const MotionPlanes& before, int width, int height);

}  // namespace montelux
