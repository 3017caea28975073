// Pixels that share samples: what they show, their noise, their features, and their bits.
#include "render/shared_samples.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "mc/random.h"
#include "render/render.h"
#include "statistics.h"

namespace montelux::test {

namespace {

constexpr PixelBounds picture{0, 0, 40, 24};

// The samples of a plane whose light is known at every place, with noise of variance 1, independent from sample to
// sample, in `noise`.
class Plane final : public PixelIntegrator {
 public:
  using Show = std::function<PixelSample(float x, float y, const TilePass& pass, std::uint32_t index, float noise)>;
  explicit Plane(Show show) : show_(std::move(show)) {}

  RayCounts trace(const TilePass& pass, std::span<PixelSample> out) const override {
    std::size_t at = 0;
    for (int y = pass.tile.y0; y < pass.tile.y1; ++y)
      for (int x = pass.tile.x0; x < pass.tile.x1; ++x)
        for (std::uint32_t i = 0; i < pass.samples(); ++i) {
          const std::uint32_t index = pass.only.value_or(i),
                              place = std::uint32_t(y + 64) * 1024u + std::uint32_t(x + 64);
          RandomStream<float> random(mix_bits(pass.points.seed * 7919u + pass.points.pass) + index, place);
          const float noise = (random.next() - 0.5f) * std::sqrt(12.0f);
          const Vec2f offset = pass.offsets.empty() ? Vec2f{0, 0} : pass.offsets[index];
          out[at++] = show_(float(x) + 0.5f + offset.x, float(y) + 0.5f + offset.y, pass, index, noise);
        }
    return {};
  }

 private:
  Show show_;
};

PixelSample gray(float light) {
  PixelSample sample;
  sample.radiance = gray_rgb(light);
  return sample;
}

Filter filter_of(FilterKind kind, float radius) {
  FilterDesc filter = FilterDesc::usual(kind);
  filter.x_radius = filter.y_radius = radius;
  return Filter::build(filter);
}

RenderSettings settings_of(const Filter& filter, PassPlan plan, std::uint32_t seed, int threads = 1) {
  RenderSettings s;
  s.image.bounds = picture, s.image.width = picture.width(), s.image.height = picture.height();
  s.image.sampler = PointSetKind::padded_sobol, s.image.seed = seed, s.plan = plan, s.threads = threads;
  s.image.sharing = sharing_for(filter);
  return s;
}

Film film_of(const Plane& plane, const RenderSettings& settings) {
  RenderObserver silent;
  return render(plane, settings, silent).film;
}

// The p-values of what films show against its expectation, and against that of a fault that is planted: moved by a
// twentieth of `scale`.
struct Verdict {
  double of_truth, of_fault;
};
Verdict verdict(const Plane& plane, double expected, double scale, const std::function<double(const Film&)>& shown) {
  std::vector<double> values;
  for (std::uint32_t seed = 1; seed <= 16; ++seed)
    values.push_back(shown(film_of(plane, settings_of(filter_of(FilterKind::triangle, 1), {8, 16}, seed))));
  return {t_test(values, expected).p_value, t_test(values, expected + scale / 20).p_value};
}
void expect_true(const Verdict& verdict) {
  EXPECT_GT(verdict.of_truth, family_level);
  EXPECT_LT(verdict.of_fault, family_level);
}

// The part of a tent of this radius below `edge`, from its centre.
double tent_below(double edge, double radius) {
  const double t = std::clamp(edge / radius, -1.0, 1.0);
  return t < 0 ? (1 + t) * (1 + t) / 2 : 1 - (1 - t) * (1 - t) / 2;
}

// The p-value of the means of all pixels, those at the borders included, against a half-plane x < edge under a tent of
// radius 1. `moved`: by how much the plane is moved in a fault that is planted.
double half_plane_p_value(double edge, double moved) {
  const Plane plane([&](float x, float, const TilePass&, std::uint32_t, float noise) {
    return gray((double(x) < edge + moved ? 1.0f : 0.0f) + 0.01f * noise);
  });
  const Film film = film_of(plane, settings_of(filter_of(FilterKind::triangle, 1), {4, 256}, 5));
  // Pixels of a column, and neighbours, have errors in common: the mean of each column counts.
  double worst = 1;
  for (int x = picture.x0; x < picture.x1; ++x) {
    const double expected = tent_below(edge - (x + 0.5), 1);
    const PixelEstimate p = film.pixel(x, picture.y0 + 3);
    worst = std::min(
        worst,
        t_test(Estimate{p.mean[0], std::sqrt(p.variance_of_mean(0)), std::uint64_t(p.passes)}, expected).p_value);
  }
  return worst;
}

}  // namespace

TEST(SharedSamples, show_what_the_filter_weighs) {
  for (const double edge : {0.3, 12.0, 17.4, 39.8}) {
    EXPECT_GT(half_plane_p_value(edge, 0), family_level / picture.width()) << edge;
    EXPECT_LT(half_plane_p_value(edge, 0.08), family_level / picture.width()) << edge;
  }
}

TEST(SharedSamples, leave_the_noise_that_is_stated) {
  for (const auto& [kind, radius] :
       {std::pair{FilterKind::triangle, 1.0f}, {FilterKind::gaussian, 1.5f}, {FilterKind::mitchell, 2.0f}}) {
    SCOPED_TRACE(name_of(kind));
    const Plane plane([](float, float, const TilePass&, std::uint32_t, float noise) { return gray(3 + noise); });
    const double expected = SampleSharing(filter_of(kind, radius)).noise() / 8;
    std::vector<double> variances;
    for (std::uint32_t seed = 1; seed <= 24; ++seed) {
      const Film film = film_of(plane, settings_of(filter_of(kind, radius), {8, 16}, seed));
      double sum = 0;
      for (int y = picture.y0; y < picture.y1; ++y)
        for (int x = picture.x0; x < picture.x1; ++x) sum += film.pixel(x, y).variance_of_mean(0) * 16;
      variances.push_back(sum / picture.area());
    }
    EXPECT_GT(t_test(variances, expected).p_value, family_level);
    EXPECT_LT(t_test(variances, 1.2 * expected).p_value, family_level);
  }
}

TEST(SharedSamples, leave_no_noise_in_what_is_even) {
  const Plane plane([](float, float, const TilePass&, std::uint32_t, float) { return gray(0.3f); });
  for (const auto& [kind, radius] :
       {std::pair{FilterKind::triangle, 1.0f}, {FilterKind::gaussian, 1.5f}, {FilterKind::mitchell, 2.0f}}) {
    const PixelEstimate p = film_of(plane, settings_of(filter_of(kind, radius), {4, 4}, 1)).pixel(0, 0);
    EXPECT_EQ(p.mean[0], double(0.3f));
    EXPECT_EQ(p.variance_of_mean(0), 0);
  }
}

TEST(SharedSamples, make_the_same_bits_for_any_tiles_and_threads) {
  const Plane plane([](float x, float y, const TilePass&, std::uint32_t, float noise) {
    PixelSample sample = gray(x * y + noise);
    sample.features.coverage = x < 20 ? 1 : 0, sample.features.depth = y;
    return sample;
  });
  RenderSettings settings = settings_of(filter_of(FilterKind::gaussian, 1.5f), {4, 4}, 1);
  const Film film = film_of(plane, settings);
  settings.plan.max_unit_samples = 4 * 8 * 8, settings.threads = 2;
  const Film other = film_of(plane, settings);
  for (int y = picture.y0; y < picture.y1; ++y)
    for (int x = picture.x0; x < picture.x1; ++x) {
      const PixelEstimate a = film.pixel(x, y), b = other.pixel(x, y);
      EXPECT_EQ(std::tie(a.mean[0], a.m2[0]), std::tie(b.mean[0], b.m2[0]));
      EXPECT_EQ(film.features(x, y).hits, other.features(x, y).hits);
      EXPECT_EQ(film.features(x, y).sums, other.features(x, y).sums);
    }
}

TEST(SharedSamples, belong_to_features_as_well) {
  // A surface at x < 20, whose depth is 5 for y < 12 and 7 below.
  const Plane plane([](float x, float y, const TilePass&, std::uint32_t, float) {
    PixelSample sample = gray(1);
    if (x < 20) sample.features.coverage = 1, sample.features.depth = y < 12 ? 5.0f : 7.0f, sample.features.object = 3;
    return sample;
  });
  const Film film = film_of(plane, settings_of(filter_of(FilterKind::triangle, 1), {64, 16}, 1));
  const auto coverage = [&](int x) { return film.features(x, 4).hits / film.features(x, 4).samples; };
  EXPECT_EQ(coverage(10), 1);
  EXPECT_EQ(coverage(30), 0);
  for (const auto& [x, edge] : {std::pair{19, 0.5}, {20, -0.5}})
    expect_true(verdict(plane, tent_below(edge, 1), 1,
                        [&, x = x](const Film& f) { return f.features(x, 4).hits / f.features(x, 4).samples; }));
  EXPECT_EQ(film.features(19, 4).object, 3u);
  expect_true(verdict(plane, 5 * tent_below(0.5, 1) + 7 * tent_below(-0.5, 1), 2,
                      [](const Film& f) { return f.features(10, 11).depth() / f.features(10, 11).hits; }));
  // Filters with negative lobes overshoot, but not where that has no meaning.
  const Film sharp = film_of(plane, settings_of(filter_of(FilterKind::mitchell, 2), {64, 16}, 1));
  double largest = 0;
  for (int y = picture.y0; y < picture.y1; ++y)
    for (int x = picture.x0; x < 20; ++x) {
      const PixelFeatures f = sharp.features(x, y);
      largest = std::max(largest, f.depth() / f.hits);
      EXPECT_LE(f.hits, f.samples);
      EXPECT_GE(f.depth() / f.hits, 5 - 1e-5);
    }
  EXPECT_NEAR(largest, 7, 1e-5);
}

TEST(SharedSamples, of_boxes_that_overlap_by_a_part_of_a_pixel_are_not_biased) {
  // Weights differ within a step of the table, where the number of boxes that contain a place changes.
  const Plane plane([](float, float, const TilePass&, std::uint32_t, float) { return gray(3); });
  const Film film = film_of(plane, settings_of(filter_of(FilterKind::box, 0.8f), {1, 4096}, 1));
  const PixelEstimate p = film.pixel(5, 5);
  EXPECT_GT(t_test(Estimate{p.mean[0], std::sqrt(p.variance_of_mean(0)), std::uint64_t(p.passes)}, 3).p_value,
            family_level);
}

TEST(SharedSamples, that_are_not_finite_are_excluded_alone) {
  const Plane plane([](float x, float y, const TilePass& pass, std::uint32_t index, float) {
    const bool is_bad = pass.points.pass == 1 && index == 2 && int(x) == 10 && int(y) == 10;
    return gray(is_bad ? std::numeric_limits<float>::quiet_NaN() : 2.0f);
  });
  const Film film = film_of(plane, settings_of(filter_of(FilterKind::triangle, 1), {4, 4}, 1));
  EXPECT_EQ(film.non_finite(), 1u);
  for (int y = 8; y < 13; ++y)
    for (int x = 8; x < 13; ++x) {
      EXPECT_NEAR(film.pixel(x, y).mean[0], 2, 1e-5);
      EXPECT_EQ(film.pixel(x, y).passes, 4u);
    }
}

TEST(SharedSamples, leave_the_rays_for_lamps_to_their_pixel) {
  // Emission of 8 in a square, which rays of their own show as 5 in one pixel; and other light of 1 everywhere.
  const Plane plane([](float x, float y, const TilePass&, std::uint32_t, float) {
    const bool emits = x >= 9.5f && x < 11.5f && y >= 9.5f && y < 11.5f, is_own = int(x) == 10 && int(y) == 10;
    PixelSample sample = gray(1);
    if (emits) sample.emission = sample.features.emission = gray_rgb(8);
    if (is_own) sample.lamps = gray_rgb(5), sample.features.emission_rays = 8;
    return sample;
  });
  const Film film = film_of(plane, settings_of(filter_of(FilterKind::triangle, 1), {16, 16}, 1));
  EXPECT_NEAR(film.pixel(10, 10).mean[0], 1 + 5, 1e-5);
  EXPECT_NEAR(film.features(10, 10).emission / film.features(10, 10).samples, 5, 1e-5);
  EXPECT_EQ(film.features(10, 10).emission_rays, 8.0 * 256);
  // The filter of a neighbour contains half of the square's width and all of its height within reach.
  expect_true(verdict(plane, 1 + 8 * tent_below(0, 1), 8, [](const Film& f) { return f.pixel(9, 10).mean[0]; }));
  expect_true(verdict(plane, 8 * tent_below(0, 1), 8,
                      [](const Film& f) { return f.features(9, 10).emission / f.features(9, 10).samples; }));
}

TEST(SharedSamples, are_of_pixels_around_a_tile) {
  const SampleSharing sharing(filter_of(FilterKind::mitchell, 2));
  const SharedSamples shared(sharing, {4, 0, 12, 8}, {PointSetKind::blue_noise, 3, 0, 16});
  EXPECT_EQ(shared.around(), (PixelBounds{2, -2, 14, 10}));
  EXPECT_EQ(shared.offsets().size(), 16u);
}

TEST(SharedSamples, are_not_worth_it_for_all_filters) {
  EXPECT_FALSE(sharing_for(filter_of(FilterKind::box, 0.5f)));
  EXPECT_FALSE(sharing_for(filter_of(FilterKind::box, 0.52f)));
  EXPECT_TRUE(sharing_for(filter_of(FilterKind::box, 1)));
  EXPECT_TRUE(sharing_for(filter_of(FilterKind::gaussian, 1.5f)));
  EXPECT_FALSE(sharing_for(filter_of(FilterKind::gaussian, 20)));
  // Own samples of a filter with large negative lobes are noisier than those of a box.
  EXPECT_TRUE(sharing_for(filter_of(FilterKind::sinc, 4)));
}

}  // namespace montelux::test
