// The images of lights, and their distributions.
#pragma once
#include <bit>
#include <memory>
#include <mutex>
#include <utility>

#include "light/image.h"
#include "light/row.h"
#include "mc/piecewise.h"

namespace montelux {

// The images of all lights, by the number in a row minus one, and the distribution of each where it is needed.
struct LightImages {
  const std::shared_ptr<const LightImage>* images = nullptr;
  const std::shared_ptr<const PiecewiseConstant2>* distributions = nullptr;
};

// Points of the image in proportion to the mean of the components.
std::shared_ptr<const PiecewiseConstant2> distribution_of(const LightImage& image);

// The same of what exceeds the mean of the image, made when it is first wanted. Half of that mean would leave an even
// density over the sphere to other directions, and those of a surface are in one hemisphere.
class ExcessDistribution {
 public:
  explicit ExcessDistribution(std::shared_ptr<const LightImage> image) : image_(std::move(image)) {}
  // Null: nothing exceeds the mean.
  std::shared_ptr<const PiecewiseConstant2> get() const;

 private:
  std::shared_ptr<const LightImage> image_;
  mutable std::once_flag made_;
  mutable std::shared_ptr<const PiecewiseConstant2> table_;
};

// Calls f(distribution, lanes) for each image among the rows of the lanes `on`.
template <class F, class Function>
void for_each_distribution(const LightRows<F>& rows, const LightImages& of, Mask<F> on, Function f) {
  const Uint<F> image = rows.bits(light_slot::image);
  for (on = on & rows.has_image(); any(on);) {
    const std::uint32_t number = lane(image, std::countr_zero(bits(on)));
    const Mask<F> same = on & (image == Uint<F>(number));
    f(*of.distributions[number - 1], same);
    on = on & !same;
  }
}

}  // namespace montelux
