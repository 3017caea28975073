#include "light/images.h"

#include <cmath>

namespace montelux {

namespace {

// The texels' mean components; what is not a number is 0.
std::vector<float> weights_of(const LightImage& image) {
  std::vector<float> weights;
  weights.reserve(image.texels.size());
  for (const Rgb& texel : image.texels) {
    const float w = average(texel);
    weights.push_back(std::isfinite(w) ? std::max(w, 0.0f) : 0.0f);
  }
  return weights;
}

std::shared_ptr<const PiecewiseConstant2> table_of(const std::vector<float>& weights, const LightImage& image) {
  return std::make_shared<const PiecewiseConstant2>(weights, std::uint32_t(image.width), std::uint32_t(image.height));
}

}  // namespace

std::shared_ptr<const PiecewiseConstant2> distribution_of(const LightImage& image) {
  return table_of(weights_of(image), image);
}

std::shared_ptr<const PiecewiseConstant2> ExcessDistribution::get() const {
  std::call_once(made_, [this] {
    std::vector<float> weights = weights_of(*image_);
    double sum = 0;
    for (float w : weights) sum += double(w);
    const auto mean = float(sum / double(weights.size()));
    bool any = false;
    for (float& w : weights) w = std::max(w - mean, 0.0f), any |= w > 0;
    if (any) table_ = table_of(weights, *image_);
  });
  return table_;
}

}  // namespace montelux
