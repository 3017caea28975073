// The perceived difference when flipping between two images (FLIP).
#pragma once
#include "image/pixel_buffer.h"

namespace montelux {

// The viewing conditions: by default a 0.7 m wide display of 3840 pixels at a distance of 0.7 m.
struct ViewingConditions {
  double pixels_per_degree = 67.0206432765;
};

struct FlipResult {
  // The mean of the map below.
  double mean = 0.0;
  // One channel "flip" in [0, 1].
  PixelBuffer map;
};

// LDR-FLIP of Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom and Fairchild (2020, "FLIP: A Difference Evaluator
// for Alternating Images"). The images hold linear colours, which are cut to [0, 1]; they must be of the same size.
FlipResult ldr_flip(const PixelBuffer& test, const PixelBuffer& reference, const ViewingConditions& viewing = {});

// HDR-FLIP of Andersson, Nilsson, Shirley and Akenine-Moller (2021, "Visualizing Errors in Rendered High Dynamic Range
// Images"): the largest LDR-FLIP over a range of exposures that the reference sets, after the ACES fit of Narkowicz.
FlipResult hdr_flip(const PixelBuffer& test, const PixelBuffer& reference, const ViewingConditions& viewing = {});

}  // namespace montelux
