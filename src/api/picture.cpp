#include <algorithm>
#include <cmath>

#include "api/images.h"
#include "api/render.h"

namespace montelux {

namespace {

// Channels of the multi-layer picture, in their order.
enum Channel {
  r,
  g,
  b,
  a,
  stderr_r,
  stderr_g,
  stderr_b,
  albedo_r,
  albedo_g,
  albedo_b,
  n_x,
  n_y,
  n_z,
  p_x,
  p_y,
  p_z,
  z,
  samples,
  id
};

std::vector<std::string> channel_names() {
  return {"R",   "G",   "B",   "A",   "stderr.R", "stderr.G", "stderr.B", "albedo.R", "albedo.G", "albedo.B",
          "N.X", "N.Y", "N.Z", "P.X", "P.Y",      "P.Z",      "Z",        "samples",  "id"};
}

// Of every layer of light its mean, and where it is known its standard error. The colour becomes the mean of all light
// as the layers know it, so that they sum to it.
void append_light(PixelBuffer& image, const LayerFilm& film, const PixelGrid& grid,
                  const std::vector<std::string>& names) {
  const auto cell_x = [&](int x) { return grid.cell_x(grid.bounds.x0 + x); };
  const auto cell_y = [&](int y) { return grid.cell_y(grid.bounds.y0 + y); };
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int c = 0; c < spectrum_size; ++c)
        image.at(x, y, Channel::r + c) = float(film.mean(cell_x(x), cell_y(y), c));
  PixelBuffer added = make_pixel_buffer(image.width, image.height, {"R", "G", "B"});
  const auto append = [&](const std::string& name, auto value) {
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x)
        for (int c = 0; c < spectrum_size; ++c) added.at(x, y, c) = float(value(cell_x(x), cell_y(y), c));
    append_layer(image, name, added);
  };
  for (int i = 0; i < film.count(); ++i) {
    const std::string& name = names[std::size_t(i)];
    append(name, [&](int x, int y, int c) { return film.layer_mean(x, y, i, c); });
    if (film.has_spread())
      append(name + "_stderr", [&](int x, int y, int c) { return std::sqrt(film.variance_of_mean(x, y, i, c)); });
  }
}

// What an eye sees or a compositor weighs; a standard error or a place would lose what it is for.
std::vector<std::string> half_channels(const PixelBuffer& image) {
  std::vector<std::string> names;
  for (const std::string& channel : image.channels) {
    const std::size_t dot = channel.rfind('.');
    const std::string layer = dot == std::string::npos ? "" : channel.substr(0, dot);
    const bool of_picture = layer.empty() && std::string_view("RGBA").find(channel) != std::string_view::npos;
    const bool of_light = layer.starts_with("bounce") || layer.starts_with("Combined_");
    if (of_picture || (of_light && !layer.ends_with("_stderr")) || layer == "albedo" || layer == "N")
      names.push_back(channel);
  }
  return names;
}

}  // namespace

PixelBuffer layers_of(const Rendering& rendering) {
  const Film& film = rendering.result.film;
  const PixelBounds& bounds = film.bounds();
  PixelBuffer image = make_pixel_buffer(bounds.width(), bounds.height(), channel_names());
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const PixelEstimate& pixel = film.pixel(bounds.x0 + x, bounds.y0 + y);
      const PixelFeatures& feature = film.features(bounds.x0 + x, bounds.y0 + y);
      auto set = [&](int channel, double value) { image.at(x, y, channel) = float(value); };
      for (int c = 0; c < spectrum_size; ++c) {
        set(Channel::r + c, pixel.mean[c]);
        set(Channel::stderr_r + c, std::sqrt(pixel.variance_of_mean(c)));
      }
      set(Channel::a, feature.samples > 0 ? feature.hits / feature.samples : 0);
      set(Channel::samples, film.samples(bounds.x0 + x, bounds.y0 + y));
      set(Channel::id, feature.object);
      if (feature.hits == 0) continue;
      for (int c = 0; c < 3; ++c) {
        set(Channel::albedo_r + c, feature.albedo[c] / feature.hits);
        set(Channel::n_x + c, feature.normal[c] / feature.hits);
        set(Channel::p_x + c, feature.position[c] / feature.hits);
      }
      set(Channel::z, feature.depth / feature.hits);
    }
  if (rendering.motion) append_layer(image, "motion", *rendering.motion);
  if (rendering.layers) append_light(image, *film.layers(), film.grid(), layer_names(*rendering.layers));
  return image;
}

namespace {

PixelBuffer colors_of(const PixelBuffer& image) {
  PixelBuffer color = make_pixel_buffer(image.width, image.height, {"R", "G", "B"});
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int c = 0; c < 3; ++c) color.at(x, y, c) = image.at(x, y, c);
  return color;
}

}  // namespace

ChosenDisplay choose_display(const Rendering& rendering, const DisplayRequest& request) {
  return choose_display(colors_of(layers_of(rendering)), rendering.content, request, rendering.has_own_exposure);
}

Status write_rendering(const std::filesystem::path& file, const Rendering& rendering, const DisplayTransform& display,
                       bool half) {
  PixelBuffer image = layers_of(rendering);
  const std::string extension = extension_of(file);
  if (extension == ".exr") {
    ExrOptions options;
    options.attributes = rendering.header;
    if (half) options.half_channels = half_channels(image);
    return write_image(file, image, options);
  }
  const PixelBuffer color = colors_of(image);
  if (extension == ".hdr" || extension == ".pfm") return write_image(file, color);
  return write_image(file, to_display(color, display));
}

}  // namespace montelux
