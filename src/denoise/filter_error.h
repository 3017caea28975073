// What a filter leaves of the error of an image, by both halves of its passes.
#pragma once
#include <array>
#include <vector>

#include "denoise/denoise.h"
#include "denoise/relative_scale.h"
#include "denoise/small_lamps.h"

namespace montelux {

// Colours of one kind, all light or one layer: unfiltered, and after the filter of each half.
struct FilteredColors {
  std::array<const ColorPlanes*, 2> noisy;  // both halves
  const ColorPlanes* variance;              // of the mean of both; null: not known
  std::array<ColorPlanes, 2> filtered = {};
  const KeptLight* kept = nullptr;  // to be added to either; null: there is none
};
FilteredColors unfiltered(const NoisyImage& image);
FilteredColors unfiltered_layer(const NoisyLayer& layer);

// What a filter takes of each pixel itself, by half of the image.
struct OwnShares {
  std::array<Plane, 2> weight;      // of the pixel in the filtered one
  std::array<Plane, 2> covariance;  // of the filtered pixel and the noise of the pixel, in variances of the pixel
};

class FilterError {
 public:
  // All of these must outlive this. `lamps`: what the image is the rest of; null: it is whole. `own`: the share of each
  // pixel itself in its filtered halves, by weights that do not depend on what they weigh; null: not known. The error
  // is then measured by what the other half shows, whatever the filter does, with more noise.
  FilterError(const NoisyImage& image, const SplitImage* lamps, const OwnShares* own, const DenoiseSettings& settings)
      : image_(image),
        lamps_(lamps),
        own_(own),
        settings_(settings),
        counted_(settings.counted_rows.value_or(RowRange{0, image.height})) {}

  // The colours and errors of the image, and their sums over the counted rows. `whole`: the whole image before the
  // filter; null: not known.
  void state(const FilteredColors& all, const FilmPlanes* whole, DenoisedImage& result) const;
  DenoisedLayer layer(const FilteredColors& colors) const;
  // Counts the pixels, and those for which `changes` is true, in the counted rows.
  template <class Function>
  void count_changed(Function changes, ErrorSums& sums) const {
    for (std::size_t i = 0; i < image_.pixels(); ++i)
      if (is_counted(i)) sums.pixels += 1, sums.changed += changes(i) ? 1 : 0;
  }

 private:
  struct ErrorOfChannel {
    Plane error;
    Plane apart;  // what each pixel adds to the relative error by itself, less the mean around it
    ErrorSums sums;
  };
  ColorPlanes mean_of(const FilteredColors& colors) const;
  FilteredImage filtered_image(const FilteredColors& colors, const ColorPlanes& mean) const;
  float own_of_filter(std::size_t i) const;
  float own_share(std::size_t i) const;
  double squared_error_at(const FilteredColors& colors, std::size_t c, std::size_t i) const;
  ErrorSums estimate(const FilteredColors& colors, const RelativeScale& scale, ColorPlanes& errors) const;
  ErrorOfChannel error_of_channel(const FilteredColors& colors, std::size_t c, const Plane& scale,
                                  const Plane& of_covers) const;
  bool is_counted(std::size_t i) const { return counted_.has(int(i / std::size_t(image_.width))); }

  const NoisyImage& image_;
  const SplitImage* lamps_;
  const OwnShares* own_;
  const DenoiseSettings& settings_;
  const RowRange counted_;
};

}  // namespace montelux
