// Options of the command line: reading their values, and adding them to the parser.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "api/render.h"

namespace CLI {
class App;
}

namespace montelux::cli {

// Readers of option values. A failure states what is valid.
// An integer in any exact notation: 1000, 1e3, 1k (k, M and G are 10^3, 10^6 and 10^9).
Result<int> parse_whole(const std::string& text, int low, int high);
Result<std::uint64_t> parse_large_whole(const std::string& text, std::uint64_t low, std::uint64_t high);
Result<double> parse_number(const std::string& text, double low, double high);
// Seconds, from a number followed by ms, s, m or h; without a unit: seconds.
Result<double> parse_time(const std::string& text);
// "WxH" sets options.resolution, "50%" options.resolution_scale.
Status parse_resolution(const std::string& text, LoadOptions& options);
// "x0,y0,x1,y1": pixels x0 <= x < x1, y0 <= y < y1.
Result<PixelBounds> parse_crop(const std::string& text);
// One of the names; a failure lists all of them and the closest.
Result<std::string> parse_choice(const std::string& text, const std::vector<std::string>& names);
// "OPEN:CLOSE", two numbers.
Result<ShutterTimes> parse_shutter(const std::string& text);
// "LOW:HIGH", two numbers.
Result<ValueRange> parse_range(const std::string& text);
// "FILE", or "FILE:rotation=DEGREES,scale=S" with one or both of these.
Result<EnvironmentOptions> parse_environment(const std::string& text);
// "key=value".
Result<std::pair<std::string, std::string>> parse_setting(const std::string& text);

// The first elements: the names that an option accepts.
std::vector<std::string> names_of(const std::vector<std::pair<std::string, std::string>>& described);
// "a|b|c": the notation of a choice in help and completion.
std::string alternatives(const std::vector<std::string>& names);

using Setter = std::function<Status(const std::string&)>;

// A setter that reads a value with `parse` into `target`, which must outlive it.
template <class T, class Parse>
Setter into(T& target, Parse parse) {
  return [&target, parse](const std::string& text) -> Status {
    auto value = parse(text);
    if (!value) return value.failure();
    target = *value;
    return Done{};
  };
}

// Setters of texts as they are.
Setter text_into(std::optional<std::string>& target);
Setter append_to(std::vector<std::string>& list);

// Adds an option that takes one value. `type` stands for the value in help: FILE completes to file names, "a|b" to
// these words. A repeatable option calls the setter once for each value.
struct OptionText {
  std::string names, type, help;
  bool repeatable = false;
};
void add_option(CLI::App& verb, const OptionText& text, Setter set);

// Options that several verbs share.
void add_scene_options(CLI::App& verb, std::string& file, LoadOptions& options);
void add_display_options(CLI::App& verb, DisplayRequest& display);
// --denoiser; `help` follows what its values mean.
void add_denoiser_option(CLI::App& verb, std::optional<std::string>& denoiser, const std::string& help);

}  // namespace montelux::cli
