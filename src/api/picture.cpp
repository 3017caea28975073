#include <algorithm>
#include <cmath>

#include "api/images.h"
#include "api/render.h"
#include "mc/random.h"
#include "render/stopwatch.h"

namespace montelux {

namespace {

// The colour of a pixel of the picture: the mean of all light, as the layers know it where there are any, so that they
// sum to it.
double color_at(const Rendering& rendering, int x, int y, int channel) {
  const Film& film = rendering.result.film;
  const PixelGrid& grid = film.grid();
  const int px = grid.bounds.x0 + x, py = grid.bounds.y0 + y;
  if (rendering.layers) return film.layers()->mean(grid.cell_x(px), grid.cell_y(py), channel);
  return film.pixel(px, py).mean[channel];
}

// One pixel, as the layers see it.
struct PixelView {
  const Rendering& rendering;
  int x, y;  // in the image
  const PixelEstimate& estimate;
  const PixelFeatures& features;
  double samples;

  // The mean over the samples that hit a surface; 0 if none did.
  double per_hit(double sum) const { return features.hits > 0 ? sum / features.hits : 0; }
};

// A layer that every image has. Its channels are "name.R" or, without a name, "R".
struct LayerRow {
  std::string_view name;
  std::vector<std::string_view> channels;
  bool fits_half;  // 16-bit floats keep what it is for, unlike that of an error or a position
  double (*value)(const PixelView& at, int channel);
};

// The one table of these layers, in their order.
const std::vector<LayerRow>& layer_rows() {
  using At = const PixelView&;
  static const std::vector<LayerRow> rows{
      {"",
       {"R", "G", "B"},
       true,
       [](At at, int c) { return at.rendering.layers ? color_at(at.rendering, at.x, at.y, c) : at.estimate.mean[c]; }},
      {"",
       {"A"},
       true,
       [](At at, int) { return at.features.samples > 0 ? at.features.hits / at.features.samples : 0; }},
      {"stderr", {"R", "G", "B"}, false, [](At at, int c) { return std::sqrt(at.estimate.variance_of_mean(c)); }},
      {"albedo", {"R", "G", "B"}, true, [](At at, int c) { return at.per_hit(at.features.albedo[c]); }},
      {"N", {"X", "Y", "Z"}, true, [](At at, int c) { return at.per_hit(at.features.normal[c]); }},
      {"P", {"X", "Y", "Z"}, false, [](At at, int c) { return at.per_hit(at.features.position[c]); }},
      {"", {"Z"}, false, [](At at, int) { return at.per_hit(at.features.depth); }},
      {"", {"samples"}, false, [](At at, int) { return at.samples; }},
      {"", {"id"}, false, [](At at, int) { return double(at.features.object); }}};
  return rows;
}

std::string channel_name(const LayerRow& row, std::string_view channel) {
  return row.name.empty() ? std::string(channel) : std::string(row.name).append(".").append(channel);
}

std::vector<std::string> channel_names() {
  std::vector<std::string> names;
  for (const LayerRow& row : layer_rows())
    for (std::string_view channel : row.channels) names.push_back(channel_name(row, channel));
  return names;
}

// Appends the mean of each layer of light, and its standard error where it is known, for the rows from `first` on.
void append_light(PixelBuffer& image, int first, const LayerFilm& film, const PixelGrid& grid,
                  const std::vector<std::string>& names) {
  const auto cell_x = [&](int x) { return grid.cell_x(grid.bounds.x0 + x); };
  const auto cell_y = [&](int y) { return grid.cell_y(grid.bounds.y0 + first + y); };
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

// What an eye sees or a compositor weighs.
std::vector<std::string> half_channels(const std::vector<std::string>& channels) {
  std::vector<std::string> names;
  for (const LayerRow& row : layer_rows())
    for (std::string_view channel : row.channels)
      if (row.fits_half) names.push_back(channel_name(row, channel));
  for (const std::string& channel : channels) {
    const std::string layer = channel.substr(0, std::min(channel.rfind('.'), channel.size()));
    const bool of_light = layer.starts_with("bounce") || layer.starts_with("Combined_");
    if (of_light && !layer.ends_with("_stderr")) names.push_back(channel);
  }
  return names;
}

}  // namespace

namespace {

PixelBuffer rows_of(const PixelBuffer& image, int first, int count) {
  const auto row = std::ptrdiff_t(image.width) * image.channel_count();
  const auto begin = image.values.begin() + first * row;
  return {image.width, count, image.channels, {begin, begin + count * row}};
}

// The rows [first, first + count) of all layers.
PixelBuffer layers_of_rows(const Rendering& rendering, int first, int count) {
  const Film& film = rendering.result.film;
  const PixelBounds& bounds = film.bounds();
  PixelBuffer image = make_pixel_buffer(bounds.width(), count, channel_names());
  for (int y = 0; y < count; ++y)
    for (int x = 0; x < image.width; ++x) {
      const int px = bounds.x0 + x, py = bounds.y0 + first + y;
      const PixelView at{rendering, x, first + y, film.pixel(px, py), film.features(px, py), film.samples(px, py)};
      int channel = 0;
      for (const LayerRow& row : layer_rows())
        for (int c = 0; c < int(row.channels.size()); ++c) image.at(x, y, channel++) = float(row.value(at, c));
    }
  if (rendering.motion) append_layer(image, "motion", rows_of(*rendering.motion, first, count));
  if (rendering.layers) append_light(image, first, *film.layers(), film.grid(), layer_names(*rendering.layers));
  return image;
}

}  // namespace

PixelBuffer layers_of(const Rendering& rendering) {
  return layers_of_rows(rendering, 0, rendering.result.film.bounds().height());
}

namespace {

PixelBuffer colors_of(const Rendering& rendering) {
  const PixelBounds& bounds = rendering.result.film.bounds();
  PixelBuffer color = make_pixel_buffer(bounds.width(), bounds.height(), {"R", "G", "B"});
  for (int y = 0; y < color.height; ++y)
    for (int x = 0; x < color.width; ++x)
      for (int c = 0; c < spectrum_size; ++c) color.at(x, y, c) = float(color_at(rendering, x, y, c));
  return color;
}

// The bytes of a file of the picture.
Result<std::string> encode_rendering(const std::filesystem::path& file, const Rendering& rendering,
                                     const DisplayTransform& display, bool half) {
  const std::string extension = extension_of(file);
  if (extension == ".exr") {
    const PixelBounds& bounds = rendering.result.film.bounds();
    const auto rows = [&rendering](int first, int count) { return layers_of_rows(rendering, first, count); };
    const ImageRows image{bounds.width(), bounds.height(), rows(0, 1).channels, rows};
    ExrOptions options{rendering.header, {}};
    if (half) options.half_channels = half_channels(image.channels);
    return encode_exr(file, image, options);
  }
  const PixelBuffer color = colors_of(rendering);
  if (extension == ".hdr" || extension == ".pfm") return encode_image(file, color);
  return encode_image(file, to_display(color, display));
}

// Two passes of noise.
Rendering noise(const PixelBounds& bounds) {
  Rendering rendering{RenderResult{Film(bounds), {}, 0, false, 0, 0, 0}, {}, {}, {}, {}, 0, {}, {}, {}};
  std::vector<PixelSample> samples(std::size_t(bounds.area()));
  RandomStream<float> random(0, 0);
  for (int pass = 0; pass < 2; ++pass) {
    for (PixelSample& sample : samples) {
      for (float& channel : sample.radiance.c) channel = random.next();
      sample.features.coverage = 1, sample.features.object = 1;
      sample.features.depth = 1 + 0.001f * random.next();
    }
    rendering.result.film.add_pass(bounds, pass, 1, samples);
  }
  return rendering;
}

// Of a picture of noise; its encoding takes no time where it is not possible.
FinishTime finish_strip(int width, int height, const FilesToWrite& files) {
  Rendering strip = noise({0, 0, width, height});
  const Stopwatch since_start;
  strip.error = strip.result.film.error();
  const double error = since_start.seconds();
  for (const std::filesystem::path& file : files.paths) {
    const DisplayTransform display = is_display_file(file) ? choose_display(strip, {}).transform : DisplayTransform{};
    if (!encode_rendering(file, strip, display, files.half)) return {error, 0};
  }
  return {error, since_start.seconds() - error};
}

}  // namespace

ChosenDisplay choose_display(const Rendering& rendering, const DisplayRequest& request) {
  return choose_display(colors_of(rendering), rendering.content, request, rendering.has_own_exposure);
}

Status write_rendering(const std::filesystem::path& file, const Rendering& rendering, const DisplayTransform& display,
                       bool half) {
  const Result<std::string> bytes = encode_rendering(file, rendering, display, half);
  return bytes ? write_file(file, *bytes) : Status(bytes.failure());
}

FinishTime seconds_to_finish(const PixelBounds& bounds, const FilesToWrite& files) {
  // Without what happens once: libraries are loaded, memory is mapped.
  (void)finish_strip(bounds.width(), 1, files);
  // As many rows as an .exr packs together, or some such.
  constexpr int rows_together = 32;
  const int rows = std::min((bounds.height() / (32 * rows_together) + 1) * rows_together, bounds.height());
  const FinishTime strip = finish_strip(bounds.width(), rows, files);
  const double strips = double(bounds.height()) / rows;
  return {strips * strip.error, strips * strip.encoding};
}

}  // namespace montelux
