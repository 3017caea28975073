// Comparisons in files: their conditions and their state, as JSON. Long arrays are 64-bit floats
// (little endian) in base 64.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "api/checksum.h"
#include "api/comparison.h"
#include "api/render.h"
#include "api/saved_file.h"
#include "api/saved_scene.h"
#include "lab/report/base64.h"

namespace montelux {

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

// Version 4 had no common settings, no measure (its verdicts used mse), and repeats with 13 figures.
constexpr SavedFormat saved_format{"montelux comparison", 5, "montelux compare --save", "comparison", 4};
constexpr std::size_t figures = 17, figures_of_version_4 = 13;
static_assert(std::endian::native == std::endian::little);

// ---- long arrays ----------------------------------------------------------------------------------------------------

template <class T>
std::string packed(const std::vector<T>& values) {
  const std::vector<double> wide(values.begin(), values.end());
  return lab::base64({reinterpret_cast<const char*>(wide.data()), 8 * wide.size()});
}
template <class T>
std::vector<T> unpacked(const Json& json, std::size_t expected) {
  const auto bytes = lab::bytes_of_base64(json.get_ref<const std::string&>());
  if (!bytes || bytes->size() != 8 * expected) throw std::invalid_argument("an array in it is damaged");
  std::vector<double> wide(expected);
  std::copy(bytes->begin(), bytes->end(), reinterpret_cast<char*>(wide.data()));
  std::vector<T> values;
  values.reserve(expected);
  for (double x : wide) values.push_back(T(x));
  return values;
}
// Of any length.
std::vector<double> unpacked(const Json& json) {
  const auto bytes = lab::bytes_of_base64(json.get_ref<const std::string&>());
  return unpacked<double>(json, bytes ? bytes->size() / 8 : 0);
}

// A number that may be infinite, which JSON cannot express.
Json number(double x) { return packed(std::vector<double>{x}); }
double number_from(const Json& json) { return unpacked<double>(json, 1).front(); }

// ---- what it is of --------------------------------------------------------------------------------------------------

Json options_json(const ComparisonOptions& o) {
  Json json{{"methods", o.methods},
            {"settings", o.settings},
            {"measure", lab::key_of(o.measure)},
            {"seconds", or_null<Json>(o.seconds)},
            {"samples", or_null<Json>(o.samples)},
            {"repeats", o.repeats},
            {"confidence", o.confidence},
            {"seed", o.seed},
            {"warm_frames", o.warm_frames},
            {"processor_time", o.processor_time},
            {"slopes", o.slopes},
            {"attribution", o.attribution},
            {"crop", Json()}};
  if (o.crop) json["crop"] = {o.crop->x0, o.crop->y0, o.crop->x1, o.crop->y1};
  return json;
}
ComparisonOptions options_from(const Json& j) {
  ComparisonOptions o;
  o.methods = j.at("methods").get<std::vector<std::string>>();
  o.measure = lab::ErrorMeasure::mse;
  if (j.contains("settings")) o.settings = j.at("settings").get<decltype(o.settings)>();
  if (j.contains("measure")) {
    const auto measure = lab::measure_named(j.at("measure").get<std::string>());
    if (!measure) throw std::invalid_argument("its settings are damaged");
    o.measure = *measure;
  }
  o.seconds = optional_at<double>(j, "seconds");
  if (const Json& samples = j.at("samples"); !samples.is_null()) o.samples = whole_from(samples, 1, 1 << 20);
  o.repeats = whole_from(j.at("repeats"), 1, 1 << 20), o.confidence = j.at("confidence");
  o.seed = whole_from<std::uint32_t>(j.at("seed"), 0, std::numeric_limits<std::uint32_t>::max());
  o.warm_frames = j.at("warm_frames"), o.processor_time = j.at("processor_time");
  o.slopes = j.at("slopes"), o.attribution = j.at("attribution");
  if (const Json& c = j.at("crop"); !c.is_null())
    o.crop = PixelBounds{side_from(c.at(0)), side_from(c.at(1)), side_from(c.at(2)), side_from(c.at(3))};
  if (o.methods.empty()) throw std::invalid_argument("its settings are damaged");
  return o;
}

Json reference_json(const lab::Reference& r) {
  return {{"width", r.mean.width},
          {"height", r.mean.height},
          {"origin", r.origin},
          {"degrees_of_freedom", number(r.degrees_of_freedom)},
          {"variance_of_image",
           r.variance_of_image ? Json(packed(std::vector(r.variance_of_image->begin(), r.variance_of_image->end())))
                               : Json()},
          {"mean", packed(r.mean.values)},
          {"variance", packed(r.variance.values)}};
}
lab::Reference reference_from(const Json& j) {
  lab::Reference r;
  const int width = side_from(j.at("width")), height = side_from(j.at("height"));
  const std::size_t values = 3 * std::size_t(width) * std::size_t(height);
  std::vector<float> mean = unpacked<float>(j.at("mean"), values), variance = unpacked<float>(j.at("variance"), values);
  if (values == 0) throw std::invalid_argument("its picture has no pixels");
  const std::vector<std::string> channels{"R", "G", "B"};
  r.mean = {width, height, channels, std::move(mean)}, r.variance = {width, height, channels, std::move(variance)};
  if (const Json& known = j.at("variance_of_image"); !known.is_null()) {
    const std::vector<double> v = unpacked<double>(known, 3);
    r.variance_of_image = {v[0], v[1], v[2]};
  }
  r.origin = j.at("origin"), r.degrees_of_freedom = number_from(j.at("degrees_of_freedom"));
  return r;
}

// ---- what was gathered ----------------------------------------------------------------------------------------------

Json repeat_json(const lab::Repeat& r) {
  return packed(std::vector<double>{r.seconds, r.all_seconds, r.warm_up, r.rays, r.samples, r.mse, r.relative_mse,
                                    r.flip, r.variance, r.coverage, r.image_mean[0], r.image_mean[1], r.image_mean[2],
                                    r.passes, r.image_error[0], r.image_error[1], r.image_error[2]});
}
lab::Repeat repeat_from(const Json& j) {
  std::vector<double> v = unpacked(j);
  if (v.size() == figures_of_version_4) v.resize(figures);
  if (v.size() != figures) throw std::invalid_argument("its repeats are damaged");
  return {
      v[0], v[1], v[2], v[3], v[4], v[5], v[6], v[7], v[8], v[9], {v[10], v[11], v[12]}, v[13], {v[14], v[15], v[16]}};
}

Json method_json(const lab::MethodState& m) {
  Json json{{"samples_per_pass", m.plan.samples_per_pass},
            {"planned_passes", m.plan.passes},
            {"passes", m.passes},
            {"non_finite", m.non_finite}};
  json["repeats"] = Json::array();
  for (std::size_t i = 0; i < m.repeats.size(); ++i) {
    const lab::ConvergenceRun& run = m.convergence[i];
    Json one{{"figures", repeat_json(m.repeats[i])},
             {"luminance", packed(m.luminance[i])},
             {"convergence", {packed(run.samples), packed(run.mse), packed(run.seconds)}}};
    if (!m.attribution.empty()) one["attribution"] = {number(m.attribution[i].all), packed(m.attribution[i].layers)};
    json["repeats"].push_back(std::move(one));
  }
  std::vector<double> pixels;
  for (const PixelEstimate& p : m.pixels) {
    pixels.insert(pixels.end(), std::begin(p.mean), std::end(p.mean));
    pixels.insert(pixels.end(), std::begin(p.m2), std::end(p.m2));
    pixels.push_back(p.passes), pixels.push_back(p.non_finite);
  }
  json["pixels"] = packed(pixels);
  json["pixel_shares"] = Json::array();
  for (const auto& layer : m.pixel_shares) json["pixel_shares"].push_back(packed(layer));
  return json;
}

std::uint32_t count_from(double x) {
  if (!(x >= 0 && x <= std::numeric_limits<std::uint32_t>::max()))
    throw std::invalid_argument("a count in it is damaged");
  return std::uint32_t(x);
}

lab::MethodState method_from(const Json& j, std::size_t pixel_count, int max_passes) {
  lab::MethodState m;
  // No more than any comparison plans: work that continues from the file is bounded.
  m.plan = {whole_from(j.at("samples_per_pass"), 1, 1 << 20), whole_from(j.at("planned_passes"), 0, max_passes)};
  m.passes = whole_from<decltype(m.passes)>(j.at("passes"), 0, 1 << 30);
  m.non_finite = whole_from<decltype(m.non_finite)>(j.at("non_finite"), 0, std::int64_t(1) << 62);
  for (const Json& one : j.at("repeats")) {
    m.repeats.push_back(repeat_from(one.at("figures")));
    m.luminance.push_back(unpacked<float>(one.at("luminance"), pixel_count));
    const Json& run = one.at("convergence");
    m.convergence.push_back({unpacked(run.at(0)), unpacked(run.at(1)), unpacked(run.at(2))});
    if (one.contains("attribution"))
      m.attribution.push_back({number_from(one.at("attribution").at(0)), unpacked(one.at("attribution").at(1))});
  }
  if (!m.attribution.empty() && m.attribution.size() != m.repeats.size())
    throw std::invalid_argument("its repeats are damaged");
  if (!m.repeats.empty()) {
    const std::vector<double> pixels = unpacked<double>(j.at("pixels"), 8 * pixel_count);
    for (std::size_t p = 0; p < pixel_count; ++p) {
      PixelEstimate& e = m.pixels.emplace_back();
      std::copy_n(&pixels[8 * p], 3, e.mean), std::copy_n(&pixels[8 * p + 3], 3, e.m2);
      e.passes = count_from(pixels[8 * p + 6]), e.non_finite = count_from(pixels[8 * p + 7]);
    }
  }
  for (const Json& layer : j.at("pixel_shares")) m.pixel_shares.push_back(unpacked<double>(layer, pixel_count));
  return m;
}

SavedComparison saved_from(const Json& j) {
  SavedComparison saved;
  const SavedScene scene = scene_from(j);
  saved.scene = scene.file, saved.load = scene.load, saved.fingerprint = scene.fingerprint;
  saved.options = options_from(j.at("options"));
  saved.notes = j.at("notes").get<std::vector<std::string>>();
  saved.state.reference = reference_from(j.at("reference"));
  // A pass has at least one sample; if time ends a comparison, passes have another limit.
  const int max_passes = saved.options.samples.value_or(1 << 20);
  for (const Json& m : j.at("methods"))
    saved.state.methods.push_back(method_from(m, saved.state.reference.mean.pixel_count(), max_passes));
  if (saved.state.methods.size() != saved.options.methods.size())
    throw std::invalid_argument("its results do not match its methods");
  return saved;
}

}  // namespace

Status save_comparison(const fs::path& file, const SavedComparison& c) {
  Json json{{"format", saved_format.name}, {"version", saved_format.version}, {"program", version()}};
  add_scene(json, {c.scene, c.load, c.fingerprint});
  json["options"] = options_json(c.options);
  json["notes"] = c.notes;
  json["reference"] = reference_json(c.state.reference);
  json["methods"] = Json::array();
  for (const lab::MethodState& m : c.state.methods) json["methods"].push_back(method_json(m));
  return save_json(file, std::move(json));
}

Status check_comparison_file(const fs::path& file) { return check_saved_target(file, saved_format); }

Result<SavedComparison> load_comparison(const fs::path& file) {
  return load_saved<Json>(file, saved_format, [](const Json& json) {
    SavedComparison saved = saved_from(json);
    if (scene_fingerprint(saved.scene, saved.load.environment) != saved.fingerprint)
      throw std::invalid_argument(
          fmt::format("the scene {} has changed since, or is no longer there", saved.scene.string()));
    return saved;
  });
}

}  // namespace montelux
