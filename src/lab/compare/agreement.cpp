#include "lab/compare/agreement.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mc/confidence.h"

namespace montelux::lab {

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

// The maximum ratio of Student's quantile to the normal one; with fewer degrees of freedom a test has almost no power.
constexpr double max_quantiles = 2;

// The p-values of one test: by Student's distribution, and by the normal one, which is the limit for many repeats.
struct PValues {
  double student = 1, normal = 1;
};

PValues two_sided(double t, double degrees_of_freedom) {
  if (std::isinf(t)) return {0, 0};
  const double x = -std::abs(t);
  return {degrees_of_freedom > 0 ? 2 * student_t_cdf(x, degrees_of_freedom) : 1, 2 * normal_cdf(x)};
}

Agreement::Outcome outcome_of(PValues p, double level) {
  if (p.student < level) return Agreement::Outcome::differs;
  return p.normal < level ? Agreement::Outcome::too_few_repeats : Agreement::Outcome::agrees;
}

// The degrees of freedom of the sum of both variances, bounded from below by the smaller of the two (Scheffe 1970).
// Satterthwaite's estimate is larger if a variance is small by chance, which violates the level for few passes.
double joint_degrees(const MeanDifference& d) {
  const double own = d.variance > 0 ? d.degrees_of_freedom : infinite;
  return std::min(own, d.reference_variance > 0 ? d.reference_degrees_of_freedom : infinite);
}

}  // namespace

double level_of_each_test(double family_level, std::size_t methods) {
  return family_level / (4 * double(std::max<std::size_t>(methods, 1)));
}

Agreement judge_agreement(const std::array<MeanDifference, 3>& channels, const Measured& bias_squared, int repeats,
                          double level) {
  using Outcome = Agreement::Outcome;
  Agreement a;
  a.level = level;
  bool differs = false, too_few = repeats < Agreement::min_repeats;
  const auto consider = [&](PValues p) {
    const Outcome outcome = outcome_of(p, level);
    differs = differs || outcome == Outcome::differs, too_few = too_few || outcome == Outcome::too_few_repeats;
  };
  for (std::size_t c = 0; c < channels.size(); ++c) {
    const MeanDifference& d = channels[c];
    const double error = std::sqrt(d.variance + d.reference_variance), degrees = joint_degrees(d);
    // Without any variance it is either exactly equal or different.
    const double t = d.difference == 0 ? 0 : error > 0 ? d.difference / error : std::copysign(infinite, d.difference);
    const PValues p = two_sided(t, degrees);
    consider(p);
    const double critical = degrees > 0 ? student_t_quantile(1 - 0.5 * level, degrees) : infinite;
    too_few = too_few || (error > 0 && critical > max_quantiles * normal_quantile(1 - 0.5 * level));
    if (error > 0)
      a.detectable = std::max(a.detectable,
                              (critical + (degrees > 0 ? student_t_quantile(Agreement::power, degrees) : 0)) * error);
    if (c > 0 && !(p.student < a.p_value)) continue;
    a.channel = int(c), a.difference = d.difference, a.standard_error = error;
    a.degrees_of_freedom = degrees, a.t = t, a.p_value = p.student;
  }
  if (bias_squared.count >= 2 && bias_squared.mean > 0 && bias_squared.standard_error > 0) {
    a.pixel_t = bias_squared.mean / bias_squared.standard_error;
    a.pixel_p_value = student_t_cdf(-a.pixel_t, bias_squared.count - 1.0);
    consider({a.pixel_p_value, normal_cdf(-a.pixel_t)});
  }
  a.outcome = differs ? Outcome::differs : too_few ? Outcome::too_few_repeats : Outcome::agrees;
  return a;
}

}  // namespace montelux::lab
