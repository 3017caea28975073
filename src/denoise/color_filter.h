// Filters of others, of which nothing is known but what they make of an image.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "denoise/denoise.h"

namespace montelux {

// An image to be filtered, row by row from the top: three channels for each pixel. All numbers are finite.
struct FilterInput {
  int width = 0, height = 0;
  std::vector<float> color;   // linear, not limited to 1
  std::vector<float> albedo;  // of what is seen, through mirrors and glass
  std::vector<float> normal;  // in the world; 0 where nothing is seen
};

class ColorFilter {
 public:
  virtual ~ColorFilter() = default;
  // As users know it, with its version.
  virtual std::string name() const = 0;
  // The filtered colours. `threads`: 0: all of the machine; `stop`, unless it is empty, is queried now and then. Throws
  // std::runtime_error if it was stopped, or failed.
  virtual std::vector<float> filter(const FilterInput& input, int threads, const std::function<bool()>& stop) const = 0;
};

// As denoise() says.
DenoisedImage denoise_by(const ColorFilter& filter, const NoisyImage& image, const DenoiseSettings& settings);

}  // namespace montelux
