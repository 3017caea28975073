#include "image/pixel_buffer.h"

#include <algorithm>
#include <cassert>

namespace montelux {

PixelBuffer make_pixel_buffer(int width, int height, std::vector<std::string> channels) {
  PixelBuffer image{width, height, std::move(channels), {}};
  image.values.resize(image.pixel_count() * image.channels.size());
  return image;
}

std::optional<int> find_channel(const PixelBuffer& image, std::string_view name) {
  auto found = std::find(image.channels.begin(), image.channels.end(), name);
  if (found == image.channels.end()) return std::nullopt;
  return int(found - image.channels.begin());
}

std::array<int, 3> rgb_channels(const PixelBuffer& image) {
  std::optional<int> r = find_channel(image, "R"), g = find_channel(image, "G"), b = find_channel(image, "B");
  if (r && g && b) return {*r, *g, *b};
  if (image.channel_count() >= 3) return {0, 1, 2};
  return {0, 0, 0};
}

Rgb rgb_at(const PixelBuffer& image, const std::array<int, 3>& channels, int x, int y) {
  const float* pixel = &image.values[image.index(x, y, 0)];
  Rgb r;
  for (int i = 0; i < 3; ++i) r.c[i] = pixel[channels[std::size_t(i)]];
  return r;
}

std::optional<PixelBuffer> layer(const PixelBuffer& image, std::string_view name) {
  std::vector<int> places;
  std::vector<std::string> names;
  for (int c = 0; c < image.channel_count(); ++c) {
    std::string_view channel = image.channels[std::size_t(c)];
    std::size_t dot = channel.rfind('.');
    bool bare = dot == std::string_view::npos;
    if (name.empty() ? !bare : bare || channel.substr(0, dot) != name) continue;
    places.push_back(c);
    names.emplace_back(bare ? channel : channel.substr(dot + 1));
  }
  if (places.empty()) return std::nullopt;

  PixelBuffer out = make_pixel_buffer(image.width, image.height, std::move(names));
  auto to = out.values.begin();
  for (std::size_t from = 0; from < image.values.size(); from += image.channels.size())
    for (int c : places) *to++ = image.values[from + std::size_t(c)];
  return out;
}

PixelBuffer rows_of(const PixelBuffer& image, int first, int count) {
  const auto row = std::ptrdiff_t(image.width) * image.channel_count();
  const auto begin = image.values.begin() + first * row;
  return {image.width, count, image.channels, {begin, begin + count * row}};
}

void append_layer(PixelBuffer& image, std::string_view name, const PixelBuffer& added) {
  assert(image.channels.empty() || (image.width == added.width && image.height == added.height));
  PixelBuffer out{added.width, added.height, image.channels, {}};
  for (const std::string& channel : added.channels)
    out.channels.push_back(name.empty() ? channel : std::string(name) + "." + channel);
  out.values.reserve(out.pixel_count() * out.channels.size());
  auto old = image.values.begin();
  auto extra = added.values.begin();
  for (std::size_t i = 0; i < out.pixel_count(); ++i) {
    out.values.insert(out.values.end(), old, old + image.channel_count());
    out.values.insert(out.values.end(), extra, extra + added.channel_count());
    old += image.channel_count();
    extra += added.channel_count();
  }
  image = std::move(out);
}

}  // namespace montelux
