// Numbers of samples of which pixels may count parts.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>

namespace montelux {

// A sum in units of 2^-32 samples, which does not depend on the order of its terms. Exact for whole samples.
class SampleCount {
 public:
  SampleCount() = default;
  static SampleCount of_units(std::uint64_t units) {
    SampleCount count;
    count.units_ = units;
    return count;
  }
  static SampleCount of(std::uint64_t samples) { return of_units(samples << fraction_bits); }

  // Any part counts as one unit at least. Requires samples < 2^24.
  void add(double samples) {
    if (samples > 0)
      units_ += std::max<std::uint64_t>(std::uint64_t(std::llround(std::ldexp(samples, fraction_bits))), 1);
  }
  double value() const { return std::ldexp(double(units_), -fraction_bits); }
  std::uint64_t units() const { return units_; }
  // Without parts of a sample, and with the last part as a whole one.
  std::uint64_t whole() const { return units_ >> fraction_bits; }
  std::uint64_t whole_above() const { return whole() + (is_whole() ? 0 : 1); }
  bool is_whole() const { return units_ == whole() << fraction_bits; }
  bool is_zero() const { return units_ == 0; }
  SampleCount& operator+=(const SampleCount& other) {
    units_ += other.units_;
    return *this;
  }
  bool operator==(const SampleCount&) const = default;

 private:
  static constexpr int fraction_bits = 32;
  std::uint64_t units_ = 0;
};

}  // namespace montelux
