// From the numbers of paths of `path` to their light.
#pragma once
#include <optional>

#include "integrator/metropolis/given_paths.h"
#include "integrator/metropolis/markov_chains.h"
#include "integrator/path/loop.h"

namespace montelux {

// The function that the chains sample: from a point of primary sample space to the light of its path. The first two
// numbers are the place in the picture.
template <class F, class Rays>
class PathFunction {
 public:
  using U = Uint<F>;
  using Settings = PathSettings;
  // All must outlive this.
  PathFunction(const Scene& scene, const Rays& rays, const PathSettings& settings, const SeriesPass& pass)
      : scene_(scene),
        rays_(rays),
        settings_(settings),
        bounds_(pass.bounds),
        pass_{pass.bounds, pass.points, pass.shutter, {}, {}, pass.grid},
        numbers_(dimensions_of(settings) * std::size_t(lanes_of<F>)) {
    if (pass.layers) tally_.emplace(*pass.layers, std::size_t(lanes_of<F>));
  }

  std::size_t dimensions() const { return numbers_.size() / lanes_of<F>; }
  Contribution<F> independent(const SamplePoint<F>& point, RayCounts& counts) { return (*this)(point, counts); }
  Contribution<F> start(SamplePoint<F>& point, const F&, const F&, RayCounts& counts) { return (*this)(point, counts); }
  void propose(SamplePoint<F>& to, const SamplePoint<F>& from, const StepOfNumbers<F>& step) const {
    for (std::size_t d = 0; d < dimensions(); ++d) put_numbers(to, d, step.moved(from, d));
  }
  // Numbers that are varied one by one: of the first vertices, which decide most.
  static std::size_t dimensions_of(const PathSettings& settings) {
    constexpr int deepest = 12;
    const int vertices = 1 + std::min(settings.max_depth.value_or(deepest), deepest);
    return path_dimension::first_vertex + std::size_t(vertices) * path_dimension::per_vertex;
  }

  Contribution<F> operator()(const SamplePoint<F>& point, RayCounts& counts) {
    std::copy(point.values.begin(), point.values.end(), numbers_.begin());
    Contribution<F> c;
    const std::span<float> film(numbers_.data() + path_dimension::film * lanes_of<F>, 2 * lanes_of<F>);
    c.x = take_pixel<F>(film.first(lanes_of<F>), bounds_.x0, bounds_.width());
    c.y = take_pixel<F>(film.last(lanes_of<F>), bounds_.y0, bounds_.height());
    std::array<PixelSample, lanes_of<F>> out{};
    const RecordedNumbers<F> numbers(numbers_, point.beyond);
    const auto [x, y] = pixels_of<F>(pass_.grid, pass_.points, c.x, c.y, Uint<F>(0u));
    const Mask<F> all(true);
    const GivenStart<F> start{pass_, {x, y, U(0u)}, numbers, all, all};
    counts.camera += lanes_of<F>;
    counts += tally_ ? trace(start, out, *tally_) : trace(start, out, no_tally);
    std::array<Rgb, lanes_of<F>> light;
    for (std::size_t k = 0; k < light.size(); ++k) {
      light[k] = out[k].radiance;
      if (tally_) c.parts.push_back(tally_->take(k));
    }
    put_light<F>(c, light);
    return c;
  }

 private:
  template <class Tally>
  RayCounts trace(const GivenStart<F>& start, std::span<PixelSample> out, Tally& tally) const {
    GivenPaths<F, Rays, Tally> paths(scene_, rays_, start, out, tally);
    return scene_.has_participating_media()
               ? run_paths<F, true>(scene_, scene_.lights, rays_, settings_, pass_, out, paths, tally)
               : run_paths<F>(scene_, scene_.lights, rays_, settings_, pass_, out, paths, tally);
  }

  const Scene& scene_;
  const Rays& rays_;
  const PathSettings& settings_;
  const PixelBounds bounds_;
  const TilePass pass_;
  std::vector<float> numbers_;
  std::optional<PartsTally> tally_;  // of a pass with layers
};

}  // namespace montelux
