#include "integrator/bidirectional/bdpt.h"

#include <algorithm>

#include "integrator/bidirectional/eye_subpaths.h"
#include "integrator/compensated_lights.h"

namespace montelux {

namespace {

// `in_media`: the scene has participating media.
template <class F, bool in_media>
class BdptSeries final : public FrameSeries {
 public:
  // What is referred to must outlive the series.
  BdptSeries(const Scene& scene, const Accel& accel, const BidirectionalPaths& paths,
             const std::optional<AliasTable>& by_power, const std::optional<LightSet>& compensated,
             const std::optional<LightMedia>& light_media, const SeriesPass& pass)
      : scene_(scene),
        accel_(accel),
        paths_(paths),
        by_power_(by_power),
        compensated_(compensated),
        light_media_(light_media),
        pass_(pass),
        one_sided_(has_one_sided_surfaces(scene)),
        plane_(pass.grid.value_or(PixelGrid{pass.bounds}), scene.filter, pass.layers),
        samples_(std::size_t(pass.bounds.area())),
        stride_(pass.layers ? std::size_t(pass.layers->count()) + 1 : 0),
        sums_(samples_.size() * stride_),
        light_of_path_(pass.layers ? samples_.size() : 0) {}

  RayCounts run(const SeriesStep& step, const PixelBounds& tile, std::span<PixelSample> out) override {
    return run_layers(step, tile, out, {});
  }
  RayCounts run_layers(const SeriesStep& step, const PixelBounds& tile, std::span<PixelSample> out,
                       std::span<ExactRgb> sums) override {
    if (step.stage == 0) return follow(step, tile);
    const auto row = std::size_t(tile.width());
    for (std::size_t y = 0; y < std::size_t(tile.height()); ++y) {
      const std::size_t first = pixel_number(tile.x0, tile.y0 + int(y));
      std::ranges::copy(std::span(samples_).subspan(first, row), out.begin() + std::ptrdiff_t(y * row));
      std::ranges::copy(std::span(sums_).subspan(first * stride_, row * stride_),
                        sums.begin() + std::ptrdiff_t(y * row * stride_));
    }
    plane_.take_tile(tile, out, sums);
    return {};
  }

 private:
  std::size_t pixel_number(int x, int y) const {
    return std::size_t(y - pass_.bounds.y0) * std::size_t(pass_.bounds.width()) + std::size_t(x - pass_.bounds.x0);
  }
  RayCounts follow(const SeriesStep& step, const PixelBounds& tile) {
    using Frame = BidirectionalFrame<Accel>;
    const Frame frame{scene_,
                      accel_,
                      by_power_ ? &*by_power_ : nullptr,
                      pass_,
                      std::uint32_t(step.frame),
                      {},
                      paths_,
                      StrategyWeights(paths_.mis == BidirectionalMis::power),
                      one_sided_,
                      plane_,
                      std::uint32_t(pass_.bounds.area()),
                      light_media_ ? &*light_media_ : nullptr,
                      nullptr,
                      PhotonKernel::epanechnikov,
                      light_of_path_.empty() ? nullptr : light_of_path_.data(),
                      compensated_ ? &*compensated_ : nullptr};
    RayCounts counts;
    const LightVertices light = light_vertices<F, AdjointCorrection, in_media>(frame, tile, Splatting::on, counts);
    std::vector<PixelSample> samples(std::size_t(tile.area()));
    std::vector<ExactRgb> sums(samples.size() * stride_);
    std::optional<LayerTally> tally;
    if (pass_.layers) tally.emplace(*pass_.layers, 1, sums);
    counts +=
        EyeSubpaths<F, Frame, AdjointCorrection, in_media>(frame, light, tally ? &*tally : nullptr).run(tile, samples);
    const auto row = std::size_t(tile.width());
    for (std::size_t y = 0; y < std::size_t(tile.height()); ++y) {
      const std::size_t first = pixel_number(tile.x0, tile.y0 + int(y));
      std::ranges::copy(std::span(samples).subspan(y * row, row), samples_.begin() + std::ptrdiff_t(first));
      std::ranges::copy(std::span(sums).subspan(y * row * stride_, row * stride_),
                        sums_.begin() + std::ptrdiff_t(first * stride_));
    }
    return counts;
  }

  const Scene& scene_;
  const Accel& accel_;
  const BidirectionalPaths& paths_;
  const std::optional<AliasTable>& by_power_;
  const std::optional<LightSet>& compensated_;
  const std::optional<LightMedia>& light_media_;
  const SeriesPass pass_;
  const bool one_sided_;
  SplatPlane plane_;
  std::vector<PixelSample> samples_;  // what the paths from the eye found in this frame
  const std::size_t stride_;          // sums of a pixel with layers
  std::vector<ExactRgb> sums_;        // of what they found
  std::vector<std::uint32_t> light_of_path_;
};

}  // namespace

BdptIntegrator::BdptIntegrator(const Scene& scene, const Accel& accel, const BidirectionalPaths& paths)
    : scene_(scene), accel_(accel), paths_(paths) {
  if (scene.lights.count() > 0) by_power_ = scene.lights.by_power();
  if (paths.connect) compensated_ = compensated_lights(scene.lights, scene, accel);
  light_media_ = light_media(scene, accel);
}

std::unique_ptr<FrameSeries> BdptIntegrator::begin(const SeriesPass& pass) const {
  const auto make = [&]<class F, bool in_media>() -> std::unique_ptr<FrameSeries> {
    return std::make_unique<BdptSeries<F, in_media>>(scene_, accel_, paths_, by_power_, compensated_, light_media_,
                                                     pass);
  };
  const bool one = paths_.lanes == Lanes::one;
  if (scene_.has_participating_media())
    return one ? make.template operator()<float, true>() : make.template operator()<NativeFloats, true>();
  return one ? make.template operator()<float, false>() : make.template operator()<NativeFloats, false>();
}

}  // namespace montelux
