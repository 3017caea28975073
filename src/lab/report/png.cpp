#include <zlib.h>

#include <stdexcept>

#include "lab/report/write.h"

namespace montelux::lab {

namespace {

void append_word(std::string& bytes, std::uint32_t word) {
  for (int shift = 24; shift >= 0; shift -= 8) bytes += char(word >> shift & 0xffu);
}

void append_chunk(std::string& png, const std::string& type, const std::string& data) {
  append_word(png, std::uint32_t(data.size()));
  const std::string content = type + data;
  png += content;
  append_word(png, std::uint32_t(crc32(0, reinterpret_cast<const Bytef*>(content.data()), uInt(content.size()))));
}

}  // namespace

std::string to_png(const Picture& picture) {
  const auto width = std::size_t(picture.width), height = std::size_t(picture.height);
  if (picture.rgb.size() != 3 * width * height)
    throw std::invalid_argument("the number of pixels does not match the size of an image");
  // Each row behind the number of its filter: differences to the row above ("Up"), which suit smooth pictures.
  std::string rows;
  for (std::size_t y = 0; y < height; ++y) {
    rows += '\2';
    for (std::size_t i = y * 3 * width; i < (y + 1) * 3 * width; ++i)
      rows += char(picture.rgb[i] - (y > 0 ? picture.rgb[i - 3 * width] : 0));
  }
  std::string packed(compressBound(uLong(rows.size())), '\0');
  uLongf size = uLongf(packed.size());
  if (compress2(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(rows.data()),
                uLong(rows.size()), 9) != Z_OK)
    throw std::runtime_error("an image cannot be compressed");
  packed.resize(size);

  std::string header, png = "\x89PNG\r\n\x1a\n";
  append_word(header, std::uint32_t(width)), append_word(header, std::uint32_t(height));
  header += std::string("\x08\x02\x00\x00\x00", 5);  // 8 bits, red green blue
  append_chunk(png, "IHDR", header);
  append_chunk(png, "IDAT", packed);
  append_chunk(png, "IEND", "");
  return png;
}

}  // namespace montelux::lab
