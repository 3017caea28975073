#include "integrator/irradiance_cache/integrator.h"

#include "integrator/irradiance_cache/bias_pairs.h"
#include "integrator/irradiance_cache/filling.h"

namespace montelux {

namespace {

template <class F>
class IrradianceCacheSeries final : public FrameSeries {
 public:
  using Filling = CacheFilling<F, Accel>;
  // What is referred to must outlive the series.
  IrradianceCacheSeries(const Scene& scene, const Accel& accel, const IrradianceCacheSettings& settings,
                        const SeriesPass& pass)
      : scene_(scene), accel_(accel), settings_(settings), filling_(scene, accel, settings, pass) {}

  std::optional<std::size_t> units(const SeriesStep& step) const override {
    return step.stage < Filling::stages ? filling_.units(step.frame, step.stage) : std::nullopt;
  }
  RayCounts run_unit(const SeriesStep& step, std::size_t unit) override {
    return filling_.run_unit(step.frame, step.stage, unit);
  }
  RayCounts run(const SeriesStep& step, const PixelBounds& tile, std::span<PixelSample> out) override {
    if (step.stage < Filling::stages) return filling_.run(step.frame, step.stage, tile);
    return show(step.frame, tile, out, no_tally);
  }
  RayCounts run_layers(const SeriesStep& step, const PixelBounds& tile, std::span<PixelSample> out,
                       std::span<ExactRgb> sums) override {
    if (step.stage < Filling::stages) return run(step, tile, out);
    LayerTally tally(*filling_.pass().layers, 1, sums);
    return show(step.frame, tile, out, tally);
  }
  std::optional<MeanDifference> measured_bias() override { return pairs_.take(); }

 private:
  template <class Tally>
  RayCounts show(int frame, const PixelBounds& tile, std::span<PixelSample> out, Tally& tally) {
    if (frame == 0) return {};
    const TilePass pass = filling_.request(frame, tile);
    FirstHits<F> starts(scene_, accel_, pass, out, tally);
    const PathSettings& settings = filling_.path();
    const std::vector<std::uint8_t> compared = BiasPairs::choose(filling_.pass().points, frame, tile, settings_.pairs);
    CachedPaths<F, FirstHits<F>> paths(starts, filling_.cache(), out.size(), settings.max_depth.has_value(), compared,
                                       Tally::records);
    RayCounts counts = run_cache_paths<F>(scene_, accel_, settings, pass, out, paths, tally);
    counts.camera += starts.rays();
    filling_.miss(tile, std::move(paths.missed()));
    pairs_.count(compared);
    const HemisphereStrata strata = BiasPairs::strata();
    HemispherePaths<F, Accel> unbiased(scene_, accel_, settings, strata,
                                       {hemisphere_points(filling_.pass().points, frame, 1, strata)}, counts);
    pairs_.compare(paths.cached(), unbiased);
    return counts;
  }

  const Scene& scene_;
  const Accel& accel_;
  const IrradianceCacheSettings& settings_;
  Filling filling_;
  BiasPairs pairs_;
};

}  // namespace

int IrradianceCacheIntegrator::stages() const { return CacheFilling<float, Accel>::stages + 1; }

std::unique_ptr<FrameSeries> IrradianceCacheIntegrator::begin(const SeriesPass& pass) const {
  if (settings_.lanes == Lanes::one)
    return std::make_unique<IrradianceCacheSeries<float>>(scene_, accel_, settings_, pass);
  return std::make_unique<IrradianceCacheSeries<NativeFloats>>(scene_, accel_, settings_, pass);
}

}  // namespace montelux
