#include <algorithm>
#include <array>
#include <cmath>

#include "api/images.h"
#include "api/render.h"
#include "mc/random.h"
#include "render/stopwatch.h"

namespace montelux {

namespace {

// The colour of a pixel of the picture: the mean of all light, as the layers know it where there are any, so that they
// sum to it.
std::array<double, 3> color_at(const Rendering& rendering, int x, int y) {
  const Film& film = rendering.result.film;
  const PixelGrid& grid = film.grid();
  const int px = grid.bounds.x0 + x, py = grid.bounds.y0 + y;
  if (!rendering.layers) return film.mean(px, py);
  std::array<double, 3> color{};
  for (int c = 0; c < 3; ++c) color[std::size_t(c)] = film.layers()->mean(grid.cell_x(px), grid.cell_y(py), c);
  return color;
}

// Fills pixels of the rows [first, first + count), `channels` values each. The pixels of a cell are alike: compute(x,
// y, values) is called for one of them, and the others copy its values.
template <class Compute>
void fill_by_cells(const PixelGrid& grid, int first, int count, int channels, float* values, Compute compute) {
  const int width = grid.bounds.width(), x0 = grid.bounds.x0, y0 = grid.bounds.y0 + first;
  for (int y = 0; y < count; ++y)
    for (int x = 0; x < width; ++x, values += channels) {
      const bool like_left = x > 0 && grid.cell_x(x0 + x) == grid.cell_x(x0 + x - 1);
      const bool like_above = y > 0 && grid.cell_y(y0 + y) == grid.cell_y(y0 + y - 1);
      if (like_left || like_above)
        std::copy_n(values - channels * (like_left ? 1 : width), channels, values);
      else
        compute(x, first + y, values);
    }
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
  int first = 0;  // the number that `value` takes for the first channel
};

// These layers, in their order: those of light, the features, and what is known of the samples.
std::vector<LayerRow> all_layer_rows() {
  using At = const PixelView&;
  std::vector<LayerRow> rows{
      {"",
       {"R", "G", "B"},
       true,
       [](At at, int c) {
         return at.rendering.layers ? color_at(at.rendering, at.x, at.y)[std::size_t(c)] : at.estimate.mean[c];
       }},
      {"",
       {"A"},
       true,
       [](At at, int) { return at.features.samples > 0 ? at.features.hits / at.features.samples : 0; }},
      {"stderr", {"R", "G", "B"}, false, [](At at, int c) { return std::sqrt(at.estimate.variance_of_mean(c)); }}};
  int first = 0;
  for (const FeatureRow& feature : feature_rows) {
    std::vector<std::string_view> channels;
    for (std::size_t c = 0; c < feature.channels.size(); ++c) channels.push_back(feature.channels.substr(c, 1));
    rows.push_back({feature.layer, channels, feature.fits_half,
                    [](At at, int c) { return at.per_hit(at.features.sums[std::size_t(c)]); }, first});
    first += int(channels.size());
  }
  rows.push_back({"", {"samples"}, false, [](At at, int) { return at.samples; }});
  rows.push_back({"", {"id"}, false, [](At at, int) { return double(at.features.object); }});
  return rows;
}
const std::vector<LayerRow>& layer_rows() {
  static const std::vector<LayerRow> rows = all_layer_rows();
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

// The number of the channel that counts the samples.
int samples_channel() {
  const std::vector<std::string> names = channel_names();
  return int(std::ranges::find(names, "samples") - names.begin());
}

// Appends the mean of each layer of light, its standard error and its halves where they are known, for the rows from
// `first` on.
void append_light(PixelBuffer& image, int first, const LayerFilm& film, const PixelGrid& grid,
                  const std::vector<std::string>& names) {
  const auto cell_x = [&](int x) { return grid.cell_x(grid.bounds.x0 + x); };
  const auto cell_y = [&](int y) { return grid.cell_y(grid.bounds.y0 + first + y); };
  PixelBuffer added = make_pixel_buffer(image.width, image.height, {"R", "G", "B"});
  const auto append = [&](const std::string& name, auto value) {
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x)
        for (int c = 0; c < rgb_size; ++c) added.at(x, y, c) = float(value(cell_x(x), cell_y(y), c));
    append_layer(image, name, added);
  };
  for (int i = 0; i < film.count(); ++i) {
    const std::string& name = names[std::size_t(i)];
    append(name, [&](int x, int y, int c) { return film.layer_mean(x, y, i, c); });
    if (film.has_spread())
      append(name + "_stderr", [&](int x, int y, int c) { return std::sqrt(film.variance_of_mean(x, y, i, c)); });
    for (std::size_t half = 0; film.has_halves() && half < 2; ++half)
      append(half_layer_names[half].of_layer(name),
             [&](int x, int y, int c) { return film.halves(x, y, i)[half][std::size_t(c)]; });
  }
}

// Appends both halves of the passes, and how many rays show their emission, for the rows from `first` on.
void append_halves(PixelBuffer& image, int first, const Film& film) {
  PixelBuffer added = make_pixel_buffer(image.width, image.height, {});
  for (const HalfLayerNames& names : half_layer_names) {
    for (std::string_view colors : {names.color, names.emission, names.albedo})
      for (const char* channel : {".R", ".G", ".B"}) added.channels.push_back(std::string(colors) + channel);
    for (const char* channel : {".X", ".Y", ".Z"}) added.channels.push_back(std::string(names.normal) + channel);
    added.channels.emplace_back(names.share);
  }
  added.channels.emplace_back(emission_rays_layer);
  added.values.resize(added.pixel_count() * added.channels.size());
  const PixelGrid& grid = film.grid();
  fill_by_cells(grid, first, image.height, added.channel_count(), added.values.data(), [&](int x, int y, float* to) {
    for (const PixelHalf& half : film.halves(grid.bounds.x0 + x, grid.bounds.y0 + y)) {
      for (double channel : half.mean) *to++ = float(channel);
      for (double channel : half.emission) *to++ = float(channel);
      for (double channel : half.albedo) *to++ = float(channel);
      for (double channel : half.normal) *to++ = float(channel);
      *to++ = float(half.share);
    }
    *to++ = float(film.features(grid.bounds.x0 + x, grid.bounds.y0 + y).emission_rays);
  });
  append_layer(image, "", added);
}

// Appends the intervals of the pixels, for the rows from `first` on.
void append_intervals(PixelBuffer& image, int first, const PixelIntervals& intervals) {
  PixelBuffer added = make_pixel_buffer(image.width, image.height, {"R", "G", "B"});
  const std::size_t begin = std::size_t(first) * std::size_t(image.width);
  const auto append = [&](const std::string& name, const ColorPlanes& planes) {
    for (std::size_t i = 0; i < added.pixel_count(); ++i)
      for (std::size_t c = 0; c < rgb_size; ++c) added.values[i * rgb_size + c] = planes[c][begin + i];
    append_layer(image, name, added);
  };
  append("low", intervals.low), append("high", intervals.high);
}

// What an eye sees or a compositor weighs.
std::vector<std::string> half_channels(const std::vector<std::string>& channels) {
  std::vector<std::string> names;
  for (const LayerRow& row : layer_rows())
    for (std::string_view channel : row.channels)
      if (row.fits_half) names.push_back(channel_name(row, channel));
  for (const std::string& channel : channels) {
    const std::string layer = channel.substr(0, std::min(channel.rfind('.'), channel.size()));
    if (layer_family(layer) && !layer.ends_with("_stderr")) names.push_back(channel);
  }
  return names;
}

}  // namespace

namespace {

// The rows [first, first + count) of all layers.
PixelBuffer layers_of_rows(const Rendering& rendering, int first, int count) {
  const Film& film = rendering.result.film;
  const PixelBounds& bounds = film.bounds();
  PixelBuffer image = make_pixel_buffer(bounds.width(), count, channel_names());
  fill_by_cells(film.grid(), first, count, image.channel_count(), image.values.data(),
                [&](int x, int y, float* values) {
                  const int px = bounds.x0 + x, py = bounds.y0 + y;
                  const PixelView at{rendering, x, y, film.pixel(px, py), film.features(px, py), film.samples(px, py)};
                  for (const LayerRow& row : layer_rows())
                    for (int c = 0; c < int(row.channels.size()); ++c) *values++ = float(row.value(at, row.first + c));
                });
  // The samples are those of the pixel itself.
  if (const int of_samples = samples_channel(); film.grid().stride > 1)
    for (int y = 0; y < count; ++y)
      for (int x = 0; x < image.width; ++x)
        image.at(x, y, of_samples) = float(film.samples(bounds.x0 + x, bounds.y0 + first + y));
  if (rendering.motion) append_layer(image, "motion", rows_of(*rendering.motion, first, count));
  if (film.has_halves()) append_halves(image, first, film);
  if (rendering.intervals) append_intervals(image, first, *rendering.intervals);
  if (rendering.denoised) append_layer(image, "", rows_of(rendering.denoised->layers, first, count));
  if (rendering.layers) append_light(image, first, *film.layers(), film.grid(), layer_names(*rendering.layers));
  return image;
}

}  // namespace

PixelBuffer layers_of(const Rendering& rendering) {
  return layers_of_rows(rendering, 0, rendering.result.film.bounds().height());
}

namespace {

PixelBuffer colors_of(const Rendering& rendering) {
  const PixelGrid& grid = rendering.result.film.grid();
  PixelBuffer color = make_pixel_buffer(grid.bounds.width(), grid.bounds.height(), {"R", "G", "B"});
  if (rendering.denoised) return *layer(rendering.denoised->layers, "denoised");
  fill_by_cells(grid, 0, color.height, 3, color.values.data(), [&](int x, int y, float* values) {
    for (double channel : color_at(rendering, x, y)) *values++ = float(channel);
  });
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
    ExrOptions options{rendering.header, {}, rendering.threads};
    if (half) options.half_channels = half_channels(image.channels);
    return encode_exr(file, image, options);
  }
  const PixelBuffer color = colors_of(rendering);
  if (extension == ".hdr" || extension == ".pfm") return encode_image(file, color);
  return encode_image(file, to_display(color, display));
}

// Two passes of noise.
Rendering noise(const PixelBounds& bounds, int stride, const PictureSteps& steps) {
  Film film(bounds, steps.layers, stride, steps.denoise);
  Rendering rendering{RenderResult{std::move(film), {}, 0, false, 0, 0, 0}, {}, {}, {}, {}, 0, {}, {}, {}};
  rendering.layers = steps.layers;
  const PixelBounds cells = rendering.result.film.grid().cells();
  std::vector<PixelSample> samples(std::size_t(cells.area()));
  RandomStream<float> random(0, 0);
  for (int pass = 0; pass < 2; ++pass) {
    for (PixelSample& sample : samples) {
      for (float& channel : sample.radiance.c) channel = random.next();
      sample.features.coverage = 1, sample.features.object = 1;
      sample.features.depth = 1 + 0.001f * random.next();
      // Where few pixels are sampled, all layers have edges between the squares.
      if (stride > 1) {
        for (float& channel : sample.features.albedo.c) channel = random.next();
        sample.features.normal = {random.next(), random.next(), random.next()};
        sample.features.position = {random.next(), random.next(), random.next()};
      }
    }
    std::vector<ExactRgb> sums(steps.layers ? samples.size() * (std::size_t(steps.layers->count()) + 1) : 0);
    for (ExactRgb& sum : sums)
      for (ExactSum& channel : sum.c) channel.add(random.next());
    rendering.result.film.add_pass(cells, pass, 1, samples, sums);
  }
  return rendering;
}

// Seconds that the error and the files of a picture of noise take. Its encoding takes no time where it is not possible.
struct StripTime {
  double error = 0, encoding = 0;
};
StripTime time_strip(const PixelBounds& bounds, int stride, const FilesToWrite& files, const PictureSteps& steps) {
  Rendering strip = noise(bounds, stride, steps);
  strip.threads = steps.threads;
  const Stopwatch since_start;
  strip.error = strip.result.film.error();
  if (steps.intervals && stride == 1) strip.intervals = pixel_intervals(strip.result.film);
  if (steps.denoise && stride == 1)
    if (Result<DenoisedLayers> layers =
            denoise(strip.result.film, denoise_options(steps.layers, steps.threads, steps.filter)))
      strip.denoised = *std::move(layers);
  // Each earlier image takes as long as the image itself.
  const double denoising = strip.denoised ? strip.denoised->estimate.seconds : 0;
  const double error = since_start.seconds();
  for (const std::filesystem::path& file : files.paths) {
    const DisplayTransform display = is_display_file(file) ? choose_display(strip, {}).transform : DisplayTransform{};
    if (!encode_rendering(file, strip, display, files.half))
      return {error + double(steps.earlier_images) * denoising, 0};
  }
  return {error + double(steps.earlier_images) * denoising, since_start.seconds() - error};
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

FinishTime seconds_to_finish(const PixelBounds& bounds, const FilesToWrite& files, PictureSteps steps) {
  // Without what happens once: libraries are loaded, memory is mapped.
  (void)time_strip({0, 0, 1, 1}, 1, files, steps);
  // As many rows as an .exr takes at once, of two threads at most: more of them would make long strips.
  const int rows = std::min(exr_rows_together(steps.threads), exr_rows_together(2));
  const PixelBounds strip{0, 0, bounds.width(), std::min(bounds.height(), rows)};
  const double strips = double(bounds.height()) / strip.height();
  const StripTime dense = time_strip(strip, 1, files, steps);
  const auto sparse = [&](int stride) {
    return std::min(time_strip(strip, stride, files, steps).encoding, dense.encoding);
  };
  const double coarse = sparse(4), even = std::min(sparse(std::max(bounds.width(), bounds.height())), coarse);
  return {strips * dense.error, strips * dense.encoding, strips * coarse, strips * even};
}

}  // namespace montelux
