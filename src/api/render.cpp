#include "api/render.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>

#include "api/parts.h"
#include "integrator/path/tracer.h"

namespace montelux {

namespace {

constexpr std::string_view montelux_version = MONTELUX_VERSION;

std::string quoted_list(const std::vector<std::string_view>& names) {
  std::string list;
  for (std::string_view name : names) list += (list.empty() ? "" : ", ") + std::string(name);
  return list;
}

// "unknown integrator "pth"; valid are path (did you mean "path"?)".
Failure unknown(std::string_view what, const std::string& name, const std::vector<std::string_view>& valid) {
  std::string message = fmt::format("unknown {} \"{}\"; valid: {}", what, name, quoted_list(valid));
  if (std::string_view near = nearest_name(name, valid); !near.empty())
    message += fmt::format(" (did you mean \"{}\"?)", near);
  return {message};
}

std::optional<int> whole_number(const std::string& text, int low) {
  int value = 0;
  auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || value < low) return std::nullopt;
  return value;
}

// Applies "name=value" pairs to the settings of the path integrator.
Status apply_settings(const std::vector<std::pair<std::string, std::string>>& pairs, PathSettings& settings) {
  const std::vector<std::string_view> names{"maxdepth", "maxcomponent", "roulette-depth", "lanes"};
  for (const auto& [name, value] : pairs) {
    if (name == "maxdepth") {
      if (value == "none" || value == "unbounded") {
        settings.max_depth.reset();
      } else if (auto depth = whole_number(value, 0)) {
        settings.max_depth = depth;
      } else {
        return Failure{fmt::format("maxdepth takes a whole number from 0, or none; found \"{}\"", value)};
      }
    } else if (name == "maxcomponent") {
      float most = 0;
      auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), most);
      if (value == "none")
        settings.max_component.reset();
      else if (error == std::errc{} && end == value.data() + value.size() && most > 0)
        settings.max_component = most;
      else
        return Failure{fmt::format("maxcomponent takes a number above 0, or none; found \"{}\"", value)};
    } else if (name == "roulette-depth") {
      auto depth = whole_number(value, 0);
      if (!depth) return Failure{fmt::format("roulette-depth takes a whole number from 0; found \"{}\"", value)};
      settings.roulette_depth = *depth;
    } else if (name == "lanes") {
      if (value != "one" && value != "native")
        return Failure{fmt::format("lanes takes one or native; found \"{}\"", value)};
      settings.lanes = value == "one" ? Lanes::one : Lanes::native;
    } else {
      return unknown("setting of the path integrator", name, names);
    }
  }
  return Done{};
}

std::vector<std::string_view> views_of(const std::vector<std::pair<std::string, std::string>>& named) {
  std::vector<std::string_view> names;
  for (const auto& [name, description] : named) names.push_back(name);
  return names;
}

// Everything that decides a render, checked.
struct Plan {
  RenderSettings render;
  PathSettings path;
};

Result<Plan> plan_render(const LoadedScene::Parts& parts, const RenderOptions& options) {
  const PictureSettings& picture = parts.picture;
  Plan plan;
  const auto integrators = integrator_names();
  if (options.integrator && *options.integrator != "path")
    return unknown("integrator", *options.integrator, views_of(integrators));
  plan.path.max_depth = picture.max_depth;
  plan.path.max_component = picture.max_component;
  if (Status status = apply_settings(options.settings, plan.path); !status) return status.failure();

  RenderSettings& r = plan.render;
  r.sampler = picture.sampler;
  if (options.sampler) {
    auto kind = point_set_named(*options.sampler);
    const auto samplers = sampler_names();
    if (!kind) return unknown("sampler", *options.sampler, views_of(samplers));
    r.sampler = *kind;
  }
  r.width = picture.width, r.height = picture.height;
  r.bounds = options.crop.value_or(picture.crop);
  const PixelBounds& b = r.bounds;
  if (b.x0 < 0 || b.y0 < 0 || b.x1 > r.width || b.y1 > r.height || b.x0 >= b.x1 || b.y0 >= b.y1)
    return Failure{fmt::format("the crop {},{},{},{} is not inside the picture of {} x {} pixels", b.x0, b.y0, b.x1,
                               b.y1, r.width, r.height)};
  if (options.samples && (*options.samples < 1 || *options.samples > (1 << 24)))
    return Failure{fmt::format("the number of samples must be from 1 to {}; found {}", 1 << 24, *options.samples)};
  r.seed = options.seed;
  r.threads = options.threads;
  r.seconds = options.seconds;
  r.plan = plan_passes(options.samples.value_or(picture.samples), r.sampler);
  return plan;
}

// For a render that is bounded by time: as many samples a pass as leave enough passes, by a measured pass.
PassPlan plan_for_time(const PathTracer& tracer, RenderSettings settings, double seconds) {
  settings.seconds.reset();
  settings.plan = {1, 1};
  settings.first_pass = 1 << 30;  // a pass that the render itself will never take
  RenderObserver silent;
  const double one_sample = std::max(render(tracer, settings, silent).seconds, 1e-6);
  const auto affordable = int(std::min(seconds / one_sample, 1e6));
  PassPlan plan = plan_passes(std::max(affordable, 1), settings.sampler);
  plan.passes = 1 << 20;  // time ends it
  return plan;
}

std::vector<Attribute> header_of(const LoadedScene::Parts& parts, const Plan& plan, const RenderResult& result) {
  std::vector<Attribute> header;
  auto add = [&](std::string name, std::variant<std::string, std::int32_t, float, double> value) {
    header.push_back({"montelux:" + std::move(name), std::move(value)});
  };
  add("version", version());
  add("scene", std::filesystem::path(parts.info.file).filename().string());
  add("integrator", std::string("path"));
  add("sampler", std::string(name_of(plan.render.sampler)));
  add("seed", std::int32_t(plan.render.seed));
  add("samplesPerPass", std::int32_t(plan.render.plan.samples_per_pass));
  add("passes", std::int32_t(result.film.image().passes));
  add("nonFinite", std::int32_t(std::min<std::uint64_t>(result.film.non_finite(), 0x7fffffff)));
  std::string biased;
  if (plan.path.max_depth) biased += fmt::format("maxdepth={}", *plan.path.max_depth);
  if (plan.path.max_component)
    biased += fmt::format("{}maxcomponent={}", biased.empty() ? "" : " ", *plan.path.max_component);
  add("biasedOptions", biased.empty() ? std::string("none") : biased);
  const ErrorEstimate error = result.film.error(result.film.bounds());
  add("estimatedMSE", error.mse);
  add("estimatedRelativeMSE", error.relative_mse);
  const ImageEstimate image = result.film.image();
  for (int c = 0; c < spectrum_size; ++c) {
    add(fmt::format("mean{}", "RGB"[c]), image.mean[c]);
    if (image.passes >= 2) add(fmt::format("meanStandardError{}", "RGB"[c]), image.standard_error[c]);
  }
  // A file that must be the same in every run carries no times.
  if (auto date = date_attribute())
    header.push_back(*date);
  else
    add("renderSeconds", result.seconds);
  return header;
}

}  // namespace

Result<Rendering> render_scene(const LoadedScene& scene, const RenderOptions& options, RenderObserver& observer) {
  const LoadedScene::Parts& parts = scene.parts();
  Result<Plan> checked = plan_render(parts, options);
  if (!checked) return checked.failure();
  Plan& plan = *checked;
  PathTracer tracer(parts.scene, *parts.accel, plan.path);
  if (plan.render.seconds) {
    // The pass that measures the speed is taken from the time, too.
    const auto start = std::chrono::steady_clock::now();
    plan.render.plan = plan_for_time(tracer, plan.render, *plan.render.seconds);
    const std::chrono::duration<double> measured = std::chrono::steady_clock::now() - start;
    plan.render.seconds = std::max(*plan.render.seconds - measured.count(), 0.0);
  }
  RenderResult result = render(tracer, plan.render, observer);
  std::vector<Attribute> header = header_of(parts, plan, result);
  std::vector<std::string> notes;
  if (plan.path.max_depth)
    notes.push_back(
        fmt::format("paths end after {} scattering events, as the scene asks: the picture is biased by what "
                    "longer paths would bring (--set maxdepth=none lifts it)",
                    *plan.path.max_depth));
  if (plan.path.max_component)
    notes.push_back(fmt::format(
        "samples brighter than {} are scaled down to it: the picture is biased by the light that this takes "
        "away (--set maxcomponent=none lifts it)",
        *plan.path.max_component));
  return Rendering{std::move(result), std::move(header), std::move(notes), plan.render.plan};
}

std::vector<std::pair<std::string, std::string>> integrator_names() {
  return {{"path", "path tracing: next-event estimation and BSDF sampling by MIS, Russian roulette"}};
}

std::vector<std::pair<std::string, std::string>> sampler_names() {
  std::vector<std::pair<std::string, std::string>> names;
  for (const NamedPointSet& set : point_set_names) names.emplace_back(set.name, set.description);
  return names;
}

std::string version() { return std::string(montelux_version); }

}  // namespace montelux
