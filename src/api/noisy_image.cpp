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

// Of a pixel with passes in both halves.
bool is_part(double share) { return share > 0 && share < 1; }

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

Failure has_no_channel(std::string_view name) { return Failure{fmt::format("it has no channel {}", name)}; }

std::string channel_name(std::string_view layer, char channel) {
  return layer.empty() ? std::string(1, channel) : fmt::format("{}.{}", layer, channel);
}

// Copies channels of an image to planes, all in one pass over its pixels.
class PlaneReader {
 public:
  explicit PlaneReader(const PixelBuffer& image) : image_(image) {}

  // Three channels of a layer; a failure names the first that is missing. The planes are filled by read().
  Status add(std::string_view layer, std::string_view channels, std::array<Plane, 3>& planes) {
    for (std::size_t c = 0; c < 3; ++c)
      if (Status added = add(channel_name(layer, channels[c]), planes[c]); !added) return added;
    return Done{};
  }
  Status add(std::string_view channel, Plane& plane) {
    if (!has(channel)) return has_no_channel(channel);
    add_existing(channel, plane);
    return Done{};
  }
  // The image has the channel.
  void add_existing(std::string_view channel, Plane& plane) {
    plane.resize(image_.pixel_count());
    planes_.push_back({std::size_t(*find_channel(image_, channel)), &plane});
  }
  bool has(std::string_view channel) const { return find_channel(image_, channel).has_value(); }
  // In parts that fit into caches: the channels of a pixel are side by side.
  void read() const {
    constexpr std::size_t part = 512;  // pixels
    const std::size_t pixels = image_.pixel_count(), channels = image_.channels.size();
    for (std::size_t first = 0; first < pixels; first += part)
      for (const auto& [channel, plane] : planes_)
        for (std::size_t i = first; i < std::min(first + part, pixels); ++i)
          (*plane)[i] = image_.values[i * channels + channel];
  }

 private:
  struct Wanted {
    std::size_t channel;
    Plane* plane;
  };
  const PixelBuffer& image_;
  std::vector<Wanted> planes_;
};

// Numbers that cannot be become 0.
void keep_usable(Plane& plane) {
  for (float& value : plane)
    if (!is_usable(double(value))) value = 0;
}

// The colours of a layer of an image.
class LayerColors {
 public:
  LayerColors(const PixelBuffer& image, std::string_view layer) : image_(image) {
    for (std::size_t c = 0; c < rgb_size; ++c) {
      const std::string name = channel_name(layer, "RGB"[c]);
      const std::optional<int> channel = find_channel(image, name);
      if (!channel && missing_.empty()) missing_ = name;
      channels_[c] = std::size_t(channel.value_or(0));
    }
  }
  Status exist() const { return missing_.empty() ? Status(Done{}) : has_no_channel(missing_); }
  // Numbers that cannot be are 0.
  float at(std::size_t c, std::size_t i) const {
    const float value = image_.values[i * image_.channels.size() + channels_[c]];
    return is_usable(double(value)) ? value : 0;
  }

 private:
  const PixelBuffer& image_;
  std::array<std::size_t, rgb_size> channels_;
  std::string missing_;
};

// Adds both halves of a layer, and the standard errors where the image has them.
Status add_layer(PlaneReader& reader, const std::string& name, NoisyLayer& layer) {
  for (std::size_t h = 0; h < 2; ++h)
    if (Status added = reader.add(half_layer_names[h].of_layer(name), "RGB", layer.halves[h]); !added) return added;
  if (!layer.knows_variance()) return Done{};
  return reader.add(name + "_stderr", "RGB", layer.variance);
}

// Pixels that are not filtered have the whole as both halves. The standard errors become variances.
void finish_layer(const NoisyImage& noisy, const LayerColors& whole, NoisyLayer& layer) {
  for (std::size_t c = 0; c < rgb_size; ++c)
    for (std::size_t i = 0; i < noisy.pixels(); ++i) {
      for (ColorPlanes& half : layer.halves) {
        if (noisy.halves[0].share[i] == 1) half[c][i] = whole.at(c, i);
        if (!is_usable(double(half[c][i]))) half[c][i] = 0;
      }
      if (!layer.knows_variance()) continue;
      float& error = layer.variance[c][i];
      error = error >= 0 && is_usable(double(error) * double(error)) ? error * error : 0;
    }
}

// The mean of the channels.
float gray_of(const ColorPlanes& planes, std::size_t i) { return (planes[0][i] + planes[1][i] + planes[2][i]) / 3; }

// Planes of the whole image, each with its channel.
std::vector<std::pair<std::string_view, Plane*>> channels_of(FilmPlanes& whole) {
  auto& [red, green, blue] = whole.albedo;
  auto& [x, y, z] = whole.normal;
  return {{"A", &whole.coverage},
          {"samples", &whole.samples},
          {"id", &whole.object},
          {"albedo.R", &red},
          {"albedo.G", &green},
          {"albedo.B", &blue},
          {"N.X", &x},
          {"N.Y", &y},
          {"N.Z", &z}};
}

// Adds what is read of the whole image, if the image has all of it.
void add_whole(PlaneReader& reader, NoisyImage& noisy) {
  FilmPlanes& whole = noisy.whole.emplace(PixelBounds{0, 0, noisy.width, noisy.height});
  const auto channels = channels_of(whole);
  if (!std::ranges::all_of(channels, [&](const auto& channel) { return reader.has(channel.first); }))
    return noisy.whole.reset();
  for (const auto& [name, plane] : channels) reader.add_existing(name, *plane);
  if (reader.has(emission_rays_layer)) reader.add_existing(emission_rays_layer, whole.emission_rays);
}

void finish_whole(const PlaneReader& reader, NoisyImage& noisy) {
  if (!noisy.whole) return;
  FilmPlanes& whole = *noisy.whole;
  for (const auto& [name, plane] : channels_of(whole)) keep_usable(*plane);
  keep_usable(whole.emission_rays);
  // Images of older versions have one for each sample.
  if (!reader.has(emission_rays_layer)) whole.emission_rays = whole.samples;
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
}

// Adds the layers of a half; images of older versions have no emission.
Status add_half(PlaneReader& reader, const HalfLayerNames& names, HalfPlanes& half) {
  if (Status added = reader.add(names.color, "RGB", half.color); !added) return added;
  if (reader.has(channel_name(names.emission, 'R')))
    if (Status added = reader.add(names.emission, "RGB", half.emission); !added) return added;
  if (Status added = reader.add(names.albedo, "RGB", half.albedo); !added) return added;
  if (Status added = reader.add(names.normal, "XYZ", half.normal); !added) return added;
  return reader.add(names.share, half.share);
}

// The standard errors become variances. Pixels with numbers that cannot be are left as they are.
void finish_halves(const LayerColors& color, NoisyImage& noisy) {
  for (HalfPlanes& half : noisy.halves) keep_usable(half.share);
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
        half.color[c][i] = color.at(c, i);
        half.emission[c][i] = half.albedo[c][i] = half.normal[c][i] = 0;
      }
    }
    for (Plane& plane : noisy.variance) plane[i] = 0;
  }
}

}  // namespace

NoisyImage noisy_image(const Film& film, const std::vector<std::string>& layers, const RowRange& rows) {
  const PixelBounds& all = film.bounds();
  const PixelBounds b{all.x0, all.y0 + rows.first, all.x1, all.y0 + rows.end()};
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

bool has_both_halves(const Film& film) {
  const PixelBounds& b = film.bounds();
  for (int y = b.y0; y < b.y1; ++y)
    for (int x = b.x0; x < b.x1; ++x)
      if (is_part(film.halves(x, y).front().share)) return true;
  return false;
}

bool has_both_halves(const PixelBuffer& image) {
  const std::optional<int> share = find_channel(image, half_layer_names[0].share);
  for (std::size_t i = 0; share && i < image.pixel_count(); ++i)
    if (is_part(double(image.values[i * image.channels.size() + std::size_t(*share)]))) return true;
  return false;
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
  PlaneReader reader(image);
  const LayerColors color(image, "");
  if (Status exist = color.exist(); !exist) return exist.failure();
  if (Status added = reader.add("stderr", "RGB", noisy.variance); !added) return added.failure();
  for (std::size_t h = 0; h < 2; ++h)
    if (Status added = add_half(reader, half_layer_names[h], noisy.halves[h]); !added) return added.failure();
  add_whole(reader, noisy);
  std::vector<LayerColors> of_layers;
  for (const std::string& name : layers) {
    noisy.layers.emplace_back(noisy.pixels(), reader.has(name + "_stderr.R"), *layer_family(name));
    of_layers.emplace_back(image, name);
  }
  for (std::size_t k = 0; k < layers.size(); ++k) {
    if (Status added = add_layer(reader, layers[k], noisy.layers[k]); !added) return added.failure();
    if (Status exist = of_layers[k].exist(); !exist) return exist.failure();
  }
  reader.read();
  finish_halves(color, noisy);
  finish_whole(reader, noisy);
  for (std::size_t k = 0; k < layers.size(); ++k) finish_layer(noisy, of_layers[k], noisy.layers[k]);
  return noisy;
}

}  // namespace montelux
