#include "api/noisy_image.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "api/denoise.h"
#include "film/film.h"
#include "image/layers.h"

namespace montelux {

namespace {

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

// Reads both halves, and the standard errors where the image has them. Pixels that are not filtered have the whole as
// both halves.
Status read_layer(const PixelBuffer& image, const std::string& name, NoisyImage& noisy) {
  const bool knows_error = find_channel(image, name + "_stderr.R").has_value();
  NoisyLayer& layer = noisy.layers.emplace_back(noisy.pixels(), knows_error, *layer_family(name));
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

}  // namespace

NoisyImage noisy_image(const Film& film, const std::vector<std::string>& layers) {
  const PixelBounds& b = film.bounds();
  NoisyImage image(b.width(), b.height());
  for (const std::string& name : layers)
    image.layers.emplace_back(image.pixels(), film.layers()->has_spread(), *layer_family(name));
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

std::vector<std::string> layers_with_halves(const PixelBuffer& image) {
  std::vector<std::string> names;
  const std::string begin = half_layer_names[0].of_layer("");
  for (const std::string& channel : image.channels) {
    if (!channel.starts_with(begin) || !channel.ends_with(".R")) continue;
    const std::string name = channel.substr(begin.size(), channel.size() - begin.size() - 2);
    if (layer_family(name)) names.push_back(name);
  }
  return names;
}

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

}  // namespace montelux
