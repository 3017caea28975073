#include "film/reciprocals.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "film/neighbours.h"
#include "film/picture_error.h"

namespace montelux {

// A pixel against its neighbours, by the mean of the channels.
struct Reciprocals::Excess {
  double own = 0, neighbours = 0, variance = 0;
  double first = 0, second = 0;  // of the halves over the neighbours
  double emission = 0;           // of the pixel

  double value() const { return own - neighbours; }
  // Whether an emitter that the camera sees makes most of it.
  bool is_emission() const { return 2 * emission > value(); }
  // In standard errors, squared: the number of bright samples, where few of them make the excess.
  double significance() const { return value() * value() / std::max(variance, 1e-30); }
};

void Reciprocals::Agreement::add(const Excess& e) {
  // Where many samples made the pixel bright there is no question.
  constexpr double few_samples = 2.5;
  const double squares = e.first * e.first + e.second * e.second;
  if (std::max(e.first, e.second) <= 0 || e.significance() >= few_samples || squares <= 0) return;
  Class& c = classes_[class_of(e)];
  c.agreement += 2 * e.first * e.second / squares, c.pixels += 1;
}

double Reciprocals::Agreement::operator()(const Excess& e, double prior) const {
  constexpr double prior_pixels = 2;
  const Class& c = classes_[class_of(e)];
  return std::max(c.agreement + prior_pixels * prior, 0.0) / (c.pixels + prior_pixels);
}

std::size_t Reciprocals::Agreement::class_of(const Excess& e) {
  const double ratio = std::max(e.first, e.second) / (e.neighbours + 0.05);
  const std::size_t of_ratio = ratio < 0.5 ? 0 : std::min(ratios - 1, std::size_t(2 + std::floor(std::log2(ratio))));
  return of_ratio + (e.is_emission() ? ratios : 0);
}

namespace {

// The mean of 1 / (expectation^2 + relative_epsilon) where the excess over the neighbours is known by `samples` bright
// samples: it has a gamma distribution then, here by eight of its quantiles (Wilson and Hilferty 1931).
double mean_reciprocal(double neighbours, double excess, double samples) {
  constexpr double normal_quantiles[] = {-1.534, -0.887, -0.489, -0.157, 0.157, 0.489, 0.887, 1.534};
  const double k = std::max(samples, 1.0);
  double sum = 0;
  for (double z : normal_quantiles) {
    const double root = std::max(1 - 1 / (9 * k) + z / (3 * std::sqrt(k)), 0.0);
    const double value = neighbours + excess * root * root * root;
    sum += 1 / (value * value + relative_epsilon);
  }
  return sum / std::size(normal_quantiles);
}

}  // namespace

Reciprocals::Reciprocals(const FilmPlanes& planes) : planes_(planes), neighbours_(mean_of_neighbours(planes)) {
  for (std::size_t i = 0; i < planes.passes.size(); ++i)
    if (planes.passes[i] >= 2) agreement_.add(excess_of(i));
}

Reciprocals::Excess Reciprocals::excess_of(std::size_t i) const {
  const FilmPlanes& p = planes_;
  Excess e;
  for (std::size_t c = 0; c < rgb_size; ++c) {
    e.own += double(p.mean[c][i]) / rgb_size, e.neighbours += double(neighbours_[c][i]) / rgb_size;
    e.variance += double(p.variance[c][i]) / rgb_size;
  }
  e.first = double(p.first_half[i]) - e.neighbours, e.second = double(p.second_half[i]) - e.neighbours;
  e.emission = double(p.emission[i]);
  return e;
}

Reciprocals::Belief Reciprocals::belief_of(const Excess& e) const {
  const double surely = std::clamp((e.significance() - 1.2) / 1.5, 0.0, 1.0);
  Belief belief;
  if (e.is_emission()) {
    // An emitter that covers a part of the pixel. The agreement of halves shows how probable it is that a half is
    // bright if the other one is; the expectation is that of a bright sample times twice as much, since there are two
    // halves.
    const double both = agreement_(e, 0.25);
    belief.share = std::clamp(2.0 * 2 * both / (1 + both), 0.0, 1.0);
    belief.share += surely * (1 - belief.share);
  } else {
    // Either a detail, whose halves agree by two thirds in the mean if the logarithm of the probability of a bright
    // half is uniform, or a rare sample.
    belief.own = std::clamp(agreement_(e, 1.0 / 3) * 1.5, 0.0, 1.0);
    belief.own += surely * (1 - belief.own);
  }
  return belief;
}

std::array<double, rgb_size> Reciprocals::of(std::size_t i) const {
  const Excess e = excess_of(i);
  const Belief belief = belief_of(e);
  std::array<double, rgb_size> reciprocals;
  for (std::size_t c = 0; c < rgb_size; ++c) {
    const double own = double(planes_.mean[c][i]), neighbours = double(neighbours_[c][i]);
    if (e.value() < 0) {
      // Darker than its neighbours: shrinks toward them unless it is surely darker (James and Stein 1961).
      constexpr double shrinkage = 1;
      const double share = e.significance() / (e.significance() + shrinkage);
      const double expected = neighbours + share * (own - neighbours);
      reciprocals[c] = 1 / (expected * expected + relative_epsilon);
    } else {
      reciprocals[c] = belief.own * mean_reciprocal(neighbours, belief.share * (own - neighbours), e.significance()) +
                       (1 - belief.own) / (neighbours * neighbours + relative_epsilon);
    }
  }
  return reciprocals;
}

}  // namespace montelux
