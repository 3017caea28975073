// The squared error of the mean of N independent chains falls as 1 / N, to ten thousand chains: no floor is left by the
// dependence between pixels and frames. Naive weights leave one.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "error_bars.h"
#include "reuse_scenes.h"

namespace montelux::test {
namespace {

constexpr int size = 16, chains = 10240, groups = 32;
constexpr double level = 0.01;

// Pass means: one number a pixel and chain.
std::vector<std::vector<float>> chains_of(const TestScene& scene, std::string_view way, int frames) {
  const ChosenIntegrator chosen = scene.integrator(way);
  std::vector<std::vector<float>> all;
  RenderObserver silent;
  for (int chain = 0; chain < chains; ++chain) {
    RenderSettings s = scene.settings(PointSetKind::independent, {frames, 1}, 11, 1);
    s.first_pass = chain;
    const Film film = render(chosen.any(), s, silent).film;
    std::vector<float>& means = all.emplace_back();
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x) means.push_back(float(film.pixel(x, y).mean[0]));
  }
  return all;
}

struct Errors {
  std::vector<double> n, mse;        // for N chains, over all parts of N
  double slope = 0;                  // of log MSE over log N
  std::vector<double> squared_bias;  // estimates of the mean squared bias, one for each pair of neighbouring groups
};

Errors errors_of(const std::vector<std::vector<float>>& all, const Truth& truth) {
  const std::size_t pixels = truth.mean.size();
  double known = 0;
  for (double v : truth.variance) known += v / double(pixels);
  const auto off = [&](std::size_t first, std::size_t n) {
    std::vector<double> d(pixels, 0.0);
    for (std::size_t i = first; i < first + n; ++i)
      for (std::size_t p = 0; p < pixels; ++p) d[p] += double(all[i][p]) / double(n);
    for (std::size_t p = 0; p < pixels; ++p) d[p] -= truth.mean[p];
    return d;
  };
  Errors e;
  double sx = 0, sy = 0, sxx = 0, sxy = 0, count = 0;
  for (std::size_t n = 10; n <= all.size(); n *= 4) {
    double sum = 0;
    const std::size_t parts = all.size() / n;
    for (std::size_t part = 0; part < parts; ++part)
      for (double d : off(part * n, n)) sum += d * d / double(pixels * parts);
    e.n.push_back(double(n)), e.mse.push_back(sum - known);
    const double x = std::log(double(n)), y = std::log(std::max(e.mse.back(), 1e-30));
    sx += x, sy += y, sxx += x * x, sxy += x * y, count += 1;
  }
  e.slope = (count * sxy - sx * sy) / (count * sxx - sx * sx);
  // Groups are independent, so the mean product of two groups' errors is the squared bias and the truth's own variance.
  const std::size_t n = all.size() / groups;
  for (std::size_t g = 0; g < groups; g += 2) {
    const std::vector<double> a = off(g * n, n), b = off((g + 1) * n, n);
    double product = 0;
    for (std::size_t p = 0; p < pixels; ++p) product += a[p] * b[p] / double(pixels);
    e.squared_bias.push_back(product - known);
  }
  return e;
}

void print(const char* name, const Errors& e) {
  std::printf("%s: slope %.3f;", name, e.slope);
  for (std::size_t i = 0; i < e.n.size(); ++i) std::printf(" %g: %.3g", e.n[i], e.mse[i]);
  const SampleSummary bias = summarize(e.squared_bias);
  std::printf("; squared bias %.3g +- %.3g\n", bias.mean, bias.standard_error());
}

TEST(ReuseSlope, is_minus_one_to_ten_thousand_chains) {
  const ReuseScene text = reuse_scenes(size)[1];
  ASSERT_EQ(text.name, "blockers");
  const TestScene scene(text.text);
  const Truth truth = truth_of(scene, {8192, 64});
  const Errors unbiased = errors_of(chains_of(scene, "restir-di:radius=4", 4), truth);
  const Errors naive = errors_of(chains_of(scene, "restir-di:radius=4,weights=naive", 4), truth);
  print("pairwise", unbiased), print("naive", naive);
  EXPECT_NEAR(unbiased.slope, -1, 0.1);
  EXPECT_GT(t_test(unbiased.squared_bias, 0).p_value, level);
  EXPECT_GT(naive.slope, -0.8);
  EXPECT_LT(t_test(naive.squared_bias, 0).p_value, 1e-4);
}

}  // namespace
}  // namespace montelux::test
