#include "integrator/light_tracing/integrator.h"

#include "integrator/light_tracing/loop.h"

namespace montelux {

namespace {

class LightTracingSeries final : public FrameSeries {
 public:
  // What `shared` refers to must outlive the series.
  LightTracingSeries(const Scene& scene, const Accel& accel, const LightTracingSettings& settings,
                     const std::optional<AliasTable>& by_power, const std::optional<LightMedia>& light_media,
                     const SeriesPass& pass)
      : scene_(scene),
        accel_(accel),
        settings_(settings),
        by_power_(by_power),
        light_media_(light_media),
        pass_(pass),
        one_sided_(has_one_sided_surfaces(scene)),
        plane_(pass.grid.value_or(PixelGrid{pass.bounds}), scene.filter, pass.layers) {}

  RayCounts run(const SeriesStep& step, const PixelBounds& tile, std::span<PixelSample> out) override {
    return run_layers(step, tile, out, {});
  }
  RayCounts run_layers(const SeriesStep& step, const PixelBounds& tile, std::span<PixelSample> out,
                       std::span<ExactRgb> sums) override {
    if (step.stage == 0)
      return settings_.lanes == Lanes::one ? follow<float>(step, tile) : follow<NativeFloats>(step, tile);
    plane_.take_tile(tile, out, sums);
    return {};
  }

 private:
  template <class F>
  RayCounts follow(const SeriesStep& step, const PixelBounds& tile) {
    if (!by_power_) return {};
    const LightTracingScene<Accel> shared{scene_,     accel_, settings_,
                                          *by_power_, pass_,  std::uint32_t(step.frame),
                                          one_sided_, plane_, light_media_ ? &*light_media_ : nullptr};
    if (scene_.has_participating_media()) return LightTracingLoop<F, Accel, AdjointCorrection, true>(shared).run(tile);
    return LightTracingLoop<F, Accel>(shared).run(tile);
  }

  const Scene& scene_;
  const Accel& accel_;
  const LightTracingSettings& settings_;
  const std::optional<AliasTable>& by_power_;
  const std::optional<LightMedia>& light_media_;
  const SeriesPass pass_;
  const bool one_sided_;
  SplatPlane plane_;
};

}  // namespace

LightTracer::LightTracer(const Scene& scene, const Accel& accel, const LightTracingSettings& settings)
    : scene_(scene), accel_(accel), settings_(settings) {
  if (scene.lights.count() > 0) by_power_ = scene.lights.by_power();
  light_media_ = light_media(scene, accel);
}

Result<std::unique_ptr<LightTracer>> LightTracer::make(const Scene& scene, const Accel& accel,
                                                       const LightTracingSettings& settings) {
  if (scene.pixel_centres)
    return Failure{
        "light cannot render this scene: its camera rays go through the centres of pixels alone (disablepixeljitter), "
        "where no path from a light arrives"};
  return std::unique_ptr<LightTracer>(new LightTracer(scene, accel, settings));
}

std::unique_ptr<FrameSeries> LightTracer::begin(const SeriesPass& pass) const {
  return std::make_unique<LightTracingSeries>(scene_, accel_, settings_, by_power_, light_media_, pass);
}

}  // namespace montelux
