// Path guiding: what the field learns, and that it is the same in every run.
#include <gtest/gtest.h>

#include <cmath>

#include "integrator/guiding/learner.h"
#include "render_scenes.h"

namespace montelux::test {
namespace {

// Records at random places of a floor, of directions drawn from the cosine. Light comes from a part of the sky: for
// x < 0 from the side of +x, for x > 0 from that of -x.
std::vector<GuideRecord> records_of(int count, bool guided) {
  std::vector<GuideRecord> all;
  RandomStream<float> r(4, 8);
  for (int i = 0; i < count; ++i) {
    const Vec3f p{2 * r.next() - 1, 0, 2 * r.next() - 1};
    const Vec2f u = r.next2();
    const float phi = 2 * pi * u.x, across = std::sqrt(u.y);
    const Vec3f w{across * std::cos(phi), std::sqrt(1 - u.y), across * std::sin(phi)};
    GuideRecord record{};
    record.p = p, record.n = {0, 1, 0}, record.wi = w;
    record.bsdf = w.y * inv_pi, record.guide = inv_four_pi, record.share = guided ? 1e-6f : 0.0f;
    record.throughput = 1;
    record.light = w.x * (p.x < 0 ? 1.0f : -1.0f) > 0.8f ? 1.0f : 0.0f;
    all.push_back(record);
  }
  return all;
}

TEST(GuideLearner, sends_directions_to_where_light_comes_from) {
  const std::vector<GuideRecord> records = records_of(20000, false);
  std::vector<Vec3f> places;
  for (const GuideRecord& r : records) places.push_back(r.p);
  GuideLearner learner(places);
  for (int round = 0; round < 3; ++round) {
    for (const GuideRecord& r : records) learner.add(r);
    if (round < 2) learner.refine(1000);
  }
  const GuideField field = learner.field();
  EXPECT_GT(field.tables(), 20u);
  RandomStream<float> r(1, 1);
  int right = 0;
  for (int i = 0; i < 1000; ++i) {
    const Vec3f p{i % 2 == 0 ? -0.4f : 0.6f, 0, 2 * r.next() - 1};
    const FieldSite<float> at = field.at<float>(p, {0, 1, 0}, true);
    EXPECT_GT(at.share, 0);
    right += field.sample(at, r.next2()).wi.x * (p.x < 0 ? 1.0f : -1.0f) > 0.6f;
  }
  // Of directions of equal density a fifth would be.
  EXPECT_GT(right, 700);
  // Other orientations have seen nothing.
  EXPECT_EQ(field.at<float>({0, 0, 0}, {0, -1, 0}, true).share, 0);
  EXPECT_EQ(field.at<float>({0, 0, 0}, {0, 0, 0}, true).share, 0);
}

// By an even guide there is nothing to gain where light comes in proportion to the density of the BSDF.
TEST(GuideLearner, leaves_directions_to_the_bsdf_where_a_guide_gains_nothing) {
  std::vector<GuideRecord> records = records_of(20000, true);
  for (GuideRecord& r : records) r.light = 0.5f;
  GuideLearner even(std::vector<Vec3f>{{-1, 0, -1}, {1, 0, 1}});
  for (const GuideRecord& r : records) even.add(r);
  EXPECT_EQ(even.field().at<float>({0, 0, 0}, {0, 1, 0}, true).share, 0);
  // And much to gain where it comes from the horizon, which the cosine hardly sees.
  GuideLearner low(std::vector<Vec3f>{{-1, 0, -1}, {1, 0, 1}});
  for (GuideRecord& r : records) r.light = r.wi.y < 0.3f ? 1.0f : 0.0f, low.add(r);
  EXPECT_GT(low.field().at<float>({0, 0, 0}, {0, 1, 0}, true).share, 0.1f);
}

// However many records there are, and however large the sums.
TEST(PlaceSums, have_no_more_leaves_than_fit_into_their_memory) {
  struct Counted {
    double records = 0;
    std::size_t size = 0;
    std::size_t bytes() const { return size; }
    void add(const Counted& other, double scale) { records += scale * other.records; }
  };
  for (const auto& [size, most] : {std::pair(1u << 22, 64u), std::pair(1u << 14, 16384u)}) {
    PlaceSums<Counted> sums(std::vector<Vec3f>{{-1, 0, -1}, {1, 0, 1}}, {0, size});
    RandomStream<float> r(4, 9);
    for (int round = 0; round < 4; ++round) {
      for (int i = 0; i < 100000; ++i) sums.at({2 * r.next() - 1, 0, 2 * r.next() - 1}, {0, 1, 0}).records += 1;
      sums.refine(1);
    }
    EXPECT_LE(sums.leaves(), most) << size;
    EXPECT_GT(sums.leaves(), most / 8) << size;
  }
}

TEST(PlaceTree, finds_the_same_leaf_in_every_lane_as_alone) {
  using F = NativeFloats;
  const std::vector<GuideRecord> records = records_of(5000, false);
  std::vector<Vec3f> places;
  for (const GuideRecord& r : records) places.push_back(r.p);
  GuideLearner learner(places);
  for (const GuideRecord& r : records) learner.add(r);
  learner.refine(200);
  const GuideField field = learner.field();
  RandomStream<float> r(3, 3);
  for (int i = 0; i < 500; ++i) {
    Vec3<F> p{F(0.0f), F(0.0f), F(0.0f)}, n{F(0.0f), F(1.0f), F(0.0f)};
    for (int k = 0; k < lanes_of<F>; ++k)
      set_lane(p.x, k, 3 * r.next() - 1.5f), set_lane(p.y, k, 0.1f * r.next()), set_lane(p.z, k, 3 * r.next() - 1.5f);
    const Mask<F> on = mask_of_bits<F>(0xaaaau | std::uint32_t(i));
    const FieldSite<F> at = field.at<F>(p, n, on);
    for_each_lane(on, [&](int k) {
      const FieldSite<float> alone = field.at<float>(lane(p, k), {0, 1, 0}, true);
      EXPECT_EQ(alone.table, lane(at.table, k));
      EXPECT_EQ(alone.share, lane(at.share, k));
    });
    for_each_lane(!on, [&](int k) { EXPECT_EQ(lane(at.share, k), 0); });
  }
}

TEST(PathGuiding, gives_the_same_bits_for_any_number_of_threads_and_in_every_run) {
  const std::filesystem::path scenes = std::filesystem::path(MONTELUX_SOURCE_DIR) / "scenes";
  const auto scene_of = [&](const std::string& name) {
    const std::filesystem::path folder = scenes / name;
    return TestScene(read_text(folder / (name + ".pbrt")), folder.string(), std::pair(37, 21));
  };
  const TestScene inside = scene_of("first-light"), outside = scene_of("ring-caustic");
  const auto pixels = [&](const TestScene& scene, const std::string& way, int threads) {
    const ChosenIntegrator chosen = scene.integrator(way);
    RenderObserver silent;
    const Film film =
        render(*chosen.integrator, scene.settings(PointSetKind::blue_noise, {2, 3}, 5, threads), silent).film;
    std::vector<double> all;
    for (int y = 0; y < 21; ++y)
      for (int x = 0; x < 37; ++x)
        for (double c : film.pixel(x, y).mean) all.push_back(c);
    return all;
  };
  for (const std::string name : {"guiding", "sky"}) {
    const TestScene& scene = name == "sky" ? outside : inside;
    const std::string on = name == "sky" ? "path:sky-learning=on," : "path:guiding=on,",
                      way = on + name + "-paths=20000";
    const auto one = pixels(scene, way, 1);
    EXPECT_EQ(one, pixels(scene, way, 2)) << way;
    EXPECT_EQ(one, pixels(scene, way, 3)) << way;
    EXPECT_NE(one, pixels(scene, "path", 1)) << way;
    EXPECT_NE(one, pixels(scene, on + name + "-paths=10000", 1)) << way;
  }
}

// Training and render, path by path in single lanes and in packs.
TEST(PathGuiding, does_not_depend_on_the_lanes) {
  const std::filesystem::path room = std::filesystem::path(MONTELUX_SOURCE_DIR) / "scenes/ring-caustic";
  const TestScene scene(read_text(room / "ring-caustic.pbrt"), room.string(), std::pair(24, 16));
  RenderObserver silent;
  const auto image = [&](const std::string& lanes) {
    const ChosenIntegrator chosen =
        scene.integrator("path:guiding=on,guiding-paths=8000,sky-learning=on,sky-paths=4000,lanes=" + lanes);
    return render(chosen.any(), scene.settings(PointSetKind::independent, {4, 2}, 3), silent).film.image();
  };
  const ImageEstimate one = image("one"), native = image("native");
  EXPECT_GT(one.mean[0], 0);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(one.mean[k], native.mean[k]);
}

TEST(PathGuiding, is_a_setting_of_path_and_its_misspelling_is_none) {
  const TestScene scene("Film \"rgb\" \"integer xresolution\" [ 4 ] \"integer yresolution\" [ 4 ]\nWorldBegin\n");
  EXPECT_NO_THROW(scene.integrator("path:guiding=on,guiding-paths=1024"));
  EXPECT_THROW(scene.integrator("path:guidance=on"), std::runtime_error);
  EXPECT_THROW(scene.integrator("path:guiding-paths=4096"), std::runtime_error);
  EXPECT_THROW(scene.integrator("path:guiding=on,guiding-paths=0"), std::runtime_error);
  EXPECT_THROW(scene.integrator("naive:guiding=on"), std::runtime_error);
  EXPECT_NO_THROW(scene.integrator("path:sky-learning=on,sky-paths=1024"));
  EXPECT_THROW(scene.integrator("path:sky-paths=4096"), std::runtime_error);
  EXPECT_THROW(scene.integrator("path:sky-learning=on,nee=off"), std::runtime_error);
}

}  // namespace
}  // namespace montelux::test
