#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <thread>

#include "mc/random.h"
#include "statistics.h"
#include "texture/build.h"
#include "texture/noise.h"
#include "texture/table.h"

namespace montelux {
namespace {

TextureName name(const char* of) { return {of}; }
SpectrumValue rgb(float r, float g, float b) { return RgbValue{{{r, g, b}}}; }
TextureDesc texture(std::string under, bool is_spectrum, TextureModel model, const Transform& to_world = {}) {
  return {std::move(under), is_spectrum, std::move(model), to_world, {}};
}
TexturePoint at_uv(float u, float v) { return {{u, v}, {0, 0, 0}, {0, 0, 1}}; }
TexturePoint at_point(Vec3f p) { return {{0, 0}, p, {0, 0, 1}}; }

// A set under construction.
struct Bench {
  TextureSet set;
  Diagnostics diagnostics;
  TextureBuilder builder{set, std::filesystem::temp_directory_path().string(),
                         [](const SpectrumValue& v) { return std::get<RgbValue>(v).rgb; }, diagnostics};

  NumberTextureId number_texture(TextureModel model, const Transform& t = {}) {
    builder.add(texture("n", false, std::move(model), t));
    return *builder.find_number("n");
  }
  SpectrumTextureId spectrum_texture(TextureModel model, const Transform& t = {}) {
    builder.add(texture("s", true, std::move(model), t));
    return *builder.find_spectrum("s");
  }
};

TEST(Bilerp, corners_have_their_values_and_the_middle_their_mean) {
  Bench b;
  NumberTextureId id = b.number_texture(BilerpTextureDesc{.v00 = 1.0f, .v01 = 2.0f, .v10 = 3.0f, .v11 = 6.0f});
  EXPECT_FLOAT_EQ(b.set.number(id, at_uv(0, 0)), 1);
  EXPECT_FLOAT_EQ(b.set.number(id, at_uv(0, 1)), 2);
  EXPECT_FLOAT_EQ(b.set.number(id, at_uv(1, 0)), 3);
  EXPECT_FLOAT_EQ(b.set.number(id, at_uv(1, 1)), 6);
  EXPECT_FLOAT_EQ(b.set.number(id, at_uv(0.5f, 0.5f)), 3);
  SpectrumTextureId colors = b.spectrum_texture(BilerpTextureDesc{.v00 = rgb(1, 0, 0), .v11 = rgb(0, 0, 4)});
  EXPECT_FLOAT_EQ(b.set.color(colors, at_uv(1, 1))[2], 4);
  EXPECT_FLOAT_EQ(b.set.color(colors, at_uv(0, 0))[0], 1);
  EXPECT_FLOAT_EQ(b.set.color(colors, at_uv(0, 1))[0], 1);
}

TEST(Checkerboard, cells_alternate_in_the_plane_and_in_space) {
  Bench b;
  NumberTextureId flat = b.number_texture(CheckerboardTextureDesc{.mapping = {.u_scale = 4, .v_scale = 2}});
  NumberTextureId solid = b.number_texture(CheckerboardTextureDesc{.dimension = 3}, translate(0.5, 0, 0));
  RandomStream<float> random(1u, 1u);
  for (int k = 0; k < 1000; ++k) {
    float u = 4 * random.next() - 2, v = 4 * random.next() - 2, w = 4 * random.next() - 2;
    int cell = int(std::floor(4 * u)) + int(std::floor(2 * v));
    EXPECT_EQ(b.set.number(flat, at_uv(u, v)), cell % 2 == 0 ? 1 : 0);
    int cube = int(std::floor(u - 0.5f)) + int(std::floor(v)) + int(std::floor(w));
    EXPECT_EQ(b.set.number(solid, at_point({u, v, w})), cube % 2 == 0 ? 1 : 0);
  }
}

TEST(Combinations, scale_mix_and_directionmix_follow_their_definitions) {
  Bench b;
  b.builder.add(texture("ramp", false, BilerpTextureDesc{.v01 = 0.0f, .v10 = 1.0f}));  // is u
  b.builder.add(texture("color", true, ConstantTextureDesc{rgb(0.2f, 0.4f, 0.8f)}));
  SpectrumTextureId scaled = b.spectrum_texture(ScaleTextureDesc{name("color"), name("ramp")});
  EXPECT_FLOAT_EQ(b.set.color(scaled, at_uv(0.25f, 0.9f))[2], 0.2f);
  NumberTextureId mixed = b.number_texture(MixTextureDesc{10.0f, 20.0f, name("ramp")});
  EXPECT_FLOAT_EQ(b.set.number(mixed, at_uv(0.25f, 0.1f)), 12.5f);
  NumberTextureId directed = b.number_texture(DirectionMixTextureDesc{10.0f, 20.0f, {3, 0, 0}}, rotate(90, 0, 0, 1));
  EXPECT_FLOAT_EQ(b.set.number(directed, {{0, 0}, {0, 0, 0}, {0, -1, 0}}), 10);
  EXPECT_FLOAT_EQ(b.set.number(directed, {{0, 0}, {0, 0, 0}, {1, 0, 0}}), 20);
}

TEST(Combinations, of_constants_are_constant) {
  Bench b;
  NumberTextureId mixed = b.number_texture(MixTextureDesc{1.0f, 3.0f});
  ASSERT_TRUE(b.set.is_constant(mixed));
  EXPECT_FLOAT_EQ(*b.set.constant(mixed), 2);
  SpectrumTextureId scaled = b.spectrum_texture(ScaleTextureDesc{rgb(1, 2, 3), name("n")});
  ASSERT_TRUE(b.set.is_constant(scaled));
  EXPECT_FLOAT_EQ((*b.set.constant(scaled))[1], 4);
  EXPECT_FALSE(b.set.is_constant(b.number_texture(FbmTextureDesc{})));
}

TEST(Mapping, each_follows_its_definition) {
  Bench b;
  // A bilerp that shows s, and one that shows t.
  auto st = [&](const MappingDesc& mapping, const Transform& to_world, const TexturePoint& point) {
    const BilerpTextureDesc s{0.0f, 0.0f, 1.0f, 1.0f, mapping}, t{0.0f, 1.0f, 0.0f, 1.0f, mapping};
    return Vec2f{b.set.number(b.number_texture(s, to_world), point),
                 b.set.number(b.number_texture(t, to_world), point)};
  };
  const auto of = [](MappingKind kind) { return MappingDesc{.kind = kind}; };
  auto expect = [](Vec2f a, float s, float t) {
    EXPECT_NEAR(a.x, s, 1e-6f);
    EXPECT_NEAR(a.y, t, 1e-6f);
  };
  expect(st({.u_scale = 2, .v_scale = -1, .u_delta = 0.5f, .v_delta = 3}, {}, at_uv(0.25f, 0.5f)), 1, 2.5f);
  expect(st({.uv_matrix = std::array<float, 6>{1, 2, 3, 4, 5, 6}}, {}, at_uv(1, 0.5f)), 5, 12.5f);
  expect(st(of(MappingKind::spherical), translate(1, 2, 3), at_point({1, 2, 9})), 0, 0);
  expect(st(of(MappingKind::spherical), {}, at_point({0, 5, 0})), 0.5f, 0.25f);
  expect(st(of(MappingKind::spherical), {}, at_point({0, -5, 0})), 0.5f, 0.75f);
  expect(st(of(MappingKind::cylindrical), {}, at_point({5, 0, 0.25f})), 0.5f, 0.25f);
  expect(st(of(MappingKind::cylindrical), {}, at_point({0, -5, 2})), 0.25f, 2);
  expect(st({.kind = MappingKind::planar, .u_delta = 10, .s_axis = {0, 0, 2}, .t_axis = {1, 1, 0}}, scale(2, 2, 2),
            at_point({2, 4, 6})),
         16, 3);
}

TEST(Noise, agrees_with_the_published_value_of_the_reference_implementation) {
  EXPECT_NEAR(gradient_noise({3.14f, 42.0f, 7.0f}), 0.13691995878400012, 1e-6);
}

TEST(Noise, is_zero_on_the_lattice_bounded_continuous_and_periodic) {
  RandomStream<float> random(2u, 2u);
  for (int k = 0; k < 2000; ++k) {
    auto coordinate = [&] { return 600 * random.next() - 300; };
    Vec3f p{coordinate(), coordinate(), coordinate()};
    EXPECT_EQ(gradient_noise({std::floor(p.x), std::floor(p.y), std::floor(p.z)}), 0);
    EXPECT_LE(std::abs(gradient_noise(p)), 1.05f);
    EXPECT_NEAR(gradient_noise({std::floor(p.x) - 1e-4f, p.y, p.z}), gradient_noise({std::floor(p.x), p.y, p.z}),
                1e-3f);
    Vec3f q{std::floor(p.x * 64) / 64, std::floor(p.y * 64) / 64, 0.25f};
    EXPECT_EQ(gradient_noise(q), gradient_noise({q.x + 256, q.y - 512, q.z}));
  }
  EXPECT_TRUE(std::isfinite(gradient_noise({1e30f, -1e30f, 3e12f})));
  EXPECT_EQ(gradient_noise({INFINITY, -INFINITY, std::nanf("")}), 0);
}

TEST(Noise, textures_of_one_octave_are_the_noise_itself) {
  Bench b;
  Transform to_world = translate(1, 2, 3) * scale(2, 2, 2);
  NumberTextureId fbm = b.number_texture(FbmTextureDesc{{1}}, to_world);
  NumberTextureId wrinkled = b.number_texture(WrinkledTextureDesc{{1}}, to_world);
  NumberTextureId two = b.number_texture(FbmTextureDesc{{2, 0.25f}}, to_world);
  Vec3f p{3.3f, -1.2f, 0.7f}, local{1.15f, -1.6f, -1.15f};
  EXPECT_NEAR(b.set.number(fbm, at_point(p)), gradient_noise(local), 1e-5f);
  EXPECT_NEAR(b.set.number(wrinkled, at_point(p)), std::abs(gradient_noise(local)), 1e-5f);
  EXPECT_NEAR(b.set.number(two, at_point(p)), gradient_noise(local) + 0.25f * gradient_noise(local * 1.99f), 1e-5f);
}

TEST(Noise, windy_is_flat_where_the_wind_is_still_and_marble_stays_within_its_palette) {
  Bench b;
  NumberTextureId windy = b.number_texture(WindyTextureDesc{});
  SpectrumTextureId marble = b.spectrum_texture(MarbleTextureDesc{});
  EXPECT_EQ(b.set.number(windy, at_point({0, 0, 0})), 0);
  RandomStream<float> random(3u, 3u);
  for (int k = 0; k < 1000; ++k) {
    Rgb c = b.set.color(marble, at_point({9 * random.next(), 9 * random.next(), 9 * random.next()}));
    for (int i = 0; i < 3; ++i) {
      EXPECT_GE(c[i], 1.5f * 0.2f);
      EXPECT_LE(c[i], 1.5f * 0.6001f);
    }
  }
}

TEST(Dots, are_discs_inside_of_their_cells_and_in_two_of_five_of_them) {
  Bench b;
  NumberTextureId id = b.number_texture(DotsTextureDesc{});
  // Whether a cell has a dot depends on the noise at its centre, which follows from the gradients at its corners; cells
  // at even positions share none.
  int apart_with_dot = 0;
  std::vector<double> areas;
  const int cells = 40, n = 30;
  for (int t = 0; t < cells; ++t)
    for (int s = 0; s < cells; ++s) {
      int inside = 0;
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i)
          inside += b.set.number(id, at_uv(float(s) - 0.5f + (float(i) + 0.5f) / n,
                                           float(t) - 0.5f + (float(j) + 0.5f) / n)) == 1;
      if (inside > 0) areas.push_back(double(inside) / (n * n));
      if (inside > 0 && s % 2 == 0 && t % 2 == 0) ++apart_with_dot;
    }
  // In the middle of a cell eight gradients pull by -1, 0 or 1, that is by sixteen fair halves: the sum is positive
  // with probability (1 - C(16, 8) / 2^16) / 2.
  double expected = 0.5 * (1 - 12870.0 / 65536);
  EXPECT_GT(test::proportion_test(apart_with_dot, cells * cells / 4, expected).p_value, test::family_level);
  EXPECT_LT(test::proportion_test(apart_with_dot, cells * cells / 4, 0.5).p_value, test::family_level);
  // Where a dot lies on the grid of points is random, so that the points in it tell its area without bias.
  EXPECT_GT(test::t_test(areas, std::numbers::pi * 0.35 * 0.35).p_value, test::family_level);
  EXPECT_LT(test::t_test(areas, std::numbers::pi * 0.352 * 0.352).p_value, test::family_level);
}

// A 2 x 2 PNG: black, red over green, blue.
struct Picture {
  std::filesystem::path path =
      std::filesystem::temp_directory_path() / ("montelux_texture_" + std::to_string(::getpid()) + ".png");
  std::string name = path.filename().string();
  Picture() { EXPECT_TRUE(write_image(path, DisplayImage{2, 2, 3, {0, 0, 0, 255, 0, 0, 0, 255, 0, 0, 0, 255}})); }
  ~Picture() { std::filesystem::remove(path); }
};

TEST(ImageMap, shows_the_picture_upright_with_v_up) {
  Picture picture;
  Bench b;
  SpectrumTextureId id = b.spectrum_texture(ImageTextureDesc{.file = picture.name});
  ASSERT_FALSE(b.diagnostics.has_errors());
  EXPECT_FLOAT_EQ(b.set.color(id, at_uv(0.75f, 0.75f))[0], 1);  // red: upper right
  EXPECT_FLOAT_EQ(b.set.color(id, at_uv(0.25f, 0.25f))[1], 1);  // green: lower left
  EXPECT_FLOAT_EQ(b.set.color(id, at_uv(0.75f, 0.25f))[2], 1);  // blue: lower right
  EXPECT_FLOAT_EQ(b.set.color(id, at_uv(0.5f, 0.5f))[1], 0.25f);
  NumberTextureId mean = b.number_texture(ImageTextureDesc{.file = picture.name});
  EXPECT_FLOAT_EQ(b.set.number(mean, at_uv(0.75f, 0.75f)), 1.0f / 3);
}

// Each image once, whichever thread reads it; one that cannot be read fails where it is requested.
TEST(ImageMap, is_read_before_it_is_requested) {
  Picture picture;
  Bench b;
  const ImageRequest plain{picture.path}, linear{picture.path, ColorEncoding{}}, missing{"/no/such/image.png"};
  std::size_t read = 0;
  b.set.read_ahead({plain, linear, plain, missing}, [&](std::size_t count, const auto& body) {
    std::vector<std::thread> threads;
    for (std::size_t i = 0; i < count; ++i) threads.emplace_back(body, i);
    for (std::thread& thread : threads) thread.join();
    read = count;
  });
  EXPECT_EQ(read, 3u);
  const std::size_t bytes = b.set.image_bytes();
  EXPECT_GT(bytes, 0u);
  std::filesystem::remove(picture.path);
  EXPECT_TRUE(b.set.image(plain.path));
  EXPECT_TRUE(b.set.image(linear.path, linear.encoding));
  EXPECT_FALSE(b.set.image(missing.path));
  EXPECT_EQ(b.set.image_bytes(), bytes);
}

TEST(ImageMap, scale_invert_and_point_filter_apply) {
  Picture picture;
  Bench b;
  SpectrumTextureId id = b.spectrum_texture(
      ImageTextureDesc{.file = picture.name, .scale = 0.25f, .invert = true, .filter = TextureFilter::point});
  Rgb c = b.set.color(id, at_uv(0.51f, 0.51f));
  EXPECT_FLOAT_EQ(c[0], 0.75f);
  EXPECT_FLOAT_EQ(c[1], 1);
  SpectrumTextureId dark = b.spectrum_texture(ImageTextureDesc{.file = picture.name, .scale = 3, .invert = true});
  EXPECT_EQ(b.set.color(dark, at_uv(0.75f, 0.75f))[0], 0);
}

TEST(ImageMap, one_file_is_held_once_an_encoding_and_prefilters_are_noted_once) {
  Picture picture;
  Bench b;
  for (TextureFilter filter : {TextureFilter::trilinear, TextureFilter::ewa, TextureFilter::bilinear})
    b.number_texture(ImageTextureDesc{.file = picture.name, .filter = filter});
  EXPECT_EQ(b.set.image_bytes(), 12u);
  ASSERT_EQ(b.diagnostics.all().size(), 1u);
  EXPECT_EQ(b.diagnostics.all()[0].severity, Severity::note);
  b.number_texture(ImageTextureDesc{.file = picture.name, .encoding = ColorEncoding{}});
  EXPECT_EQ(b.set.image_bytes(), 24u);
}

TEST(TextureBuilder, inputs_are_values_or_names) {
  Bench b;
  b.builder.add(texture("wavy", false, WindyTextureDesc{}));
  b.builder.add(texture("veins", true, MarbleTextureDesc{}));
  EXPECT_FLOAT_EQ(*b.set.constant(b.builder.number(0.5f)), 0.5f);
  EXPECT_EQ(b.builder.number(name("wavy")), *b.builder.find_number("wavy"));
  EXPECT_FLOAT_EQ((*b.set.constant(b.builder.spectrum(rgb(1, 2, 3))))[2], 3);
  EXPECT_EQ(b.builder.spectrum(name("veins")), *b.builder.find_spectrum("veins"));
  EXPECT_EQ(b.builder.constant(0.5f), b.builder.number(0.5f));
  // A number in a texture of spectra is the same in all components.
  const auto seven = b.set.constant(b.spectrum_texture(ConstantTextureDesc{7.0f}));
  ASSERT_TRUE(seven);
  EXPECT_FLOAT_EQ((*seven)[0], 7);
  EXPECT_FLOAT_EQ((*seven)[2], 7);
  EXPECT_FALSE(b.diagnostics.has_errors());
  // Another name, and the name of a texture of the other kind, are reported where they were stated.
  const SourceLocation where{std::make_shared<const std::string>("room.pbrt"), 7, 9};
  b.builder.number({TextureName{"wary"}, where});
  b.builder.spectrum({TextureName{"wavy"}, where});
  ASSERT_EQ(b.diagnostics.errors(), 2);
  EXPECT_EQ(b.diagnostics.all()[0].hint, "wavy");
  EXPECT_EQ(b.diagnostics.all()[0].where.column, 9);
  EXPECT_NE(b.diagnostics.all()[1].hint.find("other kind"), std::string::npos);
}

TEST(TextureBuilder, what_cannot_be_built_is_reported_with_the_nearest_name) {
  auto errors = [](bool is_spectrum, TextureModel model) {
    Bench b;
    b.builder.add(texture("granite", false, FbmTextureDesc{}));
    b.builder.add(texture("x", is_spectrum, std::move(model)));
    return b.diagnostics;
  };
  const SourceLocation place{nullptr, 3, 4};
  const Diagnostics unknown = errors(false, ScaleTextureDesc{{name("granit"), place}});
  ASSERT_EQ(unknown.all().size(), 1u);
  EXPECT_EQ(unknown.all()[0].hint, "granite");
  EXPECT_EQ(unknown.all()[0].where.line, 3);
  EXPECT_TRUE(errors(true, ScaleTextureDesc{name("granite")}).has_errors());
  EXPECT_TRUE(errors(false, ImageTextureDesc{}).has_errors());
  EXPECT_TRUE(errors(false, ImageTextureDesc{.file = "no_such.png"}).has_errors());
  EXPECT_TRUE(errors(false, DirectionMixTextureDesc{.direction = {0, 0, 0}}).has_errors());
}

TEST(TextureBuilder, builds_every_texture_of_the_table_that_can_be_of_the_kind) {
  Picture picture;
  int of_one_kind = 0;
  for (const EntitySpec& spec : texture_models().specs())
    for (bool is_spectrum : {false, true}) {
      if (spec.later) continue;
      TextureModel model = texture_models().initial(spec.name).model;
      EXPECT_EQ(name_of(model), spec.name);
      if (auto* image = std::get_if<ImageTextureDesc>(&model)) image->file = picture.name;
      Bench b;
      b.builder.add(texture("x", is_spectrum, model));
      EXPECT_EQ(b.diagnostics.has_errors(), !can_be(model, is_spectrum)) << spec.name;
      of_one_kind += !can_be(model, is_spectrum);
    }
  EXPECT_EQ(of_one_kind, 5);
}

TEST(TextureSet, packs_and_threads_find_the_values_of_single_points) {
  using F = NativeFloats;
  Bench b;
  b.builder.add(texture("board", false, CheckerboardTextureDesc{.mapping = {.u_scale = 8}}));
  b.builder.add(texture("bilerp", true, BilerpTextureDesc{.v00 = rgb(1, 0, 0.5f), .v11 = rgb(0, 0, 4)}));
  b.builder.add(texture("solid", true,
                        CheckerboardTextureDesc{.dimension = 3, .even = name("bilerp"), .odd = rgb(0.1f, 1, 0)},
                        scale(0.2, 0.3, 0.4)));
  const NumberTextureId number_ids[] = {
      b.number_texture(FbmTextureDesc{}), b.number_texture(ScaleTextureDesc{name("board"), 0.7f}),
      b.number_texture(BilerpTextureDesc{.v00 = 1.0f, .v11 = 3.0f, .mapping = {.kind = MappingKind::spherical}}),
      b.number_texture(BilerpTextureDesc{.v00 = 1.0f, .v11 = 3.0f, .mapping = {.kind = MappingKind::planar}}),
      b.number_texture(DotsTextureDesc{.inside = 2.0f, .mapping = {.u_scale = 5}})};
  const SpectrumTextureId spectrum_ids[] = {
      b.spectrum_texture(MarbleTextureDesc{}),
      b.spectrum_texture(MixTextureDesc{name("solid"), name("bilerp"), name("board")}),
      b.spectrum_texture(DirectionMixTextureDesc{.along = name("solid"), .direction = {1, 2, 3}})};
  auto check = [&](std::uint32_t seed) {
    RandomStream<float> random(seed, 7u);
    for (int round = 0; round < 100; ++round) {
      TexturePoints<F> points{};
      for (int k = 0; k < native_lanes; ++k) {
        set_lane(points.uv, k, random.next2());
        set_lane(points.p, k, Vec3f{random.next(), random.next(), random.next()});
        set_lane(points.n, k, normalize(Vec3f{random.next(), random.next(), 0.1f}));
      }
      const auto on = mask_of_bits<F>(std::uint32_t(random.next() * 0x1p16f) | 1u);
      const auto compare = [&](auto id) {
        const auto pack = [&] {
          if constexpr (std::is_same_v<decltype(id), NumberTextureId>)
            return RgbOf<F>{{b.set.number(id, points, on)}};
          else
            return b.set.color(id, points, on);
        }();
        for_each_lane(on, [&](int k) {
          const TexturePoint point{lane(points.uv, k), lane(points.p, k), lane(points.n, k)};
          const auto one = [&] {
            if constexpr (std::is_same_v<decltype(id), NumberTextureId>)
              return Rgb{{b.set.number(id, point)}};
            else
              return b.set.color(id, point);
          }();
          for (int i = 0; i < rgb_size; ++i) EXPECT_EQ(lane(pack.c[i], k), one.c[i]) << int(id);
        });
      };
      for (const NumberTextureId id : number_ids) compare(id);
      for (const SpectrumTextureId id : spectrum_ids) compare(id);
    }
  };
  std::vector<std::thread> threads;
  for (std::uint32_t t = 0; t < 4; ++t) threads.emplace_back(check, t);
  for (std::thread& t : threads) t.join();
}

}  // namespace
}  // namespace montelux
