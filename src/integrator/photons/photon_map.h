// Photons of one frame, and those near a point: a hash grid, filled by any number of threads with the same bits.
#pragma once
#include <span>
#include <vector>

#include "color/spectrum.h"
#include "image/pixel_sample.h"
#include "integrator/integrator.h"
#include "math/shared_count.h"
#include "math/vec.h"

namespace montelux {

// What photons carry where they share the light with other strategies; see PartialWeights.
struct PhotonWeights {
  float vcm = 0, vm = 0;
};

// Flux that arrives at a rough surface; or the flux that an event in a medium scatters over the medium's scattering
// coefficient, whose density per volume is the radiance that arrives, over all directions.
struct Photon {
  Vec3f p;
  Vec3f wi;  // unit, to where it came from
  Vec3f ng;  // unit geometric normal of the surface; zero in a medium
  Spectrum<float> flux;
  std::uint32_t events;  // that have scattered it
  std::uint32_t path;    // its number: a path leaves one photon for each number of events
  PhotonWeights weights{};
};

// The part of a photon that a gathering point needs, as lanes gather it.
struct GatheredPhoton {
  Vec3f wi;
  Spectrum<float> flux;
  std::uint32_t events;
};
inline constexpr std::uint32_t photon_words = sizeof(GatheredPhoton) / 4;
static_assert(sizeof(GatheredPhoton) % 4 == 0);

// Photons that lie further above or below the tangent plane of the point that gathers than this share of the radius
// are those of another surface.
inline constexpr float similar_height = 0.3f;

// Photons on surfaces whose normals have a smaller cosine with that of the gathering point are those of another
// surface.
inline constexpr float similar_normals = 0.7f;

// Photons around a point: the first `count` of the vectors, beyond which lanes may read.
struct NearPhotons {
  std::size_t count = 0;
  std::vector<std::uint32_t> photon;  // number in the map
  std::vector<float> distance_squared;
  // Room for so many more, and for a pack beyond them.
  void reserve_more(std::size_t more);
};

// Filled in stages, each by many threads, with a barrier between two; then photons can be looked up. The order of
// photons within a cell is that of their numbers, whatever the threads did, so that sums over them have the same bits.
class PhotonMap {
 public:
  // Filled by so many boxes; `keeps_paths`: with their weights and paths.
  explicit PhotonMap(std::size_t boxes, bool keeps_paths = false) : boxes_(boxes), keeps_paths_(keeps_paths) {}

  // The photons that one unit of the first stage has found.
  std::vector<Photon>& box(std::size_t number) { return boxes_[number]; }
  std::size_t boxes() const { return boxes_.size(); }

  static constexpr int stages = 6;
  std::size_t units(int stage) const { return stage == choose_table || stage == lay_out ? 1 : boxes(); }
  // trace(box) adds the photons of that box, in the first stage.
  template <class Trace>
  RayCounts run_unit(int stage, std::size_t unit, float radius, Trace trace) {
    if (stage == fill_boxes) {
      box(unit).clear();
      return trace(box(unit));
    }
    arrange(stage, unit, radius);
    return {};
  }
  // A unit of a later stage, which sorts the photons of the boxes into the map.
  void arrange(int stage, std::size_t unit, float radius);
  // All later stages, on this thread.
  void arrange(float radius);

  std::size_t size() const { return dealt_.size(); }
  float radius() const { return radius_; }
  const GatheredPhoton* photons() const { return photons_.data(); }
  const PhotonWeights* weights() const { return weights_.data(); }
  const std::uint32_t* paths() const { return paths_.data(); }  // their numbers; of a map that keeps them
  // Finds the photons within the radius of p that lie near the plane across n, on surfaces with similar normals, in a
  // fixed order.
  void near(const Vec3f& p, const Vec3f& n, NearPhotons& found) const;
  // Finds all photons within the radius of p, likewise.
  void near(const Vec3f& p, NearPhotons& found) const;

 private:
  // similar(first, dx, dy, dz): the lanes, from that photon on, whose photons count; the last are p's way to them.
  template <class Similar>
  void find_near(const Vec3f& p, NearPhotons& found, Similar similar) const;
  struct Dealt {
    std::uint64_t key;
    const Photon* photon;
  };
  enum Stage { fill_boxes, choose_table, count_cells, lay_out, deal, put_in_order };
  void choose_table_for(float radius);
  void count_cells_of(std::size_t box);
  void lay_out_cells();
  void deal_from(std::size_t box);
  void put_in_order_part(std::size_t part);
  std::uint32_t cell_of(const Vec3f& p) const;
  std::uint32_t hash(std::int64_t x, std::int64_t y, std::int64_t z) const;

  float radius_ = 0;
  double per_cell_ = 0;                                            // one over the side of a cell
  std::uint32_t mask_ = 0;                                         // the cells of the table, less one
  std::vector<SharedCount> counts_ = std::vector<SharedCount>(1);  // by cell; zero between frames
  std::vector<std::uint32_t> starts_ = {0, 0};                     // by cell, and the end
  std::vector<std::vector<Photon>> boxes_;
  std::vector<Dealt> dealt_;
  std::vector<float> x_, y_, z_, nx_, ny_, nz_;  // places and normals, for lanes
  std::vector<GatheredPhoton> photons_;
  bool keeps_paths_;
  std::vector<PhotonWeights> weights_;  // of the same photons
  std::vector<std::uint32_t> paths_;    // likewise
};

}  // namespace montelux
