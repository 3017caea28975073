// The distance of an image from the reference as one number: the measures for comparing methods.
#pragma once
#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

namespace montelux::lab {

// relative_mse: mean over pixels and channels of (x - r)^2 / (r^2 + 0.01), r the reference; mse: of (x - r)^2; flip:
// the mean of HDR-FLIP.
enum class ErrorMeasure { relative_mse, mse, flip };
inline constexpr std::array<ErrorMeasure, 3> error_measures{ErrorMeasure::relative_mse, ErrorMeasure::mse,
                                                            ErrorMeasure::flip};

// The name in options and JSON, and the name in sentences.
struct MeasureName {
  std::string_view key, title;
};
inline constexpr std::array<MeasureName, 3> measure_names{{{"relmse", "relMSE"}, {"mse", "MSE"}, {"flip", "FLIP"}}};
constexpr std::string_view key_of(ErrorMeasure m) { return measure_names[std::size_t(m)].key; }
constexpr std::string_view title_of(ErrorMeasure m) { return measure_names[std::size_t(m)].title; }
constexpr std::optional<ErrorMeasure> measure_named(std::string_view key) {
  for (ErrorMeasure m : error_measures)
    if (key_of(m) == key) return m;
  return std::nullopt;
}

// One value for each measure.
template <class T>
struct ByMeasure {
  std::array<T, error_measures.size()> values{};
  T& operator[](ErrorMeasure m) { return values[std::size_t(m)]; }
  const T& operator[](ErrorMeasure m) const { return values[std::size_t(m)]; }
};

}  // namespace montelux::lab
