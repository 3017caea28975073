#include "picture_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "api/json_text.h"
#include "api/target_text.h"
#include "denoise_output.h"
#include "display_json.h"
#include "progress.h"
#include "shortcomings.h"

namespace montelux::cli {

namespace {

using Json = nlohmann::ordered_json;

// The values of one channel each; what is not finite (an error that is not known) is null.
template <std::size_t n>
Json to_json(const double (&values)[n]) {
  Json list = Json::array();
  for (double value : values) list.push_back(std::isfinite(value) ? Json(value) : Json());
  return list;
}

Json number_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json nulls() { return Json::array({nullptr, nullptr, nullptr}); }

constexpr double confidence = default_confidence;

// The interval of each channel of the picture's mean, with its confidence; null where there is no error bar.
Json interval_to_json(const Rendering& rendering) {
  Json low = Json::array(), high = Json::array();
  for (int c = 0; c < rgb_size; ++c) {
    const std::optional<Interval> interval = rendering.interval_of_mean(c, confidence);
    if (!interval) return Json();
    low.push_back(interval->low), high.push_back(interval->high);
  }
  return {{"confidence", confidence}, {"low", low}, {"high", high}};
}

// Of the pixels of the picture, those that have samples; below 1 where time did not allow for all.
double sampled_share(const Rendering& rendering) {
  const Film& film = rendering.result.film;
  const PixelBounds& b = film.bounds();
  double sampled = 0;
  for (int y = b.y0; y < b.y1; ++y)
    for (int x = b.x0; x < b.x1; ++x) sampled += film.samples(x, y) > 0;
  return sampled / b.area();
}

// The mean of each layer over the picture.
Json layers_to_json(const Rendering& rendering) {
  const LayerFilm& film = *rendering.result.film.layers();
  const PixelBounds& b = rendering.result.film.grid().cells();
  Json json = Json::object();
  const std::vector<std::string> names = layer_names(*rendering.layers);
  for (int i = 0; i < film.count(); ++i) {
    double mean[rgb_size] = {};
    for (int c = 0; c < rgb_size; ++c) {
      for (int y = b.y0; y < b.y1; ++y)
        for (int x = b.x0; x < b.x1; ++x) mean[c] += film.layer_mean(x, y, i, c);
      mean[c] /= double(b.area());
    }
    json[names[std::size_t(i)]] = to_json(mean);
  }
  return json;
}

std::string header_text(const Rendering& rendering, std::string_view name) {
  for (const Attribute& attribute : rendering.header)
    if (attribute.name == name)
      if (auto* text = std::get_if<std::string>(&attribute.value)) return *text;
  return {};
}

void print_bias(const BiasEstimate& bias) {
  std::string line = "bias    ";
  for (std::size_t c = 0; c < bias.mean.size(); ++c)
    line += fmt::format(" {} {:.2g} ± {:.1g}", "RGB"[c], bias.mean[c], bias.standard_error[c]);
  fmt::print("{} of the mean, as measured\n", line);
}

// The mean of the picture with its standard error, and with its interval.
void print_mean(const Rendering& rendering) {
  if (rendering.image.passes == 0) {
    fmt::print("mean     -\n");
    return;
  }
  std::string mean = "mean    ", interval = fmt::format("         {:.0f} %:", 100 * confidence);
  for (int c = 0; c < rgb_size; ++c) {
    mean += fmt::format(" {} {:.6g}", "RGB"[c], rendering.image.mean[c]);
    if (const auto range = rendering.interval_of_mean(c, confidence)) {
      mean += fmt::format(" ± {:.2g}", rendering.image.standard_error[c]);
      interval += fmt::format(" {} {:.6g} to {:.6g}", "RGB"[c], (*range).low, (*range).high);
    }
  }
  fmt::print("{}\n", mean);
  if (rendering.has_error_bar()) fmt::print("{}\n", interval);
}

// A range of numbers, or of times.
template <class Text>
std::string range_text(const TargetResult& target, double (TargetResult::*more)(double) const, Text text) {
  const auto of = [&](double work) { return text((target.*more)(work)); };
  return fmt::format("{} ({} to {})", of(target.state.work), of(target.state.work_low), of(target.state.work_high));
}

std::string target_line(const TargetResult& target) {
  const TargetState& state = target.state;
  const ErrorTarget& error = target.request.error;
  const std::string text = to_text(error), sure = fmt::format("{:.4g} %", 100 * error.confidence);
  if (target.reached())
    return fmt::format("{} reached: with {} confidence the error is at most {:.3g} %", text, sure, 100 * state.bound);
  if (!state.is_known) return fmt::format("{} {}", text, why_not_reached(target));
  std::string line =
      fmt::format("{} not reached: with {} confidence the error is at most {:.3g} %", text, sure, 100 * state.bound);
  if (std::isfinite(state.work_high))
    line += fmt::format("\n         it takes about {} samples per pixel more, {}",
                        range_text(target, &TargetResult::more_samples, [](double n) { return count_text(n); }),
                        range_text(target, &TargetResult::more_seconds, time_text));
  return line;
}

Json target_json(const TargetResult& target) {
  const TargetState& state = target.state;
  const auto range = [&](double (TargetResult::*more)(double) const) {
    return state.is_known
               ? Json{number_or_null((target.*more)(state.work_low)), number_or_null((target.*more)(state.work_high))}
               : Json();
  };
  const auto value = [&](double number) { return state.is_known ? number_or_null(number) : Json(); };
  return {{"request", to_text(target.request.error)},
          {"confidence", target.request.error.confidence},
          {"unbiased", target.request.unbiased},
          {"reached", target.reached()},
          {"error", value(state.error)},
          {"bound", value(state.bound)},
          {"samples_needed", value(target.more_samples(state.work))},
          {"samples_needed_range", range(&TargetResult::more_samples)},
          {"seconds_needed", value(target.more_seconds(state.work))},
          {"seconds_needed_range", range(&TargetResult::more_seconds)}};
}

Json choice_json(const AutomaticChoice& choice) {
  Json ratios = Json::array();
  for (const auto& r : choice.ratios)
    ratios.push_back({{"integrator", r.integrator},
                      {"efficiency", number_or_null(r.ratio)},
                      {"interval", {number_or_null(r.low), number_or_null(r.high)}}});
  return {
      {"integrator", choice.integrator}, {"reason", choice.reason}, {"pilots", choice.share}, {"candidates", ratios}};
}

// The error of a pixel; never that of a part of the picture.
std::string error_line(const Rendering& rendering) {
  const ErrorEstimate& error = rendering.error;
  if (rendering.found_no_light) return "unknown: no sample found light";
  if (!rendering.has_pixel_error()) return "unknown: it takes two independent passes of every pixel";
  std::string line = fmt::format("{} per pixel (root mean square of the relative errors)", error_text(error));
  if (error.is_unsure())
    line += fmt::format("; few bright samples determine it: {:.3g} to {:.3g} %", 100 * std::sqrt(error.relative_low),
                        100 * std::sqrt(error.relative_high));
  if (error.may_miss_light()) line += "\n         " + missing_text(error.missing_share(confidence));
  return line;
}

Json mixing_json(const MixingFigures& mixing) {
  const auto known = [](const std::optional<double>& x) { return x ? number_or_null(*x) : Json(); };
  return {{"chains", mixing.chains},
          {"steps", mixing.steps},
          {"large_step_acceptance", known(mixing.large_acceptance())},
          {"small_step_acceptance", known(mixing.small_acceptance())},
          {"autocorrelation_time", known(mixing.autocorrelation_time())},
          {"effective_samples", known(mixing.effective_samples())}};
}

// How the Markov chains have moved.
void print_mixing(const MixingFigures& mixing) {
  std::string accepted;
  const auto add = [&](const std::optional<double>& share, const char* steps) {
    if (share) accepted += fmt::format("{}{:.3g} % of {}", accepted.empty() ? "" : " and ", 100 * *share, steps);
  };
  add(mixing.large_acceptance(), "large"), add(mixing.small_acceptance(), "small");
  fmt::print("mixing   {} Markov chains with {:.4g} steps each; accepted {} steps\n", mixing.chains,
             double(mixing.steps) / double(mixing.chains), accepted);
  if (const auto time = mixing.autocorrelation_time())
    fmt::print("         autocorrelation {:.3g} steps: {} steps are worth {} independent ones\n", *time,
               count_text(double(mixing.steps)), count_text(mixing.effective_samples().value_or(0)));
}

}  // namespace

std::string missing_text(double share) {
  return fmt::format(
      "up to {} may be missing: light that paths meet by chance (vcm and sppm look for it in other ways)",
      share < 1 ? fmt::format("{:.2g} % of the mean", 100 * share) : fmt::format("{:.2g} times the mean", share));
}

Outcome outcome_of(const Rendering& rendering) {
  const RenderResult& result = rendering.result;
  const PixelBounds& b = result.film.bounds();
  Outcome outcome{rendering.image, rendering.error, 0, result.rays.all(), result.film.non_finite()};
  for (int y = b.y0; y < b.y1; ++y)
    for (int x = b.x0; x < b.x1; ++x) outcome.samples += result.film.samples(x, y);
  return outcome;
}

void print_picture_json(const PictureReport& report, const Rendering& rendering) {
  const Outcome outcome = outcome_of(rendering);
  const double seconds = rendering.result.seconds;
  const bool known = rendering.has_pixel_error();
  Json json;
  json["version"] = version();
  json["scene"] = report.scene;
  json["files"] = report.files;
  if (report.film) json["film"] = *report.film;
  json["interrupted"] = rendering.result.interrupted;
  json["seed"] = report.seed;
  if (report.frame) {
    json["frame"] = *report.frame;
    json["shutter"] = {report.shutter->open, report.shutter->close};
  }
  json["mean"] = outcome.image.passes > 0 ? to_json(outcome.image.mean) : nulls();
  json["standard_error"] = rendering.has_error_bar() ? to_json(outcome.image.standard_error) : nulls();
  json["interval_of_mean"] = interval_to_json(rendering);
  json["mse"] = known ? number_or_null(outcome.error.mse) : Json();
  json["relative_mse"] = known ? number_or_null(outcome.error.relative_mse) : Json();
  json["relative_mse_range"] =
      known ? Json{number_or_null(outcome.error.relative_low), number_or_null(outcome.error.relative_high)} : Json();
  json["tail_index"] = known ? number_or_null(outcome.error.tail_index) : Json();
  json["unsure_error"] = known && outcome.error.is_unsure();
  json["missing_by_chance"] = known ? number_or_null(outcome.error.missing_share(confidence)) : Json();
  if (rendering.choice) json["choice"] = choice_json(*rendering.choice);
  if (rendering.target) json["target"] = target_json(*rendering.target);
  if (rendering.denoised) json["denoised"] = denoising_json<Json>(rendering.denoised->estimate);
  json["sampled_pixels"] = sampled_share(rendering);
  json["passes"] = outcome.image.passes;
  json["samples_per_pass"] = rendering.plan.samples_per_pass;
  json["samples"] = outcome.samples;
  json["error_bar"] = rendering.has_error_bar();
  json["seconds"] = seconds;
  if (report.budget) {
    json["budget"] = *report.budget;
    json["over_budget"] = seconds > *report.budget;
  }
  if (report.frame) json["history_bytes"] = rendering.history_bytes;
  json["rays"] = outcome.rays;
  if (rendering.result.rays.by_depth[0] > 0) json["rays_by_depth"] = rendering.result.rays.by_depth;
  json["rays_per_second"] = number_or_null(double(outcome.rays) / seconds);
  json["non_finite"] = outcome.non_finite;
  if (rendering.layers) json["layers"] = layers_to_json(rendering);
  json["biased_options"] = header_text(rendering, "montelux:biasedOptions");
  if (!rendering.result.mixing.empty()) json["mixing"] = mixing_json(sum_of(rendering.result.mixing));
  if (const auto& bias = rendering.measured_bias)
    json["measured_bias"] = {{"mean", bias->mean}, {"standard_error", bias->standard_error}, {"passes", bias->passes}};
  if (report.display) json["display"] = display_json<Json>(*report.display);
  add_to(json, {rendering.missing, rendering.replaced, rendering.left_out});
  // A line for each frame of a sequence.
  fmt::print("{}\n", json_text(std::move(json), report.frame ? -1 : 2));
}

void print_picture_text(const PictureReport& report, const Rendering& rendering) {
  const Outcome outcome = outcome_of(rendering);
  const double seconds = std::max(rendering.result.seconds, 1e-9);
  const int k = rendering.plan.samples_per_pass, passes = outcome.image.passes;
  for (const std::string& file : report.files) fmt::print("image    {}\n", file);
  if (report.film) fmt::print("film     {}\n", *report.film);
  print_mean(rendering);
  if (rendering.measured_bias) print_bias(*rendering.measured_bias);
  fmt::print("error    {}\n", error_line(rendering));
  if (rendering.choice) fmt::print("chosen   {}\n", to_text(*rendering.choice));
  if (rendering.target) fmt::print("target   {}\n", target_line(*rendering.target));
  if (rendering.denoised) fmt::print("denoised {}\n", denoising_text(rendering.denoised->estimate));
  if (!rendering.result.mixing.empty()) print_mixing(sum_of(rendering.result.mixing));
  if (outcome.non_finite > 0) fmt::print("not finite {} samples, excluded from the mean\n", outcome.non_finite);
  print_text(Shortcomings{rendering.missing, rendering.replaced, rendering.left_out}, 9);
  const double pixels = rendering.result.film.bounds().area(), share = sampled_share(rendering);
  std::size_t max_passes = 0;
  for (const auto& [index, tile] : rendering.result.film.tiles()) max_passes = std::max(max_passes, tile.passes.size());
  const std::string passes_text =
      max_passes > std::size_t(passes) ? fmt::format("{} to {}", passes, max_passes) : fmt::format("{}", passes);
  fmt::print("samples  {:.3g} per pixel ({} passes of {}), {} in all\n", outcome.samples / pixels, passes_text, k,
             count_text(outcome.samples));
  if (share < 1) fmt::print("         {:.3g} % of the pixels have samples\n", 100 * share);
  fmt::print("time     {}, {}, {}{}\n", time_text(seconds), count_text(outcome.samples / seconds, "samples/s"),
             count_text(double(outcome.rays) / seconds, "rays/s"),
             report.budget && seconds > *report.budget
                 ? fmt::format(", over the budget of {}", time_text(*report.budget))
                 : "");
}

}  // namespace montelux::cli
