#include "integrator/bidirectional/vcm.h"

#include <algorithm>

#include "integrator/bidirectional/eye_subpaths.h"
#include "integrator/compensated_lights.h"
#include "integrator/photons/filling.h"
#include "integrator/photons/sppm.h"

namespace montelux {

namespace {

// Mergings count in the weights as this share of the paths from the lights. All mergings of a vertex share the path
// from the eye that leads there, so that they are worth less than as many connections; any share is unbiased. A tenth
// makes a wide radius cost little where connections do as well, and is enough where they do not.
constexpr float merging_share = 0.1f;

std::uint32_t light_paths_of(const VcmSettings& settings, const SeriesPass& pass) {
  const int pixels = pass.bounds.area();
  return std::uint32_t(std::max(settings.photons > 0 ? settings.photons : min_photons, pixels));
}

// `in_media`: the scene has participating media.
template <class F, bool in_media>
class VcmSeries final : public FrameSeries {
 public:
  // What is referred to must outlive the series.
  VcmSeries(const Scene& scene, const Accel& accel, const VcmSettings& settings,
            const std::optional<AliasTable>& by_power, const std::optional<LightSet>& compensated,
            const std::optional<LightMedia>& light_media, const SeriesPass& pass)
      : scene_(scene),
        accel_(accel),
        settings_(settings),
        by_power_(by_power),
        compensated_(compensated),
        light_media_(light_media),
        pass_(pass),
        one_sided_(has_one_sided_surfaces(scene)),
        light_paths_(light_paths_of(settings, pass)),
        map_(units_of_light_paths(light_paths_), true),
        plane_(pass.grid.value_or(PixelGrid{pass.bounds}), scene.filter, pass.layers),
        light_of_path_(pass.layers ? light_paths_ : 0) {}

  std::optional<std::size_t> units(const SeriesStep& step) const override {
    return step.stage < PhotonMap::stages ? std::optional(map_.units(step.stage)) : std::nullopt;
  }
  RayCounts run_unit(const SeriesStep& step, std::size_t unit) override {
    return map_.run_unit(step.stage, unit, radius(step.frame), [&](std::vector<Photon>& box) {
      return follow_light(frame_of(step.frame), light_path_part(unit, light_paths_), box);
    });
  }
  RayCounts run(const SeriesStep& step, const PixelBounds& tile, std::span<PixelSample> out) override {
    return run_layers(step, tile, out, {});
  }
  RayCounts run_layers(const SeriesStep& step, const PixelBounds& tile, std::span<PixelSample> out,
                       std::span<ExactRgb> sums) override {
    return follow_eye(frame_of(step.frame), tile, out, sums);
  }

 private:
  using Frame = BidirectionalFrame<Accel>;

  float radius(int frame) const { return float(sppm_radius(settings_.radius, settings_.alpha, frame)); }
  Frame frame_of(int frame) {
    const float r = radius(frame), merges = merging_share * pi * r * r * float(light_paths_);
    return {scene_,
            accel_,
            by_power_ ? &*by_power_ : nullptr,
            pass_,
            std::uint32_t(frame),
            shared_shutter_sample(scene_, pass_, frame),
            settings_.paths,
            StrategyWeights(settings_.paths.mis == BidirectionalMis::power, merges, settings_.paths.connect),
            one_sided_,
            plane_,
            light_paths_,
            light_media_ ? &*light_media_ : nullptr,
            &map_,
            settings_.kernel,
            light_of_path_.empty() ? nullptr : light_of_path_.data(),
            compensated_ ? &*compensated_ : nullptr};
  }

  RayCounts follow_light(const Frame& frame, const LightPathPart& part, std::vector<Photon>& box) {
    RayCounts counts;
    const float scale = 1 / float(light_paths_);
    const auto store = [&](const LightVertexView<F>& view, Mask<F> on) {
      const LightPathVertex<F>& v = view.vertex;
      const Spectrum<F> flux = v.path.flux * scale;
      // Vertices in media are not merged.
      for_each_lane(on & !v.at.in_medium, [&](int k) {
        box.push_back({lane(v.at.x.point.p, k),
                       lane(-v.at.d, k),
                       lane(v.at.x.point.ng, k),
                       lane(flux, k),
                       lane(v.path.depth, k),
                       lane(v.path.site.index, k),
                       {lane(view.weights.vcm, k), lane(view.weights.vm, k)}});
      });
    };
    follow_light_subpaths<F, AdjointCorrection, in_media>(
        frame, part.count, [&](std::uint32_t i) { return part.first + i; }, Splatting::on, counts, store);
    return counts;
  }

  RayCounts follow_eye(const Frame& frame, const PixelBounds& tile, std::span<PixelSample> out,
                       std::span<ExactRgb> sums) {
    RayCounts counts;
    LightVertices light(tile.area());
    if (settings_.paths.connect)
      light = light_vertices<F, AdjointCorrection, in_media>(frame, tile, Splatting::off, counts);
    std::fill(out.begin(), out.end(), PixelSample{});
    std::optional<LayerTally> tally;
    if (pass_.layers) tally.emplace(*pass_.layers, 1, sums);
    counts +=
        EyeSubpaths<F, Frame, AdjointCorrection, in_media>(frame, light, tally ? &*tally : nullptr).run(tile, out);
    plane_.take_tile(tile, out, sums);
    return counts;
  }

  const Scene& scene_;
  const Accel& accel_;
  const VcmSettings& settings_;
  const std::optional<AliasTable>& by_power_;
  const std::optional<LightSet>& compensated_;
  const std::optional<LightMedia>& light_media_;
  const SeriesPass pass_;
  const bool one_sided_;
  const std::uint32_t light_paths_;
  PhotonMap map_;
  SplatPlane plane_;
  std::vector<std::uint32_t> light_of_path_;
};

}  // namespace

VcmIntegrator::VcmIntegrator(const Scene& scene, const Accel& accel, const VcmSettings& settings)
    : scene_(scene), accel_(accel), settings_(settings) {
  if (scene.lights.count() > 0) by_power_ = scene.lights.by_power();
  if (settings.paths.connect) compensated_ = compensated_lights(scene.lights, scene, accel);
  light_media_ = light_media(scene, accel);
}

int VcmIntegrator::stages() const { return PhotonMap::stages + 1; }

std::unique_ptr<FrameSeries> VcmIntegrator::begin(const SeriesPass& pass) const {
  const auto make = [&]<class F, bool in_media>() -> std::unique_ptr<FrameSeries> {
    return std::make_unique<VcmSeries<F, in_media>>(scene_, accel_, settings_, by_power_, compensated_, light_media_,
                                                    pass);
  };
  const bool one = settings_.paths.lanes == Lanes::one;
  if (scene_.has_participating_media())
    return one ? make.template operator()<float, true>() : make.template operator()<NativeFloats, true>();
  return one ? make.template operator()<float, false>() : make.template operator()<NativeFloats, false>();
}

}  // namespace montelux
