// Paths from the camera by given numbers.
#pragma once
#include <span>
#include <utility>

#include "integrator/path/first_hits.h"
#include "transport/numbers.h"

namespace montelux {

// One camera path a lane, which starts by given numbers.
template <class F>
struct GivenStart {
  const TilePass& pass;
  PathSite<F> site;
  const RecordedNumbers<F>& numbers;
  Mask<F> on, wants_sky;  // whose paths are wanted, and where they leave the scene at once their light
};
template <class F, class Rays, class Tally = const NoTally>
class GivenPaths {
 public:
  GivenPaths(const Scene& scene, const Rays& rays, const GivenStart<F>& given, std::span<PixelSample> out,
             Tally& tally = no_tally)
      : scene_(scene), rays_(rays), given_(given), out_(out), tally_(tally) {}

  Mask<F> refill(PathState<F>& path, Mask<F> on) {
    if (std::exchange(started_, true)) return on;
    PathStart<F> start = start_of_path<F>(scene_, given_.pass, given_.site, given_.numbers);
    start.output = lane_index<F>();
    const auto [found, hit] =
        rays_.template trace<F>({start.o, start.d, F(ray_infinity), start.time}, given_.on, RayUse::camera);
    start.hit = hit;
    const Mask<F> starts = found | (given_.on & Mask<F>(scene_.camera_medium != empty_space));
    show_sky<F>(scene_, start, given_.wants_sky & !starts, out_, tally_);
    begin_paths(path, start, media_of<F>(scene_.media, Uint<F>(scene_.camera_medium)), starts);
    return starts;
  }
  const RecordedNumbers<F>& numbers(const PathState<F>&) const { return given_.numbers; }

 private:
  const Scene& scene_;
  const Rays& rays_;
  const GivenStart<F> given_;
  std::span<PixelSample> out_;
  Tally& tally_;
  bool started_ = false;
};

}  // namespace montelux
