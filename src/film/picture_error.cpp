#include "film/picture_error.h"

#include <algorithm>
#include <cmath>

#include "film/neighbours.h"
#include "film/partial_cover.h"
#include "mc/tail.h"

namespace montelux {

namespace {

// A pixel against its neighbours, by the mean of the channels.
struct Excess {
  double own = 0, neighbours = 0, variance = 0;
  double first = 0, second = 0;  // of the halves over the neighbours
  double emission = 0;           // of the pixel

  double value() const { return own - neighbours; }
  // Whether an emitter that the camera sees makes most of it.
  bool is_emission() const { return 2 * emission > value(); }
  // In standard errors, squared: the number of bright samples, where few of them make the excess.
  double significance() const { return value() * value() / std::max(variance, 1e-30); }
};

Excess excess_of(const FilmPlanes& p, const ColorPlanes& neighbours, std::size_t i) {
  Excess e;
  for (std::size_t c = 0; c < rgb_size; ++c) {
    e.own += double(p.mean[c][i]) / rgb_size, e.neighbours += double(neighbours[c][i]) / rgb_size;
    e.variance += double(p.variance[c][i]) / rgb_size;
  }
  e.first = double(p.first_half[i]) - e.neighbours, e.second = double(p.second_half[i]) - e.neighbours;
  e.emission = double(p.emission[i]);
  return e;
}

// Whether pixels that few bright samples made brighter than their neighbours are bright in both halves of their passes.
// One rare sample that any of them might have had shows in one half alone. By classes of how much brighter the brighter
// half is, and of whether the excess is an emitter that the camera sees.
class Agreement {
 public:
  void add(const Excess& e) {
    // Where many samples made the pixel bright there is no question.
    constexpr double few_samples = 2.5;
    const double squares = e.first * e.first + e.second * e.second;
    if (std::max(e.first, e.second) <= 0 || e.significance() >= few_samples || squares <= 0) return;
    Class& c = classes_[class_of(e)];
    c.agreement += 2 * e.first * e.second / squares, c.pixels += 1;
  }
  // The mean over the pixel's class: 1 where both halves are bright, 0 where one is; with two pixels of this mean
  // added.
  double operator()(const Excess& e, double prior) const {
    constexpr double prior_pixels = 2;
    const Class& c = classes_[class_of(e)];
    return std::max(c.agreement + prior_pixels * prior, 0.0) / (c.pixels + prior_pixels);
  }

 private:
  struct Class {
    double agreement = 0, pixels = 0;
  };
  static constexpr std::size_t ratios = 8;
  static std::size_t class_of(const Excess& e) {
    const double ratio = std::max(e.first, e.second) / (e.neighbours + 0.05);
    const std::size_t of_ratio = ratio < 0.5 ? 0 : std::min(ratios - 1, std::size_t(2 + std::floor(std::log2(ratio))));
    return of_ratio + (e.is_emission() ? ratios : 0);
  }
  std::array<Class, 2 * ratios> classes_{};
};

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

// What is known of the expectation of a pixel that is brighter than its neighbours.
struct Belief {
  double own = 1;    // the probability that the excess is the pixel's own; else it is as its neighbours are
  double share = 1;  // then the mean of the expected excess, of the one that was seen
};

Belief belief_of(const Excess& e, const Agreement& agreement) {
  const double surely = std::clamp((e.significance() - 1.2) / 1.5, 0.0, 1.0);
  Belief belief;
  if (e.is_emission()) {
    // An emitter that covers a part of the pixel. The agreement of halves shows how probable it is that a half is
    // bright if the other one is; the expectation is that of a bright sample times twice as much, since there are two
    // halves.
    const double both = agreement(e, 0.25);
    belief.share = std::clamp(2.0 * 2 * both / (1 + both), 0.0, 1.0);
    belief.share += surely * (1 - belief.share);
  } else {
    // Either a detail, whose halves agree by two thirds in the mean if the logarithm of the probability of a bright
    // half is uniform, or a rare sample.
    belief.own = std::clamp(agreement(e, 1.0 / 3) * 1.5, 0.0, 1.0);
    belief.own += surely * (1 - belief.own);
  }
  return belief;
}

// The mean of 1 / (expectation^2 + relative_epsilon) of one channel of a pixel, by its mean, its neighbours', and what
// is known of the excess.
double reciprocal_of(double own, double neighbours, const Excess& e, const Belief& belief) {
  if (e.value() < 0) {
    // Darker than its neighbours: shrinks toward them unless it is surely darker (James and Stein 1961).
    constexpr double shrinkage = 1;
    const double share = e.significance() / (e.significance() + shrinkage);
    const double expected = neighbours + share * (own - neighbours);
    return 1 / (expected * expected + relative_epsilon);
  }
  return belief.own * mean_reciprocal(neighbours, belief.share * (own - neighbours), e.significance()) +
         (1 - belief.own) / (neighbours * neighbours + relative_epsilon);
}

// Sums over pixels.
struct Sums {
  double squared = 0, relative = 0;
  double seen = 0, seen_squares = 0;  // of the relative errors without the correction for partial covers
  double of_few_samples = 0;          // of the relative
  LargestTerms largest;
};

// Returns its relative squared error.
double add_pixel(const FilmPlanes& p, const ColorPlanes& neighbours, const Agreement& agreement,
                 const PartialCovers& covers, std::size_t i, Sums& sums) {
  const Excess e = excess_of(p, neighbours, i);
  const Belief belief = belief_of(e, agreement);
  double relative = 0;
  std::array<double, rgb_size> reciprocal;
  for (std::size_t c = 0; c < rgb_size; ++c) {
    const double variance = double(p.variance[c][i]) / rgb_size;
    sums.squared += variance;
    reciprocal[c] = reciprocal_of(double(p.mean[c][i]), double(neighbours[c][i]), e, belief);
    relative += variance * reciprocal[c];
  }
  const double of_pixel_alone = relative;
  relative = std::max(relative + covers.correction(i, reciprocal), 0.0);
  sums.relative += relative, sums.seen += of_pixel_alone, sums.seen_squares += of_pixel_alone * of_pixel_alone;
  constexpr double few_samples = 5;
  if (e.own * e.own < few_samples * e.variance) {
    // What the hits of a pixel that is covered in part do not show, the pixels around do.
    constexpr double of_cover = 0.65;
    sums.of_few_samples += (covers.has(i) ? of_cover : 1) * std::min(of_pixel_alone, relative);
  }
  sums.largest.add(of_pixel_alone);
  return relative;
}

// Sums over the pixels that have two passes; `visit` gets the number of each with its relative squared error.
template <class Visit>
Sums sum_pixels(const FilmPlanes& p, Visit visit) {
  const ColorPlanes neighbours = mean_of_neighbours(p);
  Agreement agreement;
  for (std::size_t i = 0; i < p.passes.size(); ++i)
    if (p.passes[i] == 2) agreement.add(excess_of(p, neighbours, i));
  const PartialCovers covers(p);
  Sums sums;
  for (std::size_t i = 0; i < p.passes.size(); ++i)
    if (p.passes[i] == 2) visit(i, add_pixel(p, neighbours, agreement, covers, i, sums));
  return sums;
}

}  // namespace

ErrorEstimate estimate_error(const FilmPlanes& p) {
  ErrorEstimate error;
  error.all = std::size_t(std::count(p.expected.begin(), p.expected.end(), std::uint8_t(1)));
  error.pixels = std::size_t(std::count(p.passes.begin(), p.passes.end(), std::uint8_t(2)));
  if (error.pixels == 0) return error;
  const Sums sums = sum_pixels(p, [](std::size_t, double) {});
  error.mse = sums.squared / double(error.pixels), error.relative_mse = sums.relative / double(error.pixels);
  // Their number decides how far the logarithm of the sum may be off. The divisor is another part of it: pictures of
  // many scenes show 0.8 to 1.25 of the true error in their mean.
  error.effective_pixels = sums.seen_squares > 0 ? sums.seen * sums.seen / sums.seen_squares : double(error.pixels);
  if (sums.relative > 0) error.share_of_few_samples = sums.of_few_samples / sums.relative;
  const double factor = std::exp(1.96 * std::hypot(std::sqrt(2 / error.effective_pixels), divisor_deviation));
  error.relative_low = error.relative_mse / factor, error.relative_high = error.relative_mse * factor;
  error.tail_index = hill_index(sums.largest.sorted());
  return error;
}

Plane relative_errors(const FilmPlanes& p) {
  Plane errors(p.passes.size());
  sum_pixels(p, [&](std::size_t i, double relative) { errors[i] = float(relative); });
  return errors;
}

}  // namespace montelux
