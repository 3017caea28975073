// An image in memory: named float channels, interleaved, the top row first.
#pragma once
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "color/rgb.h"

namespace montelux {

// Plain data. values[(y * width + x) * channel_count + c]; row 0 is the top of the image. Channels are named as in
// OpenEXR: "R", "G", "B", "A" or "Y" for the image itself, "layer.R" and so on for further layers.
struct PixelBuffer {
  int width = 0;
  int height = 0;
  std::vector<std::string> channels;
  std::vector<float> values;

  int channel_count() const { return int(channels.size()); }
  std::size_t pixel_count() const { return std::size_t(width) * std::size_t(height); }
  std::size_t index(int x, int y, int c) const {
    return (std::size_t(y) * std::size_t(width) + std::size_t(x)) * channels.size() + std::size_t(c);
  }
  float& at(int x, int y, int c) { return values[index(x, y, c)]; }
  float at(int x, int y, int c) const { return values[index(x, y, c)]; }
};

// A buffer of zeros.
PixelBuffer make_pixel_buffer(int width, int height, std::vector<std::string> channels);

// The index of the channel with exactly that name.
std::optional<int> find_channel(const PixelBuffer& image, std::string_view name);

// The indices of red, green and blue: the channels R, G, B if all exist, the first three of a buffer with three or
// more, and otherwise three times the first.
std::array<int, 3> rgb_channels(const PixelBuffer& image);
Rgb rgb_at(const PixelBuffer& image, const std::array<int, 3>& channels, int x, int y);

// The channels "name.X" as a buffer whose channels are called "X"; the empty name selects the channels without a dot.
// Nothing if there are none.
std::optional<PixelBuffer> layer(const PixelBuffer& image, std::string_view name);
// Rows of it, counted from the top.
PixelBuffer rows_of(const PixelBuffer& image, int first, int count);
// Appends the channels of a buffer of the same size as "name.X" (as "X" for the empty name).
void append_layer(PixelBuffer& image, std::string_view name, const PixelBuffer& added);

}  // namespace montelux
