// The squared error of the mean of N independent chains falls as 1 / N, and leaves no floor at ten thousand chains: the
// dependence between pixels and frames does no harm. Naive weights leave a floor.
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
  std::vector<double> slopes;        // the same of each part of the chains by itself
  std::vector<double> squared_bias;  // estimates of the mean squared bias, one for each pair of neighbouring groups
};

// Of log y over log x, by least squares.
double slope_of_logarithms(const std::vector<double>& x, const std::vector<double>& y) {
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  const auto count = double(x.size());
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double a = std::log(x[i]), b = std::log(std::max(y[i], 1e-30));
    sx += a, sy += b, sxx += a * a, sxy += a * b;
  }
  return (count * sxy - sx * sy) / (count * sxx - sx * sx);
}

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
  // Mean squared errors of means of n chains, for ever larger n, over the chains [first, last).
  const auto fill = [&](std::size_t first, std::size_t last, std::vector<double>& ns, std::vector<double>& mse) {
    for (std::size_t n = 10; n <= last - first; n *= 4) {
      double sum = 0;
      const std::size_t parts = (last - first) / n;
      for (std::size_t part = 0; part < parts; ++part)
        for (double d : off(first + part * n, n)) sum += d * d / double(pixels * parts);
      ns.push_back(double(n)), mse.push_back(sum - known);
    }
  };
  Errors e;
  fill(0, all.size(), e.n, e.mse);
  e.slope = slope_of_logarithms(e.n, e.mse);
  constexpr std::size_t part = 640;
  for (std::size_t first = 0; first + part <= all.size(); first += part) {
    std::vector<double> n, mse;
    fill(first, first + part, n, mse);
    e.slopes.push_back(slope_of_logarithms(n, mse));
  }
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
  const SampleSummary bias = summarize(e.squared_bias), slopes = summarize(e.slopes);
  std::printf("; slope of a part %.4f +- %.4f, squared bias %.3g +- %.3g\n", slopes.mean, slopes.standard_error(),
              bias.mean, bias.standard_error());
}

TEST(ReuseSlope, is_minus_one_to_ten_thousand_chains) {
  const ReuseScene text = reuse_scenes(size)[1];
  ASSERT_EQ(text.name, "blockers");
  const TestScene scene(text.text);
  const Truth truth = truth_of(scene, {8192, 64});
  const auto measured = [&](const char* way) {
    const Errors e = errors_of(chains_of(scene, way, 4), truth);
    print(way, e);
    return e;
  };
  // The slope up to the chains of one part, in independent parts; the floor, over all chains.
  const double own = sidak_level(level, 4);
  const Errors naive = measured("restir-di:radius=4,weights=naive");
  const SampleSummary floor = summarize(naive.squared_bias);
  EXPECT_LT(t_test(naive.slopes, -1).p_value, own);
  EXPECT_LT(t_test(naive.squared_bias, 0).p_value, own);
  for (const char* way : {"restir-di:radius=4", "restir-di:radius=4,weights=pairwise"}) {
    const Errors unbiased = measured(way);
    EXPECT_GT(t_test(unbiased.slopes, -1).p_value, own) << way;
    EXPECT_GT(t_test(unbiased.squared_bias, 0).p_value, own) << way;
    // Good enough to see a tenth of the naive form's floor.
    EXPECT_LT(3 * summarize(unbiased.squared_bias).standard_error(), 0.1 * floor.mean) << way;
  }
}

}  // namespace
}  // namespace montelux::test
