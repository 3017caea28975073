#include "io/text_file.h"

#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>

namespace montelux {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t most_unpacked = std::size_t{8} << 30;

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
struct EndInflate {
  void operator()(z_stream* stream) const { inflateEnd(stream); }
};

// All members of a gzip file, one behind the other.
Result<std::string> unpack(const std::string& packed, const std::string& path) {
  z_stream stream{};
  constexpr int gzip_window = 15 + 16;
  if (inflateInit2(&stream, gzip_window) != Z_OK) return Failure{"cannot start to unpack '" + path + "'"};
  std::unique_ptr<z_stream, EndInflate> guard(&stream);
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
    if (text.size() > most_unpacked) return Failure{"'" + path + "' unpacks to more than 8 GiB"};
    if (status == Z_STREAM_END) {
      bool another = packed.size() - consumed > 2 && packed.compare(consumed, 2, "\x1f\x8b") == 0;
      if (!another) return text;
      inflateReset(&stream);
      continue;
    }
    if (status != Z_OK || (produced == 0 && consumed == packed.size()))
      return Failure{"'" + path + "' is no complete gzip file"};
  }
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

Result<std::string> read_whole_file(const std::string& path) {
  std::error_code problem;
  fs::file_status status = fs::status(path, problem);
  if (!fs::exists(status)) return Failure{"there is no file '" + printable(path) + "'"};
  if (!fs::is_regular_file(status)) return Failure{"'" + printable(path) + "' is not a regular file"};
  std::unique_ptr<std::FILE, CloseFile> file(std::fopen(path.c_str(), "rb"));
  if (!file) return Failure{"cannot open '" + printable(path) + "': " + std::strerror(errno)};
  std::uintmax_t size = fs::file_size(path, problem);
  std::string bytes(problem ? 0 : static_cast<std::size_t>(size), '\0');
  std::size_t read = std::fread(bytes.data(), 1, bytes.size(), file.get());
  if (read != bytes.size()) return Failure{"cannot read all of '" + printable(path) + "'"};
  if (bytes.size() > 2 && bytes.compare(0, 2, "\x1f\x8b") == 0) return unpack(bytes, printable(path));
  return bytes;
}

std::string printable(std::string_view text) {
  constexpr std::size_t most = 120;
  std::string clean(text.substr(0, most));
  for (char& c : clean)
    if (static_cast<unsigned char>(c) < 32 || c == 127) c = '?';
  if (text.size() > most) clean += "...";
  return clean;
}

}  // namespace montelux
