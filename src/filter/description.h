// A pixel filter as stated by a scene: plain data.
#pragma once
#include <array>
#include <cstddef>
#include <string_view>

namespace montelux {

enum class FilterKind { box, gaussian, mitchell, sinc, triangle };
inline constexpr std::array<std::string_view, 5> filter_names{"box", "gaussian", "mitchell", "sinc", "triangle"};
constexpr std::string_view name_of(FilterKind kind) { return filter_names[std::size_t(kind)]; }

struct FilterDesc {
  FilterKind kind = FilterKind::gaussian;
  float x_radius = 1.5f, y_radius = 1.5f;  // half the support, in pixels
  float sigma = 0.5f;                      // standard deviation of the Gaussian, in pixels
  float b = 1.0f / 3, c = 1.0f / 3;        // of Mitchell and Netravali's family of cubics
  float tau = 3;                           // of the sinc: how many cycles the Lanczos window contains

  // The filter of that kind with its usual radius.
  static constexpr FilterDesc usual(FilterKind kind) {
    constexpr std::array<float, 5> radii{0.5f, 1.5f, 2, 4, 2};
    FilterDesc filter;
    filter.kind = kind;
    filter.x_radius = filter.y_radius = radii[std::size_t(kind)];
    return filter;
  }
};

}  // namespace montelux
