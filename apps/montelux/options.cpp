#include "options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "api/denoisers.h"
#include "api/images.h"

namespace montelux::cli {

namespace {

// The whole text as a number; nothing if it contains anything else.
template <class T>
std::optional<T> number_in(std::string_view text) {
  T value{};
  auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || text.empty()) return std::nullopt;
  return value;
}

}  // namespace

Result<std::uint64_t> parse_large_whole(const std::string& text, std::uint64_t low, std::uint64_t high) {
  std::string_view digits = text;
  double unit = 1;
  for (auto [name, size] : {std::pair{'k', 1e3}, {'M', 1e6}, {'G', 1e9}})
    if (digits.ends_with(name)) digits.remove_suffix(1), unit = size;
  // A double represents every integer up to 2^53.
  const auto value = number_in<double>(digits);
  const double whole = value.value_or(-1) * unit;
  if (whole >= double(low) && whole <= std::min(double(high), 0x1p53) && whole == std::floor(whole))
    return std::uint64_t(whole);
  return Failure{fmt::format("takes a whole number from {} to {}; found \"{}\"", low, high, text)};
}

Result<int> parse_whole(const std::string& text, int low, int high) {
  const auto value = parse_large_whole(text, std::uint64_t(low), std::uint64_t(high));
  if (!value) return value.failure();
  return int(*value);
}

Result<double> parse_number(const std::string& text, double low, double high) {
  auto value = number_in<double>(text);
  if (value && *value >= low && *value <= high) return *value;
  return Failure{fmt::format("takes a number from {} to {}; found \"{}\"", low, high, text)};
}

Result<double> parse_time(const std::string& text) {
  const std::size_t end = text.find_last_of("0123456789.") + 1;  // 0 if there is none
  const std::string unit = text.substr(end);
  static constexpr std::array<std::pair<std::string_view, double>, 5> units{
      {{"", 1}, {"ms", 1e-3}, {"s", 1}, {"m", 60}, {"h", 3600}}};
  auto value = number_in<double>(std::string_view(text).substr(0, end));
  for (auto [name, seconds] : units)
    if (value && std::isfinite(*value) && *value > 0 && unit == name) return *value * seconds;
  return Failure{fmt::format("takes a time above zero such as 500ms, 30s, 10m or 2h; found \"{}\"", text)};
}

Status parse_resolution(const std::string& text, LoadOptions& options) {
  options.resolution.reset(), options.resolution_scale.reset();
  if (text.ends_with('%')) {
    const auto percent = number_in<double>(std::string_view(text).substr(0, text.size() - 1));
    if (percent && *percent > 0 && *percent <= 1000) {
      options.resolution_scale = *percent / 100;
      return Done{};
    }
    return Failure{
        fmt::format("takes WIDTHxHEIGHT in pixels, or a percentage of the scene's size above 0% and up to "
                    "1000%; found \"{}\"",
                    text)};
  }
  const std::size_t x = text.find('x');
  if (x != std::string::npos) {
    auto width = number_in<int>(std::string_view(text).substr(0, x));
    auto height = number_in<int>(std::string_view(text).substr(x + 1));
    if (width && height) {
      if (Status possible = check_resolution(*width, *height); !possible) return possible;
      options.resolution = std::pair{*width, *height};
      return Done{};
    }
  }
  return Failure{
      fmt::format("takes WIDTHxHEIGHT in pixels, such as 1280x720, or a percentage, such as 50%; found \"{}\"", text)};
}

Result<PixelBounds> parse_crop(const std::string& text) {
  std::array<int, 4> edges{};
  std::string_view rest = text;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const std::size_t comma = i < 3 ? rest.find(',') : rest.size();
    auto edge = comma == std::string_view::npos ? std::nullopt : number_in<int>(rest.substr(0, comma));
    if (!edge || *edge < 0)
      return Failure{fmt::format("takes x0,y0,x1,y1 in pixels (x1 and y1 are excluded); found \"{}\"", text)};
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

Result<ValueRange> parse_range(const std::string& text) {
  const std::size_t colon = text.find(':');
  if (colon != std::string::npos) {
    const auto low = number_in<float>(std::string_view(text).substr(0, colon));
    const auto high = number_in<float>(std::string_view(text).substr(colon + 1));
    if (low && high && std::isfinite(*low) && std::isfinite(*high) && *low < *high) return ValueRange{*low, *high};
  }
  return Failure{
      fmt::format("takes auto, or LOW:HIGH, two numbers of which the first is the smaller; found \"{}\"", text)};
}

Result<EnvironmentOptions> parse_environment(const std::string& text) {
  // A file name may contain colons: settings have an = after the last one.
  const std::size_t colon = text.rfind(':');
  const bool has_settings = colon != std::string::npos && text.find('=', colon) != std::string::npos;
  EnvironmentOptions environment{has_settings ? text.substr(0, colon) : text};
  if (environment.file.empty()) return Failure{fmt::format("takes FILE[:rotation=DEG,scale=S]; found \"{}\"", text)};
  if (!has_settings) return environment;
  for (std::string rest = text.substr(colon + 1); !rest.empty();) {
    const std::size_t comma = rest.find(',');
    const auto setting = parse_setting(rest.substr(0, comma));
    if (!setting) return setting.failure();
    const auto& [key, value] = *setting;
    if (key != "rotation" && key != "scale")
      return Failure{fmt::format("takes FILE[:rotation=DEG,scale=S]; found the setting \"{}\"{}", key,
                                 montelux::did_you_mean(key, {"rotation", "scale"}))};
    const auto number = key == "scale" ? parse_number(value, 0, 1e30) : parse_number(value, -1e6, 1e6);
    if (!number) return Failure{fmt::format("{} {}", key, number.error())};
    (key == "scale" ? environment.scale : environment.rotation) = *number;
    rest = comma == std::string::npos ? std::string() : rest.substr(comma + 1);
  }
  return environment;
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

Setter text_into(std::optional<std::string>& target) {
  return into(target, [](const std::string& text) -> Result<std::string> { return text; });
}

Setter append_to(std::vector<std::string>& list) {
  return [&list](const std::string& text) -> Status {
    list.push_back(text);
    return Done{};
  };
}

void add_option(CLI::App& verb, const OptionText& text, Setter set) {
  // Messages use the long name.
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
  verb.add_option("SCENE", file, "scene file (" + scene_extensions() + ")")->required()->type_name("FILE");
  add_option(verb, {"--resolution", "WxH|P%", "size of the image in pixels, or as a percentage of the file's"},
             [&options](const std::string& text) { return parse_resolution(text, options); });
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
  add_option(
      verb,
      {"--shutter", "OPEN:CLOSE",
       "exposure interval in the scene's unit of time (glTF: seconds), overrides that of the file; "
       "with --frames, that of frame 0; with --frames A:B/N, that of all frames; does not change the brightness"},
      into(options.shutter, parse_shutter));
  add_option(
      verb,
      {"--environment", "FILE[:rotation=DEG,scale=S]",
       "environment map instead of the scene's own: equirectangular with +y at the top, or square and equal-area"},
      into(options.environment, parse_environment));
  verb.add_flag("--verbose", options.verbose, "list every warning and note of the scene instead of one for each kind");
  verb.add_flag("--lenient", options.lenient, "warn about unknown and unsupported features of the scene, and continue");
}

void add_display_options(CLI::App& verb, DisplayRequest& display) {
  add_option(
      verb,
      {"--exposure", "auto|EV",
       "for 8-bit images: multiply by 2^EV; auto: automatic exposure; default: 0, or auto if the scene states no "
       "exposure and nearly all of the image would be black or white"},
      [&display](const std::string& text) -> Status {
        display.automatic_exposure = text == "auto";
        display.exposure.reset();
        if (display.automatic_exposure) return Done{};
        auto stops = parse_number(text, -100, 100);
        if (!stops) return Failure{"takes auto, or stops: " + stops.error().substr(stops.error().find(' ') + 1)};
        display.exposure = float(*stops);
        return Done{};
      });
  add_option(verb, {"--tone", alternatives(names_of(tone_curves())), "for 8-bit images: tone curve (default clip)"},
             into(display.curve, [](const std::string& text) -> Result<ToneCurve> {
               auto name = parse_choice(text, names_of(tone_curves()));
               if (!name) return name.failure();
               return *tone_curve_named(*name);
             }));
  add_option(verb,
             {"--range", "auto|LOW:HIGH",
              "for 8-bit images: values from black to white, or from the first to the last colour of a map"},
             [&display](const std::string& text) -> Status {
               display.automatic_range = text == "auto";
               display.range.reset();
               if (display.automatic_range) return Done{};
               auto range = parse_range(text);
               if (!range) return range.failure();
               display.range = *range;
               return Done{};
             });
  add_option(verb,
             {"--colormap", alternatives(names_of(color_maps())),
              "for 8-bit images: false colours (default: viridis for distances, errors and numbers of samples)"},
             [&display](const std::string& text) -> Status {
               auto name = parse_choice(text, names_of(color_maps()));
               if (!name) return name.failure();
               display.map.reset();
               display.no_map = *name == "none";
               for (std::size_t i = 0; i < color_map_names.size(); ++i)
                 if (color_map_names[i] == *name) display.map = ColorMap(i);
               return Done{};
             });
}

void add_denoiser_option(CLI::App& verb, std::optional<std::string>& denoiser, const std::string& help) {
  add_option(
      verb,
      {"--denoiser", alternatives(names_of(denoiser_names())),
       "filter that removes noise: montelux (default), or oidn, which is Intel's Open Image Denoise, where it is "
       "installed (or oidn:library=FILE)" +
           help},
      [&denoiser](const std::string& text) -> Status {
        denoiser = text;
        return check_denoiser(text);
      });
}

}  // namespace montelux::cli
