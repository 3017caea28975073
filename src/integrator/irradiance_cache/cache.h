// Records of irradiance and the interpolation between them (Ward, Rubinstein and Clear 1988, "A Ray Tracing Solution
// for Diffuse Interreflection"; Krivanek et al. 2006, "Making Radiance and Irradiance Caching Practical").
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "integrator/irradiance_cache/hemisphere.h"
#include "integrator/light_parts.h"

namespace montelux {

// What is looked up: the irradiance at a point of a surface, on the side of the unit normal. `depth`:
// scattering events before it; where the number of events is limited only records of the same depth count, elsewhere it
// is 0.
struct CacheQuery {
  Vec3f p, n;
  std::uint32_t depth = 0;
};

// What light of one origin contributes to the irradiance of a record; its bounces are those before the record's
// surface, and the one there.
struct CachePart {
  LightOrigin<float> from;
  Spectrum<float> irradiance;
  IrradianceGradients gradients;
};

struct CacheRecord {
  CacheQuery at;
  Spectrum<float> irradiance;
  IrradianceGradients gradients;
  float distance;                  // harmonic mean of those to the surfaces around, bounded by the cache
  std::vector<CachePart> parts{};  // in a pass with layers
};

struct CacheRules {
  float accuracy;                  // Ward's a
  float min_spacing, max_spacing;  // bounds of the radius within which a record counts, which is a times its distance
  bool gradients = true, clamping = true;
};

// The weight of a record at a point, 1 / error - 1 / a, so that it falls to zero where the error reaches a. The error
// is that of Ward's split sphere: the way over the record's distance, and the root of 1 - the cosine of the normals.
// Records that lie in front of the point see what it may not see.
struct CacheWeight {
  float operator()(const CacheRecord& record, const CacheQuery& at, float accuracy) const {
    // The error is not zero at the record itself, so that the weight is finite.
    constexpr float min_error = 1e-4f, tolerance = 0.02f;
    const Vec3f way = at.p - record.at.p;
    const float cosine = dot(record.at.n, at.n);
    if (dot(way, record.at.n + at.n) < -2 * tolerance * accuracy * record.distance) return 0;
    const float error = length(way) / record.distance + std::sqrt(std::max(1 - cosine, 0.0f));
    return error < accuracy ? 1 / std::max(error, min_error) - 1 / accuracy : 0;
  }
};

// Records in the cells of grids, each in that whose cells are a little wider than the sphere within which the record
// counts, so that it is in at most eight of them, and a point is in one cell of each grid. One thread adds
// records; while none does any number of threads may look them up.
class IrradianceCache {
 public:
  explicit IrradianceCache(const CacheRules& rules) : rules_(rules) {}

  // Bounds the record's distance, by its neighbours too, and theirs by it.
  void insert(CacheRecord record);
  std::size_t size() const { return records_.size(); }
  std::span<const CacheRecord> records() const { return records_; }

  // Calls f(record, weight) for each record that counts at the point, in a fixed order.
  template <class Function, class Weight = CacheWeight>
  void for_each_near(const CacheQuery& at, Function f, const Weight& weight = {}) const {
    for (const Grid& grid : grids_) {
      const auto cell = grid.cells.find(key_of(grid, at.p));
      if (cell == grid.cells.end()) continue;
      for (const std::uint32_t number : cell->second) {
        const CacheRecord& record = records_[number];
        if (record.at.depth != at.depth) continue;
        if (const float w = weight(record, at, rules_.accuracy); w > 0) f(record, w);
      }
    }
  }
  // None: no record counts there.
  template <class Weight = CacheWeight>
  std::optional<Spectrum<float>> irradiance(const CacheQuery& at, const Weight& weight = {}) const {
    Spectrum<float> sum = gray(0.0f);
    float weights = 0;
    for_each_near(
        at, [&](const CacheRecord& record, float w) { sum += extrapolated(record, at) * w, weights += w; }, weight);
    if (weights == 0) return std::nullopt;
    return sum * (1 / weights);
  }
  // The same by origin, where the records have parts: these sum to it except for rounding, and each may be negative,
  // since its gradients alone have no bound.
  std::vector<LightPart> parts(const CacheQuery& at) const;
  bool covers(const CacheQuery& at) const {
    bool any = false;
    for_each_near(at, [&](const CacheRecord&, float) { any = true; });
    return any;
  }

 private:
  struct Grid {
    int level;  // cells are 2^level wide
    double side;
    std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells;
  };
  struct Cell {
    std::int64_t x, y, z;
  };
  static Cell cell_of(double side, const Vec3f& p);
  static std::uint64_t key_of(const Grid& grid, const Cell& cell);
  static std::uint64_t key_of(const Grid& grid, const Vec3f& p) { return key_of(grid, cell_of(grid.side, p)); }
  Grid& grid_for(float radius);
  // Calls f(key) for each cell of the grid that the box of this half side meets.
  template <class Function>
  static void for_each_cell(const Grid& grid, const Vec3f& p, float radius, Function f);

  float bounded(float distance) const;
  void clamp_neighbours(CacheRecord& record);
  // The irradiance of a record, or of one of its parts, as its gradients continue it.
  template <class Part>
  Spectrum<float> continued(const CacheRecord& record, const Part& part, const CacheQuery& at) const;
  // That of the record, which is not negative.
  Spectrum<float> extrapolated(const CacheRecord& record, const CacheQuery& at) const;

  CacheRules rules_;
  std::vector<CacheRecord> records_;
  std::vector<Grid> grids_;     // by level
  std::optional<Grid> places_;  // of the records, in cells twice as wide as the largest radius
};

}  // namespace montelux
