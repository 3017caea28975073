// From linear radiance to the 8 bits of a display.
#pragma once
#include "image/image_file.h"
#include "image/pixel_buffer.h"

namespace montelux {

// How the range of radiance is pressed into [0, 1] before the sRGB transfer function.
enum class ToneCurve {
  // Values above one are cut off.
  clip,
  // The filmic curve of Hable (2010, "Uncharted 2: HDR Lighting"), white point 11.2, exposure bias 2.
  hable,
  // The fit of Narkowicz (2015, "ACES Filmic Tone Mapping Curve") to the ACES reference transform.
  aces,
};

struct DisplayTransform {
  // Stops: the image is multiplied by 2^exposure.
  float exposure = 0.0f;
  ToneCurve curve = ToneCurve::clip;
};

// The curve alone, on a linear value; the result is in [0, 1]. Not a number gives 0, infinity 1.
float apply_curve(ToneCurve curve, float linear);

// The colour channels of an image as a picture for display; one channel stays gray. Alpha is ignored.
DisplayImage to_display(const PixelBuffer& image, const DisplayTransform& transform = {});

}  // namespace montelux
