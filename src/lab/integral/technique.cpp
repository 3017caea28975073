#include "lab/integral/technique.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "lab/integral/sampled.h"
#include "lab/integral/weighted.h"
#include "lab/integral/whole_pass.h"
#include "mc/moments.h"

namespace montelux::lab {
namespace {

constexpr std::size_t width = 8;
typedef double Pack __attribute__((vector_size(8 * width)));

struct BatchMoments {
  double sum = 0, m2 = 0;
};

double total_of(Pack p) {
  double sum = 0;
  for (std::size_t k = 0; k < width; ++k) sum += p[k];
  return sum;
}

// In a fixed order, so that the same terms give the same bits.
double sum_of(std::span<const double> x) {
  Pack sum{};
  std::size_t i = 0;
  for (; i + width <= x.size(); i += width) {
    Pack p;
    std::memcpy(&p, x.data() + i, sizeof p);
    sum += p;
  }
  double rest = 0;
  for (; i < x.size(); ++i) rest += x[i];
  return total_of(sum) + rest;
}

double squares_about(std::span<const double> x, double centre) {
  Pack sum{};
  std::size_t i = 0;
  for (; i + width <= x.size(); i += width) {
    Pack p;
    std::memcpy(&p, x.data() + i, sizeof p);
    p -= centre;
    sum += p * p;
  }
  double rest = 0;
  for (; i < x.size(); ++i) rest += (x[i] - centre) * (x[i] - centre);
  return total_of(sum) + rest;
}

// Squared deviations of two sets together from their common mean.
double merged_m2(double n, double sum_n, double m2_n, double k, double sum_k, double m2_k) {
  if (n == 0 || k == 0) return m2_n + m2_k;
  Moments both{std::uint64_t(n), 0, sum_n / n, m2_n};
  both.merge({std::uint64_t(k), 0, sum_k / k, m2_k});
  return both.m2;
}

}  // namespace

void TermSums::add(std::span<double> terms) {
  if (terms.empty()) return;
  double total = sum_of(terms);
  if (!std::isfinite(total)) {
    for (double& x : terms)
      if (!std::isfinite(x)) x = 0, ++non_finite;
    total = sum_of(terms);
  }
  const double n = double(terms.size());
  const double squares = squares_about(terms, total / n);
  m2 = merged_m2(double(samples), sum, m2, n, total, squares);
  sum += total;
  samples += terms.size();
  largest.add(terms);
}

void TermSums::merge(const TermSums& other) {
  m2 = merged_m2(double(samples), sum, m2, double(other.samples), other.sum, other.m2);
  sum += other.sum;
  samples += other.samples, evaluations += other.evaluations, non_finite += other.non_finite;
  own_variance += other.own_variance;
  proposed += other.proposed, accepted += other.accepted;
  control_sum += other.control_sum, control_squares += other.control_squares;
  control_products += other.control_products;
  outside.merge(other.outside);
  magnitude += other.magnitude;
  largest.merge(other.largest);
}

std::size_t batch_size(std::size_t dimension) {
  const std::size_t fit = std::size_t(3072) / dimension / 16 * 16;
  return std::clamp<std::size_t>(fit, 64, 512);
}

bool trains(const Method& method) {
  return method.kind == MethodKind::vegas || (method.kind == MethodKind::qmc && method.adapt);
}

std::unique_ptr<Technique> make_technique(const Problem& problem, const Method& method, std::uint64_t seed,
                                          const MapTraining* training) {
  switch (method.kind) {
    case MethodKind::uniform:
    case MethodKind::stratified:
    case MethodKind::antithetic:
    case MethodKind::control:
    case MethodKind::qmc:
      return make_sampled(problem, method, training);
    case MethodKind::importance:
      return make_importance(problem);
    case MethodKind::mis:
      return make_mis(problem, method);
    case MethodKind::ris:
      return make_ris(problem, method);
    case MethodKind::vegas:
      return make_vegas(problem, seed, *training);
    case MethodKind::miser:
      return make_miser(problem);
    case MethodKind::metropolis:
      return make_metropolis(problem, method);
    case MethodKind::automatic:
      break;
  }
  throw std::logic_error("auto is no technique of its own");
}

}  // namespace montelux::lab
