// What the path loop writes down for path guiding.
#pragma once
#include <span>
#include <vector>

#include "image/pixel_sample.h"
#include "integrator/guiding/guided_scattering.h"
#include "transport/path_state.h"

namespace montelux {

// A direction in which a path was scattered at a surface, and what it found along it.
struct GuideRecord {
  Vec3f p, n, wi;              // as PlaceTree::leaf_at takes them; unit, world space
  float bsdf, guide, share;    // as GuidedDirection
  float throughput;            // with which the path had come
  float light;                 // gathered up to here; once the path has ended: what came along wi, over the throughput
  std::uint32_t path, before;  // its number in the tile; the record before of the same path, counted from 1

  float mixture() const { return (1 - share) * bsdf + share * guide; }
};

// A tally of the path loop for the paths of one tile.
class GuideTally {
 public:
  static constexpr bool records = false, trains_guide = true;
  explicit GuideTally(std::size_t paths) : last_(paths, 0u) {}

  // Paths have come to the vertex with the throughput `arriving`, and have been scattered there in the lanes `on`.
  template <class F>
  void train(const PathState<F>& path, const Vertex<F>& v, const Spectrum<F>& arriving, const GuidedDirection<F>& to,
             Mask<F> on) {
    const Spectrum<F> gathered = path.radiance * path.weight;
    const F throughput = max_component(arriving) * path.weight;
    for_each_lane(on, [&](int k) {
      std::uint32_t& last = last_[lane(path.output, k)];
      records_.push_back({lane(v.x.point.p, k), lane(v.bsdf.light_normal, k), lane(to.wi, k), lane(to.bsdf.value, k),
                          lane(to.guide.value, k), lane(to.share, k), lane(throughput, k),
                          mean_light(to_rgb(lane(gathered, k))), lane(path.output, k), last});
      last = std::uint32_t(records_.size());
    });
  }

  // The paths have ended with these samples: calls learn(record) for each record, path by path.
  template <class Learn>
  void finish(std::span<const PixelSample> samples, Learn learn) const {
    for (std::size_t path = 0; path < last_.size(); ++path) {
      const float all = mean_light(samples[path].radiance);
      for (std::uint32_t at = last_[path]; at != 0; at = records_[at - 1].before) {
        GuideRecord record = records_[at - 1];
        record.light = (all - record.light) / record.throughput;
        // A filter may have negative weights, which cancel.
        if (is_finite(record.light) && record.light >= 0) learn(record);
      }
    }
  }

 private:
  static float mean_light(const Rgb& radiance) { return (radiance.c[0] + radiance.c[1] + radiance.c[2]) / 3; }

  std::vector<GuideRecord> records_;
  std::vector<std::uint32_t> last_;  // of each path
};

}  // namespace montelux
