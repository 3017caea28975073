#include "integrator/path/media_paths.h"

#include "integrator/path/loop.h"

namespace montelux {

template <class Tally>
RayCounts trace_paths_in_media(const Scene& scene, const LightSet& lights, const Accel& rays,
                               const PathSettings& settings, const TilePass& pass, std::span<PixelSample> out,
                               Tally& tally) {
  return settings.lanes == Lanes::one
             ? trace_paths<float, true>(scene, lights, rays, settings, pass, out, tally)
             : trace_paths<NativeFloats, true>(scene, lights, rays, settings, pass, out, tally);
}

template RayCounts trace_paths_in_media(const Scene&, const LightSet&, const Accel&, const PathSettings&,
                                        const TilePass&, std::span<PixelSample>, const NoTally&);
template RayCounts trace_paths_in_media(const Scene&, const LightSet&, const Accel&, const PathSettings&,
                                        const TilePass&, std::span<PixelSample>, LayerTally&);
template RayCounts trace_paths_in_media(const Scene&, const LightSet&, const Accel&, const PathSettings&,
                                        const TilePass&, std::span<PixelSample>, PilotTally&);

}  // namespace montelux
