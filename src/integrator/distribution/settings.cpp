#include "integrator/distribution/settings.h"

#include <fmt/format.h>

#include <charconv>

#include "integrator/path/settings.h"

namespace montelux {

namespace {

// "16/4/1": whole numbers from `low` to 4096.
Result<std::vector<int>> read_counts(std::string_view name, const std::string& text, int low) {
  const auto wrong = [&] {
    return Failure{
        fmt::format("{} takes whole numbers from {} to 4096 by depth, such as 16/4/1; found \"{}\"", name, low, text)};
  };
  std::vector<int> counts;
  const char *at = text.data(), *end = at + text.size();
  for (;;) {
    int value = 0;
    const auto [next, error] = std::from_chars(at, end, value);
    if (error != std::errc{} || value < low || value > 4096) return wrong();
    counts.push_back(value);
    if (next == end) return counts;
    if (*next != '/' || counts.size() == 64) return wrong();
    at = next + 1;
  }
}

std::string counts_text(const std::vector<int>& counts) { return fmt::format("{}", fmt::join(counts, "/")); }

using S = DistributionSettings;
using Counts = std::vector<int> S::*;

// How a row of counts is read, and how its default is shown.
auto reader_of(std::string_view name, Counts place, int low) {
  return [=](const std::string& text, S& s) -> Status {
    auto counts = read_counts(name, text, low);
    if (!counts) return counts.failure();
    s.*place = *std::move(counts);
    return Done{};
  };
}
auto shown_by(Counts place) {
  return [=](const S& s) { return counts_text(s.*place); };
}

Fields<S> distribution_fields() {
  Fields<S> fields;
  fields
      .text("branching", "secondary rays at the 1st/2nd/... surface", reader_of("branching", &S::branching, 1),
            shown_by(&S::branching))
      .text("shadow-rays", "shadow rays at the 1st/2nd/... surface", reader_of("shadow-rays", &S::shadow_rays, 0),
            shown_by(&S::shadow_rays))
      .other(max_depth_spec());
  return fields;
}

}  // namespace

EntitySpec distribution_spec() {
  return {"distribution", "distribution ray tracing: many secondary rays at each surface",
          distribution_fields().specs({})};
}

Result<DistributionSettings> distribution_settings(const ParameterList& list, std::optional<int> max_depth) {
  DistributionSettings s;
  s.max_depth = max_depth;
  if (Status read = distribution_fields().read(list, s); !read) return read.failure();
  if (s.branching.back() > 1 && !s.max_depth)
    return Failure{fmt::format("branching {} never ends: its last number must be 1, or maxdepth must be set",
                               counts_text(s.branching))};
  return s;
}

}  // namespace montelux
