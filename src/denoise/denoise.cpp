#include "denoise/denoise.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "denoise/box_mean.h"
#include "denoise/squared_error.h"
#include "denoise/weighted_sums.h"

namespace montelux {

HalfPlanes::HalfPlanes(std::size_t pixels) : share(pixels) {
  for (ColorPlanes* planes : {&color, &albedo})
    for (Plane& plane : *planes) plane.resize(pixels);
  for (Plane& plane : normal) plane.resize(pixels);
}

NoisyImage::NoisyImage(int w, int h) : width(w), height(h), halves{HalfPlanes(pixels()), HalfPlanes(pixels())} {
  for (Plane& plane : variance) plane.resize(pixels());
}

namespace {

constexpr int choice_reach = 3;   // pixels over which estimated errors are averaged to choose a filter,
constexpr int error_reach = 10;   // and to be stated: the estimate at one pixel has the noise of the unfiltered image
constexpr int choice_spread = 5;  // pixels over which the choices are averaged: neighbours share what the estimates say
// The candidates: the filters, the means of the first of them and the image, the image.
constexpr std::size_t halved = 2;

float relative_scale(float brightness) { return 1 / (brightness * brightness + 0.01f); }

float mean_of_channels(const ColorPlanes& planes, std::size_t i) {
  float sum = 0;
  for (const Plane& plane : planes) sum += plane[i];
  return sum / rgb_size;
}

class Denoiser {
 public:
  Denoiser(const NoisyImage& image, const DenoiseSettings& settings)
      : image_(image),
        filtered_(filter_halves(image, settings)),
        filters_(filtered_[0].size()),
        unfiltered_(filters_ + halved),
        relative_(image.pixels()) {}

  DenoisedImage run() {
    find_scale();
    choose();
    return combine();
  }

 private:
  // Both halves exist: elsewhere nothing is known of the error, and nothing is filtered.
  bool has_halves(std::size_t i) const {
    const float share = image_.halves[0].share[i];
    return share > 0 && share < 1;
  }
  Noisy noisy(std::size_t c, std::size_t i) const {
    const auto& [a, b] = image_.halves;
    return {double(a.color[c][i]), double(b.color[c][i]), double(a.share[i]), double(image_.variance[c][i])};
  }
  Filtered candidate(std::size_t k, std::size_t c, std::size_t i) const {
    if (k == unfiltered_) {
      const Noisy n = noisy(c, i);
      return {n.first, n.second, 1, 1};
    }
    if (k >= filters_) return mean(candidate(k - filters_, c, i), candidate(unfiltered_, c, i));
    const FilteredHalf &a = filtered_[0][k], &b = filtered_[1][k];
    return {double(a.color[c][i]), double(b.color[c][i]), double(a.own[i]), double(b.own[i])};
  }
  static Filtered mean(const Filtered& a, const Filtered& b) {
    return {(a.first + b.first) / 2, (a.second + b.second) / 2, (a.own_first + b.own_first) / 2,
            (a.own_second + b.own_second) / 2};
  }
  // Mean over the channels, relative.
  float error_of(std::size_t k, std::size_t i) const {
    double sum = 0;
    for (std::size_t c = 0; c < rgb_size; ++c) {
      const Noisy n = noisy(c, i);
      sum += k == unfiltered_ ? n.variance : squared_error(n, candidate(k, c, i));
    }
    return float(sum / rgb_size * double(relative_[i]));
  }

  // Relative errors are divided by the square of the first filter's result, the mean over 3 x 3 pixels.
  void find_scale() {
    Plane gray(image_.pixels());
    for (std::size_t i = 0; i < gray.size(); ++i) {
      double sum = 0;
      for (std::size_t c = 0; c < rgb_size; ++c) {
        const double s = has_halves(i) ? noisy(c, i).share : 0.5;
        const Filtered f = candidate(0, c, i);
        sum += s * f.first + (1 - s) * f.second;
      }
      gray[i] = float(sum / rgb_size);
    }
    const Plane mean = box_mean(gray, image_.width, image_.height, 1);
    for (std::size_t i = 0; i < gray.size(); ++i) relative_[i] = relative_scale(mean[i]);
  }

  // The candidate with the least error around the pixel. What one pixel chooses is a noisy decision: it is averaged.
  void choose() {
    const int w = image_.width, h = image_.height;
    std::vector<std::uint8_t> choice(image_.pixels(), 0);
    Plane least(image_.pixels(), std::numeric_limits<float>::infinity()), error(image_.pixels());
    for (std::size_t k = 0; k <= unfiltered_; ++k) {
      for (std::size_t i = 0; i < error.size(); ++i) error[i] = has_halves(i) ? error_of(k, i) : 0;
      const Plane mean = box_mean(error, w, h, choice_reach);
      for (std::size_t i = 0; i < error.size(); ++i)
        if (mean[i] < least[i]) least[i] = mean[i], choice[i] = std::uint8_t(k);
    }
    for (std::size_t k = 0; k <= unfiltered_; ++k) {
      Plane chosen(image_.pixels());
      for (std::size_t i = 0; i < chosen.size(); ++i)
        chosen[i] = (has_halves(i) ? choice[i] : unfiltered_) == k ? 1.0f : 0.0f;
      shares_.push_back(box_mean(chosen, w, h, choice_spread));
    }
  }

  // The mixture of the candidates that were chosen.
  Filtered mixture(std::size_t c, std::size_t i) const {
    Filtered sum{0, 0, 0, 0};
    for (std::size_t k = 0; k < shares_.size(); ++k) {
      const double share = double(shares_[k][i]);
      if (share == 0) continue;
      const Filtered f = candidate(k, c, i);
      sum.first += share * f.first, sum.second += share * f.second;
      sum.own_first += share * f.own_first, sum.own_second += share * f.own_second;
    }
    return sum;
  }

  DenoisedImage combine() {
    DenoisedImage result;
    for (std::size_t c = 0; c < rgb_size; ++c) {
      result.color[c].resize(image_.pixels());
      for (std::size_t i = 0; i < image_.pixels(); ++i) {
        const Noisy n = noisy(c, i);
        const Filtered f = mixture(c, i);
        result.color[c][i] = float(has_halves(i) ? n.share * f.first + (1 - n.share) * f.second : n.first);
      }
    }
    for (std::size_t i = 0; i < image_.pixels(); ++i) relative_[i] = relative_scale(mean_of_channels(result.color, i));
    for (std::size_t c = 0; c < rgb_size; ++c) estimate_error(c, result);
    for (float share : shares_[unfiltered_]) result.filtered += share < 1 ? 1.0 / double(image_.pixels()) : 0;
    result.mse = std::max(result.mse, least_);
    for (double* sum : {&result.mse, &result.relative_mse, &result.noisy_mse, &result.noisy_relative_mse})
      *sum /= std::max(measured_, 1.0);
    return result;
  }

  // Of one channel; adds to the sums over all.
  void estimate_error(std::size_t c, DenoisedImage& result) {
    Plane error(image_.pixels(), 0.0f), spread(image_.pixels(), 0.0f);
    for (std::size_t i = 0; i < image_.pixels(); ++i) {
      if (!has_halves(i)) continue;
      const Noisy n = noisy(c, i);
      const Filtered f = mixture(c, i);
      const double squared = squared_error(n, f), relative = double(relative_[i]);
      const double noise = n.share * (1 - n.share) * (f.first - f.second) * (f.first - f.second);
      error[i] = float(squared * relative), spread[i] = float(noise * relative);
      result.mse += squared, least_ += noise;
      result.noisy_mse += n.variance, result.noisy_relative_mse += n.variance * relative;
      measured_ += 1;
    }
    // Means of relative errors: those of bright pixels must not spread to dark ones.
    const Plane mean = box_mean(error, image_.width, image_.height, error_reach);
    const Plane noise = box_mean(spread, image_.width, image_.height, error_reach);
    result.error[c].resize(image_.pixels());
    for (std::size_t i = 0; i < image_.pixels(); ++i) {
      // The difference of the halves shows their noise alone: the error is not less.
      const float relative = std::max({mean[i], noise[i], 0.0f}), squared = relative / relative_[i];
      result.error[c][i] = std::sqrt(squared);
      if (has_halves(i)) result.relative_mse += double(relative);
    }
  }

  const NoisyImage& image_;
  const FilteredHalves filtered_;
  const std::size_t filters_, unfiltered_;  // the number of the filters; the number of the image among the candidates
  Plane relative_;
  std::vector<Plane> shares_;        // of each candidate
  double measured_ = 0, least_ = 0;  // numbers of pixels and channels; the sum of the noise of these
};

}  // namespace

DenoisedImage denoise(const NoisyImage& image, const DenoiseSettings& settings) {
  return Denoiser(image, settings).run();
}

}  // namespace montelux
