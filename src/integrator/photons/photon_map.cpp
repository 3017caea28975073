#include "integrator/photons/photon_map.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "math/write_lanes.h"
#include "mc/random.h"

namespace montelux {

namespace {

// Beyond every array that lanes may read past its end.
constexpr std::size_t padding = native_lanes;

NativeFloats load(const std::vector<float>& from, std::size_t at) {
  NativeFloats f;
  std::memcpy(&f, from.data() + at, sizeof f);
  return f;
}

// One over the side of a cell, which is two radii and a little more: the points within a radius of any point are in two
// cells along each axis.
double cells_per_length(float radius) { return 0.5 / (double(radius) * (1 + 1e-6)); }

}  // namespace

void PhotonMap::arrange(int stage, std::size_t unit, float radius) {
  switch (stage) {
    case choose_table:
      return choose_table_for(radius);
    case count_cells:
      return count_cells_of(unit);
    case lay_out:
      return lay_out_cells();
    case deal:
      return deal_from(unit);
    default:
      return put_in_order_part(unit);
  }
}

void PhotonMap::arrange(float radius) {
  for (int stage = fill_boxes + 1; stage < stages; ++stage)
    for (std::size_t unit = 0; unit < units(stage); ++unit) arrange(stage, unit, radius);
}

// About two cells for each photon, so that few photons share a cell by chance. The time of a frame follows the photons
// that were found, which may be few.
void PhotonMap::choose_table_for(float radius) {
  radius_ = radius, per_cell_ = cells_per_length(radius);
  std::size_t photons = 0;
  for (const std::vector<Photon>& box : boxes_) photons += box.size();
  const std::size_t cells = std::bit_ceil(std::clamp<std::size_t>(2 * photons, 16, std::size_t{1} << 26));
  mask_ = std::uint32_t(cells - 1);
  if (counts_.size() == cells) return;
  counts_ = std::vector<SharedCount>(cells);
  starts_.resize(cells + 1);
}

std::uint32_t PhotonMap::hash(std::int64_t x, std::int64_t y, std::int64_t z) const {
  return mix_bits(std::uint32_t(x) * 0x9e3779b9u ^
                  mix_bits(std::uint32_t(y) * 0x85ebca6bu ^ mix_bits(std::uint32_t(z) + 0x27220a95u))) &
         mask_;
}

std::uint32_t PhotonMap::cell_of(const Vec3f& p) const {
  const auto along = [&](float x) { return std::int64_t(std::floor(double(x) * per_cell_)); };
  return hash(along(p.x), along(p.y), along(p.z));
}

void PhotonMap::count_cells_of(std::size_t box) {
  for (const Photon& photon : boxes_[box]) counts_[cell_of(photon.p)].next();
}

void PhotonMap::lay_out_cells() {
  std::uint32_t sum = 0;
  for (std::size_t i = 0; i < counts_.size(); ++i) starts_[i] = sum, sum += counts_[i].take();
  starts_.back() = sum;
  dealt_.resize(sum);
  for (std::vector<float>* all : {&x_, &y_, &z_, &nx_, &ny_, &nz_}) all->resize(sum + padding);
  photons_.resize(sum + 1);
  if (keeps_paths_) weights_.resize(sum + 1), paths_.resize(sum + 1);
}

void PhotonMap::deal_from(std::size_t box) {
  for (const Photon& photon : boxes_[box]) {
    const std::uint32_t cell = cell_of(photon.p);
    const std::uint32_t place = starts_[cell] + counts_[cell].next();
    dealt_[place] = {std::uint64_t(photon.path) << 32 | photon.events, &photon};
  }
}

void PhotonMap::put_in_order_part(std::size_t part) {
  const std::size_t cells = counts_.size(), parts = boxes();
  const std::size_t first = part * cells / parts, last = (part + 1) * cells / parts;
  for (std::size_t cell = first; cell < last; ++cell) {
    counts_[cell].take();
    const std::uint32_t from = starts_[cell], to = starts_[cell + 1];
    std::sort(dealt_.begin() + from, dealt_.begin() + to, [](const Dealt& a, const Dealt& b) { return a.key < b.key; });
    for (std::uint32_t i = from; i < to; ++i) {
      const Photon& photon = *dealt_[i].photon;
      x_[i] = photon.p.x, y_[i] = photon.p.y, z_[i] = photon.p.z;
      nx_[i] = photon.ng.x, ny_[i] = photon.ng.y, nz_[i] = photon.ng.z;
      photons_[i] = {photon.wi, photon.flux, photon.events};
      if (keeps_paths_) weights_[i] = photon.weights, paths_[i] = photon.path;
    }
  }
}

void NearPhotons::reserve_more(std::size_t more) {
  const std::size_t needed = count + more + padding;
  if (photon.size() >= needed) return;
  photon.resize(2 * needed), distance_squared.resize(2 * needed);
}

template <class Similar>
void PhotonMap::find_near(const Vec3f& p, NearPhotons& found, Similar similar) const {
  using F = NativeFloats;
  found.count = 0;
  const auto cells_along = [&](float x) {
    const double low = (double(x) - double(radius_)) * per_cell_, high = (double(x) + double(radius_)) * per_cell_;
    return std::pair{std::int64_t(std::floor(low)), std::int64_t(std::floor(high))};
  };
  const auto [x0, x1] = cells_along(p.x);
  const auto [y0, y1] = cells_along(p.y);
  const auto [z0, z1] = cells_along(p.z);
  // Cells that share an entry of the table are looked through once.
  std::array<std::uint32_t, 8> seen;
  std::size_t cells = 0;
  const float radius_squared = radius_ * radius_;
  for (std::int64_t z = z0; z <= z1; ++z)
    for (std::int64_t y = y0; y <= y1; ++y)
      for (std::int64_t x = x0; x <= x1; ++x) {
        const std::uint32_t cell = hash(x, y, z);
        if (std::find(seen.begin(), seen.begin() + cells, cell) != seen.begin() + cells) continue;
        seen[cells++] = cell;
        const std::uint32_t end = starts_[cell + 1];
        found.reserve_more(end - starts_[cell]);
        for (std::uint32_t i = starts_[cell]; i < end; i += native_lanes) {
          const F dx = load(x_, i) - p.x, dy = load(y_, i) - p.y, dz = load(z_, i) - p.z;
          const F d2 = dx * dx + dy * dy + dz * dz;
          const Mask<F> near = (d2 < F(radius_squared)) & similar(i, dx, dy, dz) & (lane_index<F>() < Uint<F>(end - i));
          write_lanes(near, Uint<F>(lane_index<F>() + Uint<F>(i)), found.photon.data() + found.count);
          write_lanes(near, d2, found.distance_squared.data() + found.count);
          found.count += std::size_t(montelux::count(near));
        }
      }
}

void PhotonMap::near(const Vec3f& p, const Vec3f& n, NearPhotons& found) const {
  using F = NativeFloats;
  const float height = similar_height * radius_;
  find_near(p, found, [&](std::uint32_t i, const F& dx, const F& dy, const F& dz) {
    const F cosine = load(nx_, i) * n.x + load(ny_, i) * n.y + load(nz_, i) * n.z;
    return (abs(dx * n.x + dy * n.y + dz * n.z) <= F(height)) & (abs(cosine) > F(similar_normals));
  });
}

void PhotonMap::near(const Vec3f& p, NearPhotons& found) const {
  using F = NativeFloats;
  find_near(p, found, [](std::uint32_t, const F&, const F&, const F&) { return Mask<F>(true); });
}

}  // namespace montelux
