// What is known of a picture once its film is there: its errors and its header.
#include <fmt/format.h>

#include <algorithm>

#include "api/film_keeper.h"
#include "api/target_text.h"
#include "render/target_plan.h"

namespace montelux {

namespace {

// For a header, which has no lists.
std::string list_or_none(const std::vector<std::string>& all, std::string_view separator = "; ") {
  return all.empty() ? std::string("none") : fmt::format("{}", fmt::join(all, separator));
}

// Whether there are samples and each of them is zero. (A mean of zero of values that are not shows in m2.)
bool is_black(const Film& film) {
  const PixelBounds& b = film.bounds();
  bool sampled = false;
  for (int y = b.y0; y < b.y1; ++y)
    for (int x = b.x0; x < b.x1; ++x) {
      const PixelEstimate& pixel = film.pixel(x, y);
      sampled |= pixel.passes > 0;
      for (int c = 0; c < rgb_size; ++c)
        if (pixel.mean[c] != 0 || pixel.m2[c] != 0) return false;
    }
  return sampled;
}

double samples_per_pixel(const Film& film) {
  const PixelBounds& b = film.bounds();
  double samples = 0;
  for (int y = b.y0; y < b.y1; ++y)
    for (int x = b.x0; x < b.x1; ++x) samples += film.samples(x, y);
  return samples / b.area();
}

std::vector<Attribute> header_of(const PictureFacts& facts, const Rendering& rendering) {
  const RenderResult& result = rendering.result;
  std::vector<Attribute> header;
  auto add = [&](std::string name, std::variant<std::string, std::int32_t, float, double> value) {
    header.push_back({"montelux:" + std::move(name), std::move(value)});
  };
  add("version", version());
  add("scene", facts.scene);
  add("integrator", facts.integrator);
  if (facts.choice) add("chosenBy", "auto: " + to_text(*facts.choice));
  add("sampler", facts.sampler);
  add("seed", std::int32_t(facts.seed));
  add("samplesPerPass", std::int32_t(rendering.plan.samples_per_pass));
  const ImageEstimate& image = rendering.image;
  add("passes", std::int32_t(image.passes));
  add("nonFinite", std::int32_t(std::min<std::uint64_t>(result.film.non_finite(), 0x7fffffff)));
  add("biasedOptions", list_or_none(facts.biases, ", "));
  if (const auto bias = rendering.measured_bias)
    for (int c = 0; c < rgb_size; ++c) {
      add(fmt::format("measuredBias{}", "RGB"[c]), bias->mean[std::size_t(c)]);
      add(fmt::format("measuredBiasStandardError{}", "RGB"[c]), bias->standard_error[std::size_t(c)]);
    }
  add("display", std::string(content_names[std::size_t(facts.content)]));
  if (facts.shared_filters) add("filterSamples", std::string("shared"));
  add("exposure", std::string(facts.states_exposure ? "stated by the scene" : "not stated"));
  add("missingLight", list_or_none(facts.missing));
  std::vector<std::string> replaced;
  for (const Replacement& r : facts.replaced) replaced.push_back(to_text(r));
  add("replaced", list_or_none(replaced));
  add("leftOut", list_or_none(facts.left_out));
  const bool has_error_bar = rendering.has_error_bar();
  if (has_error_bar)
    add("errorBar", fmt::format("over {} independent passes", image.passes));
  else
    add("errorBar", std::string(rendering.found_no_light ? "none: no sample found light"
                                                         : "none: it takes two independent passes"));
  if (result.film.grid().stride > 1) add("sparse", sparse_text(result.film.grid().stride));
  if (const ErrorEstimate& error = rendering.error; error.whole() && !rendering.found_no_light) {
    add("estimatedMSE", error.mse);
    add("estimatedRelativeMSE", error.relative_mse);
    add("estimatedRelativeMSELow", error.relative_low);
    add("estimatedRelativeMSEHigh", error.relative_high);
    if (error.is_unsure()) add("unsureError", std::string("few bright samples determine the error"));
    if (error.may_miss_light()) add("missingByChance", error.missing_share(default_confidence));
  }
  if (const auto& target = rendering.target) {
    add("targetError", to_text(target->request.error));
    add("targetConfidence", target->request.error.confidence);
    add("targetReached", std::string(target->reached() ? "yes" : why_not_reached(*target)));
    if (target->state.is_known) add("targetErrorBound", target->state.bound);
  }
  for (int c = 0; c < rgb_size; ++c) {
    add(fmt::format("mean{}", "RGB"[c]), image.mean[c]);
    if (has_error_bar) add(fmt::format("meanStandardError{}", "RGB"[c]), image.standard_error[c]);
    if (has_error_bar && rendering.error.chance_share > 0)
      add(fmt::format("meanChanceLight{}", "RGB"[c]), rendering.error.chance_light[std::size_t(c)]);
  }
  // A file that must be the same in every run carries no times.
  if (auto date = date_attribute())
    header.push_back(*date);
  else
    add("renderSeconds", result.seconds);
  return header;
}

}  // namespace

std::string sparse_text(int stride) {
  return fmt::format("one pixel of each {0} x {0} is sampled, the others repeat it", stride);
}

Rendering rendering_of(PictureFacts facts, RenderResult result, const PassPlan& plan,
                       const std::optional<TargetJudge>& judge) {
  const ImageEstimate image = result.film.image();
  const ErrorEstimate error = result.film.error();
  Rendering rendering{std::move(result), {}, facts.notes, plan, facts.layers, 0, {}, image, error};
  rendering.found_no_light = facts.content == Content::light && is_black(rendering.result.film);
  rendering.measured_bias = estimate_bias(rendering.result.bias);
  if (facts.target) {
    const Film& film = rendering.result.film;
    rendering.target = TargetResult{*facts.target, judge->judge(film, facts.target->unbiased), samples_per_pixel(film),
                                    rendering.result.seconds};
  }
  rendering.header = header_of(facts, rendering);
  rendering.choice = std::move(facts.choice);
  rendering.missing = std::move(facts.missing), rendering.replaced = std::move(facts.replaced);
  rendering.left_out = std::move(facts.left_out);
  rendering.content = facts.content, rendering.has_own_exposure = facts.states_exposure;
  return rendering;
}

bool add_intervals(Rendering& rendering) {
  if (rendering.error.pixels == 0 || rendering.found_no_light) return false;
  rendering.intervals = pixel_intervals(rendering.result.film);
  rendering.header.push_back({"montelux:intervalConfidence", rendering.intervals->confidence});
  return true;
}

Rendering rendering_of(SavedFilm film) {
  BegunFilm& begun = film.begun;
  RenderResult result{std::move(begun.film), begun.rays, begun.seconds, false};
  result.bias = std::move(begun.bias), result.mixing = std::move(begun.mixing);
  const PassPlan plan{film.settings.samples_per_pass, result.film.image().passes};
  film.facts.target = film.options.target;
  const Result<LayerRequest> layers = parse_layers(film.settings.layers);
  std::optional<TargetJudge> judge;
  if (film.facts.target) judge = judge_of(film.facts.target->error, 0);
  Rendering rendering = rendering_of(std::move(film.facts), std::move(result), plan, judge);
  if (layers && layers->intervals) add_intervals(rendering);
  return rendering;
}

std::optional<Interval> Rendering::interval_of_mean(int channel, double confidence) const {
  if (!has_error_bar()) return std::nullopt;
  return interval_with_missing(
      confidence_interval(image.mean[channel], image.standard_error[channel], image.passes, confidence),
      error.chance_light[std::size_t(channel)], confidence);
}

}  // namespace montelux
