// Where naive weights are biased, and by how much, follows from geometry: over a floor that the half-plane of a screen
// parts from a lamp, each pixel's domain is what it sees of the lamp. Column by column of the picture, at one level for
// all: what lies within reach of pixels with another domain is too dark, by as much as the shares of neighbours say;
// all else is right. Nothing that is expected here comes from a render.
#include <gtest/gtest.h>

#include <numbers>

#include "pass_means.h"
#include "reuse_scenes.h"

namespace montelux::test {
namespace {

// Naive weights are measured well enough to tell five neighbours from four in a penumbra.
constexpr int size = 32, frames = 8, passes = 100, naive_passes = 400, neighbours = 5;
constexpr double level = 1e-3, decisions = 18;
constexpr double albedo = 0.6, lamp_height = 2, screen_height = 1.5;
// A bias of more than this must be found; one that is smaller needs only be as large as predicted.
constexpr double surely_found = 0.01;

// A lamp over the floor y = 0, and the edge of the screen, which reaches from there to the left: what is seen of the
// lamp from a place of the floor is what lies right of a line.
class Stage {
 public:
  virtual ~Stage() = default;
  virtual double edge() const = 0;
  virtual std::string lamp() const = 0;
  // What the floor at (x, z) sends up of the light of the lamp's part right of `from`.
  virtual double light(double x, double z, double from) const = 0;

  double seen_from(double x) const {
    return (edge() * lamp_height - x * (lamp_height - screen_height)) / screen_height;
  }
  std::string text() const {
    const char* camera = R"(LookAt 0 1 0  0 0 0  0 0 1
Camera "orthographic" "float screenwindow" [ -1 1 -1 1 ])";
    return reuse_scene_head(size, camera, 1) + lamp() +
           fmt::format(R"(Material "diffuse" "rgb reflectance" [ {0} {0} {0} ]
Shape "bilinearmesh" "point3 P" [ -3 0 -3  3 0 -3  -3 0 3  3 0 3 ]
Material "diffuse" "rgb reflectance" [ 0 0 0 ]
Shape "bilinearmesh" "point3 P" [ -90 {1} -90  {2} {1} -90  -90 {1} 90  {2} {1} 90 ]
)",
                       albedo, screen_height, edge());
  }
};

// The shadow ends at x = 0, between columns 15 and 16.
class PointLamp final : public Stage {
 public:
  double edge() const override { return at * screen_height / lamp_height; }
  std::string lamp() const override {
    return fmt::format("LightSource \"point\" \"rgb I\" [ 9 9 9 ] \"point3 from\" [ {} {} 0 ]\n", at, lamp_height);
  }
  double light(double x, double z, double from) const override {
    if (at < from) return 0;
    const double squared = (x - at) * (x - at) + lamp_height * lamp_height + z * z;
    return albedo / std::numbers::pi * 9 * lamp_height / (squared * std::sqrt(squared));
  }

 private:
  static constexpr double at = 0.3;
};

// The penumbra is six columns wide, from x = -1/8 (column 14) to x = 1/4 (column 20).
class Panel final : public Stage {
 public:
  double edge() const override { return 0; }
  std::string lamp() const override {
    return fmt::format(R"(AttributeBegin
AreaLightSource "diffuse" "rgb L" [ 9 9 9 ] "bool twosided" [ true ]
Material "diffuse" "rgb reflectance" [ 0 0 0 ]
Shape "bilinearmesh" "point3 P" [ {0} {2} -{3}  {1} {2} -{3}  {0} {2} {3}  {1} {2} {3} ]
AttributeEnd
)",
                       left, right, lamp_height, half_depth);
  }
  // The configuration factor of a parallel rectangle (Howell's catalogue, B-3), corner by corner.
  double light(double x, double z, double from) const override {
    from = std::clamp(from, left, right);
    const auto corner = [](double a, double b) {
      a /= lamp_height, b /= lamp_height;
      const double p = std::sqrt(1 + a * a), q = std::sqrt(1 + b * b);
      return (a / p * std::atan(b / p) + b / q * std::atan(a / q)) / (2 * std::numbers::pi);
    };
    return albedo * 9 *
           (corner(right - x, half_depth - z) - corner(from - x, half_depth - z) - corner(right - x, -half_depth - z) +
            corner(from - x, -half_depth - z));
  }

 private:
  static constexpr double left = -1.0 / 12, right = 1.0 / 24, half_depth = 0.5;
};

// How often a place uniform in a disk is nearest to the pixel (dx, dy): the disk's share in a unit square.
class DiskShares {
 public:
  explicit DiskShares(double radius) : reach_(int(radius + 0.5)), width_(2 * reach_ + 1) {
    for (int dy = -reach_; dy <= reach_; ++dy)
      for (int dx = -reach_; dx <= reach_; ++dx) {
        const auto chord = [&](double x) {
          const double half = std::sqrt(std::max(0.0, radius * radius - x * x));
          return std::max(0.0, std::min(dy + 0.5, half) - std::max(dy - 0.5, -half));
        };
        shares_.push_back(integrate(chord, dx - 0.5, dx + 0.5, 64) / (std::numbers::pi * radius * radius));
      }
  }
  int reach() const { return reach_; }
  double of(int dx, int dy) const { return shares_[std::size_t((dy + reach_) * width_ + dx + reach_)]; }

 private:
  int reach_, width_;
  std::vector<double> shares_;
};

// Means of columns: of all light, and of what naive weights leave.
struct Expected {
  std::vector<double> all, naive;
  double bias(std::size_t column) const { return naive[column] / all[column] - 1; }
};

// A pixel's sample reaches another one where that sees it, too, and both look at the lamp past one edge: what both see
// is what the left one sees. Of N neighbours that are there, of `draws` that are looked for, each counts 1 / (1 + N),
// as the pixel itself.
Expected expected(const Stage& stage, double radius, int draws) {
  static const QuadratureRule rule = gauss_legendre(4);
  constexpr double width = 2.0 / size;
  const DiskShares shares(radius);
  const auto place = [](int pixel, double u) { return -1 + width * (pixel + u); };
  const auto mean = [](auto f) {
    double sum = 0;
    for (std::size_t i = 0; i < rule.x.size(); ++i) sum += rule.w[i] * f(rule.x[i]);
    return sum;
  };
  // Of pixel (column, row), by a neighbour in column `other`.
  const auto shared = [&](int column, int row, int other) {
    return mean([&](double v) {
      return mean([&](double u) {
        const double x = place(column, u), z = place(row, v);
        const auto by = [&](double w) { return stage.light(x, z, stage.seen_from(std::min(x, place(other, w)))); };
        if (other != column) return mean(by);
        return u * mean([&](double w) { return by(u * w); }) + (1 - u) * by(1);
      });
    });
  };
  Expected e{std::vector<double>(size, 0.0), std::vector<double>(size, 0.0)};
  for (int column = 0; column < size; ++column)
    for (int row = 0; row < size; ++row) {
      const double own = mean([&](double v) {
        return mean([&](double u) {
          const double x = place(column, u);
          return stage.light(x, place(row, v), stage.seen_from(x));
        });
      });
      double there = 0, theirs = 0;
      for (int dx = -shares.reach(); dx <= shares.reach(); ++dx) {
        double here = 0;
        for (int dy = -shares.reach(); dy <= shares.reach(); ++dy) {
          const bool inside = column + dx >= 0 && column + dx < size && row + dy >= 0 && row + dy < size;
          if (inside && (dx != 0 || dy != 0)) here += shares.of(dx, dy);
        }
        there += here;
        if (here > 0) theirs += here * shared(column, row, column + dx);
      }
      // E[1 / (1 + N)] of a binomial N.
      const double own_share = (1 - std::pow(1 - there, draws + 1)) / ((draws + 1) * there);
      e.all[std::size_t(column)] += own / size;
      e.naive[std::size_t(column)] += (own_share * own + (1 - own_share) * theirs / there) / size;
    }
  return e;
}

// Column by column.
PassMeans measure(const Stage& stage, const std::string& settings, int count, std::uint32_t seed) {
  const TestScene scene(stage.text());
  const ChosenIntegrator chosen = scene.integrator(
      fmt::format("restir-di:candidates=1,bsdf=off,temporal=off,similar=off,neighbours={},{}", neighbours, settings));
  return measure_passes(scene, chosen, frames, count, seed, {1, size});
}
double p_value(const PassMeans& m, std::size_t column, double value) {
  return t_test(m.values[1 + column], value).p_value;
}
// Of all columns that see light, at one level.
int columns_that_differ(const PassMeans& m, const std::vector<double>& means) {
  int differ = 0;
  for (std::size_t c = 0; c < size; ++c)
    differ += means[c] > 0 && p_value(m, c, means[c]) < sidak_level(level / decisions, size);
  return differ;
}

// Columns [first_biased, first_right) see light, and are within reach of other domains; those left of them are dark.
void expect_bias_in(const Stage& stage, double radius, std::size_t first_biased, std::size_t first_right) {
  const Expected theory = expected(stage, radius, neighbours);
  const PassMeans naive = measure(stage, fmt::format("weights=naive,radius={}", radius), naive_passes, 1);
  const double own = sidak_level(level / decisions, size);
  for (std::size_t c = 0; c < size; ++c) {
    if (c < first_biased) {
      // A place of the floor is rounded, and so is on which side of the edge it is.
      EXPECT_LT(summarize(naive.values[1 + c]).mean, 1e-4 * theory.all[first_biased]) << c;
      continue;
    }
    const SampleSummary measured = summarize(naive.values[1 + c]);
    printf("column %2zu: bias %+.3f %% +- %.3f %%, predicted %+.3f %%\n", c, 100 * (measured.mean / theory.all[c] - 1),
           100 * measured.standard_error() / theory.all[c], 100 * theory.bias(c));
    const double p = p_value(naive, c, theory.all[c]);
    if (c >= first_right) {
      EXPECT_NEAR(theory.bias(c), 0, 1e-12) << c;
      EXPECT_GT(p, own) << c;
    } else if (theory.bias(c) < -surely_found) {
      EXPECT_LT(p, own) << c;
    }
  }
  EXPECT_EQ(columns_that_differ(naive, theory.naive), 0);
  // Planted: neighbours that are looked for a little less far, or one of them less than there is.
  EXPECT_GT(columns_that_differ(naive, expected(stage, radius - 0.5, neighbours).naive), 0);
  EXPECT_GT(columns_that_differ(naive, expected(stage, radius, neighbours - 1).naive), 0);
  // Groups and every other form of weights are right everywhere, and so is this one where targets do not see the
  // screen.
  for (const char* way : {"groups=on", "weights=pairwise", "weights=unbiased", "weights=generalised",
                          "weights=naive,visibility-reuse=off"}) {
    const PassMeans means = measure(stage, fmt::format("{},radius={}", way, radius), passes, 2);
    EXPECT_EQ(columns_that_differ(means, theory.all), 0) << way;
  }
}

TEST(NaiveBias, is_where_neighbours_of_a_point_lamps_shadow_are_and_as_large_as_their_share) {
  expect_bias_in(PointLamp(), 6, 16, 22);
}

TEST(NaiveBias, is_in_and_around_the_penumbra_of_a_panel_and_as_large_as_what_neighbours_do_not_see) {
  expect_bias_in(Panel(), 4, 14, 24);
}

}  // namespace
}  // namespace montelux::test
