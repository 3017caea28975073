#include "integrator/irradiance_cache/cache.h"

#include <algorithm>

namespace montelux {

namespace {

// A bijection of 64-bit words (splitmix64; Steele, Lea and Flood 2014).
std::uint64_t mix_words(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

}  // namespace

IrradianceCache::Cell IrradianceCache::cell_of(double side, const Vec3f& p) {
  const auto along = [side](float x) { return std::int64_t(std::floor(double(x) / side)); };
  return {along(p.x), along(p.y), along(p.z)};
}

// Two cells may share a key: then records of both are looked through.
std::uint64_t IrradianceCache::key_of(const Grid& grid, const Cell& cell) {
  std::uint64_t key = mix_words(std::uint64_t(grid.level) + 0x9e3779b97f4a7c15u);
  for (const std::int64_t part : {cell.x, cell.y, cell.z}) key = mix_words(key ^ std::uint64_t(part)) + 1;
  return key;
}

template <class Function>
void IrradianceCache::for_each_cell(const Grid& grid, const Vec3f& p, float radius, Function f) {
  const Vec3f r{radius, radius, radius};
  const Cell low = cell_of(grid.side, p - r), high = cell_of(grid.side, p + r);
  for (std::int64_t z = low.z; z <= high.z; ++z)
    for (std::int64_t y = low.y; y <= high.y; ++y)
      for (std::int64_t x = low.x; x <= high.x; ++x) f(key_of(grid, Cell{x, y, z}));
}

IrradianceCache::Grid& IrradianceCache::grid_for(float radius) {
  // A little wider than the sphere, so that rounding cannot make it meet a third cell.
  const int level = int(std::ceil(std::log2(2.02 * double(radius))));
  auto at = std::ranges::lower_bound(grids_, level, {}, &Grid::level);
  if (at == grids_.end() || at->level != level) at = grids_.insert(at, Grid{level, std::ldexp(1.0, level), {}});
  return *at;
}

float IrradianceCache::bounded(float distance) const {
  return std::clamp(distance, rules_.min_spacing / rules_.accuracy, rules_.max_spacing / rules_.accuracy);
}

// Two points at the distance d from each other have distances to a surface that differ by d at most: a record that saw
// a small object limits those that missed it. Only near ones, within the larger of the two radii.
void IrradianceCache::clamp_neighbours(CacheRecord& record) {
  if (!places_) places_ = Grid{0, 2 * double(rules_.max_spacing), {}};
  std::vector<std::uint32_t> near;
  for_each_cell(*places_, record.at.p, rules_.max_spacing, [&](std::uint64_t key) {
    const auto cell = places_->cells.find(key);
    if (cell != places_->cells.end()) near.insert(near.end(), cell->second.begin(), cell->second.end());
  });
  // In the order of their insertion, each once.
  std::ranges::sort(near);
  near.erase(std::unique(near.begin(), near.end()), near.end());
  const auto is_near = [&](const CacheRecord& other) {
    return length(other.at.p - record.at.p) < rules_.accuracy * std::max(record.distance, other.distance);
  };
  for (const std::uint32_t i : near)
    if (is_near(records_[i]))
      record.distance = std::min(record.distance, records_[i].distance + length(records_[i].at.p - record.at.p));
  for (const std::uint32_t i : near)
    if (is_near(records_[i]))
      records_[i].distance = std::min(records_[i].distance, record.distance + length(records_[i].at.p - record.at.p));
  places_->cells[key_of(*places_, record.at.p)].push_back(std::uint32_t(records_.size()));
}

void IrradianceCache::insert(CacheRecord record) {
  record.distance = bounded(record.distance);
  if (rules_.clamping) clamp_neighbours(record);
  const float radius = rules_.accuracy * record.distance;
  // Noise may make a gradient larger than irradiance, which is not negative, can have over the record's radius. Those
  // of the parts still sum to it.
  for (int c = 0; c < spectrum_size; ++c) {
    const auto i = std::size_t(c);
    Vec3f& gradient = record.gradients.translational[i];
    const float change = length(gradient) * radius;
    if (!(change > record.irradiance[c])) continue;
    const float share = record.irradiance[c] / change;
    gradient = gradient * share;
    for (CachePart& part : record.parts) part.gradients.translational[i] = part.gradients.translational[i] * share;
  }
  const auto number = std::uint32_t(records_.size());
  Grid& grid = grid_for(radius);
  for_each_cell(grid, record.at.p, radius, [&](std::uint64_t key) {
    std::vector<std::uint32_t>& cell = grid.cells[key];
    if (cell.empty() || cell.back() != number) cell.push_back(number);
  });
  records_.push_back(std::move(record));
}

template <class Part>
Spectrum<float> IrradianceCache::continued(const CacheRecord& record, const Part& part, const CacheQuery& at) const {
  if (!rules_.gradients) return part.irradiance;
  const Vec3f turn = cross(record.at.n, at.n), way = at.p - record.at.p;
  Spectrum<float> there;
  for (int c = 0; c < spectrum_size; ++c) {
    const auto i = std::size_t(c);
    const float change = dot(turn, part.gradients.rotational[i]) + dot(way, part.gradients.translational[i]);
    there[c] = part.irradiance[c] + change;
  }
  return there;
}

Spectrum<float> IrradianceCache::extrapolated(const CacheRecord& record, const CacheQuery& at) const {
  Spectrum<float> there = continued(record, record, at);
  for (int c = 0; c < spectrum_size; ++c) there[c] = std::max(there[c], 0.0f);
  return there;
}

std::vector<LightPart> IrradianceCache::parts(const CacheQuery& at) const {
  std::vector<LightPart> all;
  float weights = 0;
  for_each_near(at, [&](const CacheRecord& record, float w) {
    const Spectrum<float> whole = extrapolated(record, at);
    for (const CachePart& part : record.parts) {
      Spectrum<float> there = continued(record, part, at);
      for (int c = 0; c < spectrum_size; ++c) there[c] = whole[c] > 0 ? there[c] : 0;
      add_part(all, part.from, there * w);
    }
    weights += w;
  });
  for (LightPart& part : all) part.contribution = part.contribution * (1 / weights);
  return all;
}

}  // namespace montelux
