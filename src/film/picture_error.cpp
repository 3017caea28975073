#include "film/picture_error.h"

#include <algorithm>
#include <cmath>

#include "film/neighbours.h"
#include "mc/tail.h"

namespace montelux {

namespace {

constexpr double dark = 0.01;  // added to the squared expectation

// A pixel against its neighbours, by the mean of the channels.
struct Excess {
  double own = 0, neighbours = 0, variance = 0;
  double first = 0, second = 0;  // of the halves over the neighbours

  double value() const { return own - neighbours; }
  // In standard errors, squared: the number of bright samples, where few of them make the excess.
  double significance() const { return value() * value() / std::max(variance, 1e-30); }
};

Excess excess_of(const FilmPlanes& p, const ColorPlanes& neighbours, std::size_t i) {
  Excess e;
  for (std::size_t c = 0; c < spectrum_size; ++c) {
    e.own += double(p.mean[c][i]) / spectrum_size, e.neighbours += double(neighbours[c][i]) / spectrum_size;
    e.variance += double(p.variance[c][i]) / spectrum_size;
  }
  e.first = double(p.first_half[i]) - e.neighbours, e.second = double(p.second_half[i]) - e.neighbours;
  return e;
}

// How much of what makes pixels brighter than their neighbours is their own, and not one rare sample that any of them
// might have had: by classes of how much brighter the brighter half is.
class PersistentShare {
 public:
  void add(const Excess& e) {
    // Where many samples made the pixel bright there is no question.
    constexpr double few_samples = 6;
    const double squares = e.first * e.first + e.second * e.second;
    if (std::max(e.first, e.second) <= 0 || e.significance() >= few_samples || squares <= 0) return;
    Class& c = classes_[class_of(e)];
    c.agreement += 2 * e.first * e.second / squares, c.pixels += 1;
  }
  double operator()(const Excess& e) const {
    // Two pixels of share one half before any was seen. If a pixel is bright in a half by a probability whose logarithm
    // is uniform, both halves of a persistent one agree by two thirds in the mean.
    constexpr double prior_pixels = 2, prior_share = 0.5, agreement = 2.0 / 3;
    const Class& c = classes_[class_of(e)];
    return std::clamp((c.agreement + prior_pixels * prior_share) / (c.pixels * agreement + prior_pixels), 0.0, 1.0);
  }

 private:
  struct Class {
    double agreement = 0, pixels = 0;
  };
  static constexpr std::size_t classes = 8;
  static std::size_t class_of(const Excess& e) {
    const double ratio = std::max(e.first, e.second) / (e.neighbours + 0.05);
    return ratio < 0.5 ? 0 : std::min(classes - 1, std::size_t(1 + std::floor(std::log2(ratio) + 1)));
  }
  std::array<Class, classes> classes_{};
};

// The mean of 1 / (expectation^2 + dark) where the excess over the neighbours is known by `samples` bright samples: it
// has a gamma distribution then, here by eight of its quantiles (Wilson and Hilferty 1931).
double mean_reciprocal(double neighbours, double excess, double samples) {
  constexpr double normal_quantiles[] = {-1.534, -0.887, -0.489, -0.157, 0.157, 0.489, 0.887, 1.534};
  const double k = std::max(samples, 1.0);
  double sum = 0;
  for (double z : normal_quantiles) {
    const double root = std::max(1 - 1 / (9 * k) + z / (3 * std::sqrt(k)), 0.0);
    const double value = neighbours + excess * root * root * root;
    sum += 1 / (value * value + dark);
  }
  return sum / std::size(normal_quantiles);
}

// The mean of 1 / (expectation^2 + dark) of one channel, by what the pixel and its neighbours say.
double reciprocal_of(double own, double neighbours, const Excess& e, double persistent) {
  const double t2 = e.significance();
  if (e.value() < 0) {
    // Darker than its neighbours: shrinks toward them unless it is surely darker (James and Stein 1961).
    constexpr double shrinkage = 4;
    const double share = std::max(0.0, 1 - shrinkage / std::max(t2, 1e-9));
    const double expected = neighbours + share * (own - neighbours);
    return 1 / (expected * expected + dark);
  }
  const double surely = std::clamp((t2 - 4) / 8, 0.0, 1.0), share = surely + (1 - surely) * persistent;
  return share * mean_reciprocal(neighbours, own - neighbours, t2) + (1 - share) / (neighbours * neighbours + dark);
}

// What a camera sees of an emitter directly is the pixel's own, however few samples found it.
double share_of_emission(const FilmPlanes& p, const Excess& e, std::size_t i) {
  return e.value() > 0 ? std::min(double(p.emission[i]) / e.value(), 1.0) : 0.0;
}

// Sums over pixels.
struct Sums {
  double squared = 0, relative = 0, relative_squares = 0;
  LargestTerms largest;
};

void add_pixel(const FilmPlanes& p, const ColorPlanes& neighbours, const PersistentShare& share, std::size_t i,
               Sums& sums) {
  const Excess e = excess_of(p, neighbours, i);
  const double persistent = std::max(share(e), share_of_emission(p, e, i));
  double relative = 0;
  for (std::size_t c = 0; c < spectrum_size; ++c) {
    const double variance = double(p.variance[c][i]) / spectrum_size;
    sums.squared += variance;
    relative += variance * reciprocal_of(double(p.mean[c][i]), double(neighbours[c][i]), e, persistent);
  }
  sums.relative += relative, sums.relative_squares += relative * relative;
  sums.largest.add(relative);
}

}  // namespace

ErrorEstimate estimate_error(const FilmPlanes& p) {
  ErrorEstimate error;
  error.all = std::size_t(std::count(p.expected.begin(), p.expected.end(), std::uint8_t(1)));
  error.pixels = std::size_t(std::count(p.passes.begin(), p.passes.end(), std::uint8_t(2)));
  if (error.pixels == 0) return error;
  const ColorPlanes neighbours = mean_of_neighbours(p);
  PersistentShare share;
  for (std::size_t i = 0; i < p.passes.size(); ++i)
    if (p.passes[i] == 2) share.add(excess_of(p, neighbours, i));
  Sums sums;
  for (std::size_t i = 0; i < p.passes.size(); ++i)
    if (p.passes[i] == 2) add_pixel(p, neighbours, share, i, sums);
  error.mse = sums.squared / double(error.pixels), error.relative_mse = sums.relative / double(error.pixels);
  // Kish's number of pixels of equal error that would be as sure, and with it the spread of the logarithm.
  const double alike =
      sums.relative_squares > 0 ? sums.relative * sums.relative / sums.relative_squares : double(error.pixels);
  const double factor = std::exp(1.96 * std::sqrt(2 / alike));
  error.relative_low = error.relative_mse / factor, error.relative_high = error.relative_mse * factor;
  error.tail_index = hill_index(sums.largest.sorted());
  return error;
}

}  // namespace montelux
