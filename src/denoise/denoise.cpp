#include "denoise/denoise.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "denoise/box_mean.h"
#include "denoise/choice.h"
#include "denoise/color_filter.h"
#include "denoise/filter_error.h"
#include "denoise/relative_scale.h"
#include "denoise/small_lamps.h"
#include "denoise/squared_error.h"
#include "denoise/units.h"
#include "denoise/weighted_sums.h"
#include "film/max_around.h"
#include "film/picture_error.h"
#include "math/functions.h"

namespace montelux {

HalfPlanes::HalfPlanes(std::size_t pixels) : share(pixels) {
  for (ColorPlanes* planes : {&color, &albedo, &emission})
    for (Plane& plane : *planes) plane.resize(pixels);
  for (Plane& plane : normal) plane.resize(pixels);
}

NoisyLayer::NoisyLayer(std::size_t pixels, bool knows_variance, std::string_view family_name) : family(family_name) {
  for (ColorPlanes& half : halves)
    for (Plane& plane : half) plane.resize(pixels);
  for (Plane& plane : variance) plane.resize(knows_variance ? pixels : 0);
}

NoisyImage::NoisyImage(int w, int h) : width(w), height(h), halves{HalfPlanes(pixels()), HalfPlanes(pixels())} {
  for (Plane& plane : variance) plane.resize(pixels());
}

namespace {

// What a filter blurs shows more than noise of the same squared error. So the bias of a candidate counts more, by the
// square of its ratio to the noise of the image, both over so many pixels, times `bias_weight`, at most `max_bias`.
constexpr float bias_weight = 12, max_bias = 1.2f;
// What neighbours choose counts in full up to this multiple of the least error at the pixel.
constexpr float choice_tolerance = 3;
// A pixel is beside a lamp if, as near as the filter reaches, an emitter that the camera sees is brighter by this
// factor.
constexpr int beside_lamp_reach = filter_reach + 1;
constexpr float beside_lamp_contrast = 3;
constexpr int choice_spread_beside_lamps = 3;
// The candidates: the filters, the mean of the first of them and the image, the image.
constexpr std::size_t halved = 1;

// Layers that are fitted may be below zero, though the image is not. They become zero; the others of their family lose
// in proportion what they gain, so that the family sums to what it did.
void keep_layers_above_zero(const std::vector<NoisyLayer>& noisy, std::vector<DenoisedLayer>& layers) {
  std::map<std::string_view, std::vector<std::size_t>> families;
  for (std::size_t k = 0; k < noisy.size(); ++k)
    if (!noisy[k].family.empty()) families[noisy[k].family].push_back(k);
  for (const auto& [name, members] : families)
    for (std::size_t c = 0; c < rgb_size; ++c)
      for (std::size_t i = 0; i < layers.front().color[c].size(); ++i) {
        float sum = 0, positive = 0;
        for (std::size_t k : members) {
          const float value = layers[k].color[c][i];
          sum += value, positive += std::max(value, 0.0f);
        }
        if (sum <= 0 || sum == positive) continue;
        for (std::size_t k : members) {
          float& value = layers[k].color[c][i];
          value = std::max(value, 0.0f) * (sum / positive);
        }
      }
}

class Denoiser {
 public:
  // `lamps`: what the image is the rest of; null: it is whole. `whole`: that of the whole image; null: not known.
  Denoiser(const NoisyImage& image, const SplitImage* lamps, const FilmPlanes* whole, const DenoiseSettings& settings)
      : image_(image),
        lamps_(lamps),
        whole_(whole),
        settings_(settings),
        filtered_(filter_halves(image, settings)),
        filters_(filtered_[0].size()),
        unfiltered_(filters_ + halved),
        relative_(image.pixels()) {}

  DenoisedImage run() {
    find_scale();
    choose();
    keep_above_zero();
    DenoisedImage result;
    const FilteredColors all = filtered_colors();
    const FilterError error(image_, lamps_, &own_, settings_);
    error.state(all, whole_, result);
    error.count_changed([&](std::size_t i) { return mixture_.unfiltered[i] < 1; }, result.sums);
    add_layers(error, result);
    return result;
  }

 private:
  bool has_halves(std::size_t i) const { return image_.has_halves(i); }
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
    // Not with the noise that pixels share: its law is one for the image, too coarse to choose by.
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

  // The part of it that is noise, at most: no pixel counts more in a filter than the pixel itself, whose share is the
  // greatest that the squares of all shares sum to.
  float noise_of(std::size_t k, std::size_t i) const {
    const bool is_mean = k >= filters_ && k != unfiltered_;
    double sum = 0;
    for (std::size_t c = 0; c < rgb_size; ++c) {
      const Noisy n = noisy(c, i);
      const Filtered f = candidate(is_mean ? k - filters_ : k, c, i);
      const double own = n.share * f.own_first + (1 - n.share) * f.own_second;
      sum += n.variance * (is_mean ? (1 + 3 * own) / 4 : own);  // of the mean of both: their covariance is `own`, too
    }
    return float(sum / rgb_size * double(relative_[i]));
  }

  // Relative errors are divided by the square of the first filter's result, the mean over 3 x 3 pixels.
  void find_scale() {
    Plane gray(image_.pixels());
    for_each_pixel_in_parallel(gray.size(), settings_, [&](std::size_t i) {
      double sum = 0;
      for (std::size_t c = 0; c < rgb_size; ++c) {
        const double s = has_halves(i) ? noisy(c, i).share : 0.5;
        const Filtered f = candidate(0, c, i);
        sum += s * f.first + (1 - s) * f.second;
      }
      gray[i] = float(sum / rgb_size);
    });
    const Plane mean = box_mean(gray, image_.width, image_.height, 1);
    for (std::size_t i = 0; i < gray.size(); ++i) relative_[i] = reciprocal_square(mean[i]);
    if (whole_) find_scale_beside_lamps();
  }

  // Beside lamps a filter may make a glow, whose error would seem small by its own brightness. What the camera sees of
  // emitters within a pixel, and the mean of all other light around, tell better how bright the pixel is.
  void find_scale_beside_lamps() {
    const int w = image_.width, h = image_.height;
    const Plane& emission = whole_->emission;
    const Plane lamp = max_around(emission, w, beside_lamp_reach), emission_near = box_mean(emission, w, h, 1);
    Plane gray(image_.pixels()), rest(image_.pixels());
    for (std::size_t i = 0; i < gray.size(); ++i) {
      gray[i] = (whole_->mean[0][i] + whole_->mean[1][i] + whole_->mean[2][i]) / rgb_size;
      rest[i] = gray[i] - emission[i];
    }
    rest = box_mean(rest, w, h, filter_reach);
    std::vector<std::uint8_t> found(image_.pixels());
    bool any = false;
    for (std::size_t i = 0; i < lamp.size(); ++i) {
      if (lamp[i] <= beside_lamp_contrast * std::sqrt(square(gray[i]) + float(relative_epsilon))) continue;
      found[i] = 1, any = true;
      relative_[i] = std::max(relative_[i], reciprocal_square(std::max(rest[i], 0.0f) + emission_near[i]));
    }
    if (any) beside_lamp_ = std::move(found);
  }

  // The candidate with the least error around the pixel. What one pixel chooses is a noisy decision: it is averaged,
  // over fewer pixels beside lamps, where a small part of the wrong filter may do more harm.
  void choose() {
    const int w = image_.width, h = image_.height;
    const std::size_t candidates = unfiltered_ + 1;
    std::vector<Plane> errors(candidates), noises(candidates), shares(candidates);  // of each, around each pixel
    for_each_unit(2 * candidates, settings_, [&](std::size_t unit) {
      const std::size_t k = unit / 2;
      const bool of_noise = unit % 2 == 1;
      Plane error(image_.pixels());
      for (std::size_t i = 0; i < error.size(); ++i)
        if (has_halves(i)) error[i] = of_noise ? noise_of(k, i) : error_of(k, i);
      (of_noise ? noises : errors)[k] = box_mean(error, w, h, choice_reach);
    });
    const Plane noise_around = box_mean(noises[unfiltered_], w, h, bias_reach);
    for_each_unit(unfiltered_, settings_, [&](std::size_t k) { weigh_bias(noises[k], noise_around, errors[k]); });
    std::vector<std::uint8_t> choice(image_.pixels(), std::uint8_t(unfiltered_));
    for_each_pixel_in_parallel(image_.pixels(), settings_, [&](std::size_t i) {
      float least = std::numeric_limits<float>::infinity();
      for (std::size_t k = 0; k < candidates && has_halves(i); ++k)
        if (errors[k][i] < least) least = errors[k][i], choice[i] = std::uint8_t(k);
    });
    for_each_unit(candidates, settings_, [&](std::size_t k) { shares[k] = shares_around(choice, k); });
    mixture_.filters.assign(filters_, Plane(image_.pixels()));
    mixture_.unfiltered.resize(image_.pixels());
    for_each_pixel_in_parallel(image_.pixels(), settings_, [&](std::size_t i) {
      const float least = errors[choice[i]][i];
      float own_choice = 1;
      for (std::size_t k = 0; k < candidates; ++k) {
        const float share = shares[k][i] * (has_halves(i) ? trust_in_neighbors(errors[k][i], least) : 1.0f);
        own_choice -= share;
        add_choice(k, i, share);
      }
      add_choice(choice[i], i, own_choice);
    });
  }
  // `noise`: of the candidate; `noise_around`: of the unfiltered image.
  void weigh_bias(const Plane& noise, const Plane& noise_around, Plane& error) const {
    Plane bias(error.size());
    for (std::size_t i = 0; i < bias.size(); ++i) bias[i] = error[i] - noise[i];
    const Plane bias_around = box_mean(bias, image_.width, image_.height, bias_reach);
    for (std::size_t i = 0; i < bias.size(); ++i) {
      // The lesser of both: one of few pixels is as noisy as the image.
      const float sure = std::min(bias[i], bias_around[i]);
      if (sure <= 0 || noise_around[i] <= 0) continue;
      error[i] += sure * std::min(bias_weight * square(bias_around[i] / noise_around[i]), max_bias);
    }
  }
  // The share of the pixels around each pixel that choose a candidate.
  Plane shares_around(const std::vector<std::uint8_t>& choice, std::size_t candidate) const {
    const int w = image_.width, h = image_.height;
    Plane chosen(image_.pixels());
    for (std::size_t i = 0; i < chosen.size(); ++i) chosen[i] = choice[i] == candidate ? 1.0f : 0.0f;
    Plane share = box_mean(chosen, w, h, choice_spread);
    if (beside_lamp_.empty()) return share;
    const Plane less_spread = box_mean(chosen, w, h, choice_spread_beside_lamps);
    for (std::size_t i = 0; i < share.size(); ++i)
      if (beside_lamp_[i]) share[i] = less_spread[i];
    return share;
  }
  // What neighbours choose counts less where it has a larger error at the pixel: one rare bright sample has many times
  // the light of its pixel, so that no part of the unfiltered image may be left there.
  static float trust_in_neighbors(float error, float least) {
    const float tolerated = choice_tolerance * std::abs(least);
    return error <= tolerated ? 1 : tolerated / error;
  }
  void add_choice(std::size_t candidate, std::size_t i, float share) {
    const bool is_mean = candidate >= filters_ && candidate != unfiltered_;
    const float of_each = is_mean ? 0.5f : 1.0f;
    if (candidate != unfiltered_) mixture_.filters[candidate % filters_][i] += of_each * share;
    if (candidate >= filters_) mixture_.unfiltered[i] += of_each * share;
  }

  // Fits may be below zero where there is no light. As much of them as leads below zero is taken from the smoothest
  // mean instead, unless the filter of the pixels has negative parts. The mixture does it, so that layers still sum to
  // the image.
  void keep_above_zero() {
    for (std::size_t first = 0; first < filters_; first += filter_count)
      for_each_pixel_in_parallel(image_.pixels(), settings_, [&](std::size_t i) {
        if (!has_halves(i)) return;
        const float replaced = fits_below_zero(first, i);
        for (std::size_t k = first + mean_count; replaced > 0 && k < first + filter_count; ++k) {
          const float moved = replaced * mixture_.filters[k][i];
          mixture_.filters[k][i] -= moved, mixture_.filters[first + mean_count - 1][i] += moved;
        }
      });
  }
  // The share of the fits from number `first` that leads the pixel below zero.
  float fits_below_zero(std::size_t first, std::size_t i) const {
    double replaced = 0;
    for (std::size_t c = 0; c < rgb_size; ++c) {
      const auto value = [&](std::size_t k) {
        const double share = noisy(c, i).share;
        const Filtered f = candidate(k, c, i);
        return share * f.first + (1 - share) * f.second;
      };
      const double of_image = value(unfiltered_), smooth = value(first + mean_count - 1);
      double sum = double(mixture_.unfiltered[i]) * of_image, of_fits = 0, of_mean = 0;
      for (std::size_t k = 0; k < filters_; ++k) {
        const double weight = double(mixture_.filters[k][i]), weighted = weight * value(k);
        sum += weighted;
        if (k >= first + mean_count && k < first + filter_count) of_fits += weighted, of_mean += weight * smooth;
      }
      const double lack = std::min(of_image, 0.0) - sum;
      if (lack > 0 && of_mean > of_fits) replaced = std::max(replaced, lack / (of_mean - of_fits));
    }
    return float(std::min(replaced, 1.0));
  }

  // The colours of the image, and the share of each pixel itself in them.
  FilteredColors filtered_colors() {
    FilteredColors all = unfiltered(image_);
    if (lamps_) all.kept = &lamps_->kept;
    for_each_unit(2, settings_, [&](std::size_t half) {
      own_.weight[half] = own_.covariance[half] = mixture_.unfiltered;
      for (std::size_t c = 0; c < rgb_size; ++c) {
        Plane& sum = all.filtered[half][c] = (*all.noisy[half])[c];
        for (std::size_t i = 0; i < sum.size(); ++i) sum[i] *= mixture_.unfiltered[i];
      }
      for (std::size_t k = 0; k < filters_; ++k) {
        const FilteredHalf& filtered = filtered_[half][k];
        const Plane& weight = mixture_.filters[k];
        for (std::size_t i = 0; i < weight.size(); ++i) {
          own_.weight[half][i] += weight[i] * filtered.own[i];
          own_.covariance[half][i] += weight[i] * filtered.with_pixel()[i];
          for (std::size_t c = 0; c < rgb_size; ++c) all.filtered[half][c][i] += weight[i] * filtered.color[c][i];
        }
      }
    });
    return all;
  }

  void add_layers(const FilterError& error, DenoisedImage& result) const {
    const auto filtered = filter_layers(image_, settings_, mixture_, filtered_);
    for (std::size_t k = 0; k < filtered.size(); ++k) {
      FilteredColors colors = unfiltered_layer(image_.layers[k]);
      colors.filtered = filtered[k];
      if (lamps_) colors.kept = &lamps_->kept_layers[k];
      result.layers.push_back(error.layer(colors));
    }
    keep_layers_above_zero(image_.layers, result.layers);
  }

  const NoisyImage& image_;
  const SplitImage* lamps_;
  const FilmPlanes* whole_;
  const DenoiseSettings& settings_;
  const FilteredHalves filtered_;
  const std::size_t filters_, unfiltered_;  // the number of the filters; the number of the image among the candidates
  Plane relative_;
  std::vector<std::uint8_t> beside_lamp_;  // 1: the pixel is; empty: no pixel is known to be
  FilterMixture mixture_;                  // what each pixel takes
  OwnShares own_;
};

}  // namespace

DenoisedImage denoise(const NoisyImage& image, const DenoiseSettings& settings) {
  if (settings.filter) return denoise_by(*settings.filter, image, settings);
  const std::optional<SplitImage> split = split_small_lamps(image);
  DenoiseSettings of_rest = settings;
  std::vector<NoisyImage> others;
  for (std::size_t i = 0; i < settings.others.size(); ++i)
    if (std::optional<SplitImage> lamps = split_small_lamps(settings.others[i])) {
      if (others.empty()) others.assign(settings.others.begin(), settings.others.end());
      others[i] = std::move(lamps->rest);
    }
  if (!others.empty()) of_rest.others = others;
  const FilmPlanes* whole = image.whole ? &*image.whole : nullptr;
  return Denoiser(split ? split->rest : image, split ? &*split : nullptr, whole, of_rest).run();
}

}  // namespace montelux
