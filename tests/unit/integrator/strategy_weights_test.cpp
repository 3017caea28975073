// The recursive weights of bidirectional strategies are those of the explicit sum over all of them, path by path.
#include "integrator/bidirectional/strategy_weights.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "math/vec.h"
#include "mc/random.h"

namespace montelux::test {
namespace {

enum class LightSort { surface, point, distant, sky };

// A complete path x_0 (at a light) ... x_k (at the lens), with all its densities. Densities of deltas are 1 in both
// directions: every strategy that finds the path has them once.
struct Path {
  std::vector<Vec3f> x, n;
  std::vector<float> to_lens, to_light;  // at vertex i: of the direction to i + 1 from i - 1, and the other way
  std::vector<bool> delta;
  std::vector<bool> in_medium;  // without a normal, and never merged
  std::vector<double> passing;  // of the segment from i to i + 1: the probability of no event along it
  LightSort sort = LightSort::surface;
  double position = 1, direction = 1, sampled = 1;  // of the light, choices included
  double pixels = 1, light_paths = 1;               // at the lens
  int last() const { return int(x.size()) - 1; }

  double squared(int i) const { return length_squared(x[std::size_t(i)] - x[std::size_t(i + 1)]); }
  // At vertex i, with the segment between j and j + 1.
  double cos(int i, int j) const {
    if (in_medium[std::size_t(i)]) return 1;
    return std::abs(dot(n[std::size_t(i)], normalize(x[std::size_t(j)] - x[std::size_t(j + 1)])));
  }
  bool is_beyond() const { return sort == LightSort::distant || sort == LightSort::sky; }
  bool is_delta_light() const { return sort == LightSort::point || sort == LightSort::distant; }
  // The light's own measure, per steradian at x_1.
  double measure() const { return sort == LightSort::surface ? cos(0, 0) / squared(0) : 1; }

  // ---- densities per area, or in the light's own measure

  double from_light(int i) const {
    if (i == 0) return is_beyond() ? direction : position;
    if (i == 1) return is_beyond() ? position * cos(1, 0) : direction * cos(1, 0) / squared(0);
    return to_lens[std::size_t(i - 1)] * cos(i, i - 1) / squared(i - 1);
  }
  double from_lens(int i) const {
    if (i == last() - 1) return pixels * cos(i, i);
    return to_light[std::size_t(i + 1)] * (i == 0 ? measure() : cos(i, i) / squared(i));
  }
  // n p of the strategy with s vertices from the light; 0: it cannot find the path.
  double connected(int s) const {
    const int k = last();
    if (s == 0 && is_delta_light()) return 0;
    if (s >= 1 && s < k && delta[std::size_t(s)]) return 0;
    if (s >= 2 && delta[std::size_t(s - 1)]) return 0;
    double product = s == k ? light_paths : 1;
    for (int i = 0; i < s; ++i) product *= s == 1 ? sampled * (is_delta_light() ? 1 : measure()) : from_light(i);
    for (int i = s; i < k; ++i) product *= from_lens(i);
    // Every segment is drawn and passed, except that of the connection.
    for (int i = 0; i < k; ++i) product *= s > 0 && i == s - 1 ? 1 : passing[std::size_t(i)];
    return product;
  }
  // n p of merging at vertex i.
  double merged(int i, double merges) const {
    if (delta[std::size_t(i)] || in_medium[std::size_t(i)]) return 0;
    double product = merges;
    for (const double segment : passing) product *= segment;
    for (int j = 0; j <= i; ++j) product *= from_light(j);
    for (int j = i; j < last(); ++j) product *= from_lens(j);
    return product;
  }
};

Path random_path(std::uint32_t number, bool in_media) {
  RandomStream<float> random = RandomStream<float>(17, 4).fork(number);
  const auto spread = [&random] { return std::exp2(6 * random.next() - 3); };
  const auto vector = [&random] { return Vec3f{2 * random.next() - 1, 2 * random.next() - 1, 2 * random.next() - 1}; };
  Path p;
  const int vertices = 3 + int(number % 6);
  for (int i = 0; i < vertices; ++i) {
    p.x.push_back(vector() * 3.0f);
    p.n.push_back(normalize(vector()));
    p.delta.push_back(i > 0 && i < vertices - 1 && random.next() < 0.25f);
    p.to_lens.push_back(p.delta.back() ? 1.0f : spread());
    p.to_light.push_back(p.delta.back() ? 1.0f : spread());
  }
  for (int i = 0; i < vertices; ++i) {
    const bool inner = i > 0 && i < vertices - 1 && !p.delta[std::size_t(i)];
    p.in_medium.push_back(in_media && inner && random.next() < 0.5f);
    if (i > 0) p.passing.push_back(in_media ? 0.02 + 0.98 * double(random.next()) : 1);
  }
  p.sort = LightSort(number / 6 % 4);
  p.position = spread(), p.direction = spread(), p.sampled = spread();
  if (p.sort == LightSort::distant) p.direction = 1;
  p.pixels = 100 * spread(), p.light_paths = 50 * spread();
  return p;
}

// What is planted in the recursion.
enum class Fault {
  none,
  no_lens,
  no_cosine,
  no_distance,
  deltas_connect,
  turned_densities,
  no_merging_behind,
  media_merge,
  nothing_passes
};

// The recursion along both subpaths of a path, and the weights of its strategies.
class Recursion {
 public:
  Recursion(const Path& path, bool power, float merges, bool connects, Fault fault = Fault::none)
      : p_(path), fault_(fault), w_(power, fault == Fault::no_merging_behind ? 0 : merges, connects) {
    const std::size_t k = std::size_t(p_.last());
    light_.resize(k), eye_.resize(k);
    light_[1] = w_.first_from_light(end(), float(p_.cos(1, 0)), passing(0));
    for (int i = 1; i < p_.last() - 1; ++i)
      light_[std::size_t(i + 1)] = w_.arrive(w_.scatter(light_[std::size_t(i)], both(i, false), cosine(i, i), delta(i)),
                                             distance(i), cosine(i + 1, i), passing(i));
    eye_[k - 1] = w_.first_from_lens(Density<Area, float>{float(p_.pixels)}, float(p_.cos(int(k) - 1, int(k) - 1)),
                                     fault == Fault::no_lens ? 0.0f : float(p_.light_paths), passing(int(k) - 1));
    for (int i = p_.last() - 1; i > 1; --i)
      eye_[std::size_t(i - 1)] = w_.arrive(w_.scatter(eye_[std::size_t(i)], both(i, true), cosine(i, i - 1), delta(i)),
                                           distance(i - 1), cosine(i - 1, i - 1), passing(i - 1));
  }

  double connected(int s) const {
    const int k = p_.last();
    const auto z = std::size_t(s), y = std::size_t(s - 1);
    if (s == 0) return w_.met(w_.scatter(eye_[1], both(1, true), cosine(1, 0), delta(1)), end(), passing(0));
    if (s == 1) return w_.light_sample(eye_[1], end(), both(1, true), cosine(1, 0), passing(0));
    if (s == k)
      return w_.lens(light_[y], both(k - 1, false), Density<Area, float>{float(p_.pixels)}, cosine(k - 1, k - 1),
                     float(p_.light_paths), passing(k - 1));
    return w_.connection(eye_[z], both(s, true), cosine(s, s - 1), light_[y], both(s - 1, false), cosine(s - 1, s - 1),
                         float(p_.squared(s - 1)), passing(s - 1));
  }
  double merged(int i) const { return w_.merging(eye_[std::size_t(i)], light_[std::size_t(i)], both(i, true)); }

 private:
  LightEnd<float> end() const {
    const double spread = p_.is_beyond() ? 1 : 1 / p_.squared(0);
    return {
        {float(p_.sampled)}, {float(p_.position * p_.direction * spread)}, float(p_.measure()), p_.is_delta_light()};
  }
  BothDensities<float> both(int i, bool from_eye) const {
    const float on = p_.to_lens[std::size_t(i)], back = p_.to_light[std::size_t(i)];
    const bool turned = from_eye != (fault_ == Fault::turned_densities);
    const bool merges = fault_ == Fault::media_merge || !p_.in_medium[std::size_t(i)];
    return turned ? BothDensities<float>{{back}, {on}, merges} : BothDensities<float>{{on}, {back}, merges};
  }
  float cosine(int i, int j) const { return fault_ == Fault::no_cosine ? 1.0f : float(p_.cos(i, j)); }
  float distance(int i) const { return fault_ == Fault::no_distance ? 1.0f : float(p_.squared(i)); }
  float passing(int i) const { return fault_ == Fault::nothing_passes ? 1.0f : float(p_.passing[std::size_t(i)]); }
  bool delta(int i) const { return fault_ != Fault::deltas_connect && p_.delta[std::size_t(i)]; }

  const Path& p_;
  const Fault fault_;
  StrategyWeights w_;
  std::vector<PartialWeights<float>> light_, eye_;
};

// The largest difference of any weight from that by the explicit sum, over many paths.
double largest_difference(bool power, float merges, bool connects, bool in_media, Fault fault = Fault::none) {
  double largest = 0;
  for (std::uint32_t number = 0; number < 480; ++number) {
    const Path path = random_path(number, in_media);
    const Recursion recursion(path, power, merges, connects, fault);
    const auto mis = [power](double x) { return power ? x * x : x; };
    double sum = 0, sum_of_weights = 0;
    for (int s = 0; connects && s <= path.last(); ++s) sum += mis(path.connected(s));
    for (int i = 1; merges > 0 && i < path.last(); ++i) sum += mis(path.merged(i, merges));
    if (sum == 0) continue;
    const auto compare = [&](double product, double weight) {
      if (product == 0) return;
      largest = std::max(largest, std::abs(mis(product) / sum - weight)), sum_of_weights += weight;
    };
    for (int s = 0; connects && s <= path.last(); ++s) compare(path.connected(s), recursion.connected(s));
    for (int i = 1; merges > 0 && i < path.last(); ++i) compare(path.merged(i, merges), recursion.merged(i));
    if (fault == Fault::none) {
      EXPECT_NEAR(sum_of_weights, 1, 2e-5) << "path " << number;
    }
  }
  return largest;
}

constexpr double rounding = 1e-5;

TEST(StrategyWeights, of_connections_are_those_of_the_sum_over_all_strategies) {
  for (const bool power : {false, true})
    for (const bool in_media : {false, true})
      EXPECT_LT(largest_difference(power, 0, true, in_media), rounding) << power << " " << in_media;
}

TEST(StrategyWeights, of_connections_and_mergings_are_those_of_the_sum_over_all_strategies) {
  for (const bool power : {false, true})
    for (const float merges : {0.01f, 1.0f, 30.0f})
      for (const bool in_media : {false, true})
        EXPECT_LT(largest_difference(power, merges, true, in_media), rounding)
            << power << " " << merges << " " << in_media;
}

TEST(StrategyWeights, of_mergings_alone_are_those_of_the_sum_over_mergings) {
  for (const bool power : {false, true}) EXPECT_LT(largest_difference(power, 1, false, false), rounding) << power;
}

TEST(StrategyWeights, with_planted_faults_are_others) {
  using enum Fault;
  for (const Fault fault : {no_lens, no_cosine, no_distance, deltas_connect, turned_densities})
    EXPECT_GT(largest_difference(true, 0, true, false, fault), 0.1) << int(fault);
  EXPECT_GT(largest_difference(true, 1, true, false, no_merging_behind), 0.1);
  EXPECT_GT(largest_difference(true, 1, true, true, media_merge), 0.1);
  EXPECT_GT(largest_difference(true, 0, true, true, nothing_passes), 0.1);
}

}  // namespace
}  // namespace montelux::test
