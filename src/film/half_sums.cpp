#include "film/half_sums.h"

#include <algorithm>
#include <span>

#include "film/film.h"
#include "film/film_bytes.h"
#include "film/limits.h"

namespace montelux {

void HalfSums::add(const PixelPass& sums, bool in_first_half) {
  if (sums.finite > 0)
    for (int c = 0; c < rgb_size; ++c) emission[in_first_half ? 0 : 1][c].add(sums.emission[c] / sums.finite);
  if (!in_first_half) return;
  if (sums.finite > 0)
    for (int c = 0; c < rgb_size; ++c) radiance[c].add(sums.sum[c] / sums.finite);
  const PixelFeatures& f = sums.features;
  hits.add(f.hits);
  if (f.hits == 0) return;
  constexpr double max_albedo = feature_limit(feature_channel("albedo"));
  for (int c = 0; c < rgb_size; ++c) albedo[c].add(within(f.albedo(c), max_albedo * f.hits));
  for (int c = 0; c < 3; ++c) normal[c].add(within(f.normal(c), f.hits));
}

void HalfSums::merge(const HalfSums& other) {
  for (int c = 0; c < rgb_size; ++c) {
    radiance[c] += other.radiance[c], albedo[c] += other.albedo[c];
    for (int h = 0; h < 2; ++h) emission[h][c] += other.emission[h][c];
  }
  for (int c = 0; c < 3; ++c) normal[c] += other.normal[c];
  hits += other.hits;
}

std::array<PixelHalf, 2> HalfSums::halves(const PixelSums& all) const {
  const double passes = all.passes, first = all.half_passes, second = passes - first;
  const bool both = first > 0 && second > 0;
  const double of_all_hits = all.hits.value(), of_first = hits.value(), rest = of_all_hits - of_first;
  const std::array<double, rgb_size> mean = all.mean();
  const PixelFeatures whole = all.features();
  PixelHalf a, b;
  a.share = both ? first / passes : 1, b.share = both ? second / passes : 1;
  // A half of the features is the whole where it has none.
  const auto split = [&](double part, double sum, double& of_a, double& of_b) {
    const double average = of_all_hits > 0 ? sum / of_all_hits : 0;
    of_a = of_first > 0 ? part / of_first : average, of_b = rest > 0 ? (sum - part) / rest : average;
  };
  for (int c = 0; c < rgb_size; ++c) {
    const double sum = radiance[c].value(), m = mean[std::size_t(c)];
    a.mean[c] = both ? sum / first : m, b.mean[c] = both ? (m * passes - sum) / second : m;
    const double of_a = emission[0][c].value(), of_b = emission[1][c].value(),
                 of_all = (of_a + of_b) / std::max(passes, 1.0);
    a.emission[c] = both ? of_a / first : of_all, b.emission[c] = both ? of_b / second : of_all;
    split(albedo[c].value(), whole.albedo(c), a.albedo[c], b.albedo[c]);
  }
  for (int c = 0; c < 3; ++c) split(normal[c].value(), whole.normal(c), a.normal[c], b.normal[c]);
  return {a, b};
}

void HalfSums::write(ByteWriter& out) const {
  out.samples(hits);
  for (const ExactSum& x : radiance) out.sum(x);
  const bool emits = std::ranges::any_of(std::span(emission), [](const ExactSum(&half)[rgb_size]) {
    return std::ranges::any_of(half, [](const ExactSum& x) { return x.units() != 0; });
  });
  out.count(emits ? 1 : 0);
  for (const auto& half : emission)
    for (const ExactSum& x : half)
      if (emits) out.sum(x);
  if (hits.is_zero()) return;
  for (const SmallExactSum& x : albedo) out.sum(x);
  for (const SmallExactSum& x : normal) out.sum(x);
}

void HalfSums::read(const PixelSums& all, ByteReader& in) {
  hits = in.samples(all.hits.whole_above());
  for (ExactSum& x : radiance) x = in.sum(all.half_passes);
  if (in.count(1) == 1)
    for (std::size_t h = 0; h < 2; ++h)
      for (ExactSum& x : emission[h]) x = in.sum(h == 0 ? all.half_passes : all.passes - all.half_passes);
  if (hits.is_zero()) return;
  for (SmallExactSum& x : albedo) x = in.small_sum();
  for (SmallExactSum& x : normal) x = in.small_sum();
}

}  // namespace montelux
