#include "api/diff.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "api/images.h"
#include "integrator/catalogue.h"

namespace montelux {

namespace {

std::vector<std::string> rgb_names() { return {"R", "G", "B"}; }

PixelBuffer colors_of(const PixelBuffer& image) {
  PixelBuffer out = make_pixel_buffer(image.width, image.height, rgb_names());
  const std::array<int, 3> channels = rgb_channels(image);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const Rgb color = rgb_at(image, channels, x, y);
      for (int c = 0; c < 3; ++c) out.at(x, y, c) = color.c[c];
    }
  return out;
}

std::optional<double> number(const Image& image, std::string_view name) {
  for (const Attribute& attribute : image.attributes) {
    if (attribute.name != name) continue;
    if (auto* value = std::get_if<double>(&attribute.value)) return *value;
    if (auto* value = std::get_if<float>(&attribute.value)) return *value;
    if (auto* value = std::get_if<std::int32_t>(&attribute.value)) return *value;
  }
  return std::nullopt;
}

std::string text(const Image& image, std::string_view name) {
  for (const Attribute& attribute : image.attributes)
    if (auto* value = std::get_if<std::string>(&attribute.value); value && attribute.name == name) return *value;
  return {};
}

// Three numbers in the header.
std::optional<std::array<double, 3>> rgb_of_header(const Image& image, std::string_view prefix) {
  std::array<double, 3> values{};
  for (std::size_t c = 0; c < 3; ++c) {
    auto value = number(image, fmt::format("{}{}", prefix, "RGB"[c]));
    if (!value || !std::isfinite(*value)) return std::nullopt;
    values[c] = *value;
  }
  return values;
}

std::array<double, 3> mean_of(const PixelBuffer& color) {
  std::array<double, 3> sum{};
  for (std::size_t i = 0; i < color.values.size(); ++i) sum[i % 3] += double(color.values[i]);
  for (double& s : sum) s /= double(color.pixel_count());
  return sum;
}

bool same(float a, float b) { return a == b || (std::isnan(a) && std::isnan(b)); }

EstimatedImage estimated(const PictureEstimate& picture) {
  const ErrorBars& bars = *picture.bars;
  return {picture.color, bars.standard_error, bars.degrees_of_freedom, bars.error_of_mean, bars.pixels_share_samples};
}

// Whether the pixels of one pass of this image share samples: through their filters, or by their integrator.
bool shares_samples(const Image& image) {
  if (text(image, "montelux:filterSamples") == "shared") return true;
  const std::string integrator = text(image, "montelux:integrator");
  const std::string_view name = std::string_view(integrator).substr(0, integrator.find(':'));
  return std::ranges::count(integrators_with(Ability::shared_samples), name) > 0;
}

}  // namespace

Result<PictureEstimate> read_estimate(const PictureFiles& files) {
  Result<Image> image = read_image(files.picture);
  if (!image) return image.failure();
  PictureEstimate estimate{colors_of(image->pixels),
                           image->stored == SampleType::uint8 || image->stored == SampleType::uint16, std::nullopt};
  std::optional<PixelBuffer> errors;
  if (files.standard_error) {
    Result<Image> bars = read_image(*files.standard_error);
    if (!bars) return bars.failure();
    errors = colors_of(bars->pixels);
    if (errors->width != estimate.color.width || errors->height != estimate.color.height)
      return Failure{fmt::format("'{}' has {} x {} pixels, its standard error '{}' {} x {}", files.picture.string(),
                                 estimate.color.width, estimate.color.height, files.standard_error->string(),
                                 errors->width, errors->height)};
  } else if (auto bars = layer(image->pixels, "stderr")) {
    errors = colors_of(*bars);
  }
  if (!errors) return estimate;
  const std::optional<double> passes = number(*image, "montelux:passes");
  // One pass has no spread: its standard error is infinite and meaningless.
  if (!files.standard_error && passes && *passes < 2) return estimate;
  const double unknown = files.degrees_of_freedom.value_or(std::numeric_limits<double>::infinity());
  ErrorBars bars{std::move(*errors), passes && !files.standard_error ? *passes - 1 : unknown, std::nullopt, false};
  if (!files.standard_error) {
    bars.error_of_mean = rgb_of_header(*image, "montelux:meanStandardError");
    bars.pixels_share_samples = shares_samples(*image);
  }
  estimate.bars = std::move(bars);
  return estimate;
}

Result<PictureDifference> compare_pictures(const PictureEstimate& a, const PictureEstimate& b, double level) {
  if (a.color.width != b.color.width || a.color.height != b.color.height)
    return Failure{fmt::format("the images differ in size: {} x {} and {} x {} pixels", a.color.width, a.color.height,
                               b.color.width, b.color.height)};
  PictureDifference difference;
  difference.equal = std::equal(a.color.values.begin(), a.color.values.end(), b.color.values.begin(), same);
  difference.mean_a = mean_of(a.color), difference.mean_b = mean_of(b.color);
  difference.measures = measure_error(a.color, b.color);
  difference.hdr_flip = !(a.display && b.display);
  difference.flip = difference.hdr_flip ? hdr_flip(a.color, b.color) : ldr_flip(a.color, b.color);
  if (a.bars && b.bars) difference.welch = welch_test(estimated(a), estimated(b), level);
  return difference;
}

std::vector<std::pair<std::string, std::string>> difference_maps() {
  return {{"relative", "(a - b)^2 / (b^2 + 0.01)"},
          {"squared", "(a - b)^2"},
          {"absolute", "|a - b|"},
          {"flip", "the perceived difference, from 0 to 1"}};
}

Result<PixelBuffer> difference_map(std::string_view name, const PictureEstimate& a, const PictureEstimate& b,
                                   const PictureDifference& difference) {
  if (name == "flip") return difference.flip.map;
  if (name == "relative") return error_map(a.color, b.color, ErrorKind::relative_squared);
  if (name == "squared") return error_map(a.color, b.color, ErrorKind::squared);
  if (name == "absolute") return error_map(a.color, b.color, ErrorKind::absolute);
  return Failure{fmt::format("there is no map \"{}\" of a difference", name)};
}

Status write_map(const std::filesystem::path& file, const PixelBuffer& map) {
  if (!is_display_file(file)) return write_picture(file, map, {});
  DisplayRequest request;
  request.map = ColorMap::magma;
  return write_picture(file, map, choose_display(map, Content::amount, request, false).transform);
}

}  // namespace montelux
