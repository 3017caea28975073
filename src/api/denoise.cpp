#include "api/denoise.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "api/images.h"
#include "api/noisy_image.h"
#include "denoise/color_filter.h"
#include "denoise/denoise.h"
#include "denoise/reproject.h"
#include "film/film.h"
#include "image/layers.h"
#include "render/stopwatch.h"

namespace montelux {

namespace {

// What is added: the image and its error, and with "_NAME" those of the layer NAME.
constexpr std::string_view added_color = "denoised", added_error = "denoised_error";

bool is_added(std::string_view layer) { return layer == added_color || layer.starts_with("denoised_"); }

std::string of_layer(std::string_view added, std::string_view name) {
  return std::string(added).append(name.empty() ? "" : "_").append(name);
}

// `names`: of the layers of light.
PixelBuffer buffer_of(const DenoisedImage& image, const std::vector<std::string>& names, int width, int height) {
  std::vector<std::string> channels;
  std::vector<const Plane*> planes;
  const auto add = [&](const std::string& name, const ColorPlanes& colors) {
    for (std::size_t c = 0; c < rgb_size; ++c) {
      channels.push_back(fmt::format("{}.{}", name, "RGB"[c]));
      planes.push_back(&colors[c]);
    }
  };
  add(of_layer(added_color, ""), image.color), add(of_layer(added_error, ""), image.error);
  for (std::size_t k = 0; k < image.layers.size(); ++k) {
    const DenoisedLayer& layer = image.layers[k];
    add(of_layer(added_color, names[k]), layer.color);
    if (!layer.error.front().empty()) add(of_layer(added_error, names[k]), layer.error);
  }
  PixelBuffer buffer = make_pixel_buffer(width, height, std::move(channels));
  float* to = buffer.values.data();
  for (std::size_t i = 0; i < buffer.pixel_count(); ++i)
    for (const Plane* plane : planes) *to++ = (*plane)[i];
  return buffer;
}

// From the channels `layer`X and Y.
Result<MotionPlanes> motion_of(const PixelBuffer& image, std::string_view layer = "motion.") {
  MotionPlanes motion;
  for (auto [letter, plane] : {std::pair{'X', &motion.x}, std::pair{'Y', &motion.y}}) {
    const std::string name = fmt::format("{}{}", layer, letter);
    const std::optional<int> channel = find_channel(image, name);
    if (!channel) return Failure{fmt::format("it has no channel {}", name)};
    plane->resize(image.pixel_count());
    for (std::size_t i = 0; i < plane->size(); ++i)
      (*plane)[i] = image.values[i * image.channels.size() + std::size_t(*channel)];
  }
  return motion;
}

Failure cannot_be_denoised(const std::filesystem::path& file, const std::string& why, std::string_view layers) {
  return Failure{fmt::format("'{}' cannot be denoised: {}; render it with --layers {}", file.string(), why, layers)};
}

// Earlier images as the present one would show them, with these layers of light.
Result<std::vector<NoisyImage>> earlier_images(const std::filesystem::path& file, const PixelBuffer& present,
                                               const std::vector<std::filesystem::path>& before,
                                               const std::vector<std::string>& layers) {
  std::vector<NoisyImage> images;
  std::filesystem::path shown = file;
  const PixelBuffer* pixels = &present;
  Image latest;
  MotionPlanes way;
  for (const std::filesystem::path& earlier : before) {
    Result<MotionPlanes> motion = motion_of(*pixels);
    if (!motion) return cannot_be_denoised(shown, motion.error(), "halves,motion");
    way = images.empty() ? *std::move(motion) : composed(way, *motion, pixels->width, pixels->height);
    Result<Image> image = read_image(earlier);
    if (!image) return image.failure();
    if (image->pixels.width != pixels->width || image->pixels.height != pixels->height)
      return Failure{fmt::format("'{}' has {} x {} pixels, '{}' {} x {}", earlier.string(), image->pixels.width,
                                 image->pixels.height, shown.string(), pixels->width, pixels->height)};
    const Result<NoisyImage> noisy = noisy_image(image->pixels, layers);
    if (!noisy) return cannot_be_denoised(earlier, noisy.error(), "halves");
    images.push_back(reprojected(*noisy, way));
    latest = *std::move(image);
    pixels = &latest.pixels, shown = earlier;
  }
  return images;
}

Failure lacks_halves() {
  return Failure{"noise cannot be removed: it takes two independent passes, in both halves of the layers"};
}

// The image has both halves in some pixel.
Result<DenoisedLayers> denoise_image(const NoisyRows& image, const DenoiseOptions& options,
                                     std::span<const NoisyImage> others = {}) {
  const Stopwatch since_start;
  DenoiseSettings settings{options.threads, options.stop, others, options.filter.get()};
  settings.progress = options.progress;
  try {
    const DenoisedImage done = denoise(image, settings);
    const ErrorSums& sums = done.sums;
    return DenoisedLayers{buffer_of(done, options.layers, image.width, image.height),
                          {options.filter ? options.filter->name() : "montelux", sums.noisy_mse(),
                           sums.noisy_relative_mse(), sums.mse(), sums.relative_mse(), sums.unfiltered_relative_mse(),
                           sums.relative_deviation(), sums.changed_share(), since_start.seconds()}};
  } catch (const std::exception& e) {
    return Failure{e.what()};
  }
}

NoisyRows rows_of(const Film& film, const std::vector<std::string>& layers) {
  return {film.bounds().width(), film.bounds().height(),
          [&film, &layers](const RowRange& rows) { return noisy_image(film, layers, rows); }};
}

// Without the layers that are added.
PixelBuffer without_added(PixelBuffer image) {
  std::vector<std::size_t> kept;
  std::vector<std::string> names;
  for (std::size_t c = 0; c < image.channels.size(); ++c) {
    const std::string& name = image.channels[c];
    const std::string layer = name.substr(0, std::min(name.rfind('.'), name.size()));
    if (is_added(layer)) continue;
    kept.push_back(c), names.push_back(name);
  }
  if (kept.size() == image.channels.size()) return image;
  PixelBuffer rest = make_pixel_buffer(image.width, image.height, std::move(names));
  for (std::size_t i = 0; i < image.pixel_count(); ++i)
    for (std::size_t c = 0; c < kept.size(); ++c)
      rest.values[i * kept.size() + c] = image.values[i * image.channels.size() + kept[c]];
  return rest;
}

}  // namespace

namespace {

Status has_noise_of_halves(const Film& film) {
  if (!film.has_halves()) return Failure{"noise cannot be removed: the film has no halves"};
  if (film.grid().stride > 1) return Failure{"noise is not removed: only a part of the pixels is sampled"};
  if (!has_both_halves(film)) return lacks_halves();
  return Done{};
}

}  // namespace

DenoiseOptions denoise_options(const std::optional<LayerPlan>& layers, int threads,
                               std::shared_ptr<const ColorFilter> filter) {
  DenoiseOptions options;
  options.filter = std::move(filter);
  options.threads = threads;
  if (layers) options.layers = layer_names(*layers);
  return options;
}

Result<DenoisedLayers> denoise(const Film& film, const DenoiseOptions& options) {
  if (Status good = has_noise_of_halves(film); !good) return good.failure();
  return denoise_image(rows_of(film, options.layers), options);
}

void JudgedLayers::keep(const Film& film, DenoisedLayers layers) {
  film_ = FilmMark(film.image()), layers_ = std::move(layers);
}

std::optional<DenoisedLayers> JudgedLayers::take(const Film& film) {
  if (film_ != FilmMark(film.image())) return std::nullopt;
  return std::exchange(layers_, std::nullopt);
}

TargetJudge judge_of(const ErrorTarget& target, int threads, std::shared_ptr<JudgedLayers> kept,
                     std::shared_ptr<const ColorFilter> filter) {
  if (target.measure != TargetMeasure::denoised) return TargetJudge(target);
  return TargetJudge(
      target,
      [threads, kept, filter](const Film& film, const std::function<bool()>& stops) -> std::optional<FilteredError> {
        DenoiseOptions options = denoise_options({}, threads, filter);
        options.stop = stops;
        Result<DenoisedLayers> denoised = denoise(film, options);
        if (!denoised) return std::nullopt;
        const Denoising estimate = denoised->estimate;
        if (kept) kept->keep(film, *std::move(denoised));
        return FilteredError{estimate.relative_mse, estimate.unfiltered, estimate.relative_deviation};
      });
}

Result<DenoisedLayers> SequenceDenoiser::denoise(const Film& film, const PixelBuffer& motion,
                                                 const DenoiseOptions& options) {
  std::deque<Earlier> before = std::exchange(earlier_, {});
  if (Status good = has_noise_of_halves(film); !good) return good.failure();
  Result<MotionPlanes> to_before = motion_of(motion, "");
  if (!to_before) return to_before.failure();
  const int width = film.bounds().width(), height = film.bounds().height();
  std::vector<NoisyImage> others;
  MotionPlanes way = *to_before;
  for (const Earlier& one : before) {
    others.push_back(reprojected(one.image, way));
    way = composed(way, one.motion, width, height);
  }
  Result<DenoisedLayers> layers = denoise_image(rows_of(film, options.layers), options, others);
  if (!layers) return layers;
  NoisyImage image = noisy_image(film, options.layers, {0, height});
  image.whole.reset();  // what the next images need is in the halves
  before.push_front({std::move(image), *std::move(to_before)});
  if (before.size() > max_earlier) before.pop_back();
  earlier_ = std::move(before);
  return layers;
}

Result<DenoisedFile> denoise_file(const std::filesystem::path& file, const DenoiseOptions& options) {
  if (options.filter && !options.before.empty())
    return Failure{
        fmt::format("the denoiser {} takes no earlier images: it filters each image alone", options.filter->name())};
  Result<Image> image = read_image(file);
  if (!image) return image.failure();
  DenoiseOptions of_file = options;
  of_file.layers = layers_with_halves(image->pixels);
  const PixelBuffer& pixels = image->pixels;
  const auto rows = [&](const RowRange& range) {
    return noisy_image(montelux::rows_of(pixels, range.first, range.count), of_file.layers);
  };
  if (const Result<NoisyImage> one = rows({0, 1}); !one) return cannot_be_denoised(file, one.error(), "halves");
  if (!has_both_halves(pixels)) return Failure{fmt::format("'{}': {}", file.string(), lacks_halves().message)};
  const Result<std::vector<NoisyImage>> others = earlier_images(file, pixels, options.before, of_file.layers);
  if (!others) return others.failure();
  Result<DenoisedLayers> denoised = denoise_image(
      {pixels.width, pixels.height, [&](const RowRange& range) { return *rows(range); }}, of_file, *others);
  if (!denoised) return Failure{fmt::format("'{}': {}", file.string(), denoised.error())};
  DenoisedFile result{*std::move(image), std::move(denoised->layers), denoised->estimate};
  result.image.pixels = without_added(std::move(result.image.pixels));
  std::vector<Attribute>& header = result.image.attributes;
  // Others describe how the file was stored.
  std::erase_if(header,
                [](const Attribute& entry) { return !entry.name.starts_with("montelux:") && entry.name != "capDate"; });
  for (Attribute& entry : header_of(result.estimate)) {
    std::erase_if(header, [&](const Attribute& other) { return other.name == entry.name; });
    header.push_back(std::move(entry));
  }
  return result;
}

ImageRows DenoisedFile::rows() const {
  const auto rows = [this](int first, int count) {
    PixelBuffer part = rows_of(image.pixels, first, count);
    append_layer(part, "", rows_of(layers, first, count));
    return part;
  };
  return {layers.width, layers.height, rows(0, 1).channels, rows};
}

std::vector<Attribute> header_of(const Denoising& estimate) {
  return {{"montelux:denoiser", estimate.denoiser},
          {"montelux:denoisedMSE", estimate.mse},
          {"montelux:denoisedRelativeMSE", estimate.relative_mse}};
}

}  // namespace montelux
