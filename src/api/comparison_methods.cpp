#include "api/comparison_methods.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <set>

#include "api/automatic.h"
#include "api/layers.h"
#include "api/render.h"
#include "api/shortcomings.h"

namespace montelux {

namespace {

bool has_setting(const ChoiceText& choice, const std::string& key) {
  return std::ranges::any_of(choice.settings, [&](const Setting& s) { return s.first == key; });
}

// "name=" before the integrator. A name consists of letters, digits, spaces and a few marks, so that it needs no
// escaping in any form of the results.
Status read_name(const std::string& typed, MethodText& method) {
  method.text = typed;
  const std::size_t equals = typed.find('='), colon = typed.find(':');
  if (equals == std::string::npos || equals > colon) return Done{};
  method.name = typed.substr(0, equals), method.text = typed.substr(equals + 1);
  const auto good = [](unsigned char c) {
    return std::isalnum(c) || c >= 0x80 || std::string_view(" -_.+").find(char(c)) != std::string_view::npos;
  };
  const bool edges = !method.name.empty() && method.name.front() != ' ' && method.name.back() != ' ';
  if (edges && method.name.size() <= 60 && std::ranges::all_of(method.name, good)) return Done{};
  return Failure{fmt::format(
      "\"{}\" cannot name a method: names have 1 to 60 letters, digits, spaces and -_.+ (settings follow a colon: "
      "path:mis=balance)",
      method.name)};
}

Result<PointSetKind> read_sampler(const std::string& value) {
  if (auto kind = point_set_named(value)) return *kind;
  std::vector<std::string_view> names;
  const auto samplers = sampler_names();
  for (const auto& [known, description] : samplers) names.push_back(known);
  return unknown_name("sampler", value, names);
}

Result<MethodText> read_method(const std::string& typed, const std::vector<Setting>& common) {
  MethodText method;
  if (Status named = read_name(typed, method); !named) return named.failure();
  auto choice = parse_choice(method.text);
  if (!choice) return choice.failure();
  *choice = with_present_names(*std::move(choice));
  for (const Setting& setting : with_present_names({choice->name, common}).settings)
    if (!has_setting(*choice, setting.first)) choice->settings.push_back(setting);
  method.integrator = *choice;
  std::erase_if(method.integrator.settings, [](const Setting& s) { return s.first == "sampler"; });
  for (const auto& [key, value] : choice->settings) {
    if (key != "sampler") continue;
    auto kind = read_sampler(value);
    if (!kind) return kind.failure();
    method.sampler = *kind;
  }
  if (Status known = check_integrator(method.integrator); !known) return known.failure();
  return method;
}

// The settings that were typed for a method, including the sampler.
std::vector<Setting> typed_settings(const MethodText& method) { return parse_choice(method.text)->settings; }

// Names methods by what distinguishes them: the integrator, and those of the typed settings that not all methods share.
// Identical methods get letters.
void name_methods(std::vector<MethodText>& methods) {
  std::map<Setting, std::size_t> shared;
  for (const MethodText& m : methods) {
    const std::vector<Setting> typed = typed_settings(m);
    for (const Setting& s : std::set<Setting>(typed.begin(), typed.end())) ++shared[s];
  }
  std::map<std::string, int> times;
  std::vector<std::string> names;
  for (const MethodText& m : methods) {
    std::string name = m.integrator.name;
    char separator = ':';
    for (const Setting& s : typed_settings(m)) {
      if (shared[s] == methods.size()) continue;
      name += fmt::format("{}{}={}", separator, s.first, s.second), separator = ',';
    }
    names.push_back(m.name.empty() ? name : m.name);
    ++times[names.back()];
  }
  for (std::size_t i = 0; i < methods.size(); ++i) {
    const bool typed = !methods[i].name.empty();
    methods[i].name = typed || times[names[i]] == 1 ? names[i] : fmt::format("{} ({})", names[i], methods[i].label);
  }
}

// The families of layers to which variance is attributed.
LayerPlan attribution_layers(const Scene& scene) {
  LayerPlan plan;
  plan.bounces = 4;
  plan.techniques = true;
  state_light_groups(plan, scene);
  plan.light_groups = !plan.group_names.empty();
  return plan;
}

std::set<std::string> biases_of(const lab::ComparedMethod& c) { return {c.biases.begin(), c.biases.end()}; }

// "maxdepth=5: path, naive; direct light only: direct".
std::string biases_text(const std::vector<lab::ComparedMethod>& compared_methods) {
  std::map<std::string, std::vector<std::string>> by_bias;
  for (const lab::ComparedMethod& c : compared_methods)
    by_bias[fmt::format("{}", fmt::join(c.biases, ", "))].push_back(c.shown_name());
  std::string text;
  for (const auto& [bias, names] : by_bias)
    text += fmt::format("{}{} ({})", text.empty() ? "" : "; ", fmt::join(names, ", "), bias);
  return text;
}

}  // namespace

std::string MethodText::canonical() const {
  std::vector<Setting> sorted = integrator.settings;
  std::ranges::sort(sorted);
  std::string all = integrator.name;
  for (const auto& [key, value] : sorted) all += fmt::format(",{}={}", key, value);
  return all;
}

Result<std::vector<MethodText>> read_methods(const ComparisonOptions& options) {
  std::vector<MethodText> methods;
  for (const std::string& typed : options.methods) {
    auto method = read_method(typed, options.settings);
    if (!method) return Failure{typed + ": " + method.error()};
    method->label = std::string(1, char('a' + int(methods.size())));
    methods.push_back(*std::move(method));
  }
  name_methods(methods);
  std::set<std::string> names;
  for (const MethodText& m : methods)
    if (!names.insert(m.name).second) return Failure{fmt::format("two methods are called \"{}\"", m.name)};
  return methods;
}

namespace {

class StopOfComparison final : public RenderObserver {
 public:
  explicit StopOfComparison(const ComparisonObserver& observer) : observer_(observer) {}
  bool stop_requested() override { return observer_.stop && observer_.stop(); }

 private:
  const ComparisonObserver& observer_;
};

}  // namespace

Result<ChosenMethods> choose_methods(const LoadedScene::Parts& parts, const ComparisonOptions& options,
                                     const ComparisonObserver& observer) {
  ChosenMethods chosen{options, {}};
  const auto methods = read_methods(options);
  if (!methods) return methods.failure();
  for (std::size_t i = 0; i < methods->size(); ++i) {
    const MethodText& method = (*methods)[i];
    if (method.integrator.name != "auto") continue;
    RenderOptions render;
    render.integrator = canonical_text(method.integrator);
    if (method.sampler) render.sampler = std::string(name_of(*method.sampler));
    if (options.seconds)
      render.seconds = *options.seconds / options.repeats;
    else
      render.samples = options.samples.value_or(lab::ComparisonSettings{}.samples);
    render.seed = options.seed, render.threads = options.threads, render.crop = options.crop;
    StopOfComparison stop(observer);
    Result<RenderPlan> plan = plan_render(parts, render);
    if (!plan) return Failure{method.text + ": " + plan.error()};
    if (Status good = choose_automatically(parts, *plan, stop); !good) return good.failure();
    const std::string sampler = method.sampler ? fmt::format("sampler={}", name_of(*method.sampler)) : "";
    const std::string separator = sampler.empty()                                        ? ""
                                  : plan->integrator_text.find(':') == std::string::npos ? ":"
                                                                                         : ",";
    // A name of settings cannot be typed.
    const bool is_typed = method.name.find_first_of(":(") == std::string::npos;
    const std::string name = is_typed ? method.name : fmt::format("auto {}", method.label);
    chosen.options.methods[i] = fmt::format("{}={}{}{}", name, plan->integrator_text, separator, sampler);
    chosen.notes.push_back(fmt::format("{} is {}, which its time does not include", name, to_text(*plan->choice)));
  }
  return chosen;
}

Result<Field> make_field(const LoadedScene::Parts& parts, const ComparisonOptions& options) {
  auto methods = read_methods(options);
  if (!methods) return methods.failure();
  Field field;
  for (const MethodText& method : *methods) {
    auto chosen = choose_integrator(method.integrator, integrator_defaults(parts.picture), parts.scene, *parts.accel);
    if (!chosen) return Failure{method.text + ": " + chosen.error()};
    note_light(*chosen, parts);
    field.shortcomings.push_back({chosen->missing, replaced_in(parts.info, true, method.sampler.has_value())});
    const PointSetKind sampler = method.sampler.value_or(parts.picture.sampler);
    note_sampler(*chosen, sampler);
    field.integrators.push_back(*std::move(chosen));
    lab::ComparedMethod compared_method;
    compared_method.label = method.label, compared_method.name = method.name, compared_method.text = method.text;
    compared_method.settings = method.canonical();
    compared_method.integrator = field.integrators.back().any();
    compared_method.sampler = sampler;
    compared_method.biases = field.integrators.back().biases;
    compared_method.missing = field.integrators.back().missing;
    const PixelIntegrator* pixels = compared_method.integrator.pixel();
    if (options.attribution && pixels && pixels->has_layers()) compared_method.layers = attribution_layers(parts.scene);
    field.compared_methods.push_back(std::move(compared_method));
  }
  return field;
}

namespace {

using Faults = std::set<std::string>;

// The methods without a fault; if there are none, those whose only faults are common to all. A fixed sampler would
// not state the error of the reference.
template <class FaultsOf>
std::vector<std::size_t> without_faults(const std::vector<lab::ComparedMethod>& compared_methods, FaultsOf faults_of) {
  Faults shared = faults_of(compared_methods.front());
  for (const lab::ComparedMethod& c : compared_methods) {
    const Faults own = faults_of(c);
    std::erase_if(shared, [&](const std::string& fault) { return !own.contains(fault); });
  }
  const auto with = [&](const Faults& wanted) {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < compared_methods.size(); ++i)
      if (!is_fixed(compared_methods[i].sampler) && faults_of(compared_methods[i]) == wanted) found.push_back(i);
    return found;
  };
  const std::vector<std::size_t> faultless = with({});
  return faultless.empty() ? with(shared) : faultless;
}

}  // namespace

Result<std::vector<std::size_t>> who_may_serve(const std::vector<lab::ComparedMethod>& compared_methods) {
  const auto biases_and_missing = [](const lab::ComparedMethod& c) {
    Faults faults = biases_of(c);
    faults.insert(c.missing.begin(), c.missing.end());
    return faults;
  };
  if (const auto serve = without_faults(compared_methods, biases_and_missing); !serve.empty()) return serve;
  if (const auto serve = without_faults(compared_methods, biases_of); !serve.empty()) return serve;
  return Failure{fmt::format(
      "every method is biased, but not all in the same way: {}; none of them can render a fair reference: state "
      "one by --reference, or add a method without bias (path:maxdepth=none)",
      biases_text(compared_methods))};
}

}  // namespace montelux
