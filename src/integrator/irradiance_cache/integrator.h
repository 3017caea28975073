// Irradiance caching: indirect light at diffuse surfaces changes slowly, and is interpolated between records (Ward,
// Rubinstein and Clear 1988).
#pragma once
#include "accel/accel.h"
#include "integrator/integrator.h"
#include "integrator/irradiance_cache/settings.h"
#include "scene/scene.h"

namespace montelux {

// A series fills a cache of its own in its first frame, which is not shown. Every other frame follows a path from each
// pixel as `path` does, to the first diffuse surface where the cache has a record; there it takes the indirect light
// from the cache, and ends.
class IrradianceCacheIntegrator final : public CoupledIntegrator {
 public:
  // Scene and accel must outlive the integrator, and the integrator its series. The spacings of the settings are not
  // zero, and no surface moves.
  IrradianceCacheIntegrator(const Scene& scene, const Accel& accel, const IrradianceCacheSettings& settings)
      : scene_(scene), accel_(accel), settings_(settings) {}

  int frames() const override { return settings_.frames; }
  int warm_up() const override { return 1; }
  int stages() const override;
  bool has_layers() const override { return true; }
  std::unique_ptr<FrameSeries> begin(const SeriesPass& pass) const override;

 private:
  const Scene& scene_;
  const Accel& accel_;
  const IrradianceCacheSettings settings_;
};

}  // namespace montelux
