#include "api/picture_info.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "api/images.h"
#include "film/picture_error.h"

namespace montelux {

namespace {

constexpr std::string_view prefix = "montelux:";

// The entries of a header, by name.
class Header {
 public:
  explicit Header(const std::vector<Attribute>& entries) : entries_(entries) {}

  std::string text(std::string_view name) const {
    const Attribute* entry = find(name);
    const auto* value = entry ? std::get_if<std::string>(&entry->value) : nullptr;
    return value ? *value : std::string();
  }
  // A finite one.
  std::optional<double> number(std::string_view name) const {
    const Attribute* entry = find(name);
    if (!entry || std::holds_alternative<std::string>(entry->value)) return std::nullopt;
    const double value = std::visit(
        [](const auto& x) {
          if constexpr (requires { double(x); }) return double(x);
          return 0.0;
        },
        entry->value);
    return std::isfinite(value) ? std::optional(value) : std::nullopt;
  }
  std::optional<std::array<double, 3>> rgb(std::string_view name) const {
    std::array<double, 3> values{};
    for (std::size_t c = 0; c < 3; ++c) {
      const std::optional<double> value = number(fmt::format("{}{}", name, "RGB"[c]));
      if (!value) return std::nullopt;
      values[c] = *value;
    }
    return values;
  }

 private:
  const Attribute* find(std::string_view name) const {
    const auto found = std::ranges::find(entries_, name, &Attribute::name);
    return found == entries_.end() ? nullptr : &*found;
  }
  const std::vector<Attribute>& entries_;
};

std::vector<LayerChannels> layers_of(const std::vector<std::string>& channels) {
  std::vector<LayerChannels> layers;
  for (const std::string& channel : channels) {
    const std::size_t dot = channel.rfind('.');
    const std::string name = dot == std::string::npos ? "" : channel.substr(0, dot);
    auto layer = std::ranges::find(layers, name, &LayerChannels::name);
    if (layer == layers.end()) layer = layers.insert(layers.end(), {name, {}});
    layer->channels.push_back(dot == std::string::npos ? channel : channel.substr(dot + 1));
  }
  return layers;
}

std::optional<SampleCounts> samples_of(const PixelBuffer& image) {
  const std::optional<int> channel = find_channel(image, "samples");
  if (!channel || image.pixel_count() == 0) return std::nullopt;
  SampleCounts counts{std::numeric_limits<double>::infinity()};
  for (std::size_t i = 0; i < image.pixel_count(); ++i) {
    const auto n = double(image.values[i * image.channels.size() + std::size_t(*channel)]);
    counts.min = std::min(counts.min, n), counts.max = std::max(counts.max, n);
    counts.mean += n / double(image.pixel_count());
  }
  return counts;
}

std::optional<MeanOfFile> mean_of(const Header& header, double confidence) {
  const auto mean = header.rgb("mean");
  if (!mean) return std::nullopt;
  MeanOfFile known{*mean, header.rgb("meanStandardError"), {}};
  const std::optional<double> passes = header.number("passes");
  if (!known.standard_error || !passes || *passes < 2) return known;
  const auto chance_light = header.rgb("meanChanceLight").value_or(std::array<double, 3>{});
  known.interval.emplace();
  for (std::size_t c = 0; c < 3; ++c)
    (*known.interval)[c] = interval_with_missing(
        confidence_interval((*mean)[c], (*known.standard_error)[c], *passes, confidence), chance_light[c], confidence);
  return known;
}

RenderFacts facts_of(const Header& header, double confidence) {
  RenderFacts facts;
  facts.version = header.text("version"), facts.scene = header.text("scene");
  facts.integrator = header.text("integrator"), facts.sampler = header.text("sampler");
  facts.biased_options = header.text("biasedOptions"), facts.missing_light = header.text("missingLight");
  facts.replaced = header.text("replaced"), facts.left_out = header.text("leftOut");
  facts.error_bar = header.text("errorBar"), facts.sparse = header.text("sparse");
  facts.target = header.text("targetError"), facts.target_reached = header.text("targetReached");
  facts.seed = header.number("seed"), facts.passes = header.number("passes");
  facts.samples_per_pass = header.number("samplesPerPass"), facts.non_finite = header.number("nonFinite");
  facts.seconds = header.number("renderSeconds");
  facts.interval_confidence = header.number("intervalConfidence");
  facts.mean = mean_of(header, confidence);
  const auto bias = header.rgb("measuredBias"), error_of_bias = header.rgb("measuredBiasStandardError");
  if (bias && error_of_bias) facts.bias = BiasOfFile{*bias, *error_of_bias};
  const std::optional<double> error = header.number("estimatedRelativeMSE");
  const std::optional<double> low = header.number("estimatedRelativeMSELow");
  const std::optional<double> high = header.number("estimatedRelativeMSEHigh");
  if (error && low && high) facts.error = RelativeErrorOfFile{*error, *low, *high, !header.text("unsureError").empty()};
  facts.missing_by_chance = header.number("missingByChance");
  facts.denoiser = header.text("denoiser");
  facts.denoised_relative_mse = header.number("denoisedRelativeMSE");
  return facts;
}

}  // namespace

Result<PictureInfo> picture_info(const std::filesystem::path& file, double confidence) {
  const Result<Image> image = read_image(file);
  if (!image) return image.failure();
  PictureInfo info{
      image->pixels.width, image->pixels.height, layers_of(image->pixels.channels), samples_of(image->pixels), {}, {}};
  for (const Attribute& entry : image->attributes)
    if (entry.name.starts_with(prefix)) info.header.push_back({entry.name.substr(prefix.size()), entry.value});
  const Header header(info.header);
  if (!header.text("version").empty()) info.render = facts_of(header, confidence);
  return info;
}

}  // namespace montelux
