#include "api/denoise.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "api/images.h"
#include "denoise/denoise.h"
#include "denoise/reproject.h"
#include "film/film.h"
#include "render/stopwatch.h"

namespace montelux {

namespace {

constexpr std::array<std::string_view, 2> layer_names_added{"denoised", "denoised_error"};

bool has_both_halves(const NoisyImage& image) {
  const Plane& share = image.halves[0].share;
  return std::ranges::any_of(share, [](float s) { return s > 0 && s < 1; });
}

// A number that is not one, or too large to be squared, belongs to no pixel that can be filtered.
bool is_usable(double x) { return std::abs(x) < 1e18; }

NoisyImage noisy_image(const Film& film) {
  const PixelBounds& b = film.bounds();
  NoisyImage image(b.width(), b.height());
  std::size_t i = 0;
  for (int y = b.y0; y < b.y1; ++y)
    for (int x = b.x0; x < b.x1; ++x, ++i) {
      const std::array<PixelHalf, 2> halves = film.halves(x, y);
      const PixelEstimate pixel = film.pixel(x, y);
      bool usable = true;
      for (std::size_t c = 0; c < rgb_size; ++c) {
        const double variance = pixel.variance_of_mean(int(c));
        usable &= is_usable(variance);
        image.variance[c][i] = is_usable(variance) ? float(variance) : 0;
      }
      for (std::size_t h = 0; h < 2; ++h) {
        HalfPlanes& to = image.halves[h];
        const PixelHalf& from = halves[h];
        to.share[i] = usable || from.share == 1 ? float(from.share) : 1.0f;
        for (std::size_t c = 0; c < rgb_size; ++c) {
          to.color[c][i] = float(usable ? from.mean[c] : pixel.mean[c]);
          to.albedo[c][i] = float(from.albedo[c]);
        }
        for (std::size_t c = 0; c < 3; ++c) to.normal[c][i] = float(from.normal[c]);
      }
    }
  return image;
}

// The planes of three channels; a failure names the first that is missing.
Status read_planes(const PixelBuffer& image, std::string_view layer, std::string_view channels,
                   std::array<Plane, 3>& planes) {
  for (std::size_t c = 0; c < 3; ++c) {
    const std::string name = layer.empty() ? std::string(1, channels[c]) : fmt::format("{}.{}", layer, channels[c]);
    const std::optional<int> channel = find_channel(image, name);
    if (!channel) return Failure{fmt::format("it has no channel {}", name)};
    planes[c].resize(image.pixel_count());
    for (std::size_t i = 0; i < planes[c].size(); ++i) {
      const float value = image.values[i * image.channels.size() + std::size_t(*channel)];
      planes[c][i] = value;
    }
  }
  return Done{};
}

Result<NoisyImage> noisy_image(const PixelBuffer& image) {
  NoisyImage noisy(image.width, image.height);
  ColorPlanes color;
  if (Status read = read_planes(image, "", "RGB", color); !read) return read.failure();
  if (Status read = read_planes(image, "stderr", "RGB", noisy.variance); !read) return read.failure();
  for (std::size_t h = 0; h < 2; ++h) {
    const HalfLayerNames& names = half_layer_names[h];
    HalfPlanes& half = noisy.halves[h];
    if (Status read = read_planes(image, names.color, "RGB", half.color); !read) return read.failure();
    if (Status read = read_planes(image, names.albedo, "RGB", half.albedo); !read) return read.failure();
    if (Status read = read_planes(image, names.normal, "XYZ", half.normal); !read) return read.failure();
    const std::optional<int> share = find_channel(image, names.share);
    if (!share) return Failure{fmt::format("it has no channel {}", names.share)};
    for (std::size_t i = 0; i < half.share.size(); ++i)
      half.share[i] = image.values[i * image.channels.size() + std::size_t(*share)];
  }
  // Pixels with numbers that cannot be are left as they are.
  for (std::size_t i = 0; i < noisy.pixels(); ++i) {
    auto& [a, b] = noisy.halves;
    bool usable = a.share[i] > 0 && b.share[i] > 0 && std::abs(a.share[i] + b.share[i] - 1) < 1e-4f;
    for (std::size_t c = 0; c < rgb_size; ++c) {
      float& error = noisy.variance[c][i];
      usable &= error >= 0 && is_usable(double(error) * double(error));
      error *= error;
      for (const HalfPlanes& half : noisy.halves)
        usable &= is_usable(double(half.color[c][i])) && is_usable(double(half.albedo[c][i])) &&
                  is_usable(double(half.normal[c][i]));
    }
    if (usable) {
      b.share[i] = 1 - a.share[i];
      continue;
    }
    for (HalfPlanes& half : noisy.halves) {
      half.share[i] = 1;
      for (std::size_t c = 0; c < rgb_size; ++c) {
        half.color[c][i] = is_usable(double(color[c][i])) ? color[c][i] : 0;
        half.albedo[c][i] = half.normal[c][i] = 0;
      }
    }
    for (Plane& plane : noisy.variance) plane[i] = 0;
  }
  return noisy;
}

PixelBuffer buffer_of(const DenoisedImage& image, int width, int height) {
  std::vector<std::string> channels;
  for (std::string_view layer : layer_names_added)
    for (char c : {'R', 'G', 'B'}) channels.push_back(fmt::format("{}.{}", layer, c));
  PixelBuffer buffer = make_pixel_buffer(width, height, std::move(channels));
  float* to = buffer.values.data();
  for (std::size_t i = 0; i < buffer.pixel_count(); ++i) {
    for (const Plane& plane : image.color) *to++ = plane[i];
    for (const Plane& plane : image.error) *to++ = plane[i];
  }
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

// Earlier images as the present one would show them.
Result<std::vector<NoisyImage>> earlier_images(const std::filesystem::path& file, const PixelBuffer& present,
                                               const std::vector<std::filesystem::path>& before) {
  std::vector<NoisyImage> images;
  std::filesystem::path shown = file;
  PixelBuffer pixels = present;
  MotionPlanes way;
  for (const std::filesystem::path& earlier : before) {
    Result<MotionPlanes> motion = motion_of(pixels);
    if (!motion) return cannot_be_denoised(shown, motion.error(), "halves,motion");
    way = images.empty() ? *std::move(motion) : composed(way, *motion, pixels.width, pixels.height);
    Result<Image> image = read_image(earlier);
    if (!image) return image.failure();
    if (image->pixels.width != pixels.width || image->pixels.height != pixels.height)
      return Failure{fmt::format("'{}' has {} x {} pixels, '{}' {} x {}", earlier.string(), image->pixels.width,
                                 image->pixels.height, shown.string(), pixels.width, pixels.height)};
    const Result<NoisyImage> noisy = noisy_image(image->pixels);
    if (!noisy) return cannot_be_denoised(earlier, noisy.error(), "halves");
    images.push_back(reprojected(*noisy, way));
    pixels = std::move(image->pixels), shown = earlier;
  }
  return images;
}

Result<DenoisedLayers> denoise_image(const NoisyImage& image, const DenoiseOptions& options,
                                     std::span<const NoisyImage> others = {}) {
  if (!has_both_halves(image))
    return Failure{"noise cannot be removed: it takes two independent passes, in both halves of the layers"};
  const Stopwatch since_start;
  try {
    const DenoisedImage done = denoise(image, DenoiseSettings{options.threads, options.stop, others});
    return DenoisedLayers{
        buffer_of(done, image.width, image.height),
        {done.noisy_mse, done.noisy_relative_mse, done.mse, done.relative_mse, done.filtered, since_start.seconds()}};
  } catch (const std::exception& e) {
    return Failure{e.what()};
  }
}

// Without the layers that are added.
PixelBuffer without_added(const PixelBuffer& image) {
  std::vector<std::size_t> kept;
  std::vector<std::string> names;
  for (std::size_t c = 0; c < image.channels.size(); ++c) {
    const std::string& name = image.channels[c];
    const std::string layer = name.substr(0, std::min(name.rfind('.'), name.size()));
    if (std::ranges::find(layer_names_added, layer) != layer_names_added.end()) continue;
    kept.push_back(c), names.push_back(name);
  }
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
  return Done{};
}

}  // namespace

Result<DenoisedLayers> denoise(const Film& film, const DenoiseOptions& options) {
  if (Status good = has_noise_of_halves(film); !good) return good.failure();
  return denoise_image(noisy_image(film), options);
}

Result<DenoisedLayers> SequenceDenoiser::denoise(const Film& film, const PixelBuffer& motion,
                                                 const DenoiseOptions& options) {
  std::deque<Earlier> before = std::exchange(earlier_, {});
  if (Status good = has_noise_of_halves(film); !good) return good.failure();
  Result<MotionPlanes> to_before = motion_of(motion, "");
  if (!to_before) return to_before.failure();
  NoisyImage image = noisy_image(film);
  std::vector<NoisyImage> others;
  MotionPlanes way = *to_before;
  for (const Earlier& one : before) {
    others.push_back(reprojected(one.image, way));
    way = composed(way, one.motion, image.width, image.height);
  }
  Result<DenoisedLayers> layers = denoise_image(image, options, others);
  if (!layers) return layers;
  before.push_front({std::move(image), *std::move(to_before)});
  if (before.size() > max_earlier) before.pop_back();
  earlier_ = std::move(before);
  return layers;
}

Result<DenoisedFile> denoise_file(const std::filesystem::path& file, const DenoiseOptions& options) {
  Result<Image> image = read_image(file);
  if (!image) return image.failure();
  const Result<NoisyImage> noisy = noisy_image(image->pixels);
  if (!noisy) return cannot_be_denoised(file, noisy.error(), "halves");
  const Result<std::vector<NoisyImage>> others = earlier_images(file, image->pixels, options.before);
  if (!others) return others.failure();
  const Result<DenoisedLayers> denoised = denoise_image(*noisy, options, *others);
  if (!denoised) return Failure{fmt::format("'{}': {}", file.string(), denoised.error())};
  DenoisedFile result{*std::move(image), denoised->estimate};
  result.image.pixels = without_added(result.image.pixels);
  append_layer(result.image.pixels, "", denoised->layers);
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

std::vector<Attribute> header_of(const Denoising& estimate) {
  return {{"montelux:denoisedMSE", estimate.mse}, {"montelux:denoisedRelativeMSE", estimate.relative_mse}};
}

}  // namespace montelux
