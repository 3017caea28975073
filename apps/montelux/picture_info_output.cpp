#include "picture_info_output.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "api/json_text.h"
#include "denoise_output.h"
#include "picture_output.h"
#include "progress.h"

namespace montelux::cli {

namespace {

using Json = nlohmann::ordered_json;

constexpr double confidence = default_confidence;

void print_line(std::string_view word, const std::string& text) { fmt::print("{:10}{}\n", word, text); }

// "R 0.1, G 0.2, B 0.3", each by `text` of the channel.
template <class Text>
std::string by_channel(Text text) {
  std::string line;
  for (std::size_t c = 0; c < 3; ++c) line += fmt::format("{}{} {}", c > 0 ? ", " : "", "RGB"[c], text(c));
  return line;
}

bool is_something(const std::string& text) { return !text.empty() && text != "none"; }

std::string layers_text(const PictureInfo& info) {
  std::vector<std::string> names;
  for (const LayerChannels& layer : info.layers)
    names.push_back(layer.name.empty() ? fmt::format("{}", fmt::join(layer.channels, ", "))
                                       : fmt::format("{} ({})", layer.name, fmt::join(layer.channels, "")));
  return fmt::format("{}", fmt::join(names, ", "));
}

std::string samples_text(const PictureInfo& info, const RenderFacts& facts) {
  std::string text;
  const bool is_uneven = info.samples && info.samples->min != info.samples->max;
  if (is_uneven)
    text = fmt::format("{:.3g} per pixel, from {:.0f} to {:.0f}", info.samples->mean, info.samples->min,
                       info.samples->max);
  else if (facts.passes && facts.samples_per_pass)
    text = fmt::format("{:.0f} per pixel ({:.0f} passes of {:.0f})", *facts.passes * *facts.samples_per_pass,
                       *facts.passes, *facts.samples_per_pass);
  if (facts.non_finite.value_or(0) > 0)
    text += fmt::format("; {:.0f} were not finite and are left out", *facts.non_finite);
  return text;
}

void print_mean(const RenderFacts& facts) {
  if (!facts.mean) return;
  const MeanOfFile& m = *facts.mean;
  print_line("mean", by_channel([&](std::size_t c) {
               return m.standard_error ? fmt::format("{:.6g} ± {:.2g}", m.mean[c], (*m.standard_error)[c])
                                       : fmt::format("{:.6g}", m.mean[c]);
             }));
  if (m.interval)
    print_line("", fmt::format("{:.0f} %: ", 100 * confidence) + by_channel([&](std::size_t c) {
                     return fmt::format("{:.6g} to {:.6g}", (*m.interval)[c].low, (*m.interval)[c].high);
                   }));
}

void print_error(const RenderFacts& facts) {
  if (facts.error) {
    const RelativeErrorOfFile& e = *facts.error;
    std::string text = fmt::format("{:.3g} % per pixel (root mean square of the relative errors), {:.3g} to {:.3g} %",
                                   100 * std::sqrt(e.relative_mse), 100 * std::sqrt(e.low), 100 * std::sqrt(e.high));
    if (e.is_unsure) text += "; few bright samples determine it";
    print_line("error", text);
  } else if (!facts.error_bar.empty()) {
    print_line("error",
               facts.error_bar.starts_with("none: ") ? "unknown: " + facts.error_bar.substr(6) : facts.error_bar);
  }
  if (facts.missing_by_chance) print_line("", missing_text(*facts.missing_by_chance));
  if (facts.interval_confidence)
    print_line(
        "", fmt::format("low to high contain the true value of a pixel with {:g} %", 100 * *facts.interval_confidence));
  if (facts.denoised_relative_mse)
    print_line("denoised", fmt::format("{}{:.3g} % per pixel is left, bias included", by_whom(facts.denoiser),
                                       100 * std::sqrt(*facts.denoised_relative_mse)));
  if (!facts.target.empty()) print_line("target", fmt::format("{}; reached: {}", facts.target, facts.target_reached));
}

void print_bias(const RenderFacts& facts) {
  if (!facts.biased_options.empty())
    print_line("biased by",
               is_something(facts.biased_options) ? facts.biased_options : "nothing: the image is unbiased");
  if (facts.bias)
    print_line("", "by " + by_channel([&](std::size_t c) {
                     return fmt::format("{:.2g} ± {:.1g}", facts.bias->mean[c], facts.bias->standard_error[c]);
                   }) + " of the mean, as measured");
  else if (is_something(facts.biased_options))
    print_line("", "by how much was not measured");
  for (const auto& [word, text] : {std::pair<std::string, const std::string&>{"missing", facts.missing_light},
                                   {"replaced", facts.replaced},
                                   {"left out", facts.left_out},
                                   {"sparse", facts.sparse}})
    if (is_something(text)) print_line(word, text);
}

Json number_or_null(const std::optional<double>& value) { return value ? Json(*value) : Json(); }

Json mean_json(const RenderFacts& facts) {
  if (!facts.mean) return Json();
  const MeanOfFile& m = *facts.mean;
  Json json{{"mean", m.mean}, {"standard_error", m.standard_error ? Json(*m.standard_error) : Json()}};
  json["interval_of_mean"] = nullptr;
  if (m.interval) {
    Json low = Json::array(), high = Json::array();
    for (const Interval& interval : *m.interval) low.push_back(interval.low), high.push_back(interval.high);
    json["interval_of_mean"] = {{"confidence", confidence}, {"low", low}, {"high", high}};
  }
  return json;
}

}  // namespace

void print_picture_info(const std::string& file, const PictureInfo& info) {
  print_line("image", file);
  print_line("size", fmt::format("{} x {} pixels", info.width, info.height));
  print_line("layers", layers_text(info));
  if (!info.render) {
    print_line("",
               "its header states neither samples nor error: Montelux did not render it, or the format has no header");
    return;
  }
  const RenderFacts& facts = *info.render;
  print_line("scene", facts.scene);
  print_line("by", fmt::format("integrator {}, sampler {}, seed {:.0f}; Montelux {}", facts.integrator, facts.sampler,
                               facts.seed.value_or(0), facts.version));
  print_line("samples", samples_text(info, facts));
  print_mean(facts);
  print_error(facts);
  print_bias(facts);
  if (facts.seconds) print_line("time", time_text(*facts.seconds));
}

void print_picture_info_json(const std::string& file, const PictureInfo& info) {
  Json json{{"image", file}, {"width", info.width}, {"height", info.height}};
  json["layers"] = Json::array();
  for (const LayerChannels& layer : info.layers)
    json["layers"].push_back({{"name", layer.name}, {"channels", layer.channels}});
  json["rendered"] = info.render.has_value();
  if (info.render) {
    const RenderFacts& facts = *info.render;
    json.update(mean_json(facts));
    json["relative_mse"] = facts.error ? Json(facts.error->relative_mse) : Json();
    json["relative_mse_range"] = facts.error ? Json{facts.error->low, facts.error->high} : Json();
    json["unsure_error"] = facts.error && facts.error->is_unsure;
    json["interval_confidence"] = number_or_null(facts.interval_confidence);
    json["measured_bias"] = nullptr;
    if (facts.bias)
      json["measured_bias"] = {{"mean", facts.bias->mean}, {"standard_error", facts.bias->standard_error}};
  }
  json["header"] = Json::object();
  for (const Attribute& entry : info.header)
    std::visit([&](const auto& value) { json["header"][entry.name] = value; }, entry.value);
  fmt::print("{}\n", json_text(std::move(json), 2));
}

}  // namespace montelux::cli
