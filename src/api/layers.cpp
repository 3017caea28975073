#include "api/layers.h"

#include <fmt/format.h>

#include <charconv>
#include <string_view>
#include <vector>

namespace montelux {

namespace {

// A word that may have a number of bounces.
struct CountedWord {
  std::string_view name;
  std::optional<int> LayerRequest::*member;
  int by_default, max;
};
constexpr CountedWord counted_words[]{{"bounces", &LayerRequest::bounces, 4, 64},
                                      {"strategies", &LayerRequest::strategies, 3, 16}};

// "bounces" or "bounces:3"; nothing if it is no such word.
std::optional<Status> read_counted(std::string_view word, LayerRequest& request) {
  for (const CountedWord& row : counted_words) {
    if (word == row.name) {
      request.*row.member = row.by_default;
      return Done{};
    }
    if (!word.starts_with(row.name) || word[row.name.size()] != ':') continue;
    int bounces = 0;
    const char *at = word.data() + row.name.size() + 1, *end = word.data() + word.size();
    const auto [next, error] = std::from_chars(at, end, bounces);
    if (error != std::errc{} || next != end || bounces < 0 || bounces > row.max)
      return Failure{
          fmt::format("{0} takes a whole number from 0 to {1}, such as {0}:3; found \"{2}\"", row.name, row.max, word)};
    request.*row.member = bounces;
    return Done{};
  }
  return std::nullopt;
}

Status read_word(std::string_view word, LayerRequest& request) {
  if (const std::optional<Status> counted = read_counted(word, request)) return *counted;
  if (word == "light-groups") {
    request.light_groups = true;
  } else if (word == "alone") {
    request.alone = true;
  } else if (word == "errors") {
    request.errors = true;
  } else if (word == "motion") {
    request.motion = true;
  } else if (word == "halves") {
    request.halves = true;
  } else if (word == "intervals") {
    request.intervals = true;
  } else {
    return Failure{fmt::format(
        "there are no layers \"{}\"; valid: bounces, bounces:N, light-groups, strategies, strategies:N, alone, errors, "
        "motion, halves, intervals",
        word)};
  }
  return Done{};
}

}  // namespace

void state_light_groups(LayerPlan& plan, const Scene& scene) {
  plan.group_of_light = scene.lights.groups();
  plan.group_names = scene.lights.group_names();
  if (scene.media.emits()) {
    // The number after those of all lights.
    plan.group_of_light.push_back(std::uint32_t(plan.group_names.size()));
    plan.group_names.push_back("media");
  }
}

Result<LayerRequest> parse_layers(const std::string& text) {
  LayerRequest request;
  std::string_view rest = text;
  for (bool more = true; more;) {
    const std::size_t comma = rest.find(',');
    if (Status read = read_word(rest.substr(0, comma), request); !read) return read.failure();
    more = comma != std::string_view::npos;
    if (more) rest = rest.substr(comma + 1);
  }
  if (request.alone && !request.strategies) return Failure{"alone needs strategies: state strategies as well"};
  if (!request.of_light() && (request.errors || !(request.motion || request.halves || request.intervals)))
    return Failure{"errors needs layers: state bounces, light-groups or strategies as well"};
  return request;
}

std::string to_text(const LayerRequest& request) {
  std::vector<std::string> words;
  if (request.bounces) words.push_back(fmt::format("bounces:{}", *request.bounces));
  if (request.light_groups) words.emplace_back("light-groups");
  if (request.strategies) words.push_back(fmt::format("strategies:{}", *request.strategies));
  if (request.alone) words.emplace_back("alone");
  if (request.errors) words.emplace_back("errors");
  if (request.motion) words.emplace_back("motion");
  if (request.halves) words.emplace_back("halves");
  if (request.intervals) words.emplace_back("intervals");
  return fmt::format("{}", fmt::join(words, ","));
}

}  // namespace montelux
