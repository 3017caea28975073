#include "io/text_file.h"

#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>

namespace montelux {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t max_bytes = std::size_t{8} << 30;

// The maximum size of a decompressed file: scenes compress to about a fifth, regular text to a hundredth; a higher
// ratio indicates a file made to fill the memory.
std::size_t max_unpacked(std::size_t packed) {
  constexpr std::size_t any = std::size_t{64} << 20, ratio = 256;
  return std::min(std::max(any, packed * ratio), max_bytes);
}

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
struct EndInflate {
  void operator()(z_stream* stream) const { inflateEnd(stream); }
};

// All members of a gzip file, concatenated.
Result<std::string> unpack(const std::string& packed, const std::string& path) {
  z_stream stream{};
  constexpr int gzip_window = 15 + 16;
  if (inflateInit2(&stream, gzip_window) != Z_OK) return Failure{"cannot start to decompress '" + path + "'"};
  std::unique_ptr<z_stream, EndInflate> guard(&stream);
  const std::size_t limit = max_unpacked(packed.size());
  std::string text;
  std::string chunk(std::size_t{1} << 20, '\0');
  std::size_t consumed = 0;
  int status = Z_OK;
  while (true) {
    // zlib counts in 32 bits: feed it in pieces.
    std::size_t piece = std::min(packed.size() - consumed, std::size_t{1} << 30);
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data() + consumed));
    stream.avail_in = static_cast<uInt>(piece);
    stream.next_out = reinterpret_cast<Bytef*>(chunk.data());
    stream.avail_out = static_cast<uInt>(chunk.size());
    status = inflate(&stream, Z_NO_FLUSH);
    consumed += piece - stream.avail_in;
    std::size_t produced = chunk.size() - stream.avail_out;
    text.append(chunk.data(), produced);
    if (text.size() > limit)
      return Failure{"'" + path + "' decompresses to more than " + std::to_string(limit >> 20) +
                     " MiB, which is implausible for its " + std::to_string(packed.size()) + " bytes"};
    if (status == Z_STREAM_END) {
      bool another = packed.size() - consumed > 2 && packed.compare(consumed, 2, "\x1f\x8b") == 0;
      if (!another) return text;
      inflateReset(&stream);
      continue;
    }
    if (status != Z_OK || (produced == 0 && consumed == packed.size()))
      return Failure{"'" + path + "' is not a complete gzip file"};
  }
}

// The number of bytes of the first character of the text, which is not empty; 0 if it is not UTF-8 (Unicode 15,
// table 3-7).
std::size_t utf8_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0u; };
  const unsigned first = byte(0);
  if (first < 0x80) return 1;
  const std::size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  if (first < 0xc2 || first > 0xf4) return 0;
  // No overlong forms, no surrogates, nothing above U+10FFFF.
  const unsigned low = first == 0xe0 ? 0xa0 : first == 0xf0 ? 0x90 : 0x80;
  const unsigned high = first == 0xed ? 0x9f : first == 0xf4 ? 0x8f : 0xbf;
  if (byte(1) < low || byte(1) > high) return 0;
  for (std::size_t i = 2; i < length; ++i)
    if (byte(i) < 0x80 || byte(i) > 0xbf) return 0;
  return length;
}

// The text begins with a control character: below U+0020, or U+007F to U+009F.
bool begins_with_control(std::string_view text) {
  const auto first = static_cast<unsigned char>(text.front());
  if (first == 0xc2 && text.size() > 1) return static_cast<unsigned char>(text[1]) < 0xa0;
  return first < 32 || first == 127;
}

}  // namespace

bool is_regular_file(const std::string& path) {
  std::error_code problem;
  return fs::is_regular_file(path, problem);
}

std::string resolve_path(const std::string& folder, const std::string& name) {
  fs::path path(name);
  if (path.is_absolute() || folder.empty()) return name;
  return (fs::path(folder) / path).lexically_normal().string();
}

namespace {

Result<std::string> read_regular_file(const std::string& path) {
  std::unique_ptr<std::FILE, CloseFile> file(std::fopen(path.c_str(), "rb"));
  if (!file) return Failure{"cannot open '" + printable(path) + "': " + std::strerror(errno)};
  std::error_code problem;
  const std::uintmax_t size = fs::file_size(path, problem);
  if (!problem && size > max_bytes)
    return Failure{"'" + printable(path) + "' has " + std::to_string(size >> 30) + " GiB; at most " +
                   std::to_string(max_bytes >> 30) + " are read"};
  std::string bytes(problem ? 0 : static_cast<std::size_t>(size), '\0');
  const std::size_t read = std::fread(bytes.data(), 1, bytes.size(), file.get());
  if (read != bytes.size()) return Failure{"cannot read all of '" + printable(path) + "'"};
  if (bytes.size() > 2 && bytes.compare(0, 2, "\x1f\x8b") == 0) return unpack(bytes, printable(path));
  return bytes;
}

}  // namespace

Result<std::string> read_whole_file(const std::string& path) {
  std::error_code problem;
  fs::file_status status = fs::status(path, problem);
  if (!fs::exists(status)) return Failure{"there is no file '" + printable(path) + "'"};
  if (!fs::is_regular_file(status)) return Failure{"'" + printable(path) + "' is not a regular file"};
  try {
    return read_regular_file(path);
  } catch (const std::bad_alloc&) {
    return Failure{"'" + printable(path) + "' does not fit in memory"};
  }
}

bool is_utf8(std::string_view text) {
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    if (length == 0) return false;
    text.remove_prefix(length);
  }
  return true;
}

std::string as_utf8(std::string_view text) {
  constexpr std::string_view digits = "0123456789abcdef";
  std::string valid;
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    const auto first = static_cast<unsigned char>(text.front());
    valid += length > 0 ? std::string(text.substr(0, length))
                        : std::string{'\\', 'x', digits[first >> 4], digits[first & 15]};
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return valid;
}

std::string_view without_byte_order_mark(std::string_view text) {
  constexpr std::string_view mark = "\xef\xbb\xbf";
  if (text.starts_with(mark)) text.remove_prefix(mark.size());
  return text;
}

std::string without_escapes(std::string_view text) {
  std::string plain;
  for (std::size_t i = 0; i < text.size(); ++i) {
    unsigned char byte = 0;
    if (text[i] == '%' && i + 2 < text.size() &&
        std::from_chars(&text[i + 1], &text[i + 1] + 2, byte, 16).ptr == &text[i + 1] + 2) {
      plain += char(byte);
      i += 2;
    } else {
      plain += text[i];
    }
  }
  return plain;
}

std::string printable(std::string_view text) {
  constexpr std::size_t max_length = 120;
  std::string clean = without_control(text.substr(0, max_length), '?');
  if (text.size() > max_length) clean += "...";
  return clean;
}

std::string without_control(std::string_view text, char instead) {
  std::string clean;
  while (!text.empty()) {
    const std::size_t length = begins_with_control(text) ? 0 : utf8_length(text);
    clean += length == 0 ? std::string(1, instead) : std::string(text.substr(0, length));
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return clean;
}

}  // namespace montelux
