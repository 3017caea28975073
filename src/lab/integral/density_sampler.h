// Sampling a user's density.
#pragma once
#include "lab/integral/integrate.h"
#include "mc/cube_points.h"

namespace montelux::lab {

// Samples points and states their density, which is that of the table if a table is used.
class DensitySampler {
 public:
  DensitySampler(const UserDensity& density, std::size_t dimension);

  struct Drawn {
    std::uint64_t proposed = 0;
  };
  // Writes `count` points to `points` (coordinate-major); `first` distinguishes them from others with the same key.
  Drawn sample(CubeKey key, std::uint64_t first, std::size_t count, std::span<double> points) const;
  // The density per unit volume at each point.
  void density(PointBatch points, std::span<double> values) const;
  DensitySampling sampling() const { return sampling_; }
  double bound() const { return bound_; }  // of the density as given, for rejection

 private:
  void tabulate();
  void find_bound();
  double climb(std::vector<double> top) const;
  Drawn sample_by_table(CubeKey key, std::uint64_t first, std::size_t count, std::span<double> points) const;
  Drawn sample_by_rejection(CubeKey key, std::uint64_t first, std::size_t count, std::span<double> points) const;

  UserDensity user_;
  std::size_t dimension_;
  DensitySampling sampling_;
  std::size_t cells_ = 0;          // per axis of the table
  std::vector<double> cumulated_;  // running sums of the cells' mass, from 0 to 1
  double bound_ = 0;
};

}  // namespace montelux::lab
