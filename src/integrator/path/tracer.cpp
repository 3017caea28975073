#include "integrator/path/tracer.h"

#include <algorithm>
#include <cmath>

#include "integrator/compensated_lights.h"
#include "integrator/guiding/training.h"
#include "integrator/manifold/manifold_light.h"
#include "integrator/path/loop.h"
#include "integrator/path/media_paths.h"

namespace montelux {

PathTracer::PathTracer(const Scene& scene, const Accel& accel, const PathSettings& settings)
    : scene_(scene), accel_(accel), settings_(settings) {
  if (settings.light_selection && *settings.light_selection != scene.lights.settings().selection)
    own_lights_ = scene.lights.with(LightSettings{*settings.light_selection});
  auto compensated =
      settings.nee && settings.mis != PathMis::off ? compensated_lights(lights(), scene, accel) : std::nullopt;
  if (compensated)
    own_lights_ = std::move(compensated);
  else if (settings.mis == PathMis::automatic)
    settings_.mis = PathMis::power;
  if (settings.lamp_rays > 0 && !settings.lamp_pixels)
    settings_.lamp_pixels = LampPixels::of(scene, accel, settings.width, settings.height);
  if (settings.learned_selection || settings.sky_learning) {
    if (!settings.learned)
      settings_.learned = std::make_shared<LearnedLights>(learn_lights(scene, lights(), accel, settings_));
    if (settings_.learned->clusters) own_lights_ = lights().with(settings_.learned->clusters);
    if (settings_.learned->sky) own_lights_ = lights().with(settings_.learned->sky);
  }
  if (settings.manifold > 0 && !settings.manifold_light)
    settings_.manifold_light = ManifoldLight::make(scene, accel, {settings.manifold, settings.manifold_roughness});
  if (settings.guiding && !settings.guide)
    settings_.guide = std::make_shared<GuideField>(train_guide(scene, lights(), accel, settings_));
  if (settings.roulette == PathRoulette::efficiency && !settings.survival)
    settings_.survival = std::make_shared<SurvivalMap>(run_pilot());
}

SurvivalMap PathTracer::run_pilot() const {
  // Without roulette, and so not without an end; what is deeper is rare and counts little.
  constexpr int deepest = 24, samples = 8, side = 4, tiles_in_block = 2;
  PathSettings plain = settings_;
  plain.roulette = PathRoulette::off, plain.lamp_rays = 0, plain.lamp_pixels = nullptr;
  plain.max_depth = std::min(settings_.max_depth.value_or(deepest), deepest);
  const PathTracer pilot(scene_, accel_, plain);
  const PilotBlocks blocks = PilotBlocks::of(settings_.width, settings_.height);
  const int width = std::max(settings_.width, 1), height = std::max(settings_.height, 1), block = 1 << blocks.bits;
  const RandomStream<float> places(0x3f84d5b5u, 0xb5470917u);
  std::vector<PilotPath> all;
  std::vector<PixelSample> out;
  for (int i = 0; i < blocks.count() * tiles_in_block; ++i) {
    const int b = i / tiles_in_block, x0 = b % blocks.across * block, y0 = b / blocks.across * block;
    // A block at the border may be cut off: its tiles move inside.
    const int x = std::min(x0 + int(places.at(std::uint32_t(2 * i)) * float(block)), std::max(width - side, 0));
    const int y = std::min(y0 + int(places.at(std::uint32_t(2 * i + 1)) * float(block)), std::max(height - side, 0));
    const PixelBounds tile{x, y, std::min(x + side, width), std::min(y + side, height)};
    const TilePass pass{tile, {PointSetKind::independent, 0x082efa98u, std::uint32_t(i), samples}};
    out.assign(std::size_t(tile.area()) * samples, {});
    std::vector<PilotPath> paths(out.size());
    PilotTally tally(paths);
    pilot.trace_with(pass, out, tally);
    for (std::size_t k = 0; k < paths.size(); ++k) {
      paths[k].light = PilotTally::mean_light(out[k].radiance);
      paths[k].block = b, paths[k].pixel = i * side * side + int(k) / samples;
      if (std::isfinite(paths[k].light)) all.push_back(std::move(paths[k]));
    }
  }
  return survival_from(all, blocks, settings_.roulette_depth);
}

template <class Tally>
RayCounts PathTracer::trace_with(const TilePass& pass, std::span<PixelSample> out, Tally& tally) const {
  if (settings_.guide) return trace_guided_paths(scene_, lights(), accel_, settings_, pass, out, tally);
  if (scene_.has_participating_media())
    return trace_paths_in_media(scene_, lights(), accel_, settings_, pass, out, tally);
  return settings_.lanes == Lanes::one
             ? trace_paths<float>(scene_, lights(), accel_, settings_, pass, out, tally)
             : trace_paths<NativeFloats>(scene_, lights(), accel_, settings_, pass, out, tally);
}

template class LayeredIntegrator<PathTracer>;

}  // namespace montelux
