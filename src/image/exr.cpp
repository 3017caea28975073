#include "image/exr.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfCompression.h>
#include <OpenEXR/ImfDoubleAttribute.h>
#include <OpenEXR/ImfFloatAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfIntAttribute.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfThreading.h>
#include <OpenEXR/ImfTileDescriptionAttribute.h>
#include <OpenEXR/ImfVersion.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>
#include <tuple>
#include <utility>

namespace montelux {

namespace {

bool begins_like_exr(const std::string& name, const std::string* bytes) {
  if (bytes) return bytes->starts_with(exr_magic);
  std::array<char, exr_magic.size()> first{};
  std::ifstream file(name, std::ios::binary);
  return file.read(first.data(), first.size()) && std::string_view(first.data(), first.size()) == exr_magic;
}

// Whether the entries of all headers fit into a file of this size.
bool has_whole_headers(std::istream& in, std::uint64_t size) {
  std::array<char, 8> begin{};  // magic number and version
  if (!in.read(begin.data(), begin.size())) return true;
  const bool has_parts = (static_cast<unsigned char>(begin[5]) & 0x10u) != 0;
  std::string name, type;
  for (bool was_empty = true; std::getline(in, name, '\0');) {
    if (name.empty()) {
      if (!has_parts || std::exchange(was_empty, true)) return true;
      continue;
    }
    was_empty = false;
    std::array<char, 4> stated{};
    if (!std::getline(in, type, '\0') || !in.read(stated.data(), stated.size())) return true;
    std::int32_t length = 0;
    std::memcpy(&length, stated.data(), stated.size());
    const auto at = std::uint64_t(in.tellg());
    if (length < 0 || at > size || std::uint64_t(length) > size - at) return false;
    in.seekg(length, std::ios::cur);
  }
  return true;
}

// A file in memory.
class MemoryInput final : public Imf::IStream {
 public:
  explicit MemoryInput(const std::string& bytes) : Imf::IStream("memory"), bytes_(bytes) {}
  bool read(char to[], int count) override {
    if (count < 0 || std::size_t(count) > bytes_.size() - place_) throw std::runtime_error("truncated");
    std::memcpy(to, bytes_.data() + place_, std::size_t(count));
    place_ += std::size_t(count);
    return place_ < bytes_.size();
  }
  std::uint64_t tellg() override { return place_; }
  void seekg(std::uint64_t place) override {
    if (place > bytes_.size()) throw std::runtime_error("truncated");
    place_ = place;
  }

 private:
  const std::string& bytes_;
  std::size_t place_ = 0;
};

// A channel by its layer and its place there.
struct ChannelName {
  std::string name, layer, last;  // last: of the name, in lower case
  std::size_t rank = 0;

  explicit ChannelName(std::string_view whole) : name(whole) {
    const std::size_t dot = whole.rfind('.');
    if (dot != std::string_view::npos) layer = whole.substr(0, dot), whole.remove_prefix(dot + 1);
    for (const char c : whole) last += char(std::tolower(static_cast<unsigned char>(c)));
    constexpr std::array<std::string_view, 8> usual{"r", "red", "g", "green", "b", "blue", "a", "alpha"};
    rank = std::size_t(std::find(usual.begin(), usual.end(), last) - usual.begin());
  }
  bool is_alpha() const { return last == "a" || last == "alpha"; }
  bool is_chroma() const { return last == "by" || last == "ry"; }
  friend bool operator<(const ChannelName& a, const ChannelName& b) {
    return std::tie(a.layer, a.rank, a.name) < std::tie(b.layer, b.rank, b.name);
  }
};

// Of the image, or of a tile that is larger.
bool is_plausible(const Imf::Header& header, std::uint64_t pixels, std::uint64_t pixel_bytes, std::uint64_t file_size) {
  const Imf::Compression compression = header.compression();
  const bool unbounded = compression == Imf::DWAA_COMPRESSION || compression == Imf::DWAB_COMPRESSION;
  if (header.hasTileDescription()) {
    const Imf::TileDescription& tile = header.tileDescription();
    pixels = std::max(pixels, std::uint64_t(tile.xSize) * tile.ySize);
  }
  return may_contain(double(file_size), unbounded ? unknown_packing : deflate_packing,
                     double(pixels) * double(pixel_bytes));
}

std::vector<Attribute> entries_of(const Imf::Header& header) {
  std::vector<Attribute> entries;
  for (auto entry = header.begin(); entry != header.end(); ++entry) {
    const Imf::Attribute& value = entry.attribute();
    if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&value))
      entries.push_back({entry.name(), text->value()});
    else if (const auto* whole = dynamic_cast<const Imf::IntAttribute*>(&value))
      entries.push_back({entry.name(), std::int32_t(whole->value())});
    else if (const auto* single = dynamic_cast<const Imf::FloatAttribute*>(&value))
      entries.push_back({entry.name(), single->value()});
    else if (const auto* precise = dynamic_cast<const Imf::DoubleAttribute*>(&value))
      entries.push_back({entry.name(), precise->value()});
  }
  return entries;
}

// The channels in order; none if the module should read the file.
std::vector<ChannelName> channels_of(const Imf::Header& header) {
  std::vector<ChannelName> channels;
  for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel) {
    const Imf::Channel& stored = channel.channel();
    const ChannelName& added = channels.emplace_back(channel.name());
    if (stored.type == Imf::UINT || stored.xSampling != 1 || stored.ySampling != 1 || added.is_chroma()) return {};
  }
  std::sort(channels.begin(), channels.end());
  return channels;
}

std::optional<StoredImage> read(Imf::InputFile& file, std::uint64_t file_size) {
  const Imf::Header& header = file.header();
  if (Imf::isMultiPart(file.version()) || Imf::isNonImage(file.version()) || !file.isComplete()) return std::nullopt;
  const std::vector<ChannelName> channels = channels_of(header);
  const Imath::Box2i& window = header.dataWindow();
  const std::int64_t width = std::int64_t(window.max.x) - window.min.x + 1,
                     height = std::int64_t(window.max.y) - window.min.y + 1;
  constexpr auto most = std::int64_t(largest_sample_count);
  if (channels.empty() || width <= 0 || height <= 0 || width > most / height ||
      width * height > most / std::int64_t(channels.size()))
    return std::nullopt;

  StoredImage image{{}, {std::string()}, SampleType::half, -1, entries_of(header)};
  PixelBuffer pixels{int(width), int(height), {}, {}};
  std::uint64_t pixel_bytes = 0;
  for (const ChannelName& channel : channels) {
    const bool is_half = header.channels()[channel.name.c_str()].type == Imf::HALF;
    pixel_bytes += is_half ? 2 : 4;
    if (!is_half) image.stored = SampleType::float32;
    if (image.alpha_channel < 0 && channel.is_alpha()) image.alpha_channel = pixels.channel_count();
    pixels.channels.push_back(channel.name);
  }
  if (!is_plausible(header, std::uint64_t(width * height), pixel_bytes, file_size)) return std::nullopt;

  pixels.values.resize(pixels.pixel_count() * channels.size());
  const std::size_t pixel = sizeof(float) * channels.size(), row = pixel * std::size_t(width);
  Imf::FrameBuffer frame;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    // The library counts pixels from the origin of the window's coordinates.
    char* first = reinterpret_cast<char*>(pixels.values.data() + c) - std::ptrdiff_t(pixel) * window.min.x -
                  std::ptrdiff_t(row) * window.min.y;
    frame.insert(channels[c].name, Imf::Slice(Imf::FLOAT, first, pixel, row));
  }
  file.setFrameBuffer(frame);
  file.readPixels(window.min.y, window.max.y);
  image.parts.push_back(std::move(pixels));
  return image;
}

// Threads for files that are worth them. The library has one pool for all files.
int reading_threads(std::uint64_t file_size) {
  constexpr std::uint64_t large = std::uint64_t(16) << 20;
  if (file_size < large) return 0;
  static const int threads = [] {
    const int all = exr_threads(0);
    if (Imf::globalThreadCount() < all) Imf::setGlobalThreadCount(all);
    return all;
  }();
  return threads;
}

}  // namespace

std::optional<StoredImage> read_exr(const std::string& name, const std::string* bytes) try {
  if (!begins_like_exr(name, bytes)) return std::nullopt;
  if (bytes) {
    MemoryInput stream(*bytes);
    Imf::InputFile file(stream, reading_threads(bytes->size()));
    return read(file, bytes->size());
  }
  const std::uint64_t size = std::filesystem::file_size(name);
  Imf::InputFile file(name.c_str(), reading_threads(size));
  return read(file, size);
} catch (const std::bad_alloc&) {
  throw;
} catch (const std::exception&) {
  return std::nullopt;  // damaged
}

Status check_exr(const std::string& name, const std::string* bytes) {
  if (!begins_like_exr(name, bytes)) return Done{};
  std::ifstream file;
  std::istringstream memory;
  if (bytes)
    memory.str(*bytes);
  else
    file.open(name, std::ios::binary);
  std::istream& in = bytes ? static_cast<std::istream&>(memory) : file;
  std::error_code unknown;
  const std::uint64_t size = bytes ? bytes->size() : std::filesystem::file_size(name, unknown);
  if (has_whole_headers(in, size)) return Done{};
  return Failure{"an entry of its header is larger than the file"};
}

int exr_threads(int stated) {
  constexpr int max_threads = 8;
  const int threads = stated > 0 ? stated : int(std::thread::hardware_concurrency());
  return std::clamp(threads, 1, max_threads);
}

}  // namespace montelux
