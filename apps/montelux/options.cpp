#include "options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "api/images.h"

namespace montelux::cli {

namespace {

// The whole text as a number; nothing where anything else is in it.
template <class T>
std::optional<T> number_in(std::string_view text) {
  T value{};
  auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || text.empty()) return std::nullopt;
  return value;
}

}  // namespace

Result<int> parse_whole(const std::string& text, int low, int high) {
  auto value = number_in<int>(text);
  if (value && *value >= low && *value <= high) return *value;
  return Failure{fmt::format("takes a whole number from {} to {}; found \"{}\"", low, high, text)};
}

Result<double> parse_number(const std::string& text, double low, double high) {
  auto value = number_in<double>(text);
  if (value && *value >= low && *value <= high) return *value;
  return Failure{fmt::format("takes a number from {} to {}; found \"{}\"", low, high, text)};
}

Result<double> parse_time(const std::string& text) {
  const std::size_t end = text.find_last_of("0123456789.") + 1;  // 0 where there is none
  const std::string unit = text.substr(end);
  static constexpr std::array<std::pair<std::string_view, double>, 5> units{
      {{"", 1}, {"ms", 1e-3}, {"s", 1}, {"m", 60}, {"h", 3600}}};
  auto value = number_in<double>(std::string_view(text).substr(0, end));
  for (auto [name, seconds] : units)
    if (value && std::isfinite(*value) && *value > 0 && unit == name) return *value * seconds;
  return Failure{fmt::format("takes a time above zero such as 500ms, 30s, 10m or 2h; found \"{}\"", text)};
}

Result<std::pair<int, int>> parse_resolution(const std::string& text) {
  const std::size_t x = text.find('x');
  if (x != std::string::npos) {
    auto width = number_in<int>(std::string_view(text).substr(0, x));
    auto height = number_in<int>(std::string_view(text).substr(x + 1));
    if (width && height) {
      if (Status possible = check_resolution(*width, *height); !possible) return possible.failure();
      return std::pair{*width, *height};
    }
  }
  return Failure{fmt::format("takes WIDTHxHEIGHT in pixels, as 1280x720; found \"{}\"", text)};
}

Result<PixelBounds> parse_crop(const std::string& text) {
  std::array<int, 4> edges{};
  std::string_view rest = text;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const std::size_t comma = i < 3 ? rest.find(',') : rest.size();
    auto edge = comma == std::string_view::npos ? std::nullopt : number_in<int>(rest.substr(0, comma));
    if (!edge || *edge < 0)
      return Failure{fmt::format("takes x0,y0,x1,y1 in pixels (x1 and y1 are just outside); found \"{}\"", text)};
    edges[i] = *edge;
    rest.remove_prefix(std::min(comma + 1, rest.size()));
  }
  PixelBounds crop{edges[0], edges[1], edges[2], edges[3]};
  if (crop.x0 >= crop.x1 || crop.y0 >= crop.y1)
    return Failure{fmt::format("takes x0,y0,x1,y1 with x0 < x1 and y0 < y1; found \"{}\"", text)};
  return crop;
}

Result<std::string> parse_choice(const std::string& text, const std::vector<std::string>& names) {
  if (std::find(names.begin(), names.end(), text) != names.end()) return text;
  std::string message = fmt::format("takes one of {}; found \"{}\"", fmt::join(names, ", "), text);
  if (std::string_view near = nearest_name(text, {names.begin(), names.end()}); !near.empty())
    message += fmt::format(" (did you mean \"{}\"?)", near);
  return Failure{message};
}

Result<ShutterTimes> parse_shutter(const std::string& text) {
  const std::size_t colon = text.find(':');
  if (colon != std::string::npos) {
    const auto open = number_in<double>(std::string_view(text).substr(0, colon));
    const auto close = number_in<double>(std::string_view(text).substr(colon + 1));
    if (open && close && std::abs(*open) < 1e9 && std::abs(*close) < 1e9 && *open <= *close)
      return ShutterTimes{*open, *close};
  }
  return Failure{
      fmt::format("takes OPEN:CLOSE, two times of which the second is not before the first; found \"{}\"", text)};
}

Result<std::pair<std::string, std::string>> parse_setting(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == 0 || equals == std::string::npos) return Failure{fmt::format("takes key=value; found \"{}\"", text)};
  return std::pair{text.substr(0, equals), text.substr(equals + 1)};
}

std::vector<std::string> names_of(const std::vector<std::pair<std::string, std::string>>& described) {
  std::vector<std::string> names;
  for (const auto& [name, description] : described) names.push_back(name);
  return names;
}

std::string alternatives(const std::vector<std::string>& names) { return fmt::format("{}", fmt::join(names, "|")); }

void add_option(CLI::App& verb, const OptionText& text, Setter set) {
  // The name that messages show is the long one.
  const std::string shown = text.names.substr(text.names.rfind(',') + 1);
  CLI::Option* option = verb.add_option(
      text.names,
      [set = std::move(set), shown](const CLI::results_t& values) {
        for (const std::string& value : values)
          if (Status status = set(value); !status) throw CLI::ValidationError(shown, status.error());
        return true;
      },
      text.help);
  option->type_name(text.type)->type_size(1)->allow_extra_args(false);
  if (text.repeatable)
    option->expected(1, CLI::detail::expected_max_vector_size);
  else
    option->expected(1);
}

void add_scene_options(CLI::App& verb, std::string& file, LoadOptions& options) {
  verb.add_option("SCENE", file, "scene file (.pbrt, .pbrt.gz, .gltf, .glb)")->required()->type_name("FILE");
  add_option(verb, {"--resolution", "WxH", "size of the picture in pixels, instead of the file's"},
             into(options.resolution, parse_resolution));
  add_option(verb, {"--camera", "NAME|N", "camera of a glTF scene, by its name or number; default: the first"},
             [&options](const std::string& text) -> Status {
               options.camera = text;
               return Done{};
             });
  add_option(verb, {"--animation", "NAME|N", "animation of a glTF scene, by its name or number; default: the first"},
             [&options](const std::string& text) -> Status {
               options.animation = text;
               return Done{};
             });
  add_option(verb,
             {"--shutter", "OPEN:CLOSE",
              "when the shutter is open, in the scene's unit of time (glTF: seconds), instead of as the file says; "
              "with --frames in frame 0, and where they part the scene's whole time, before it is parted; the "
              "brightness stays"},
             into(options.shutter, parse_shutter));
  verb.add_flag("--verbose", options.verbose, "list each warning and note of the scene, not one for all of a kind");
  verb.add_flag("--lenient", options.lenient, "warn of what is unknown or not yet possible in the scene, and go on");
}

void add_display_options(CLI::App& verb, DisplayTransform& display) {
  add_option(verb, {"--exposure", "STOPS", "for 8-bit pictures: multiply by 2^STOPS (default 0)"},
             into(display.exposure, [](const std::string& text) -> Result<float> {
               auto stops = parse_number(text, -100, 100);
               if (!stops) return stops.failure();
               return float(*stops);
             }));
  add_option(verb, {"--tone", alternatives(names_of(tone_curves())), "for 8-bit pictures: tone curve (default clip)"},
             into(display.curve, [](const std::string& text) -> Result<ToneCurve> {
               auto name = parse_choice(text, names_of(tone_curves()));
               if (!name) return name.failure();
               return *tone_curve_named(*name);
             }));
}

}  // namespace montelux::cli
