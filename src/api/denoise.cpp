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

bool has_both_halves(const NoisyImage& image) {
  const Plane& share = image.halves[0].share;
  return std::ranges::any_of(share, [](float s) { return s > 0 && s < 1; });
}

// A number that is not one, or too large to be squared, belongs to no pixel that can be filtered.
bool is_usable(double x) { return std::abs(x) < 1e18; }

// Layer `number` of the film at a pixel; where the pixel is not `usable` both halves are the whole.
void copy_layer(const LayerFilm& film, int number, int x, int y, bool usable, std::size_t i, NoisyLayer& layer) {
  const std::array<LayerHalf, 2> halves = film.halves(x, y, number);
  for (std::size_t c = 0; c < rgb_size; ++c) {
    for (std::size_t h = 0; h < 2; ++h)
      layer.halves[h][c][i] = float(usable ? halves[h][c] : film.layer_mean(x, y, number, int(c)));
    if (!layer.knows_variance()) continue;
    const double variance = film.variance_of_mean(x, y, number, int(c));
    layer.variance[c][i] = is_usable(variance) ? float(variance) : 0;
  }
}

// `layers`: with those of light, which the film has.
NoisyImage noisy_image(const Film& film, bool layers) {
  const PixelBounds& b = film.bounds();
  NoisyImage image(b.width(), b.height());
  if (layers)
    image.layers.assign(std::size_t(film.layers()->count()), NoisyLayer(image.pixels(), film.layers()->has_spread()));
  image.whole.emplace(b).copy(film, b);
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
      if (!usable) image.whole->passes[i] = 0;
      for (std::size_t h = 0; h < 2; ++h) {
        HalfPlanes& to = image.halves[h];
        const PixelHalf& from = halves[h];
        to.share[i] = usable || from.share == 1 ? float(from.share) : 1.0f;
        for (std::size_t c = 0; c < rgb_size; ++c) {
          to.color[c][i] = float(usable ? from.mean[c] : pixel.mean[c]);
          to.emission[c][i] = float(from.emission[c]), to.albedo[c][i] = float(from.albedo[c]);
        }
        for (std::size_t c = 0; c < 3; ++c) to.normal[c][i] = float(from.normal[c]);
      }
      for (std::size_t k = 0; k < image.layers.size(); ++k)
        copy_layer(*film.layers(), int(k), x, y, usable, i, image.layers[k]);
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

// Numbers that cannot be are 0.
Status read_plane(const PixelBuffer& image, std::string_view channel, Plane& plane) {
  const std::optional<int> number = find_channel(image, channel);
  if (!number) return Failure{fmt::format("it has no channel {}", channel)};
  plane.resize(image.pixel_count());
  for (std::size_t i = 0; i < plane.size(); ++i) {
    const float value = image.values[i * image.channels.size() + std::size_t(*number)];
    plane[i] = is_usable(double(value)) ? value : 0;
  }
  return Done{};
}

// The layers of light of an image that has both halves of them.
std::vector<std::string> layers_with_halves(const PixelBuffer& image) {
  std::vector<std::string> names;
  const std::string begin = half_layer_names[0].of_layer("");
  for (const std::string& channel : image.channels) {
    if (!channel.starts_with(begin) || !channel.ends_with(".R")) continue;
    const std::string name = channel.substr(begin.size(), channel.size() - begin.size() - 2);
    const auto starts = [&](std::string_view family) { return name.starts_with(family); };
    if (std::ranges::any_of(light_layer_names, starts)) names.push_back(name);
  }
  return names;
}

// Reads both halves, and the standard errors where the image has them. Pixels that are not filtered have the whole as
// both halves.
Status read_layer(const PixelBuffer& image, const std::string& name, NoisyImage& noisy) {
  const bool knows_error = find_channel(image, name + "_stderr.R").has_value();
  NoisyLayer& layer = noisy.layers.emplace_back(noisy.pixels(), knows_error);
  for (std::size_t h = 0; h < 2; ++h)
    if (Status read = read_planes(image, half_layer_names[h].of_layer(name), "RGB", layer.halves[h]); !read)
      return read.failure();
  ColorPlanes whole;
  if (Status read = read_planes(image, name, "RGB", whole); !read) return read.failure();
  if (knows_error)
    if (Status read = read_planes(image, name + "_stderr", "RGB", layer.variance); !read) return read.failure();
  for (std::size_t c = 0; c < rgb_size; ++c)
    for (std::size_t i = 0; i < noisy.pixels(); ++i) {
      for (ColorPlanes& half : layer.halves) {
        if (noisy.halves[0].share[i] == 1) half[c][i] = whole[c][i];
        if (!is_usable(double(half[c][i]))) half[c][i] = 0;
      }
      if (!knows_error) continue;
      float& error = layer.variance[c][i];
      error = error >= 0 && is_usable(double(error) * double(error)) ? error * error : 0;
    }
  return Done{};
}

// The mean of the channels.
float gray_of(const ColorPlanes& planes, std::size_t i) { return (planes[0][i] + planes[1][i] + planes[2][i]) / 3; }

// The whole of which both halves are known; nothing if the image has not all of its layers.
std::optional<FilmPlanes> whole_of(const PixelBuffer& image, const NoisyImage& noisy) {
  FilmPlanes whole({0, 0, image.width, image.height});
  auto& [red, green, blue] = whole.albedo;
  auto& [x, y, z] = whole.normal;
  for (auto [name, plane] :
       {std::pair{"A", &whole.coverage}, std::pair{"samples", &whole.samples}, std::pair{"id", &whole.object},
        std::pair{"albedo.R", &red}, std::pair{"albedo.G", &green}, std::pair{"albedo.B", &blue}, std::pair{"N.X", &x},
        std::pair{"N.Y", &y}, std::pair{"N.Z", &z}})
    if (!read_plane(image, name, *plane)) return std::nullopt;
  // Images of older versions have one for each sample.
  if (!read_plane(image, emission_rays_layer, whole.emission_rays)) whole.emission_rays = whole.samples;
  whole.variance = noisy.variance;
  const auto& [a, b] = noisy.halves;
  for (std::size_t i = 0; i < noisy.pixels(); ++i) {
    if (!(a.share[i] > 0 && a.share[i] < 1)) continue;
    whole.passes[i] = 2, whole.expected[i] = 1;
    for (std::size_t c = 0; c < rgb_size; ++c)
      whole.mean[c][i] = a.share[i] * a.color[c][i] + b.share[i] * b.color[c][i];
    whole.emission[i] = a.share[i] * gray_of(a.emission, i) + b.share[i] * gray_of(b.emission, i);
    whole.first_half[i] = gray_of(a.color, i), whole.second_half[i] = gray_of(b.color, i);
  }
  return whole;
}

// `layers`: the names of those of light that are read.
Result<NoisyImage> noisy_image(const PixelBuffer& image, const std::vector<std::string>& layers) {
  NoisyImage noisy(image.width, image.height);
  ColorPlanes color;
  if (Status read = read_planes(image, "", "RGB", color); !read) return read.failure();
  if (Status read = read_planes(image, "stderr", "RGB", noisy.variance); !read) return read.failure();
  for (std::size_t h = 0; h < 2; ++h) {
    const HalfLayerNames& names = half_layer_names[h];
    HalfPlanes& half = noisy.halves[h];
    if (Status read = read_planes(image, names.color, "RGB", half.color); !read) return read.failure();
    // Images of older versions have none.
    if (find_channel(image, std::string(names.emission) + ".R"))
      if (Status read = read_planes(image, names.emission, "RGB", half.emission); !read) return read.failure();
    if (Status read = read_planes(image, names.albedo, "RGB", half.albedo); !read) return read.failure();
    if (Status read = read_planes(image, names.normal, "XYZ", half.normal); !read) return read.failure();
    if (Status read = read_plane(image, names.share, half.share); !read) return read.failure();
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
        usable &= is_usable(double(half.color[c][i])) && is_usable(double(half.emission[c][i])) &&
                  is_usable(double(half.albedo[c][i])) && is_usable(double(half.normal[c][i]));
    }
    if (usable) {
      b.share[i] = 1 - a.share[i];
      continue;
    }
    for (HalfPlanes& half : noisy.halves) {
      half.share[i] = 1;
      for (std::size_t c = 0; c < rgb_size; ++c) {
        half.color[c][i] = is_usable(double(color[c][i])) ? color[c][i] : 0;
        half.emission[c][i] = half.albedo[c][i] = half.normal[c][i] = 0;
      }
    }
    for (Plane& plane : noisy.variance) plane[i] = 0;
  }
  noisy.whole = whole_of(image, noisy);
  for (const std::string& name : layers)
    if (Status read = read_layer(image, name, noisy); !read) return read.failure();
  return noisy;
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
    const Result<NoisyImage> noisy = noisy_image(image->pixels, layers);
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
    return DenoisedLayers{buffer_of(done, options.layers, image.width, image.height),
                          {done.noisy_mse, done.noisy_relative_mse, done.mse, done.relative_mse, done.unfiltered,
                           done.relative_deviation, done.filtered, since_start.seconds()}};
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
    if (is_added(layer)) continue;
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

DenoiseOptions denoise_options(const std::optional<LayerPlan>& layers, int threads) {
  DenoiseOptions options;
  options.threads = threads;
  if (layers) options.layers = layer_names(*layers);
  return options;
}

Result<DenoisedLayers> denoise(const Film& film, const DenoiseOptions& options) {
  if (Status good = has_noise_of_halves(film); !good) return good.failure();
  return denoise_image(noisy_image(film, !options.layers.empty()), options);
}

TargetJudge judge_of(const ErrorTarget& target, int threads) {
  if (target.measure != TargetMeasure::denoised) return TargetJudge(target);
  return TargetJudge(target,
                     [threads](const Film& film, const std::function<bool()>& stops) -> std::optional<FilteredError> {
                       const Result<DenoisedLayers> denoised = denoise(film, {threads, stops});
                       if (!denoised) return std::nullopt;
                       const Denoising& estimate = denoised->estimate;
                       return FilteredError{estimate.relative_mse, estimate.unfiltered, estimate.relative_deviation};
                     });
}

Result<DenoisedLayers> SequenceDenoiser::denoise(const Film& film, const PixelBuffer& motion,
                                                 const DenoiseOptions& options) {
  std::deque<Earlier> before = std::exchange(earlier_, {});
  if (Status good = has_noise_of_halves(film); !good) return good.failure();
  Result<MotionPlanes> to_before = motion_of(motion, "");
  if (!to_before) return to_before.failure();
  NoisyImage image = noisy_image(film, !options.layers.empty());
  std::vector<NoisyImage> others;
  MotionPlanes way = *to_before;
  for (const Earlier& one : before) {
    others.push_back(reprojected(one.image, way));
    way = composed(way, one.motion, image.width, image.height);
  }
  Result<DenoisedLayers> layers = denoise_image(image, options, others);
  if (!layers) return layers;
  image.whole.reset();  // what the next images need is in the halves
  before.push_front({std::move(image), *std::move(to_before)});
  if (before.size() > max_earlier) before.pop_back();
  earlier_ = std::move(before);
  return layers;
}

Result<DenoisedFile> denoise_file(const std::filesystem::path& file, const DenoiseOptions& options) {
  Result<Image> image = read_image(file);
  if (!image) return image.failure();
  DenoiseOptions of_file = options;
  of_file.layers = layers_with_halves(image->pixels);
  const Result<NoisyImage> noisy = noisy_image(image->pixels, of_file.layers);
  if (!noisy) return cannot_be_denoised(file, noisy.error(), "halves");
  const Result<std::vector<NoisyImage>> others = earlier_images(file, image->pixels, options.before, of_file.layers);
  if (!others) return others.failure();
  const Result<DenoisedLayers> denoised = denoise_image(*noisy, of_file, *others);
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
