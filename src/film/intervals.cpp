#include "film/intervals.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "film/film.h"
#include "film/likeness.h"
#include "film/max_around.h"
#include "math/special.h"

namespace montelux {

namespace {

constexpr int reach = 3;  // pixels, and blocks in the wide neighbourhood
constexpr float spatial_scale = 2.0f * reach / 3.0f;
constexpr int block = 4;  // pixels per side
// Of the squared difference of two means over its variance: a neighbour's weight is a half there.
constexpr float sure_difference = 8;
// The degrees of freedom of what is known from the neighbours: how much standard errors of like pixels differ. Half of
// them where the weights of all neighbours sum to `few_alike`; a neighbour that shows the like has nearly 1.
constexpr double prior_freedom = 10, few_alike = 0.5;
// Those of the pixel's own variance at most: many passes are short, and short passes are far from normal.
constexpr double own_freedom = 15;
// The relative variance of the mean over the near neighbourhood from that over the wide one.
constexpr double scale_heterogeneity = 0.3;
// Of the squared difference of the brightness of both over its variance: half of it is believed there. A few rare
// samples, which the near pixels may lack by chance, differ by their number at most.
constexpr double sure_darkness = 128;
// The least standard error of a pixel beside an emitter, in units of the emitter's: it may show a part of it that no
// sample has hit.
constexpr float beside_emitter = 0.2f;
// If none of n independent samples of a pixel hits a lamp, the lamp covers less than -log(1 - confidence) / n of it (3
// / n for 95 %: Hanley and Lippman-Hand 1983). Samples that are spread over the pixel leave a part of that,
// which is measured: with two thirds the edges of lamps are covered as other pixels are.
constexpr double spread_samples = 2.0 / 3;

// Standard errors of pixels, or of blocks of pixels, and what makes them alike.
struct Spreads {
  int width, height;
  ColorPlanes albedo, error, square;  // `error`: the mean of the standard errors; `square`: of their squares
  std::array<Plane, 3> normal;
  Plane object, brightness, noise;  // mean of the channels; its variance
  Plane known;                      // 1 or 0

  Spreads(int w, int h) : width(w), height(h) {
    for (auto* planes : {&albedo, &error, &square, &normal})
      for (Plane& plane : *planes) plane.resize(size());
    for (Plane* plane : {&object, &brightness, &noise, &known}) plane->resize(size());
  }
  std::size_t size() const { return std::size_t(width) * std::size_t(height); }
};

// The expectation of the root of a chi-square variable over its degrees of freedom: what the standard error of a normal
// sample is in the mean, in units of the true one.
double mean_of_chi(double freedom) {
  return std::sqrt(2 / freedom) * std::exp(special::log_gamma((freedom + 1) / 2) - special::log_gamma(freedom / 2));
}

// The quantiles of Student's t for the degrees of freedom of a pixel plus those of what is known from its neighbours,
// the latter rounded so that few are computed.
class Quantiles {
 public:
  explicit Quantiles(double confidence) : confidence_(confidence) {}
  // `freedom`: whole; `prior`: at most prior_freedom, replaced by the rounded one.
  double operator()(double freedom, double& prior) {
    if (freedom != freedom_) values_.fill(0), freedom_ = freedom;
    const int step = int(std::lround(prior * steps));
    prior = double(step) / steps;
    double& value = values_[std::size_t(step)];
    if (value == 0) value = special::student_t_quantile(0.5 + confidence_ / 2, freedom + prior);
    return value;
  }

 private:
  static constexpr int steps = 8;  // of one degree of freedom
  double confidence_, freedom_ = 0;
  std::array<double, std::size_t(prior_freedom) * steps + 1> values_{};
};

// Numbers that no sum of squares can hold belong to no pixel that others can use.
bool is_usable(double x) { return std::abs(x) < 1e15; }

Spreads spreads_of(const FilmPlanes& planes) {
  const PixelBounds& b = planes.bounds;
  Spreads s(b.width(), b.height());
  s.albedo = planes.albedo, s.normal = planes.normal, s.object = planes.object;
  std::uint32_t last_passes = 0;  // which most pixels share
  double bias = 1;
  std::size_t i = 0;
  for (int y = b.y0; y < b.y1; ++y)
    for (int x = b.x0; x < b.x1; ++x, ++i) {
      const std::uint32_t passes = planes.passes[i];
      if (passes < 2) continue;
      if (passes != last_passes) bias = mean_of_chi((last_passes = passes) - 1.0);
      bool usable = true;
      for (std::size_t c = 0; c < rgb_size; ++c) {
        const float variance = planes.variance[c][i];
        usable &= is_usable(double(variance)) && is_usable(double(planes.mean[c][i]));
        s.error[c][i] = float(std::sqrt(double(variance)) / bias), s.square[c][i] = variance;
        s.brightness[i] += planes.mean[c][i] / rgb_size, s.noise[i] += variance / rgb_size;
      }
      s.known[i] = usable ? 1.0f : 0.0f;
      if (usable) continue;
      for (std::size_t c = 0; c < rgb_size; ++c) s.error[c][i] = s.square[c][i] = 0;
      s.brightness[i] = s.noise[i] = 0;
    }
  return s;
}

// Whether most of the light of a pixel is of emitters that the camera sees: small ones say nothing about others.
std::vector<std::uint8_t> emitters_of(const FilmPlanes& planes) {
  std::vector<std::uint8_t> emitters(planes.emission.size());
  for (std::size_t i = 0; i < emitters.size(); ++i) {
    float mean = 0;
    for (const Plane& channel : planes.mean) mean += channel[i] / rgb_size;
    emitters[i] = 2 * planes.emission[i] > mean;
  }
  return emitters;
}

// The means over blocks of pixels, without those of emitters; `noise` is the variance of that of the brightness.
Spreads blocks_of(const Spreads& s, const std::vector<std::uint8_t>& emitters) {
  Spreads blocks((s.width + block - 1) / block, (s.height + block - 1) / block);
  Plane count(blocks.size());
  const auto each_plane = [](const Spreads& from, Spreads& to, auto action) {
    for (std::size_t c = 0; c < 3; ++c) {
      action(from.albedo[c], to.albedo[c]), action(from.normal[c], to.normal[c]);
      action(from.error[c], to.error[c]), action(from.square[c], to.square[c]);
    }
  };
  for (int y = 0; y < s.height; ++y)
    for (int x = 0; x < s.width; ++x) {
      const std::size_t i = std::size_t(y) * std::size_t(s.width) + std::size_t(x);
      const std::size_t k = std::size_t(y / block) * std::size_t(blocks.width) + std::size_t(x / block);
      if (s.known[i] == 0 || emitters[i]) continue;
      each_plane(s, blocks, [&](const Plane& from, Plane& to) { to[k] += from[i]; });
      blocks.brightness[k] += s.brightness[i], blocks.noise[k] += s.noise[i];
      blocks.object[k] = s.object[i], blocks.known[k] = 1, count[k] += 1;
    }
  for (float& n : count) n = std::max(n, 1.0f);
  each_plane(blocks, blocks, [&](const Plane&, Plane& plane) {
    for (std::size_t k = 0; k < plane.size(); ++k) plane[k] /= count[k];
  });
  for (std::size_t k = 0; k < count.size(); ++k)
    blocks.brightness[k] /= count[k], blocks.noise[k] /= count[k] * count[k];
  return blocks;
}

// Weighted means over the neighbours of each pixel, without itself.
struct Pooled {
  ColorPlanes error, square;
  Plane brightness, noise;  // the mean brightness; its variance
  Plane count;              // number of neighbours of equal weight with the same variance (Kish 1965); 0: none
  Plane weight;             // of all neighbours
};

// Sums over the neighbours of a row of pixels.
struct RowSums {
  ColorPlanes error, square;
  Plane brightness, noise, weight, weight_square;

  explicit RowSums(std::size_t width) : width_(width) {}
  void clear() {
    for (std::size_t c = 0; c < rgb_size; ++c) error[c].assign(width_, 0.0f), square[c].assign(width_, 0.0f);
    for (Plane* plane : {&brightness, &noise, &weight, &weight_square}) plane->assign(width_, 0.0f);
  }

 private:
  std::size_t width_;
};

template <std::size_t n>
std::array<const float*, n> rows_at(const std::array<Plane, n>& planes, std::ptrdiff_t first) {
  std::array<const float*, n> rows;
  for (std::size_t i = 0; i < n; ++i) rows[i] = planes[i].data() + first;
  return rows;
}

// Adds one neighbour to each pixel of a row. `compares`: it counts little where its brightness surely differs. The
// inner loop has no branches, so that it runs in lanes.
template <bool compares>
void add_neighbour(const Spreads& s, int row, int dx, int dy, RowSums& sums) {
  const int x0 = std::max(0, -dx), x1 = std::min(s.width, s.width - dx);
  const std::ptrdiff_t own = std::ptrdiff_t(row) * s.width, other = own + std::ptrdiff_t(dy) * s.width + dx;
  const float near = 1 / (1 + float(dx * dx + dy * dy) / (spatial_scale * spatial_scale));
  const auto albedo = rows_at(s.albedo, own), albedo_there = rows_at(s.albedo, other);
  const auto normal = rows_at(s.normal, own), normal_there = rows_at(s.normal, other);
  const auto error = rows_at(s.error, other), square = rows_at(s.square, other);
  const float *object = s.object.data() + own, *object_there = s.object.data() + other;
  const float *brightness = s.brightness.data() + own, *brightness_there = s.brightness.data() + other;
  const float *noise = s.noise.data() + own, *noise_there = s.noise.data() + other;
  const float* known = s.known.data() + other;
  // No other pointer aliases the sums.
  float* __restrict weights = sums.weight.data(), * __restrict weight_squares = sums.weight_square.data();
  float* __restrict lights = sums.brightness.data(), * __restrict noises = sums.noise.data();
  float *__restrict error0 = sums.error[0].data(), *__restrict error1 = sums.error[1].data(),
        *__restrict error2 = sums.error[2].data();
  float *__restrict square0 = sums.square[0].data(), *__restrict square1 = sums.square[1].data(),
        *__restrict square2 = sums.square[2].data();
#ifndef __clang__  // which sees by itself that no iteration depends on another
#pragma GCC ivdep
#endif
  for (int x = x0; x < x1; ++x) {
    float albedos = 0, normals = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const float a = albedo[c][x] - albedo_there[c][x], n = normal[c][x] - normal_there[c][x];
      albedos += a * a, normals += n * n;
    }
    float w = likeness(near, albedos, normals, object[x] == object_there[x]) * known[x];
    if constexpr (compares) {
      const float difference = brightness[x] - brightness_there[x];
      const float sure = difference * difference / ((noise[x] + noise_there[x]) * sure_difference + 1e-30f);
      w /= 1 + sure * sure;
    }
    weights[x] += w, weight_squares[x] += w * w;
    lights[x] += w * brightness_there[x], noises[x] += w * w * noise_there[x];
    error0[x] += w * error[0][x], error1[x] += w * error[1][x], error2[x] += w * error[2][x];
    square0[x] += w * square[0][x], square1[x] += w * square[1][x], square2[x] += w * square[2][x];
  }
}

template <bool compares>
Pooled pooled_of(const Spreads& s) {
  Pooled pooled;
  for (ColorPlanes* planes : {&pooled.error, &pooled.square})
    for (Plane& plane : *planes) plane.resize(s.size());
  for (Plane* plane : {&pooled.brightness, &pooled.noise, &pooled.count, &pooled.weight}) plane->resize(s.size());
  RowSums sums{std::size_t(s.width)};
  for (int row = 0; row < s.height; ++row) {
    sums.clear();
    for (int dy = std::max(-reach, -row); dy <= std::min(reach, s.height - 1 - row); ++dy)
      for (int dx = -reach; dx <= reach; ++dx)
        if ((dx != 0 || dy != 0) && std::abs(dx) < s.width) add_neighbour<compares>(s, row, dx, dy, sums);
    for (std::size_t x = 0; x < std::size_t(s.width); ++x) {
      const float weight = sums.weight[x];
      if (weight <= 0 || sums.weight_square[x] <= 0) continue;
      const std::size_t i = std::size_t(row) * std::size_t(s.width) + x;
      for (std::size_t c = 0; c < rgb_size; ++c) {
        pooled.error[c][i] = sums.error[c][x] / weight;
        pooled.square[c][i] = sums.square[c][x] / weight;
      }
      pooled.brightness[i] = sums.brightness[x] / weight, pooled.noise[i] = sums.noise[x] / (weight * weight);
      pooled.count[i] = weight * weight / sums.weight_square[x], pooled.weight[i] = weight;
    }
  }
  return pooled;
}

// The relative variance of one of the pooled standard errors.
double scatter_of(double mean, double square) { return mean > 0 ? std::max(square / (mean * mean) - 1, 0.0) : 0; }

// What the standard errors of the wide neighbourhood are multiplied by where the near one is surely darker, as beside a
// highlight: the root of the ratio of their brightness, as if both had the same kind of samples at different rates.
double darkness_around(const Pooled& near, std::size_t i, const Pooled& wide, std::size_t k) {
  const double own = std::max(double(near.brightness[i]), 0.0), other = double(wide.brightness[k]);
  if (!(own < other)) return 1;
  const double variance = double(near.noise[i]) + double(wide.noise[k]);
  const double sure = (other - own) * (other - own) / (variance * sure_darkness + 1e-30);
  return std::pow(own / other, 0.5 * sure * sure / (1 + sure * sure));
}

// The standard error that the neighbours of a pixel have: the mean over the near ones, shrunk toward that over the wide
// neighbourhood by the share of its variance that is noise. `darkness`: as above.
double error_around(const Pooled& near, std::size_t i, const Pooled& wide, std::size_t k, double darkness,
                    std::size_t c) {
  const double n = double(near.count[i]), wide_n = double(wide.count[k]) * block * block;
  const double own = double(near.error[c][i]), other = double(wide.error[c][k]);
  if (wide_n <= 0) return own;
  const double scatter = scatter_of(other, double(wide.square[c][k]));
  const double noise = std::max(scatter, scatter_of(own, double(near.square[c][i]))) / n;
  const double share = noise / (noise + scatter / wide_n + scale_heterogeneity);
  return own + share * (darkness * other - own);
}

// At each pixel the largest standard error of the emitters that the 3 x 3 pixels around it show.
Plane emitters_around(const Spreads& s, const std::vector<std::uint8_t>& emitters, std::size_t c) {
  Plane error = s.error[c];
  for (std::size_t i = 0; i < error.size(); ++i)
    if (!emitters[i]) error[i] = 0;
  return max_around(error, s.width, 1);
}

// At each pixel 1 if one of the 3 x 3 pixels around it shows a lamp that may cover a part of it, else 0: an emitter, or
// mostly what is beyond the scene.
Plane lamps_around(const FilmPlanes& planes, const std::vector<std::uint8_t>& emitters,
                   const std::vector<std::uint8_t>& known_covers) {
  Plane lamps(emitters.size()), beyond(emitters.size());
  for (std::size_t i = 0; i < lamps.size(); ++i) {
    beyond[i] = planes.passes[i] > 0 && planes.coverage[i] < 0.5f ? 1.0f : 0.0f;
    lamps[i] = emitters[i] ? 1.0f : beyond[i];
  }
  lamps = max_around(lamps, planes.bounds.width(), 1), beyond = max_around(beyond, planes.bounds.width(), 1);
  for (std::size_t i = 0; i < lamps.size(); ++i)
    if (known_covers[i]) lamps[i] = beyond[i];
  return lamps;
}

// The difference between the brightest and the darkest of the 3 x 3 pixels around each pixel where `lamps` is 1, else
// 0.
Plane contrast_of_lamps(const Plane& mean, const Plane& lamps, int width) {
  Plane negative = mean;
  for (float& x : negative) x = -x;
  Plane contrast = max_around(mean, width, 1);
  const Plane darkest = max_around(negative, width, 1);
  for (std::size_t i = 0; i < contrast.size(); ++i) contrast[i] = lamps[i] * (contrast[i] + darkest[i]);
  return contrast;
}

}  // namespace

double interval_freedom(double passes) { return std::min(passes - 1, own_freedom) + prior_freedom; }

PixelIntervals pixel_intervals(const Film& film, double confidence) {
  FilmPlanes planes(film.bounds());
  planes.copy(film, film.bounds());
  return pixel_intervals(planes, confidence);
}

PixelIntervals pixel_intervals(const FilmPlanes& planes, double confidence) {
  const PixelBounds& b = planes.bounds;
  const Spreads spreads = spreads_of(planes);
  const std::vector<std::uint8_t> emitters = emitters_of(planes);
  const Spreads blocks = blocks_of(spreads, emitters);
  const Pooled near = pooled_of<true>(spreads), wide = pooled_of<false>(blocks);
  const std::vector<std::uint8_t> known_covers = known_covers_of(planes);
  const Plane lamps = lamps_around(planes, emitters, known_covers);
  ColorPlanes beside, contrast;
  for (std::size_t c = 0; c < rgb_size; ++c) {
    beside[c] = emitters_around(spreads, emitters, c);
    contrast[c] = contrast_of_lamps(planes.mean[c], lamps, b.width());
  }
  PixelIntervals intervals{b, confidence, planes.mean, planes.mean};
  Quantiles quantiles(confidence);
  std::size_t i = 0;
  for (int y = 0; y < b.height(); ++y)
    for (int x = 0; x < b.width(); ++x, ++i) {
      const std::size_t k = std::size_t(y / block) * std::size_t(blocks.width) + std::size_t(x / block);
      const double freedom = std::min(double(planes.passes[i]) - 1, own_freedom);
      if (freedom < 1) {
        for (std::size_t c = 0; c < rgb_size; ++c)
          intervals.low[c][i] = -std::numeric_limits<float>::infinity(), intervals.high[c][i] = -intervals.low[c][i];
        continue;
      }
      const double weight = spreads.known[i] > 0 ? double(near.weight[i]) : 0;
      double prior = prior_freedom * weight / (weight + few_alike);
      const double quantile = quantiles(freedom, prior);
      const double darkness = weight > 0 ? darkness_around(near, i, wide, k) : 1;
      const double uncertain_cover = -spread_samples * std::log(1 - confidence) / double(planes.emission_rays[i]);
      for (std::size_t c = 0; c < rgb_size; ++c) {
        double around = 0;
        if (weight > 0) around = emitters[i] ? double(near.error[c][i]) : error_around(near, i, wide, k, darkness, c);
        if (!known_covers[i]) around = std::max(around, double(beside_emitter * beside[c][i]));
        const double variance = (prior * around * around + freedom * double(planes.variance[c][i])) / (prior + freedom);
        const double mean = double(planes.mean[c][i]);
        const double half_width = std::max(quantile * std::sqrt(variance), uncertain_cover * double(contrast[c][i]));
        intervals.low[c][i] = float(mean - half_width), intervals.high[c][i] = float(mean + half_width);
      }
    }
  return intervals;
}

}  // namespace montelux
