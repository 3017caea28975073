#include "denoise/color_filter.h"

#include <cmath>
#include <stdexcept>

#include "denoise/filter_error.h"

namespace montelux {

namespace {

std::vector<float> interleaved(const std::array<Plane, 3>& planes) {
  std::vector<float> values(3 * planes[0].size());
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t i = 0; i < planes[c].size(); ++i) values[3 * i + c] = planes[c][i];
  return values;
}

// Each half by itself.
class HalvesFilter {
 public:
  HalvesFilter(const ColorFilter& filter, const NoisyImage& image, const DenoiseSettings& settings)
      : filter_(filter), image_(image), settings_(settings) {
    for (std::size_t half = 0; half < 2; ++half)
      input_[half] = {image.width,
                      image.height,
                      {},
                      interleaved(image.halves[half].albedo),
                      interleaved(image.halves[half].normal)};
  }

  void apply(FilteredColors& colors) {
    for (std::size_t half = 0; half < 2; ++half) {
      input_[half].color = interleaved(*colors.noisy[half]);
      const std::vector<float> values = filter_.filter(input_[half], settings_.threads, settings_.stop);
      if (values.size() != input_[half].color.size()) throw std::runtime_error("the filter changed the size");
      for (std::size_t c = 0; c < rgb_size; ++c) {
        Plane& plane = colors.filtered[half][c];
        plane.resize(image_.pixels());
        for (std::size_t i = 0; i < plane.size(); ++i) {
          plane[i] = values[3 * i + c];
          if (!std::isfinite(plane[i])) throw std::runtime_error("the filter made colours that are no numbers");
        }
      }
    }
  }

 private:
  const ColorFilter& filter_;
  const NoisyImage& image_;
  const DenoiseSettings& settings_;
  std::array<FilterInput, 2> input_;
};

}  // namespace

DenoisedImage denoise_by(const ColorFilter& filter, const NoisyImage& image, const DenoiseSettings& settings) {
  HalvesFilter halves(filter, image, settings);
  const FilterError error(image, nullptr, nullptr, settings);
  DenoisedImage result;
  FilteredColors all = unfiltered(image);
  halves.apply(all);
  error.state(all, image.whole ? &*image.whole : nullptr, result);
  error.count_changed([&](std::size_t i) { return image.has_halves(i); }, result.sums);
  for (const NoisyLayer& layer : image.layers) {
    FilteredColors colors = unfiltered_layer(layer);
    halves.apply(colors);
    result.layers.push_back(error.layer(colors));
  }
  return result;
}

}  // namespace montelux
