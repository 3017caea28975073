#include "integrator/guiding/training.h"

#include "integrator/guiding/learner.h"
#include "integrator/guiding/rounds.h"
#include "integrator/path/loop.h"

namespace montelux {

template <class Tally>
RayCounts trace_guided_paths(const Scene& scene, const LightSet& lights, const Accel& rays,
                             const PathSettings& settings, const TilePass& pass, std::span<PixelSample> out,
                             Tally& tally) {
  const FieldGuide guide{*settings.guide};
  const bool one = settings.lanes == Lanes::one, media = scene.has_participating_media();
  if (media && one) return trace_paths<float, true>(scene, lights, rays, settings, pass, out, tally, guide);
  if (media) return trace_paths<NativeFloats, true>(scene, lights, rays, settings, pass, out, tally, guide);
  if (one) return trace_paths<float>(scene, lights, rays, settings, pass, out, tally, guide);
  return trace_paths<NativeFloats>(scene, lights, rays, settings, pass, out, tally, guide);
}

template RayCounts trace_guided_paths(const Scene&, const LightSet&, const Accel&, const PathSettings&, const TilePass&,
                                      std::span<PixelSample>, const NoTally&);
template RayCounts trace_guided_paths(const Scene&, const LightSet&, const Accel&, const PathSettings&, const TilePass&,
                                      std::span<PixelSample>, LayerTally&);
template RayCounts trace_guided_paths(const Scene&, const LightSet&, const Accel&, const PathSettings&, const TilePass&,
                                      std::span<PixelSample>, PilotTally&);

template RayCounts trace_guided_paths(const Scene&, const LightSet&, const Accel&, const PathSettings&, const TilePass&,
                                      std::span<PixelSample>, GuideTally&);

GuideField train_guide(const Scene& scene, const LightSet& lights, const Accel& rays, const PathSettings& settings) {
  constexpr double records_of_leaf = 2000;
  PathSettings own = for_training(settings);
  GuideLearner learner(places_of_paths(scene, lights, rays, own));
  const double paths = settings.guiding_paths;
  for_each_round(std::span(&paths, 1), [&](const TrainingRound& round) {
    if (round.before > 0) learner.refine(records_of_leaf);
    trace_round(scene, lights, rays, own, round, [&](const GuideRecord& r) { learner.add(r); });
    own.guide = std::make_shared<GuideField>(learner.field());
  });
  return *own.guide;
}

}  // namespace montelux
