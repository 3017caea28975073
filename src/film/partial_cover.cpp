#include "film/partial_cover.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "film/max_around.h"
#include "film/picture_error.h"

namespace montelux {

namespace {

// The pixels around count like so many samples at most where something covers all of a pixel. What covers less at most
// covers as much less of each pixel, so that they count for more.
constexpr double max_prior_samples = 2;
// Smaller parts count as none: filters end, and show nothing of what lies farther away.
constexpr double min_part = 1e-3;

double mean_of(const std::array<double, rgb_size>& channels) {
  double sum = 0;
  for (double c : channels) sum += c;
  return sum / rgb_size;
}

// The beta distribution of a part p, by points of equal distance in log(p / (1 - p)). Calls f(p, the density there,
// half of the distance to the next point).
template <class Function>
void for_each_part(double hits, double misses, Function f) {
  constexpr int points = 8;  // on each side of the mode
  constexpr double step = 0.5, max_deviation = 6;
  const double mode = std::log(hits / misses), deviation = std::sqrt(1 / hits + 1 / misses);
  // The part, and the logarithm of its density there.
  const auto at = [&](double z) {
    const double odds = std::exp(-z), log_p = -std::log1p(odds);
    return std::pair{1 / (1 + odds), (hits + misses) * log_p - misses * z};
  };
  const double largest = at(mode).second;
  const double distance = step * std::min(deviation, max_deviation);
  for (int i = -points; i <= points; ++i) {
    const auto [part, log_density] = at(mode + i * distance);
    f(part, std::exp(log_density - largest), 0.5 * distance * part * (1 - part));
  }
}

// 1 / (expectation^2 + relative_epsilon) of a part. Filters with negative lobes make what surrounds an emitter
// negative, so that some part has the expectation 0: there it is the mean up to half of the distance to the next
// points, or one point near that part would make most of the sum.
double reciprocal_of(double base, double bright, double part, double half_distance) {
  const double expected = base + part * bright, reach = half_distance * std::abs(bright);
  const double darkest = std::sqrt(relative_epsilon);
  if (base >= 0 || reach < 0.01 * darkest) return 1 / (expected * expected + relative_epsilon);
  return (std::atan((expected + reach) / darkest) - std::atan((expected - reach) / darkest)) / (2 * reach * darkest);
}

// Whether a share of the samples is one or more of them, apart from noise.
bool is_hit(double share, double samples) { return share * samples > 0.5; }

}  // namespace

double PartialCovers::Cover::brightness() const { return mean_of(bright); }

double PartialCovers::Cover::prior_samples() const {
  constexpr double uncertain = 3;  // hits
  const double at_most = std::min(largest + uncertain / samples, 1.0);
  return std::min(max_prior_samples / at_most, std::max(samples, max_prior_samples));
}

PartialCovers::PartialCovers(const FilmPlanes& planes)
    : planes_(planes), brightness_(planes.passes.size()), index_(planes.passes.size(), -1) {
  for (const Plane& channel : planes.mean)
    for (std::size_t i = 0; i < brightness_.size(); ++i) brightness_[i] += channel[i] / rgb_size;
  find_covers();
  measure_surfaces();
  measure_prior();
}

const PartialCovers::Cover* PartialCovers::cover_of(std::size_t pixel) const {
  return has(pixel) ? &covers_[std::size_t(index_[pixel])] : nullptr;
}

bool PartialCovers::is_at_rim(std::size_t pixel) const {
  const Cover* c = cover_of(pixel);
  return c && c->at_rim;
}

std::optional<PartialCovers::PossibleParts> PartialCovers::possible_parts(const Cover& c) const {
  const bool is_found = is_hit(c.share, c.samples);
  // The pixels around say nothing of an emitter that is smaller than a pixel; the agreement of halves knows it.
  if (c.of_emitter && is_found && 4 * c.around < c.share) return std::nullopt;
  const double prior_samples = is_found ? overlap_ * c.prior_samples() : c.prior_samples();
  const PossibleParts parts{c.samples * c.share + prior_samples * c.around,
                            c.samples * (1 - c.share) + prior_samples * (1 - c.around), is_found ? 1 : overlap_};
  constexpr double least = 1e-6;
  if (parts.hits < least || parts.misses < least) return std::nullopt;
  return parts;
}

std::array<double, rgb_size> PartialCovers::correction(std::size_t pixel,
                                                       const std::array<double, rgb_size>& reciprocal) const {
  constexpr std::array<double, rgb_size> none{};
  const Cover* c = cover_of(pixel);
  const std::optional<PossibleParts> parts = c ? possible_parts(*c) : std::nullopt;
  if (!parts) return none;
  const double of_light = mean_square_of_light(*c);
  double weights = 0;
  std::array<double, rgb_size> sums{};
  for_each_part(parts->hits, parts->misses, [&](double p, double weight, double half_distance) {
    weights += weight;
    if (p < min_part) return;
    const double variance = of_light * p * (1 - p) + c->noise * p * p;
    for (std::size_t k = 0; k < rgb_size; ++k)
      sums[k] += weight * variance * reciprocal_of(c->base[k], c->bright[k], p, half_distance);
  });
  const double as_seen = of_light * c->spread() + c->noise * c->share * c->share;
  const double factor = parts->weight / c->samples;
  std::array<double, rgb_size> correction;
  for (std::size_t k = 0; k < rgb_size; ++k)
    correction[k] = factor * c->bright[k] * c->bright[k] * (sums[k] / weights - as_seen * reciprocal[k]);
  const double mean = mean_of(correction);
  // They may show another emitter, which is larger: the error is at least what the agreement of halves says.
  if (!std::isfinite(mean) || (c->of_emitter && is_hit(c->share, c->samples) && mean < 0)) return none;
  return correction;
}

// The fourth moment of a mean of n independent samples of variance v and fourth cumulant k: 3 v^2 / n^2 + k / n^3. Hits
// that are rare have the fourth cumulant of a Poisson distribution.
std::optional<double> PartialCovers::mean_square(std::size_t pixel) const {
  const Cover* c = cover_of(pixel);
  const std::optional<PossibleParts> parts = c ? possible_parts(*c) : std::nullopt;
  if (!parts) return std::nullopt;
  const double of_light = mean_square_of_light(*c), n = c->samples;
  double weights = 0, sum = 0;
  for_each_part(parts->hits, parts->misses, [&](double p, double weight, double half_distance) {
    weights += weight;
    if (p < min_part) return;
    const double variance = of_light * p * (1 - p) + c->noise * p * p, cumulant = of_light * of_light * p * (1 - p);
    double reciprocal = 0;
    for (std::size_t k = 0; k < rgb_size; ++k)
      reciprocal += c->bright[k] * c->bright[k] * reciprocal_of(c->base[k], c->bright[k], p, half_distance) / rgb_size;
    sum += weight * (3 * variance * variance + cumulant / n) / (n * n) * reciprocal * reciprocal;
  });
  return parts->weight * sum / weights;
}

// Calls f(pixel) for those with passes.
template <class Function>
void PartialCovers::for_each_around(int x, int y, int reach, Function f) const {
  const int width = planes_.bounds.width(), height = planes_.bounds.height();
  for (int v = std::max(y - reach, 0); v <= std::min(y + reach, height - 1); ++v)
    for (int u = std::max(x - reach, 0); u <= std::min(x + reach, width - 1); ++u) {
      const auto pixel = std::size_t(v) * std::size_t(width) + std::size_t(u);
      if (planes_.passes[pixel] > 0) f(pixel);
    }
}

double PartialCovers::variance_of(std::size_t pixel) const {
  double sum = 0;
  for (const Plane& channel : planes_.variance) sum += double(channel[pixel]);
  return std::min(sum / rgb_size, double(std::numeric_limits<float>::max()));
}

void PartialCovers::find_covers() {
  const int width = planes_.bounds.width(), height = planes_.bounds.height();
  const Plane emission = max_around(planes_.emission, width, 1);
  Plane open = planes_.coverage;
  for (float& share : open) share = 1 - share;
  open = max_around(open, width, 1);
  const std::vector<std::uint8_t> known_covers = known_covers_of(planes_);
  std::size_t pixel = 0;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x, ++pixel) {
      if (planes_.passes[pixel] < 2 || planes_.samples[pixel] <= 0) continue;
      if (emission[pixel] <= 0 && open[pixel] <= 0) continue;
      Cover cover;
      cover.pixel = std::uint32_t(pixel), cover.samples = double(planes_.samples[pixel]);
      cover.of_emitter = emission[pixel] > 0 && covered_by_emitter(x, y, cover);
      if (cover.of_emitter && known_covers[pixel]) continue;
      if (cover.of_emitter) cover.samples = double(planes_.emission_rays[pixel]);
      if (!cover.of_emitter && !(open[pixel] > 0 && covered_before_darkness(x, y, cover))) continue;
      index_[pixel] = std::int32_t(covers_.size());
      covers_.push_back(cover);
    }
}

// Whether emission makes half of the contrast of the 3 x 3 pixels. The brightest of them shows the emitter, and by its
// variance how much of it: (standard error / mean)^2 is (1 - p) / p / (n - 1).
bool PartialCovers::covered_by_emitter(int x, int y, Cover& cover) const {
  std::size_t brightest = cover.pixel, darkest = cover.pixel;
  float most = 0, least = planes_.emission[cover.pixel];
  double around = 0;
  int count = 0;
  for_each_around(x, y, 1, [&](std::size_t i) {
    if (brightness_[i] > brightness_[brightest]) brightest = i;
    if (brightness_[i] < brightness_[darkest]) darkest = i;
    most = std::max(most, planes_.emission[i]), least = std::min(least, planes_.emission[i]);
    if (i != cover.pixel) around += double(brightness_[i]), ++count;
  });
  const double light = double(brightness_[brightest]), dark = double(brightness_[darkest]);
  if (count == 0 || light <= std::max(dark, 0.0) || 2 * double(most - least) < light - dark) return false;
  const double others = std::max(double(planes_.emission_rays[brightest]) - 1, 0.0);
  const double scale = 1 + others * variance_of(brightest) / (light * light);
  for (std::size_t c = 0; c < rgb_size; ++c) {
    cover.base[c] = double(planes_.mean[c][darkest]);
    cover.bright[c] = scale * (double(planes_.mean[c][brightest]) - cover.base[c]);
  }
  const auto share_of = [&](double value) { return std::clamp((value - dark) / (scale * (light - dark)), 0.0, 1.0); };
  cover.share = share_of(double(brightness_[cover.pixel])), cover.around = share_of(around / count);
  int half_covered = 0;
  cover.largest = 0;
  for_each_around(x, y, 1, [&](std::size_t i) {
    const double share = share_of(double(brightness_[i]));
    half_covered += share >= 0.5, cover.largest = std::max(cover.largest, share);
  });
  cover.at_rim = half_covered >= 2;
  if (cover.at_rim) cover.largest = 1;
  return true;
}

// Whether some samples of the 3 x 3 pixels meet surfaces, some meet none, and what is beyond is far darker, by the
// pixels near that show nothing else.
bool PartialCovers::covered_before_darkness(int x, int y, Cover& cover) const {
  constexpr double dark = 0.25;
  double covered = 0, open = 0, around = 0;
  int count = 0, empty = 0;
  std::array<double, rgb_size> sum{}, beyond{};
  for_each_around(x, y, 1, [&](std::size_t i) {
    const double share = double(planes_.coverage[i]);
    covered += share, open += 1 - share;
    for (std::size_t c = 0; c < rgb_size; ++c) sum[c] += double(planes_.mean[c][i]);
    if (i != cover.pixel) around += share, ++count;
  });
  if (covered <= 0 || open <= 0 || count == 0) return false;
  for_each_around(x, y, 2, [&](std::size_t i) {
    if (planes_.coverage[i] > 0) return;
    for (std::size_t c = 0; c < rgb_size; ++c) beyond[c] += double(planes_.mean[c][i]);
    ++empty;
  });
  if (empty == 0) return false;
  for (std::size_t c = 0; c < rgb_size; ++c) {
    cover.base[c] = beyond[c] / empty;
    cover.bright[c] = (sum[c] - open * cover.base[c]) / covered - cover.base[c];
  }
  cover.share = double(planes_.coverage[cover.pixel]), cover.around = around / count;
  return cover.brightness() > 0 && mean_of(cover.base) <= dark * cover.brightness();
}

// m of surfaces from all pixels, by those of little cover; h from the covers among the 3 x 3 pixels.
void PartialCovers::measure_surfaces() {
  constexpr double min_square = 0.1, max_square = 10, prior = 1;
  double variances = prior, spreads = prior;
  for (const Cover& c : covers_) {
    if (c.of_emitter) continue;
    const double open = 1 - c.share, weight = open * open * open * open, light = c.brightness();
    variances += weight * variance_of(c.pixel) * c.samples / (light * light), spreads += weight * c.spread();
  }
  mean_square_ = std::clamp(variances / spreads, min_square, max_square);
  const int width = planes_.bounds.width();
  for (Cover& c : covers_) {
    if (c.of_emitter) continue;
    const double light = c.brightness();
    double noise = 0, squares = 0;
    for_each_around(int(c.pixel) % width, int(c.pixel) / width, 1, [&](std::size_t i) {
      const Cover* other = cover_of(i);
      if (!other || other->of_emitter) return;
      noise += variance_of(i) * other->samples / (light * light) - mean_square_ * other->spread();
      squares += other->share * other->share;
    });
    c.noise = squares > 0 ? std::max(noise / squares, 0.0) : 0;
  }
}

// Where one half of the passes has no hit, the other half shows how much cover is left to be found: as much as the
// pixels around have if the filters of pixels overlap, and else less. By regression, for pixels alone say nothing of
// it.
void PartialCovers::measure_prior() {
  constexpr double few = 0.02;
  double seen = few, foreseen = few;
  for (const Cover& c : covers_) {
    const double base = mean_of(c.base), light = c.brightness();
    const auto share_of = [&](float half) { return std::clamp((double(half) - base) / light, 0.0, 1.0); };
    const double prior = c.prior_samples(), expected = prior * c.around / (c.samples / 2 + prior);
    const double first = share_of(planes_.first_half[c.pixel]), second = share_of(planes_.second_half[c.pixel]);
    for (const auto& [empty, other] : {std::pair{first, second}, std::pair{second, first}})
      if (!is_hit(empty, c.samples)) seen += c.around * other, foreseen += c.around * expected;
  }
  overlap_ = std::min(seen / foreseen, 1.0);
}

}  // namespace montelux
