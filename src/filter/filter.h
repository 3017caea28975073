// Pixel reconstruction filters: the weight of radiance around the centre of a pixel. Points are sampled in
// proportion to the filter (Ernst, Stamminger and Greiner 2006), so that every sample belongs to one pixel only.
#pragma once
#include <memory>
#include <variant>

#include "filter/description.h"
#include "filter/inverse_cdf.h"
#include "filter/profile.h"

namespace montelux {

// offset: from the pixel's centre, in pixels. The mean of weight * L(centre + offset) is the filtered value of the
// pixel; weight has mean 1 and carries the sign of the filter.
template <class F>
struct FilterSample {
  Vec2<F> offset;
  F weight;
};

// Constant over the rectangle of the radii.
struct BoxFilter {
  Vec2f radius{0.5f, 0.5f};

  template <class F>
  FilterSample<F> sample(Vec2<F> u) const {
    return {{(u.x * 2.0f - 1.0f) * radius.x, (u.y * 2.0f - 1.0f) * radius.y}, F(1.0f)};
  }
  template <class F>
  F evaluate(Vec2<F> offset) const {
    F reach = max(abs(offset.x) * (1.0f / radius.x), abs(offset.y) * (1.0f / radius.y));
    return select(reach <= F(1.0f), F(0.25f / (radius.x * radius.y)), F(0.0f));
  }
};

// The product of two tents.
struct TriangleFilter {
  Vec2f radius{2.0f, 2.0f};

  template <class F>
  FilterSample<F> sample(Vec2<F> u) const {
    return {{tent(u.x) * radius.x, tent(u.y) * radius.y}, F(1.0f)};
  }
  template <class F>
  F evaluate(Vec2<F> offset) const {
    F x = max(F(1.0f) - abs(offset.x) * (1.0f / radius.x), F(0.0f)) * (1.0f / radius.x);
    F y = max(F(1.0f) - abs(offset.y) * (1.0f / radius.y), F(0.0f)) * (1.0f / radius.y);
    return x * y;
  }

 private:
  // By inversion of each half.
  template <class F>
  static F tent(F u) {
    return select(u < F(0.5f), safe_sqrt(u * 2.0f) - 1.0f, F(1.0f) - safe_sqrt(F(2.0f) - u * 2.0f));
  }
};

// The product of a profile along x and one along y, sampled by tables of their magnitude.
template <class Profile>
class TabulatedFilter {
 public:
  TabulatedFilter(const Profile& x, const Profile& y)
      : radius{x.radius, y.radius},
        x_(x),
        y_(y),
        tables_(std::make_shared<const Tables>(Tables{InverseCdf(x), InverseCdf(y)})) {
    scale_ = float(1 / (tables_->x.integral() * tables_->y.integral()));
  }

  template <class F>
  FilterSample<F> sample(Vec2<F> u) const {
    auto x = tables_->x(u.x), y = tables_->y(u.y);
    F weight = (x_(x.x) * x.inverse_density) * (y_(y.x) * y.inverse_density) * scale_;
    return {{x.x, y.x}, weight};
  }
  template <class F>
  F evaluate(Vec2<F> offset) const {
    return x_(offset.x) * y_(offset.y) * scale_;
  }

  Vec2f radius;

 private:
  struct Tables {
    InverseCdf x, y;
  };
  Profile x_, y_;
  std::shared_ptr<const Tables> tables_;  // shared by copies
  float scale_ = 1;                       // one over the filter's integral
};

using GaussianFilter = TabulatedFilter<GaussianProfile>;
using MitchellFilter = TabulatedFilter<MitchellProfile>;
using SincFilter = TabulatedFilter<SincProfile>;

// One of the filters.
class Filter {
 public:
  using Variant = std::variant<BoxFilter, GaussianFilter, MitchellFilter, SincFilter, TriangleFilter>;

  // The Gaussian of radius 1.5 and standard deviation 0.5.
  Filter();
  // One of the alternatives.
  template <class Alternative>
  requires(!std::is_same_v<Alternative, Filter> &&
           std::is_constructible_v<Variant, Alternative>) explicit Filter(const Alternative& filter)
      : filter_(filter) {}
  // A radius that is not positive is replaced by the usual one.
  static Filter build(const FilterDesc& stated);

  // u in [0, 1)^2. To compile a loop for one filter, std::visit on variant() outside it.
  template <class F>
  FilterSample<F> sample(Vec2<F> u) const {
    return std::visit([&](const auto& filter) { return filter.sample(u); }, filter_);
  }
  // The filter's value at an offset from the pixel's centre, per square pixel: it integrates to 1. Signed.
  template <class F>
  F evaluate(Vec2<F> offset) const {
    return std::visit([&](const auto& filter) { return filter.evaluate(offset); }, filter_);
  }
  // Half the support along x and y, in pixels.
  Vec2f radius() const {
    return std::visit([](const auto& filter) { return filter.radius; }, filter_);
  }
  const Variant& variant() const { return filter_; }

 private:
  Variant filter_;
};

}  // namespace montelux
