// Attribution of variance to layers with known covariances; and comparisons that are continued.
#include "lab/compare/attribution.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "api/comparison.h"
#include "api/saved_file.h"
#include "lab/compare/comparison.h"
#include "noise.h"
#include "statistics.h"

namespace montelux::lab {
namespace {

using namespace montelux::test;

// Standard deviations of the independent X, Y, Z of each sample.
constexpr double sigma_x = 1, sigma_y = 0.5, sigma_z = 0.3;

// Light 1 that is seen directly, X by light samples, Y by scattered rays, and Z - X / 2 from the environment, which
// takes away half of what X adds.
class LayeredNoise final : public PixelIntegrator {
 public:
  RayCounts trace(const TilePass& pass, std::span<PixelSample> out) const override {
    for_each_sample(pass, [&](std::size_t i, float x, float y, float z) {
      out[i] = {};
      out[i].radiance = gray_rgb(1 + x + y + (z - 0.5f * x));
    });
    return {};
  }
  bool has_layers() const override { return true; }
  RayCounts trace_layers(const TilePass& pass, const LayerPlan& plan, std::span<PixelSample> out,
                         std::span<ExactRgb> sums) const override {
    const std::size_t stride = std::size_t(plan.count()) + 1, first = 1 + std::size_t(plan.bounce_count());
    for_each_sample(pass, [&](std::size_t i, float x, float y, float z) {
      ExactRgb* pixel = &sums[i / pass.points.samples_per_pass * stride];
      const float parts[4] = {1, x, y, z - 0.5f * x};
      for (std::size_t k = 0; k < 4; ++k)
        for (int c = 0; c < rgb_size; ++c) {
          pixel[0].c[c].add(parts[k]);
          pixel[first + k].c[c].add(parts[k]);
          if (plan.bounces) pixel[k == 0 ? 1 : 2].c[c].add(parts[k]);
        }
    });
    return trace(pass, out);
  }

 private:
  template <class Function>
  void for_each_sample(const TilePass& pass, Function f) const {
    for_each_noise(pass, false, [&](std::size_t i, const Sampler<float>& sampler) {
      f(i, noise(sampler, 0, float(sigma_x)), noise(sampler, 1, float(sigma_y)), noise(sampler, 2, float(sigma_z)));
    });
  }
};

ComparisonSettings settings(int repeats) {
  ComparisonSettings s;
  s.render.image.bounds = {0, 0, 24, 24}, s.render.image.width = s.render.image.height = 24, s.render.threads = 1;
  s.samples = 64, s.repeats = repeats;
  return s;
}

std::vector<ComparedMethod> compared_methods(const PixelIntegrator& integrator) {
  LayerPlan plan;
  plan.bounces = 0, plan.techniques = true;
  ComparedMethod with{"a", "with", integrator, PointSetKind::independent, {}, plan};
  ComparedMethod without{"b", "without", integrator, PointSetKind::independent, {}, {}};
  return {with, without};
}

Reference exact_one() {
  Reference r;
  r.mean = make_pixel_buffer(24, 24, {"R", "G", "B"}), r.variance = r.mean;
  for (float& v : r.mean.values) v = 1;
  r.degrees_of_freedom = INFINITY, r.origin = "exact";
  return r;
}

bool agrees(const Measured& m, double truth) {
  return std::abs(m.mean - truth) <= student_t_quantile(1 - family_level / 12, m.count - 1.0) * m.standard_error + 1e-9;
}

TEST(Attribution, finds_the_shares_of_layers_whose_covariances_are_known) {
  const LayeredNoise noise;
  const ComparisonResult r = run_comparison(compared_methods(noise), exact_one(), settings(12), {});
  ASSERT_TRUE(r.methods[0].attribution);
  EXPECT_FALSE(r.methods[1].attribution);
  const double x = sigma_x * sigma_x, y = sigma_y * sigma_y, z = sigma_z * sigma_z, all = x / 4 + y + z;
  const double truths[4] = {0, x / 2 / all, y / all, (z - x / 4) / all};
  const Attribution& found = *r.methods[0].attribution;
  ASSERT_EQ(found.families.size(), 2u);
  EXPECT_EQ(found.families[0].name, "bounces");
  EXPECT_TRUE(agrees(found.families[0].layers[0].share, 0));
  EXPECT_TRUE(agrees(found.families[0].layers[1].share, 1));
  double sum = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const Measured& share = found.families[1].layers[i].share;
    EXPECT_TRUE(agrees(share, truths[i])) << i << " " << share.mean << " +- " << share.standard_error;
    sum += share.mean;
  }
  EXPECT_NEAR(sum, 1, 1e-12);
  // The variances of the layers alone, which leave the covariances out, are other shares: the test would see them.
  const double alone = x + y + z + x / 4;
  EXPECT_FALSE(agrees(found.families[1].layers[1].share, x / alone));
  EXPECT_FALSE(agrees(found.families[1].layers[3].share, (z + x / 4) / alone));
}

TEST(Attribution, has_shares_that_sum_to_one_at_every_pixel) {
  const LayeredNoise noise;
  const ComparisonResult r = run_comparison(compared_methods(noise), exact_one(), settings(3), {});
  const auto& by_pixel = r.methods[0].attribution->by_pixel;
  ASSERT_EQ(by_pixel.size(), 6u);
  for (std::size_t p = 0; p < 24 * 24; ++p) {
    EXPECT_NEAR(by_pixel[0][p] + by_pixel[1][p], 1, 1e-5);
    EXPECT_NEAR(by_pixel[2][p] + by_pixel[3][p] + by_pixel[4][p] + by_pixel[5][p], 1, 1e-5);
  }
}

TEST(RatioOfSums, has_the_interval_of_the_jackknife) {
  // Of one denominator, it is the mean.
  const Measured m = measured_ratio_of_sums({1, 2, 3, 6}, {2, 2, 2, 2}, 0.95), mean = measured({0.5, 1, 1.5, 3}, 0.95);
  EXPECT_NEAR(m.mean, mean.mean, 1e-12);
  EXPECT_NEAR(m.low, mean.low, 1e-12);
  EXPECT_NEAR(m.high, mean.high, 1e-12);
  EXPECT_NEAR(measured_ratio_of_sums({1, 3}, {1, 9}, 0.95).mean, 0.4, 1e-12);
}

// All that does not depend on the time.
void expect_same(const ComparisonState& a, const ComparisonState& b) {
  ASSERT_EQ(a.methods.size(), b.methods.size());
  for (std::size_t i = 0; i < a.methods.size(); ++i) {
    const MethodState &m = a.methods[i], &n = b.methods[i];
    ASSERT_EQ(m.repeats.size(), n.repeats.size());
    EXPECT_EQ(m.passes, n.passes);
    EXPECT_EQ(m.luminance, n.luminance);
    EXPECT_EQ(m.pixel_shares, n.pixel_shares);
    for (std::size_t k = 0; k < m.repeats.size(); ++k) {
      EXPECT_EQ(m.repeats[k].mse, n.repeats[k].mse);
      EXPECT_EQ(m.repeats[k].flip, n.repeats[k].flip);
      EXPECT_EQ(m.convergence[k].mse, n.convergence[k].mse);
      ASSERT_EQ(m.attribution.size(), n.attribution.size());
      if (!m.attribution.empty()) {
        EXPECT_EQ(m.attribution[k].layers, n.attribution[k].layers);
      }
    }
    for (std::size_t p = 0; p < m.pixels.size(); ++p)
      for (int c = 0; c < 3; ++c) {
        EXPECT_EQ(m.pixels[p].mean[c], n.pixels[p].mean[c]);
        EXPECT_EQ(m.pixels[p].m2[c], n.pixels[p].m2[c]);
      }
  }
}

TEST(Comparison, that_continues_from_a_file_is_the_same_bits_as_one_that_never_stopped) {
  const LayeredNoise noise;
  const auto both = compared_methods(noise);
  ComparisonState whole = begin_comparison(both, exact_one(), settings(6));
  EXPECT_TRUE(run_rounds(both, settings(6), 6, {}, whole));

  SavedComparison half;
  half.state = begin_comparison(both, exact_one(), settings(3));
  EXPECT_TRUE(run_rounds(both, settings(3), 3, {}, half.state));
  // No two repeats share random numbers.
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = 0; j < i; ++j) EXPECT_NE(whole.methods[0].luminance[i], whole.methods[0].luminance[j]);
  half.options.methods = {"path", "naive"};
  const auto folder = std::filesystem::temp_directory_path();
  const auto file = folder / "montelux-saved-comparison.json", scene = folder / "montelux-saved-comparison.pbrt";
  std::ofstream(scene) << "WorldBegin\n";
  half.scene = scene, half.fingerprint = scene_fingerprint(scene);
  ASSERT_TRUE(save_comparison(file, half));
  Result<SavedComparison> read = load_comparison(file);
  ASSERT_TRUE(read) << read.error();
  expect_same(read->state, half.state);
  EXPECT_TRUE(run_rounds(both, settings(3), 3, {}, read->state));
  expect_same(read->state, whole);

  // What is not as it was written is refused.
  std::ifstream in(file);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  for (const auto& [old, by] :
       std::vector<std::pair<std::string, std::string>>{{"\"confidence\": 0.95", "\"confidence\": 1.95"},
                                                        {"\"repeats\": ", "\"repeats\": 1"},
                                                        {"\"notes\": []", "\"notes\": {}"}}) {
    std::string damaged = text;
    ASSERT_NE(damaged.find(old), std::string::npos) << old;
    std::ofstream(file) << damaged.replace(damaged.find(old), old.size(), by);
    const Result<SavedComparison> refused = load_comparison(file);
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().find("it is damaged"), std::string::npos) << refused.error();
  }
  std::ofstream(file) << text;

  // Statistics are those of all six.
  const ComparisonResult a = result_of(both, read->state, settings(3)), b = result_of(both, whole, settings(6));
  EXPECT_EQ(a.methods[0].mse.mean, b.methods[0].mse.mean);
  EXPECT_EQ(a.methods[0].mse.count, 6);
  EXPECT_EQ(a.methods[0].bias_squared.mean, b.methods[0].bias_squared.mean);
  EXPECT_EQ(a.methods[0].attribution->families[1].layers[1].share.low,
            b.methods[0].attribution->families[1].layers[1].share.low);

  // A scene that has changed is refused.
  std::ofstream(scene, std::ios::app) << "# another\n";
  const Result<SavedComparison> changed = load_comparison(file);
  ASSERT_FALSE(changed);
  EXPECT_NE(changed.error().find("has changed"), std::string::npos) << changed.error();
  std::filesystem::remove(file), std::filesystem::remove(scene);
}

// Their checksums are right: only the bounds of what they say are left to refuse them.
TEST(Comparison, refuses_files_that_nobody_would_have_saved) {
  using Json = nlohmann::ordered_json;
  const LayeredNoise noise;
  const auto both = compared_methods(noise);
  SavedComparison saved;
  saved.state = begin_comparison(both, exact_one(), settings(2));
  ASSERT_TRUE(run_rounds(both, settings(2), 2, {}, saved.state));
  saved.options.methods = {"path", "naive"}, saved.options.samples = 64;
  const auto folder = std::filesystem::temp_directory_path();
  const auto file = folder / "montelux-crafted-comparison.json", scene = folder / "montelux-crafted-comparison.pbrt";
  std::ofstream(scene) << "WorldBegin\n";
  saved.scene = scene, saved.fingerprint = scene_fingerprint(scene);
  ASSERT_TRUE(save_comparison(file, saved));
  Json whole;
  std::ifstream(file) >> whole;
  whole.erase("checksum");
  ASSERT_TRUE(save_json(file, whole));
  const Result<SavedComparison> again = load_comparison(file);
  ASSERT_TRUE(again) << again.error();
  for (const auto& [place, value] : std::vector<std::pair<std::string, Json>>{
           {"/options/repeats", 2147483647},
           {"/options/repeats", 1e39},
           {"/options/samples", 1 << 21},
           {"/options/seed", -1},
           {"/options/seed", 4294967296},
           {"/methods/0/planned_passes", 2147483647},
           {"/methods/0/planned_passes", 65},  // of 64 samples in all
           {"/methods/1/samples_per_pass", 0},
           {"/methods/1/passes", 1e300},
           {"/methods/1/non_finite", -1},
           {"/reference/width", 65536},
           {"/reference/width", 1e300},
           {"/resolution", Json{100000, 100}},
       }) {
    Json crafted = whole;
    crafted[Json::json_pointer(place)] = value;
    ASSERT_TRUE(save_json(file, crafted));
    EXPECT_FALSE(load_comparison(file)) << place << ' ' << value;
  }
  std::filesystem::remove(file), std::filesystem::remove(scene);
}

TEST(Comparison, ends_the_round_in_which_it_was_stopped_before_it_continues) {
  const LayeredNoise noise;
  const auto both = compared_methods(noise);
  ComparisonState whole = begin_comparison(both, exact_one(), settings(3)),
                  cut = begin_comparison(both, exact_one(), settings(3));
  run_rounds(both, settings(3), 3, {}, whole);
  int turns = 0;
  ComparisonWatch watch;
  watch.progress = [&](const WorkPiece&, double done) { turns += done == 0; };
  watch.stop = [&] { return turns == 4; };
  EXPECT_FALSE(run_rounds(both, settings(3), 3, watch, cut));
  EXPECT_NE(cut.methods[0].repeats.size(), cut.methods[1].repeats.size());
  const int done = int(std::min(cut.methods[0].repeats.size(), cut.methods[1].repeats.size()));
  EXPECT_TRUE(run_rounds(both, settings(3), 3 - done, {}, cut));
  expect_same(cut, whole);
}

TEST(Comparison, refuses_files_that_are_no_saved_comparison) {
  const auto file = std::filesystem::temp_directory_path() / "montelux-no-comparison.json";
  for (const auto& [text, reason] : std::vector<std::pair<std::string, std::string>>{
           {"not JSON", "not a file that montelux compare --save wrote"},
           {R"({"format": "montelux integrals"})", "not a file that montelux compare --save wrote"},
           {R"({"format": "montelux comparison", "version": 99})", "version 99, this program reads version 4 to 5"},
           {R"({"format": "montelux comparison"})", "its entry \"version\" is missing"},
           {R"({"format": "montelux comparison", "version": 5})", "it is damaged"}}) {
    std::ofstream(file) << text;
    const Result<SavedComparison> read = load_comparison(file);
    ASSERT_FALSE(read);
    EXPECT_NE(read.error().find(reason), std::string::npos) << read.error();
  }
  std::filesystem::remove(file);
  EXPECT_FALSE(load_comparison(file));
}

}  // namespace
}  // namespace montelux::lab
