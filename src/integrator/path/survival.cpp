#include "integrator/path/survival.h"

#include <algorithm>
#include <cmath>

#include "mc/roulette.h"

namespace montelux {

namespace {

constexpr int iterations = 6;

// What is known of a block at one depth, or of the whole picture: sums over paths that come there.
struct Remainder {
  double weight = 0, squares = 0;  // of T^2; of what is yet gathered
  double paths = 0, cost = 0;      // those that come there; the rays they will take
  void add(const Remainder& other) {
    weight += other.weight, squares += other.squares, paths += other.paths, cost += other.cost;
  }
};

struct Sums {
  std::vector<Remainder> at;  // by block and depth
  std::vector<Remainder> everywhere = std::vector<Remainder>(SurvivalMap::depths);
  double cost = 0;                   // of all samples
  std::vector<double> pixel_square;  // of the samples of a pixel, expected under roulette
};

// The expectations of one path under the factors: it lives past decision j with probability S_j, and then what it
// gathers counts 1 / S_j.
void add_path(const PilotPath& path, const std::vector<float>& factors, int roulette_depth, Sums& sums) {
  const int n = int(path.decisions.size());
  std::vector<double> alive(std::size_t(n) + 1, 1.0), gathered(std::size_t(n) + 1), square(std::size_t(n) + 1);
  for (int j = 0; j <= n; ++j) {
    const double from = j == 0 ? 0.0 : double(path.decisions[std::size_t(j - 1)].gathered);
    gathered[std::size_t(j)] = (j == n ? double(path.light) : double(path.decisions[std::size_t(j)].gathered)) - from;
    if (j == 0) continue;
    const double throughput = double(path.decisions[std::size_t(j - 1)].throughput) / alive[std::size_t(j - 1)];
    const int depth = std::min(j, SurvivalMap::depths);
    const double factor = double(factors[std::size_t(path.block * SurvivalMap::depths + depth - 1)]);
    const double q =
        j <= roulette_depth ? 1.0 : std::clamp(throughput * factor, double(min_survival), double(max_survival));
    alive[std::size_t(j)] = alive[std::size_t(j - 1)] * q;
  }
  // From behind: the mean square of what is gathered from decision j on, and the rays, both times S_j.
  double after = 0, squares = 0, cost = 0;
  for (int j = n; j >= 0; --j) {
    const double a = gathered[std::size_t(j)], s = alive[std::size_t(j)];
    squares += (a * a + 2 * a * after) / s, after += a, cost += s;
    if (j == 0) continue;
    const double before = alive[std::size_t(j - 1)], t = double(path.decisions[std::size_t(j - 1)].throughput);
    const double q = s / before;
    const Remainder here{t * t / before, squares * q, before, cost / q};
    const std::size_t depth = std::size_t(std::min(j, SurvivalMap::depths) - 1);
    sums.at[std::size_t(path.block * SurvivalMap::depths) + depth].add(here);
    sums.everywhere[depth].add(here);
  }
  sums.cost += cost;
  sums.pixel_square[std::size_t(path.pixel)] += squares;
}

// The light of pixels and blocks, which roulette does not change.
struct Light {
  std::vector<double> sum, sum_of_squares, samples;  // by pixel
  std::vector<int> block;                            // of the pixel
  std::vector<double> weight;                        // by block: 1 / (mean^2 + 0.01), as relMSE has it
};

Light light_of(std::span<const PilotPath> paths, int blocks) {
  Light l;
  std::vector<double> sum(std::size_t(blocks), 0.0), count(std::size_t(blocks), 0.0);
  for (const PilotPath& p : paths) {
    const auto pixel = std::size_t(p.pixel);
    if (pixel >= l.sum.size()) {
      for (auto* v : {&l.sum, &l.sum_of_squares, &l.samples}) v->resize(pixel + 1);
      l.block.resize(pixel + 1);
    }
    l.sum[pixel] += double(p.light), l.sum_of_squares[pixel] += double(p.light) * double(p.light);
    l.samples[pixel] += 1, l.block[pixel] = p.block;
    sum[std::size_t(p.block)] += double(p.light), count[std::size_t(p.block)] += 1;
  }
  for (std::size_t b = 0; b < sum.size(); ++b) {
    const double mean = count[b] > 0 ? sum[b] / count[b] : 0;
    l.weight.push_back(1 / (mean * mean + 0.01));
  }
  return l;
}

// The relative variance of a sample, mean over the pixels: mean square less the square of the mean, free of bias.
double variance_of(const Light& light, const Sums& sums) {
  double total = 0, pixels = 0;
  for (std::size_t p = 0; p < light.sum.size(); ++p) {
    const double n = light.samples[p];
    if (n < 2) continue;
    const double square_of_mean = (light.sum[p] * light.sum[p] - light.sum_of_squares[p]) / (n * (n - 1));
    total += light.weight[std::size_t(light.block[p])] * (sums.pixel_square[p] / n - square_of_mean);
    pixels += 1;
  }
  return pixels > 0 ? total / pixels : 0;
}

}  // namespace

PilotBlocks PilotBlocks::of(int width, int height) {
  PilotBlocks b;
  while ((std::max(width, height) - 1) >> b.bits >= 16) ++b.bits;
  b.across = ((std::max(width, 1) - 1) >> b.bits) + 1;
  b.down = ((std::max(height, 1) - 1) >> b.bits) + 1;
  return b;
}

SurvivalMap survival_from(std::span<const PilotPath> paths, const PilotBlocks& blocks, int roulette_depth) {
  const std::size_t cells = std::size_t(blocks.count() * SurvivalMap::depths);
  std::vector<float> factors(cells, 1e30f);
  const Light light = light_of(paths, blocks.count());
  for (int i = 0; i < iterations && !paths.empty(); ++i) {
    Sums sums;
    sums.at.resize(cells), sums.pixel_square.resize(light.sum.size());
    for (const PilotPath& path : paths) add_path(path, factors, roulette_depth, sums);
    const double variance = std::max(variance_of(light, sums), 1e-12);
    const double scale = std::sqrt(sums.cost / double(paths.size()) / variance);
    for (std::size_t c = 0; c < cells; ++c) {
      const Remainder& all = sums.everywhere[c % SurvivalMap::depths];
      // Where the pilot found no light ahead there is nothing to estimate from: the throughput itself decides.
      factors[c] = 1;
      if (!(all.weight > 0 && all.squares > 0)) continue;
      // A block with few pilot paths is shrunk toward the whole picture, as if by 16 more paths.
      const double lean = 16 / all.paths;
      Remainder here = sums.at[c];
      here.add({lean * all.weight, lean * all.squares, lean * all.paths, lean * all.cost});
      const double mean_square = std::max(here.squares, 0.0) / here.weight, cost = here.cost / here.paths;
      const double weight = light.weight[c / SurvivalMap::depths];
      factors[c] = float(std::min(1e30, scale * std::sqrt(weight * mean_square / cost)));
    }
  }
  return SurvivalMap(blocks.bits, blocks.across, std::move(factors));
}

}  // namespace montelux
