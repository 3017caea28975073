#include "api/trace.h"

#include <fmt/format.h>

#include <cmath>

#include "api/render_plan.h"

namespace montelux {

Result<SampleTrace> trace_sample(const LoadedScene& scene, const RenderOptions& options, int x, int y,
                                 std::optional<int> sample) {
  const LoadedScene::Parts& parts = scene.parts();
  Result<RenderPlan> planned = plan_render(parts, options);
  if (!planned) return planned.failure();
  const RenderPlan& plan = *planned;
  const ImageSettings& image = plan.settings.image;
  const PassPlan& passes = plan.settings.plan;
  const PixelBounds& b = image.bounds;
  if (x < b.x0 || y < b.y0 || x >= b.x1 || y >= b.y1)
    return Failure{fmt::format("pixel {},{} is outside of the picture, whose pixels are {},{} to {},{}", x, y, b.x0,
                               b.y0, b.x1 - 1, b.y1 - 1)};
  const int in_pass = passes.samples_per_pass, all = passes.samples();
  if (sample && (*sample < 0 || *sample >= all))
    return Failure{fmt::format("the pixel has samples 0 to {}; found {}", all - 1, *sample)};
  const auto trace = [&](int number) -> std::optional<TracedPath> {
    TilePass pass{{x, y, x + 1, y + 1}, image.points(passes.first_pass + number / in_pass, in_pass), image.shutter};
    pass.only = std::uint32_t(number % in_pass);
    return plan.chosen.integrator ? plan.chosen.integrator->trace_path(pass) : std::nullopt;
  };
  if (!trace(0))
    return Failure{fmt::format("the integrator {} has no paths to show; {} have", plan.chosen.name,
                               listed(integrators_with(Ability::paths)))};
  SampleTrace result{
      x,  y,  0, all, 0, 0, image.seed, {}, plan.chosen.name, std::string(name_of(image.sampler)), plan.chosen.notes,
      {}, {}, {}};
  std::array<double, rgb_size> sum{};
  float largest = -1;
  for (int k = 0; k < all; ++k) {
    TracedPath path = *trace(k);
    for (int c = 0; c < rgb_size; ++c) sum[std::size_t(c)] += double(path.radiance.c[c]);
    const bool brightest = std::abs(luminance(path.radiance)) > largest;
    if (sample ? k != *sample : !brightest) continue;
    largest = std::abs(luminance(path.radiance));
    result.sample = k, result.path = std::move(path);
  }
  for (int c = 0; c < rgb_size; ++c) result.pixel_mean.c[c] = float(sum[std::size_t(c)] / all);
  result.pass = passes.first_pass + result.sample / in_pass, result.index = result.sample % in_pass;
  result.materials = parts.info.materials_by_number;
  for (std::uint32_t i = 0; i < parts.scene.lights.count(); ++i)
    result.light_names.emplace_back(light_kind_names[std::size_t(parts.scene.lights.kind(LightId(i)))]);
  return result;
}

}  // namespace montelux
