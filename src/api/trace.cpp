#include "api/trace.h"

#include <fmt/format.h>

#include <cmath>
#include <map>

#include "api/film_keeper.h"
#include "api/render_plan.h"
#include "render/shared_samples.h"

namespace montelux {

namespace {

// The numbers of the passes that a pixel has: in the saved film, or in the plan.
std::vector<int> passes_of_pixel(const PassPlan& plan, const SavedFilm* film, int x, int y) {
  std::vector<int> numbers;
  if (!film) {
    for (int i = 0; i < plan.passes; ++i) numbers.push_back(plan.first_pass + i);
    return numbers;
  }
  for (const auto& [index, tile] : film->begun.film.tiles()) {
    const PixelBounds& b = tile.cells;
    if (x >= b.x0 && y >= b.y0 && x < b.x1 && y < b.y1) numbers = film->begun.film.pass_numbers(b);
  }
  return numbers;
}

}  // namespace

Result<SampleTrace> trace_sample(const LoadedScene& scene, const RenderOptions& options, int x, int y,
                                 std::optional<int> sample) {
  const LoadedScene::Parts& parts = scene.parts();
  Result<RenderPlan> planned = plan_render(parts, options);
  if (!planned) return planned.failure();
  const RenderPlan& plan = *planned;
  if (options.resume)
    if (Status good = check_continues(*options.resume, description_of(parts, plan, options)); !good)
      return good.failure();
  const ImageSettings& image = plan.settings.image;
  const PixelBounds& b = image.bounds;
  if (x < b.x0 || y < b.y0 || x >= b.x1 || y >= b.y1)
    return Failure{fmt::format("pixel {},{} is outside of the picture, whose pixels are {},{} to {},{}", x, y, b.x0,
                               b.y0, b.x1 - 1, b.y1 - 1)};
  const std::vector<int> passes = passes_of_pixel(plan.settings.plan, options.resume, x, y);
  if (passes.empty()) return Failure{fmt::format("the saved film has no samples of pixel {},{} yet", x, y)};
  const int in_pass = plan.settings.plan.samples_per_pass, all = in_pass * int(passes.size());
  const auto pass_of = [&](int number) { return passes[std::size_t(number / in_pass)]; };
  if (sample && (*sample < 0 || *sample >= all))
    return Failure{fmt::format("the pixel has samples 0 to {}; found {}", all - 1, *sample)};
  std::map<int, SharedSamples> shared;  // by pass
  const auto trace = [&](int number) -> std::optional<TracedPath> {
    TilePass pass{{x, y, x + 1, y + 1}, image.points(pass_of(number), in_pass), image.shutter};
    pass.only = std::uint32_t(number % in_pass);
    if (filters_share_samples(image, plan.chosen.any()))
      pass.offsets =
          shared.try_emplace(pass_of(number), *image.sharing, pass.tile, pass.points).first->second.offsets();
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
  result.pass = pass_of(result.sample), result.index = result.sample % in_pass;
  result.materials = parts.info.materials_by_number;
  for (std::uint32_t i = 0; i < parts.scene.lights.count(); ++i)
    result.light_names.emplace_back(light_kind_names[std::size_t(parts.scene.lights.kind(LightId(i)))]);
  return result;
}

}  // namespace montelux
