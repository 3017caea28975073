#include "integrator/automatic/settings.h"

#include <algorithm>

#include "integrator/path/settings.h"
#include "parameter/fields.h"

namespace montelux {

namespace {

// 32 pixels of each of 256 blocks, 8 samples each, of paths that no roulette ends.
constexpr double survival_pilot_samples = 2 * 32 * 256 * 8;

// The paths that teach a guide (guiding-paths; its default), each of which takes longer than one of path.
constexpr double guide_training_samples = 1.5 * (1 << 20);

// The paths that teach where the sky is visible (sky-paths; its default), with their shadow rays.
constexpr double sky_training_samples = 3.0 * (1 << 16);

// The same for what is hidden of the lights (light-paths).
constexpr double light_training_samples = 7.0 * (1 << 15);

constexpr AutomaticCandidate candidates[] = {
    {"restir-pt", 1.05, 6, 0},
    {"path:light-selection=learned,sky-learning=on", 1.1, 1.2, 0, sky_training_samples, light_training_samples},
    {"path:roulette=efficiency", 1, 1, survival_pilot_samples},
    {"restir-di", 0.9, 3, 0},
    {"bdpt", 1.5, 4, 0}};

// Candidates are written with + for the commas between their settings.
std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts{""};
  for (char c : text)
    if (c == '/')
      parts.emplace_back();
    else
      parts.back() += c == '+' ? ',' : c;
  return parts;
}
std::string joined() {
  std::string text;
  for (const AutomaticCandidate& candidate : candidates) text.append(text.empty() ? "" : "/").append(candidate.text);
  std::ranges::replace(text, ',', '+');
  return text;
}

Fields<AutomaticSettings> automatic_fields() {
  using S = AutomaticSettings;
  Fields<S> fields;
  fields
      .text("among",
            "the candidates beside path, separated by /, each perhaps with settings, separated by +: "
            "restir-pt:rounds=2+radius=4/restir-di; default " +
                joined(),
            [](const std::string& text, S& s) -> Status {
              s.among = split(text);
              return Done{};
            })
      .number("share", &S::share, "the share of the work that pilots may take", 0.001, 0.05)
      .other(max_depth_spec());
  return fields;
}

}  // namespace

std::span<const AutomaticCandidate> automatic_candidates() { return candidates; }

AutomaticCandidate automatic_candidate(std::string_view text) {
  const auto name = [](std::string_view t) { return t.substr(0, t.find(':')); };
  for (const AutomaticCandidate& candidate : automatic_candidates())
    if (candidate.text == text) return candidate;
  AutomaticCandidate found{text, 1.7, 6, 0};
  for (const AutomaticCandidate& candidate : automatic_candidates())
    if (name(candidate.text) == name(text) && candidate.sky_making == 0)
      found = {text, candidate.ray_cost, candidate.sample_cost, 0};
  if (text.find("roulette=efficiency") != std::string_view::npos) found.making = survival_pilot_samples;
  if (text.find("guiding=on") != std::string_view::npos) {
    found.ray_cost = std::max(found.ray_cost, 1.4), found.sample_cost = std::max(found.sample_cost, 1.4);
    found.making += guide_training_samples;
  }
  if (text.find("sky-learning=on") != std::string_view::npos) {
    found.ray_cost = std::max(found.ray_cost, 1.1), found.sample_cost = std::max(found.sample_cost, 1.3);
    found.sky_making = sky_training_samples;
  }
  if (text.find("light-selection=learned") != std::string_view::npos) {
    found.ray_cost = std::max(found.ray_cost, 1.05), found.sample_cost = std::max(found.sample_cost, 1.1);
    found.lights_making = light_training_samples;
  }
  return found;
}

EntitySpec automatic_spec() {
  return {"auto",
          "chooses by short pilots among integrators that estimate the same image: path, unless another one is "
          "significantly more efficient",
          automatic_fields().specs({})};
}

Result<AutomaticSettings> automatic_settings(const ParameterList& list) {
  AutomaticSettings s;
  if (Status read = automatic_fields().read(list, s); !read) return read.failure();
  return s;
}

}  // namespace montelux
