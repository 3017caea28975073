#include "image/display.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "color/transfer.h"

namespace montelux {
namespace {

float hable_segment(float x) {
  return (x * (0.15f * x + 0.05f) + 0.004f) / (x * (0.15f * x + 0.5f) + 0.06f) - 0.02f / 0.3f;
}

float hable(float x) { return hable_segment(2.0f * x) / hable_segment(11.2f); }

float narkowicz(float x) { return x * (2.51f * x + 0.03f) / (x * (2.43f * x + 0.59f) + 0.14f); }

std::uint8_t to_byte(float linear) { return std::uint8_t(srgb_encode(linear) * 255.0f + 0.5f); }

// The position t within the range, in [0, 1]; not a number gives 0.
float share_of(const ValueRange& range, float value) {
  const float t = (value - range.low) / (range.high - range.low);
  return t > 0 ? std::min(t, 1.0f) : 0.0f;
}

// The value of a pixel that a false colour represents.
float value_at(const PixelBuffer& image, const std::array<int, 3>& rgb, Content content, int x, int y) {
  if (content == Content::light) return luminance(rgb_at(image, rgb, x, y));
  if (image.channel_count() == 2) return std::hypot(image.at(x, y, 0), image.at(x, y, 1));
  return average(rgb_at(image, rgb, x, y));
}

bool is_nothing(Content content, float value) {
  return !std::isfinite(value) || (content == Content::distance && value <= 0);
}

// The linear colour of a pixel by the rule of its content, for content shown neither as light nor by a map.
Rgb plain_color(const Rgb& color, const DisplayTransform& transform) {
  switch (transform.content) {
    case Content::number:
      return color.c[0] > 0 ? color_of_number(std::uint32_t(std::min(color.c[0], 4e9f))) : Rgb{};
    case Content::direction:
      if (is_black(per_component([](float x) { return std::fabs(x); }, color))) return Rgb{};
      return per_component([](float x) { return srgb_decode(share_of({-1, 1}, x)); }, color);
    case Content::encoded:
      return per_component([](float x) { return srgb_decode(share_of({0, 1}, x)); }, color);
    case Content::light:
    case Content::share:
    case Content::position:
    case Content::distance:
    case Content::amount:
      break;
  }
  const ValueRange range = transform.range.value_or(ValueRange{});
  return per_component([&](float x) { return share_of(range, x); }, color);
}

Rgb shown_color(const PixelBuffer& image, const std::array<int, 3>& rgb, const DisplayTransform& transform, int x,
                int y) {
  if (transform.map) {
    const float value = value_at(image, rgb, transform.content, x, y);
    if (is_nothing(transform.content, value)) return Rgb{};
    return color_at(*transform.map, share_of(transform.range.value_or(ValueRange{}), value));
  }
  const Rgb color = rgb_at(image, rgb, x, y);
  if (transform.range || transform.content != Content::light) return plain_color(color, transform);
  const float scale = std::exp2(transform.exposure);
  return per_component([&](float c) { return apply_curve(transform.curve, c * scale); }, color);
}

// All valid values, as a map uses them, sorted.
std::vector<float> sorted_values(const PixelBuffer& image, Content content) {
  const std::array<int, 3> rgb = rgb_channels(image);
  std::vector<float> values;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const float value = value_at(image, rgb, content, x, y);
      if (!is_nothing(content, value)) values.push_back(value);
    }
  std::sort(values.begin(), values.end());
  return values;
}

// The percentile of sorted values.
float percentile(const std::vector<float>& values, double share) {
  return values[std::size_t(share * double(values.size() - 1))];
}

ValueRange automatic_range(const PixelBuffer& image, Content content) {
  if (content == Content::position) {
    std::vector<float> all;
    const std::array<int, 3> rgb = rgb_channels(image);
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x)
        for (float c : rgb_at(image, rgb, x, y).c)
          if (std::isfinite(c)) all.push_back(c);
    if (all.empty()) return {};
    const auto [low, high] = std::minmax_element(all.begin(), all.end());
    return *high > *low ? ValueRange{*low, *high} : ValueRange{*low, *low + 1};
  }
  const std::vector<float> values = sorted_values(image, content);
  if (values.empty()) return {};
  const bool from_zero = content == Content::amount || content == Content::light || content == Content::share;
  const float low = from_zero ? std::min(0.0f, values.front()) : percentile(values, 0.01);
  float high = percentile(values, 0.99);
  if (!(high > low)) high = values.back();
  return {low, high > low ? high : low + 1};
}

// Whether more than 95 % of the lit pixels are at either end of the display's range.
bool is_out_of_range(const PixelBuffer& image, ToneCurve curve) {
  const std::array<int, 3> rgb = rgb_channels(image);
  std::size_t lit = 0, outside = 0;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const float value = luminance(rgb_at(image, rgb, x, y));
      if (!(value > 0)) continue;
      const std::uint8_t byte = to_byte(apply_curve(curve, value));
      ++lit, outside += byte == 0 || byte == 255;
    }
  return double(outside) > 0.95 * double(lit);
}

}  // namespace

Content content_of_layer(std::string_view name) {
  using enum Content;
  constexpr std::array<std::pair<std::string_view, Content>, 12> known{{{"albedo", share},
                                                                        {"A", share},
                                                                        {"alpha", share},
                                                                        {"N", direction},
                                                                        {"normal", direction},
                                                                        {"P", position},
                                                                        {"Z", distance},
                                                                        {"depth", distance},
                                                                        {"samples", amount},
                                                                        {"stderr", amount},
                                                                        {"motion", amount},
                                                                        {"id", number}}};
  for (const auto& [layer, content] : known)
    if (layer == name) return content;
  return name.ends_with("_stderr") ? amount : light;
}

ChosenDisplay choose_display(const PixelBuffer& image, Content content, const DisplayRequest& request,
                             bool has_own_exposure) {
  ChosenDisplay chosen;
  DisplayTransform& t = chosen.transform;
  const bool as_range = request.range || request.automatic_range || request.map;
  const bool as_light = request.exposure || request.automatic_exposure || request.curve;
  t.content = as_light && !as_range ? Content::light : content;
  t.curve = request.curve.value_or(ToneCurve::clip);
  if (t.content == Content::light && !as_range) {
    t.exposure = request.exposure.value_or(0.0f);
    const bool useless = !request.exposure && !has_own_exposure && is_out_of_range(image, t.curve);
    if (!request.automatic_exposure && !useless) return chosen;
    const float stops = automatic_exposure(image);
    chosen.exposure_chosen = request.automatic_exposure || stops != 0;
    t.exposure = stops;
    return chosen;
  }
  const bool measured = t.content == Content::distance || t.content == Content::amount;
  if (!request.no_map) t.map = request.map ? request.map : measured ? std::optional(ColorMap::viridis) : std::nullopt;
  const bool is_share = t.content == Content::share || t.content == Content::encoded;
  const bool needs_range = measured || t.content == Content::position || (t.map && !is_share);
  chosen.range_chosen = !request.range && (request.automatic_range || needs_range);
  t.range = chosen.range_chosen ? std::optional(automatic_range(image, t.content)) : request.range;
  return chosen;
}

float automatic_exposure(const PixelBuffer& image) {
  std::vector<float> values = sorted_values(image, Content::light);
  values.erase(values.begin(), std::upper_bound(values.begin(), values.end(), 0.0f));
  if (values.empty()) return 0;
  const float high = percentile(values, 0.99), low = high * 1e-4f;
  double sum = 0, count = 0;
  for (float value : values)
    if (value >= low && value <= high) sum += std::log2(double(value)), count += 1;
  constexpr double key = 0.18;
  const double stops = std::log2(key) - sum / count;
  return float(std::round(std::clamp(stops, -100.0, 100.0) * 10) / 10);
}

float apply_curve(ToneCurve curve, float linear) {
  if (!(linear > 0.0f)) return 0.0f;
  // Beyond this the curves are flat, and their quotients would overflow.
  float x = std::min(linear, 1e9f);
  float y = curve == ToneCurve::hable ? hable(x) : curve == ToneCurve::aces ? narkowicz(x) : x;
  return std::clamp(y, 0.0f, 1.0f);
}

DisplayImage to_display(const PixelBuffer& image, const DisplayTransform& transform) {
  const bool colored = transform.map || transform.content == Content::number || image.channel_count() >= 3;
  DisplayImage out{image.width, image.height, colored ? 3 : 1, {}};
  out.values.reserve(image.pixel_count() * std::size_t(out.channel_count));
  std::array<int, 3> rgb = rgb_channels(image);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const Rgb color = shown_color(image, rgb, transform, x, y);
      for (int c = 0; c < out.channel_count; ++c) out.values.push_back(to_byte(color.c[c]));
    }
  return out;
}

std::string choice_text(const ChosenDisplay& chosen) {
  char text[96] = "";
  if (chosen.exposure_chosen)
    std::snprintf(text, sizeof text, "exposure %+.1f EV, chosen automatically", double(chosen.transform.exposure));
  else if (chosen.range_chosen && chosen.transform.range)
    std::snprintf(text, sizeof text, "range %.4g:%.4g, chosen automatically", double(chosen.transform.range->low),
                  double(chosen.transform.range->high));
  return text;
}

}  // namespace montelux
