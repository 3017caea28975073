// Does the mean of a method agree with that of the reference? Tests with a stated level, a stated power, and a separate
// answer if there are too few repeats.
#pragma once
#include <array>

#include "lab/compare/statistics.h"

namespace montelux::lab {

// One channel of the image mean: method minus reference, and the variances of both means with their degrees of
// freedom.
struct MeanDifference {
  double difference = 0;
  double variance = 0, degrees_of_freedom = 0;
  double reference_variance = 0, reference_degrees_of_freedom = 0;
};

struct Agreement {
  enum class Outcome { agrees, differs, too_few_repeats };
  // The probability of detecting a bias of `detectable`.
  static constexpr double power = 0.9;
  static constexpr int min_repeats = 3;

  Outcome outcome = Outcome::too_few_repeats;
  double level = 0;  // of each test
  // The most significant test of the image mean: its channel, the difference with its standard error, and
  // Student's t.
  int channel = 0;
  double difference = 0, standard_error = 0, degrees_of_freedom = 0, t = 0, p_value = 1;
  // The smallest bias of the image mean, in any one channel, that these tests detect with that power.
  double detectable = 0;
  // The test of the squared bias over pixels, one-sided.
  double pixel_t = 0, pixel_p_value = 1;

  bool differs() const { return outcome == Outcome::differs; }
};

// The level of each test of a method (three of the image mean, one of the squared bias over pixels) for a family
// of all tests of all methods (Bonferroni).
double level_of_each_test(double family_level, std::size_t methods);

// t-tests of the image mean, two-sided with separate variances, and a one-sided Student test of the squared bias over
// pixels. A p-value below the level: they differ. If the normal distribution would reject but Student's does not, or if
// there are fewer than `min_repeats`, there are too few repeats to tell.
Agreement judge_agreement(const std::array<MeanDifference, 3>& channels, const Measured& bias_squared, int repeats,
                          double level);

}  // namespace montelux::lab
