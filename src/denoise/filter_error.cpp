#include "denoise/filter_error.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "denoise/box_mean.h"
#include "denoise/squared_error.h"
#include "denoise/units.h"
#include "math/functions.h"

namespace montelux {

namespace {

constexpr int error_reach = 10;  // pixels over which errors are averaged: those of one have the noise of the image
constexpr int tile_side = 64;    // about that of the tiles over which they are summed for the whole image

// The difference of the halves shows their noise alone: the error is not less. The greater of two noisy numbers is too
// large on average, so sums over large tiles are compared.
double sum_of_errors(const NoisyImage& image, const RowRange& counted, const Plane& error, const Plane& noise) {
  const auto tiles_of = [](int pixels) { return std::max((pixels + tile_side / 2) / tile_side, 1); };
  const int rows = tiles_of(counted.count), columns = tiles_of(image.width);
  const auto row_of = [&](int tile) { return counted.first + counted.count * tile / rows; };
  double sum = 0;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      double of_tile = 0, at_least = 0;
      for (int y = row_of(row); y < row_of(row + 1); ++y)
        for (int x = image.width * column / columns; x < image.width * (column + 1) / columns; ++x) {
          const auto i = std::size_t(y) * std::size_t(image.width) + std::size_t(x);
          of_tile += double(error[i]), at_least += double(noise[i]);
        }
      sum += std::max({of_tile, at_least, 0.0});
    }
  return sum;
}

}  // namespace

void ErrorSums::add(const ErrorSums& other) {
  noisy += other.noisy, noisy_relative += other.noisy_relative;
  filtered += other.filtered, filtered_relative += other.filtered_relative;
  least += other.least, unfiltered += other.unfiltered, squares += other.squares, measured += other.measured;
  pixels += other.pixels, changed += other.changed;
}

FilteredColors unfiltered(const NoisyImage& image) {
  return {{&image.halves[0].color, &image.halves[1].color}, &image.variance};
}

FilteredColors unfiltered_layer(const NoisyLayer& layer) {
  return {{&layer.halves[0], &layer.halves[1]}, layer.knows_variance() ? &layer.variance : nullptr};
}

void FilterError::state(const FilteredColors& all, const FilmPlanes* whole, DenoisedImage& result) const {
  result.color = mean_of(all);
  const RelativeScale scale = whole ? scale_by_expectation(*whole, filtered_image(all, result.color), settings_)
                                    : scale_by_colors(result.color);
  result.sums = estimate(all, scale, result.error);
}

DenoisedLayer FilterError::layer(const FilteredColors& colors) const {
  DenoisedLayer layer;
  layer.color = mean_of(colors);
  if (colors.variance) estimate(colors, scale_by_colors(layer.color), layer.error);
  return layer;
}

// The mean of both halves.
ColorPlanes FilterError::mean_of(const FilteredColors& colors) const {
  ColorPlanes mean;
  for (std::size_t c = 0; c < rgb_size; ++c) {
    mean[c].resize(image_.pixels());
    for (std::size_t i = 0; i < image_.pixels(); ++i) {
      const float share = image_.halves[0].share[i];
      const auto mean_of_halves = [&](const std::array<ColorPlanes, 2>& halves) {
        return share * halves[0][c][i] + (1 - share) * halves[1][c][i];
      };
      mean[c][i] = image_.has_halves(i) ? mean_of_halves(colors.filtered) : (*colors.noisy[0])[c][i];
      if (colors.kept && image_.has_halves(i)) mean[c][i] += mean_of_halves(colors.kept->halves);
    }
  }
  return mean;
}

// The image after the filter. `mean`: of both halves.
FilteredImage FilterError::filtered_image(const FilteredColors& colors, const ColorPlanes& mean) const {
  FilteredImage image{colors.filtered, mean, Plane(image_.pixels())};
  if (colors.kept)
    for (std::size_t half = 0; half < 2; ++half)
      for (std::size_t c = 0; c < rgb_size; ++c)
        for (std::size_t i = 0; i < image_.pixels(); ++i) image.halves[half][c][i] += colors.kept->halves[half][c][i];
  for (std::size_t i = 0; i < image_.pixels(); ++i) image.own[i] = own_share(i);
  return image;
}

// The share of the unfiltered pixel in what the filter makes of it.
float FilterError::own_of_filter(std::size_t i) const {
  if (!own_) return 0;
  const float share = image_.halves[0].share[i];
  return share * own_->weight[0][i] + (1 - share) * own_->weight[1][i];
}

// The same of all light. That of small lamps is not filtered.
float FilterError::own_share(std::size_t i) const { return lamps_ && lamps_->is_lamp[i] ? 1 : own_of_filter(i); }

double FilterError::squared_error_at(const FilteredColors& colors, std::size_t c, std::size_t i) const {
  const Noisy noisy{double((*colors.noisy[0])[c][i]), double((*colors.noisy[1])[c][i]),
                    double(image_.halves[0].share[i]), double((*colors.variance)[c][i])};
  const double first = double(colors.filtered[0][c][i]), second = double(colors.filtered[1][c][i]);
  if (!own_) return squared_error_by_halves(noisy, first, second);
  return squared_error(noisy, {first, second, double(own_->covariance[0][i]), double(own_->covariance[1][i])});
}

// The error of each pixel, and sums over those that are counted.
ErrorSums FilterError::estimate(const FilteredColors& colors, const RelativeScale& scale, ColorPlanes& errors) const {
  std::array<ErrorOfChannel, rgb_size> channels;
  for_each_unit(rgb_size, settings_, [&](std::size_t c) {
    channels[c] = error_of_channel(colors, c, scale.reciprocals[c], scale.of_covers[c]);
  });
  ErrorSums sums;
  for (std::size_t c = 0; c < rgb_size; ++c) {
    sums.add(channels[c].sums);
    errors[c] = std::move(channels[c].error);
  }
  for (std::size_t i = 0; i < image_.pixels(); ++i)
    if (is_counted(i))
      sums.squares +=
          square(double(channels[0].apart[i]) + double(channels[1].apart[i]) + double(channels[2].apart[i]));
  return sums;
}

FilterError::ErrorOfChannel FilterError::error_of_channel(const FilteredColors& colors, std::size_t c,
                                                          const Plane& scale, const Plane& of_covers) const {
  ErrorOfChannel channel{Plane(image_.pixels(), 0.0f), {}, {}};
  Plane &error = channel.error, spread(image_.pixels(), 0.0f);
  ErrorSums not_counted;
  for (std::size_t i = 0; i < image_.pixels(); ++i) {
    ErrorSums& sums = is_counted(i) ? channel.sums : not_counted;
    if (!image_.has_halves(i)) continue;
    double squared = squared_error_at(colors, c, i), noisy = double((*colors.variance)[c][i]);
    double difference = double(colors.filtered[0][c][i]) - double(colors.filtered[1][c][i]);
    if (const KeptLight* kept = colors.kept) {
      const double of_kept = double(kept->variance[c][i]), with_rest = double(kept->covariance[c][i]);
      squared += of_kept + 2 * double(own_of_filter(i)) * with_rest, noisy += of_kept + 2 * with_rest;
      difference += double(kept->halves[0][c][i]) - double(kept->halves[1][c][i]);
    }
    const double relative = double(scale[i]);
    const double share = double(image_.halves[0].share[i]), noise = share * (1 - share) * difference * difference;
    error[i] = float(squared * relative), spread[i] = float(noise * relative);
    sums.filtered += squared, sums.least += noise;
    sums.noisy += noisy, sums.noisy_relative += noisy * relative;
    sums.measured += 1;
    const double left = square(double(own_share(i)));
    sums.unfiltered += left * noisy * relative;
    if (of_covers.empty()) continue;
    const double lack = std::max(double(of_covers[i]), -noisy * relative);  // no error is below 0
    error[i] += float(left * lack), sums.noisy_relative += lack, sums.unfiltered += left * lack;
  }
  // Means of relative errors: those of bright pixels must not spread to dark ones.
  const Plane mean = box_mean(error, image_.width, image_.height, error_reach);
  const Plane noise = box_mean(spread, image_.width, image_.height, error_reach);
  channel.sums.filtered_relative = sum_of_errors(image_, counted_, error, spread);
  channel.apart = error;
  for (std::size_t i = 0; i < image_.pixels(); ++i) {
    channel.apart[i] -= mean[i];
    error[i] = std::sqrt(std::max({mean[i], noise[i], 0.0f}) / scale[i]);
  }
  return channel;
}

}  // namespace montelux
