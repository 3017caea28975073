#include "api/frames.h"

#include <fmt/format.h>

#include <charconv>
#include <filesystem>
#include <vector>

#include "mc/random.h"

namespace montelux {

namespace {

constexpr int max_frames = 1000000;

// The value of a text that consists only of digits.
std::optional<int> whole(std::string_view text) {
  int value = 0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || text.front() == '-' || problem != std::errc{} || end != text.data() + text.size())
    return std::nullopt;
  return value;
}

// The placeholder for the frame number: the characters that it replaces, and its padding.
struct Place {
  std::size_t at = 0, length = 0;
  int width = 0;
  char padding = '0';
};

// The placeholder "%d", "%4d" or "%04d" at `at`, if there is one.
std::optional<Place> printf_place(const std::string& text, std::size_t at) {
  std::size_t end = at + 1;
  while (end < text.size() && text[end] >= '0' && text[end] <= '9') ++end;
  if (end == text.size() || text[end] != 'd' || end - at > 4) return std::nullopt;
  const std::string digits = text.substr(at + 1, end - at - 1);
  return Place{at, end + 1 - at, digits.empty() ? 0 : whole(digits).value_or(0), digits.starts_with('0') ? '0' : ' '};
}

std::vector<Place> places_of(const std::string& text) {
  std::vector<Place> places;
  for (std::size_t i = 0; i < text.size(); ++i) {
    std::optional<Place> found;
    if (text[i] == '%') found = printf_place(text, i);
    if (text[i] == '#') {
      const std::size_t end = std::min(text.find_first_not_of('#', i), text.size());
      found = Place{i, end - i, int(end - i), '0'};
    }
    if (!found) continue;
    places.push_back(*found);
    i += found->length - 1;
  }
  return places;
}

}  // namespace

Result<FrameRange> parse_frames(const std::string& text) {
  const std::size_t colon = text.find(':'), slash = text.find('/');
  const auto first = whole(text.substr(0, std::min(colon, slash)));
  const auto last = colon == std::string::npos
                        ? first
                        : whole(text.substr(colon + 1, slash == std::string::npos ? slash : slash - colon - 1));
  const auto of = slash == std::string::npos ? std::nullopt : whole(text.substr(slash + 1));
  if (!first || !last || (slash != std::string::npos && !of))
    return Failure{fmt::format(
        "frames are A:B, A for a single one, or A:B/N for a part of N, such as 0:23, 5 or 12:23/48; found '{}'", text)};
  if (*first > *last) return Failure{fmt::format("frames {} end before they begin", text)};
  if (*last >= max_frames || of.value_or(0) > max_frames)
    return Failure{fmt::format("frames must be below {}; found '{}'", max_frames, text)};
  if (of && *last >= *of)
    return Failure{fmt::format("there is no frame {} of {}: they are counted from 0 to {}", *last, *of, *of - 1)};
  return FrameRange{*first, *last, of, std::nullopt};
}

ShutterTimes frame_shutter(const SceneInfo& scene, const FrameRange& range, int frame) {
  const double open = scene.shutter_open, close = scene.shutter_close;
  const std::optional<double> fps = range.fps || range.of ? range.fps : scene.frame_rate;
  if (fps) return {open + frame / *fps, close + frame / *fps};
  const double start = scene.time_start, length = scene.time_end - start;
  const int slice = range.of ? frame : frame - range.first, n = range.of.value_or(range.count());
  return {start + (slice * length + open - start) / n, start + (slice * length + close - start) / n};
}

std::uint32_t frame_seed(std::uint32_t seed, int frame) {
  return mix_bits(seed ^ mix_bits(std::uint32_t(frame) + 0x5851f42du)) & 0x7fffffffu;
}

Result<std::string> frame_file(const std::string& pattern, int frame) {
  // The placeholder is in the file name; those of folders are ignored.
  const std::filesystem::path path(pattern);
  std::string name = path.filename().string();
  const std::vector<Place> places = places_of(name);
  if (places.size() > 1)
    return Failure{fmt::format("'{}' has more than one placeholder for the frame number", pattern)};
  std::string number = std::to_string(frame);
  if (places.empty()) {
    number = std::string(4 - std::min<std::size_t>(number.size(), 4), '0') + number;
    name = path.stem().string() + "." + number + path.extension().string();
  } else {
    const Place& place = places.front();
    if (number.size() < std::size_t(place.width))
      number = std::string(std::size_t(place.width) - number.size(), place.padding) + number;
    name.replace(place.at, place.length, number);
  }
  return (path.parent_path() / name).string();
}

}  // namespace montelux
