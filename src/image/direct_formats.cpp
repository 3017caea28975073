#include "image/direct_formats.h"

#include <jpeglib.h>
#include <png.h>

#include <bit>
#include <csetjmp>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace montelux {

namespace {

// What a decoder writes. It stands outside the functions that are left by longjmp.
struct Decoded {
  int width = 0, height = 0, channels = 0, bytes = 1;  // bytes: of a sample
  std::vector<std::uint8_t> samples;                   // of two bytes in the order of this machine
  std::vector<std::uint8_t*> rows;

  std::size_t row_size() const { return std::size_t(width) * std::size_t(channels) * std::size_t(bytes); }
  // Whether a file of this size may hold so many samples.
  bool is_plausible(std::size_t file_size) const {
    if (width <= 0 || height <= 0 || channels <= 0) return false;
    const double count = double(width) * height * channels;
    return count <= double(largest_sample_count) && count * bytes <= 4 * deflate_packing * double(file_size);
  }
  void make_room() {
    samples.resize(row_size() * std::size_t(height)), rows.resize(std::size_t(height));
    for (std::size_t y = 0; y < rows.size(); ++y) rows[y] = samples.data() + y * row_size();
  }
};

// ---- PNG ------------------------------------------------------------------------------------------------------------

struct Bytes {
  std::string_view left;
};

void read_png_bytes(png_structp png, png_bytep to, std::size_t count) {
  auto& bytes = *static_cast<Bytes*>(png_get_io_ptr(png));
  if (bytes.left.size() < count) png_error(png, "truncated");
  std::memcpy(to, bytes.left.data(), count);
  bytes.left.remove_prefix(count);
}

void fail_png(png_structp png, png_const_charp) { png_longjmp(png, 1); }
void ignore_png_warning(png_structp, png_const_charp) {}

// Everything between the making and the destruction of the decoder. False: it cannot, or another decoder should.
bool decode_png(png_structp png, png_infop info, Bytes& bytes, Decoded& image) {
  const std::size_t file_size = bytes.left.size();
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_read_fn(png, &bytes, read_png_bytes);
  png_read_info(png, info);
  const int depth = png_get_bit_depth(png, info), color = png_get_color_type(png, info);
  if (depth < 8 || (color & PNG_COLOR_MASK_PALETTE) != 0 || png_get_valid(png, info, PNG_INFO_tRNS) != 0) return false;
  image.width = int(png_get_image_width(png, info)), image.height = int(png_get_image_height(png, info));
  image.channels = png_get_channels(png, info), image.bytes = depth / 8;
  if (!image.is_plausible(file_size)) return false;
  if (depth == 16 && std::endian::native == std::endian::little) png_set_swap(png);
  png_set_interlace_handling(png);
  png_read_update_info(png, info);
  image.make_room();
  png_read_image(png, image.rows.data());
  png_read_end(png, nullptr);
  return true;
}

struct PngDecoder {
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, nullptr, fail_png, ignore_png_warning);
  png_infop info = png ? png_create_info_struct(png) : nullptr;

  PngDecoder() = default;
  PngDecoder(const PngDecoder&) = delete;
  ~PngDecoder() { png_destroy_read_struct(&png, &info, nullptr); }
};

bool read_png(std::string_view file, Decoded& image) {
  Bytes bytes{file};
  const PngDecoder decoder;
  return decoder.info && decode_png(decoder.png, decoder.info, bytes, image);
}

// ---- JPEG -----------------------------------------------------------------------------------------------------------

struct JpegErrors {
  jpeg_error_mgr base;
  std::jmp_buf back;
};

[[noreturn]] void fail_jpeg(j_common_ptr jpeg) { std::longjmp(reinterpret_cast<JpegErrors*>(jpeg->err)->back, 1); }
// Warnings are of damaged files.
void heed_jpeg_message(j_common_ptr jpeg, int level) {
  if (level < 0) fail_jpeg(jpeg);
}

bool decode_jpeg(jpeg_decompress_struct& jpeg, JpegErrors& errors, std::string_view file, Decoded& image) {
  if (setjmp(errors.back) != 0) return false;
  jpeg_create_decompress(&jpeg);
  jpeg_mem_src(&jpeg, reinterpret_cast<const unsigned char*>(file.data()), file.size());
  jpeg_read_header(&jpeg, TRUE);
  const bool is_gray = jpeg.jpeg_color_space == JCS_GRAYSCALE;
  if (!is_gray && jpeg.jpeg_color_space != JCS_YCbCr && jpeg.jpeg_color_space != JCS_RGB) return false;
  jpeg.out_color_space = is_gray ? JCS_GRAYSCALE : JCS_RGB;
  image.width = int(jpeg.image_width), image.height = int(jpeg.image_height), image.channels = is_gray ? 1 : 3;
  if (!image.is_plausible(file.size())) return false;
  jpeg_start_decompress(&jpeg);
  image.make_room();
  while (jpeg.output_scanline < jpeg.output_height)
    jpeg_read_scanlines(&jpeg, image.rows.data() + jpeg.output_scanline, jpeg.output_height - jpeg.output_scanline);
  jpeg_finish_decompress(&jpeg);
  return true;
}

struct JpegDecoder {
  jpeg_decompress_struct jpeg{};
  JpegErrors errors{};

  JpegDecoder() {
    jpeg.err = jpeg_std_error(&errors.base);
    errors.base.error_exit = fail_jpeg, errors.base.emit_message = heed_jpeg_message;
  }
  JpegDecoder(const JpegDecoder&) = delete;
  ~JpegDecoder() { jpeg_destroy_decompress(&jpeg); }
};

bool read_jpeg(std::string_view file, Decoded& image) {
  JpegDecoder decoder;
  return decode_jpeg(decoder.jpeg, decoder.errors, file, image);
}

// ---- writing --------------------------------------------------------------------------------------------------------

void append_png_bytes(png_structp png, png_bytep from, std::size_t count) {
  bool good = true;
  try {
    static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<const char*>(from), count);
  } catch (const std::exception&) {
    good = false;
  }
  if (!good) png_error(png, "out of memory");
}
void flush_png(png_structp) {}

struct PngEncoder {
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, fail_png, ignore_png_warning);
  png_infop info = png ? png_create_info_struct(png) : nullptr;

  PngEncoder() = default;
  PngEncoder(const PngEncoder&) = delete;
  ~PngEncoder() { png_destroy_write_struct(&png, &info); }
};

bool write_png(const PngEncoder& encoder, const DisplayImage& image, std::string& bytes) {
  png_structp png = encoder.png;
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_write_fn(png, &bytes, append_png_bytes, flush_png);
  png_set_IHDR(png, encoder.info, png_uint_32(image.width), png_uint_32(image.height), 8,
               image.channel_count == 1 ? PNG_COLOR_TYPE_GRAY : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB_gAMA_and_cHRM(png, encoder.info, PNG_sRGB_INTENT_ABSOLUTE);
  png_write_info(png, encoder.info);
  const std::size_t row = std::size_t(image.width) * std::size_t(image.channel_count);
  for (int y = 0; y < image.height; ++y) png_write_row(png, image.values.data() + std::size_t(y) * row);
  png_write_end(png, nullptr);
  return true;
}

struct JpegEncoder {
  jpeg_compress_struct jpeg{};
  JpegErrors errors{};
  unsigned char* bytes = nullptr;
  unsigned long size = 0;

  JpegEncoder() {
    jpeg.err = jpeg_std_error(&errors.base);
    errors.base.error_exit = fail_jpeg, errors.base.emit_message = heed_jpeg_message;
  }
  JpegEncoder(const JpegEncoder&) = delete;
  ~JpegEncoder() {
    jpeg_destroy_compress(&jpeg);
    std::free(bytes);
  }
};

bool write_jpeg(JpegEncoder& encoder, const DisplayImage& image) {
  jpeg_compress_struct& jpeg = encoder.jpeg;
  if (setjmp(encoder.errors.back) != 0) return false;
  jpeg_create_compress(&jpeg);
  jpeg_mem_dest(&jpeg, &encoder.bytes, &encoder.size);
  jpeg.image_width = JDIMENSION(image.width), jpeg.image_height = JDIMENSION(image.height);
  jpeg.input_components = image.channel_count;
  jpeg.in_color_space = image.channel_count == 1 ? JCS_GRAYSCALE : JCS_RGB;
  jpeg_set_defaults(&jpeg);
  jpeg_set_quality(&jpeg, 95, TRUE);
  jpeg_start_compress(&jpeg, TRUE);
  const std::size_t row = std::size_t(image.width) * std::size_t(image.channel_count);
  while (jpeg.next_scanline < jpeg.image_height) {
    // The library does not change what it writes.
    JSAMPROW samples = const_cast<JSAMPROW>(image.values.data() + jpeg.next_scanline * row);
    jpeg_write_scanlines(&jpeg, &samples, 1);
  }
  jpeg_finish_compress(&jpeg);
  return true;
}

// ---- both -----------------------------------------------------------------------------------------------------------

StoredImage stored_image(const Decoded& decoded) {
  constexpr const char* names[4][4] = {{"Y"}, {"Y", "A"}, {"R", "G", "B"}, {"R", "G", "B", "A"}};
  StoredImage image;
  image.part_names.emplace_back();
  image.stored = decoded.bytes == 1 ? SampleType::uint8 : SampleType::uint16;
  if (decoded.channels % 2 == 0) image.alpha_channel = decoded.channels - 1;
  PixelBuffer pixels{decoded.width, decoded.height, {}, {}};
  for (int c = 0; c < decoded.channels; ++c) pixels.channels.emplace_back(names[decoded.channels - 1][c]);
  const std::size_t count = decoded.samples.size() / std::size_t(decoded.bytes);
  pixels.values.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    std::uint16_t wide = 0;
    if (decoded.bytes == 2) std::memcpy(&wide, &decoded.samples[2 * i], sizeof wide);
    pixels.values[i] = decoded.bytes == 1 ? float(decoded.samples[i]) * (1.0f / 255) : float(wide) * (1.0f / 65535);
  }
  image.parts.push_back(std::move(pixels));
  return image;
}

}  // namespace

std::optional<StoredImage> read_directly(std::string_view bytes) {
  using namespace std::string_view_literals;
  Decoded decoded;
  const bool good = bytes.starts_with("\x89PNG\r\n\x1a\n"sv) ? read_png(bytes, decoded)
                    : bytes.starts_with("\xff\xd8\xff"sv)    ? read_jpeg(bytes, decoded)
                                                             : false;
  if (!good) return std::nullopt;
  return stored_image(decoded);
}

Result<std::string> encode_png(const DisplayImage& image) {
  std::string bytes;
  const PngEncoder encoder;
  if (!encoder.info || !write_png(encoder, image, bytes)) return Failure{"libpng fails"};
  return bytes;
}

Result<std::string> encode_jpeg(const DisplayImage& image) {
  JpegEncoder encoder;
  if (!write_jpeg(encoder, image)) return Failure{"libjpeg fails"};
  return std::string(reinterpret_cast<const char*>(encoder.bytes), encoder.size);
}

}  // namespace montelux
