// The squared error of the mean of N independent series is what the spread of the series says, at every N up to ten
// thousand: it falls as 1 / N and leaves no floor, and the dependence between pixels and frames does no harm. Naive
// weights leave a floor.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <initializer_list>

#include "error_bars.h"
#include "path_reuse_scenes.h"
#include "reuse_checks.h"

namespace montelux::test {
namespace {

constexpr int size = 16, frames = 4;
// The means of `block` series are kept; all others are means of these.
constexpr std::size_t series = 10240, block = 10, groups = 32, draws = 20000;
constexpr double level = 0.01;
// Bounds of 95 % on the floor must be below this, in variances of the mean of all series. The error of a picture has
// few effective degrees of freedom, about eight: without a floor the bound is at one in the middle, and hardly ever
// above six.
constexpr double largest_floor = 6;

// A number a pixel.
using Picture = std::vector<double>;

// Mean over pixels.
double mean_product(const Picture& a, const Picture& b) {
  double sum = 0;
  for (std::size_t p = 0; p < a.size(); ++p) sum += a[p] * b[p];
  return sum / double(a.size());
}

// What is right in the pixels that are looked at: those that see a lamp are left out, whose noise is that of its edge.
// It rules the error, and is not reused.
struct Known {
  std::vector<std::size_t> pixels;  // row by row
  Truth truth;
};
bool sees_a_lamp(const TestScene& scene, int x, int y) {
  constexpr int n = 32;
  for (int i = 0; i < n * n; ++i) {
    const Vec2f raster{float(x) + (float(i % n) + 0.5f) / n, float(y) + (float(i / n) + 0.5f) / n};
    const Ray<float> ray = scene.scene().camera.generate(raster, Vec2f{0.5f, 0.5f}, 0.0f).ray;
    const auto [found, hit] = scene.accel().trace<float>(ray, true);
    if (found && surface<float>(scene.scene().geometry, ray, hit, true).light != 0) return true;
  }
  return false;
}
Known without_lamps(const TestScene& scene, const Truth& all) {
  Known k;
  for (std::size_t p = 0; p < all.mean.size(); ++p) {
    if (sees_a_lamp(scene, int(p) % size, int(p) / size)) continue;
    k.pixels.push_back(p), k.truth.mean.push_back(all.mean[p]), k.truth.variance.push_back(all.variance[p]);
  }
  return k;
}

// How far the means of successive blocks of series are off.
std::vector<Picture> errors_of_blocks(const TestScene& scene, std::string_view way, const Known& known) {
  const ChosenIntegrator chosen = scene.integrator(way);
  std::vector<Picture> errors;
  RenderObserver silent;
  for (std::size_t one = 0; one < series; ++one) {
    RenderSettings s = scene.settings(PointSetKind::independent, {frames, 1}, 11, 1);
    s.plan.first_pass = int(one);
    const Film film = render(chosen.any(), s, silent).film;
    if (one % block == 0) errors.emplace_back(known.pixels.size(), 0.0);
    for (std::size_t i = 0; i < known.pixels.size(); ++i) {
      const int x = int(known.pixels[i]) % size, y = int(known.pixels[i]) / size;
      errors.back()[i] += (film.pixel(x, y).mean[0] - known.truth.mean[i]) / double(block);
    }
  }
  return errors;
}

// Of `count` successive pictures each.
std::vector<Picture> means_of(const std::vector<Picture>& pictures, std::size_t count) {
  std::vector<Picture> means;
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    if (i % count == 0) means.emplace_back(pictures[i].size(), 0.0);
    for (std::size_t p = 0; p < pictures[i].size(); ++p) means.back()[p] += pictures[i][p] / double(count);
  }
  return means;
}

// N times the squared error of a mean of N series that is off by noise alone, drawn at random: the deviations of all
// blocks from their mean, each with a random sign. Its mean is the variance of a series.
std::vector<double> noise_of(const std::vector<Picture>& blocks) {
  const Picture mean = means_of(blocks, blocks.size())[0];
  const double scale = std::sqrt(double(block) / double(blocks.size() - 1));
  std::vector<std::vector<float>> deviations(blocks.size());
  for (std::size_t b = 0; b < blocks.size(); ++b)
    for (std::size_t p = 0; p < mean.size(); ++p) deviations[b].push_back(float(scale * (blocks[b][p] - mean[p])));
  std::vector<double> noise;
  for (std::uint32_t draw = 0; draw < draws; ++draw) {
    const RandomStream<float> stream(1, draw);
    std::vector<float> sums(mean.size(), 0.0f);
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      const float sign = stream.bits_at(std::uint32_t(b / 32)) >> (b % 32) & 1 ? 1.0f : -1.0f;
      for (std::size_t p = 0; p < sums.size(); ++p) sums[p] += sign * deviations[b][p];
    }
    double squares = 0;
    for (float s : sums) squares += double(s) * double(s);
    noise.push_back(squares / double(sums.size()));
  }
  return noise;
}

// Two-sided, by draws: is `value` a mean of so many independent values of noise?
double noise_p_value(const std::vector<double>& noise, std::size_t count, double value) {
  double as_much = 0, as_little = 0;
  for (std::uint32_t draw = 0; draw < draws; ++draw) {
    const RandomStream<float> stream(2, draw);
    double mean = 0;
    for (std::size_t i = 0; i < count; ++i)
      mean += noise[stream.bits_at(std::uint32_t(i)) % noise.size()] / double(count);
    (mean >= value ? as_much : as_little) += 1;
  }
  return std::min(1.0, 2 * (1 + std::min(as_much, as_little)) / double(draws + 1));
}

// The mean squared bias: the mean product of the errors of two groups, over all pairs, as groups are independent and
// the noise of one knows nothing of the other's. By pseudo-values, one for each group that is left out (jackknife);
// where there is no bias, their standard error is too large by 1.4.
SampleSummary floor_of(const std::vector<Picture>& errors, double known) {
  const double n = double(errors.size());
  std::vector<double> of_group(errors.size(), 0.0), pseudo;
  double all = 0;
  for (std::size_t i = 0; i < errors.size(); ++i)
    for (std::size_t j = 0; j < errors.size(); ++j) {
      if (i == j) continue;
      const double product = mean_product(errors[i], errors[j]) - known;
      of_group[i] += product, all += product;
    }
  for (double own : of_group) pseudo.push_back(all / (n - 1) - (all - 2 * own) / (n - 2));
  return summarize(pseudo);
}

struct Point {
  std::size_t n;
  double mse, p_value;  // the mean over all parts of N series; is that the noise of N series?
};
struct Errors {
  std::vector<Point> points;
  double slope = 0;                  // of log MSE over log N
  double variance = 0, degrees = 0;  // of a series, by the spread of blocks; effective degrees of freedom of its error
  SampleSummary floor;               // the mean squared bias

  double variance_of_last() const { return variance / double(series); }
  // One-sided: is there no floor?
  double floor_p_value() const {
    const TestResult t = t_test(floor, 0);
    return student_t_cdf(-t.statistic, t.degrees);
  }
  // 95 %.
  double floor_at_most() const {
    return floor.mean + student_t_quantile(0.95, floor.count - 1) * floor.standard_error();
  }
};

// By least squares.
double slope_of_logarithms(const std::vector<Point>& points) {
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  const auto count = double(points.size());
  for (const Point& at : points) {
    const double a = std::log(double(at.n)), b = std::log(std::max(at.mse, 1e-30));
    sx += a, sy += b, sxx += a * a, sxy += a * b;
  }
  return (count * sxy - sx * sy) / (count * sxx - sx * sx);
}

Errors errors_of(const std::vector<Picture>& blocks, const Truth& truth) {
  // The truth's own variance, which all squares and products have in them.
  double known = 0;
  for (double v : truth.variance) known += v / double(truth.variance.size());
  const std::vector<double> noise = noise_of(blocks);
  const SampleSummary spread = summarize(noise);
  Errors e;
  e.variance = spread.mean, e.degrees = 2 * spread.mean * spread.mean / spread.variance;
  for (std::size_t n = block; n <= series; n *= 4) {
    const std::vector<Picture> means = means_of(blocks, n / block);
    double mse = -known;
    for (const Picture& mean : means) mse += mean_product(mean, mean) / double(means.size());
    e.points.push_back({n, mse, noise_p_value(noise, means.size(), double(n) * mse)});
  }
  e.slope = slope_of_logarithms(e.points);
  e.floor = floor_of(means_of(blocks, blocks.size() / groups), known);
  return e;
}

void print(const char* name, const Errors& e) {
  std::printf("%s: slope %.3f; MSE", name, e.slope);
  for (const Point& at : e.points) std::printf(" %zu: %.3g", at.n, at.mse);
  std::printf("\n  over that of noise");
  for (const Point& at : e.points)
    std::printf(" %zu: %.3f (p %.2g)", at.n, at.mse * double(at.n) / e.variance, at.p_value);
  std::printf("\n  variance of a series %.3g, %.1f degrees of freedom, of the last mean %.3g\n", e.variance, e.degrees,
              e.variance_of_last());
  std::printf("  squared bias %.3g +- %.3g, at most %.3g (95 %%)\n", e.floor.mean, e.floor.standard_error(),
              e.floor_at_most());
}

// Unbiased ways keep the law, and a biased one does not.
void hold_to_the_law(const TestScene& scene, const char* biased, std::initializer_list<const char*> ways) {
  const Known known = without_lamps(scene, truth_of(scene, {8192, 64}));
  const Truth& truth = known.truth;
  EXPECT_GT(known.pixels.size(), std::size_t(size * size * 9 / 10));
  // Of each form, five numbers of series and the floor.
  const double own = sidak_level(level, double(ways.size()) * (5 + 1));
  const std::vector<Picture> biased_blocks = errors_of_blocks(scene, biased, known);
  const Errors off_by_form = errors_of(biased_blocks, truth);
  print(biased, off_by_form);
  ASSERT_EQ(off_by_form.points.size(), 6u);
  for (std::size_t i = 2; i < off_by_form.points.size(); ++i)
    EXPECT_LT(off_by_form.points[i].p_value, own) << off_by_form.points[i].n;
  EXPECT_LT(off_by_form.floor_p_value(), own);
  const Picture bias = means_of(biased_blocks, biased_blocks.size())[0];
  for (const char* way : ways) {
    std::vector<Picture> blocks = errors_of_blocks(scene, way, known);
    const Errors unbiased = errors_of(blocks, truth);
    print(way, unbiased);
    // Blocks themselves say nothing: their spread is what noise is drawn from.
    for (std::size_t i = 1; i < unbiased.points.size(); ++i)
      EXPECT_GT(unbiased.points[i].p_value, own) << way << ", " << unbiased.points[i].n;
    EXPECT_GT(unbiased.floor_p_value(), own) << way;
    EXPECT_LT(unbiased.floor_at_most(), largest_floor * unbiased.variance_of_last()) << way;
    // Planted: a quarter of the bias, a sixteenth of its floor.
    for (Picture& block_error : blocks)
      for (std::size_t p = 0; p < bias.size(); ++p) block_error[p] += 0.25 * bias[p];
    const Errors off = errors_of(blocks, truth);
    print("a quarter of the bias of naive weights planted", off);
    EXPECT_LT(off.points.back().p_value, own) << way;
    EXPECT_LT(off.floor_p_value(), own) << way;
    EXPECT_GT(off.floor_at_most(), largest_floor * off.variance_of_last()) << way;
  }
}

TEST(ReuseSlope, is_minus_one_to_ten_thousand_series) {
  const ReuseScene text = reuse_scenes(size)[1];
  ASSERT_EQ(text.name, "blockers");
  hold_to_the_law(TestScene(text.text), "restir-di:radius=4,weights=naive",
                  {"restir-di:radius=4", "restir-di:radius=4,weights=pairwise"});
}

// Paths of several bounces, whose frames reuse the previous frames.
TEST(ReuseSlope, of_paths_is_minus_one_to_ten_thousand_series) {
  const ReuseScene text = path_reuse_scenes(size)[0];
  ASSERT_EQ(text.name, "indirect");
  hold_to_the_law(TestScene(text.text, textures_of_reuse_scenes()),
                  "restir-pt:radius=4,temporal=on,weights=naive,similar=off", {"restir-pt:radius=4,temporal=on"});
}

}  // namespace
}  // namespace montelux::test
