// What image textures take beyond pbrt's parameters: a channel, a tint, edges by axis, an affine map; and thresholds.
#include <gtest/gtest.h>

#include "texture/texture_set.h"

namespace montelux {
namespace {

// Two by one texels: (0.1, 0.2, 0.3, alpha 0.25) and (0.5, 0.6, 0.7, alpha 1).
std::shared_ptr<const TexelImage> two_texels() {
  PixelBuffer pixels = make_pixel_buffer(2, 1, {"R", "G", "B", "A"});
  pixels.values = {0.1f, 0.2f, 0.3f, 0.25f, 0.5f, 0.6f, 0.7f, 1.0f};
  return std::make_shared<const TexelImage>(TexelImage::from(pixels));
}

TexturePoint at(float u, float v) { return {{u, v}, {0, 0, 0}, {0, 0, 1}}; }

TEST(ImageTexture, may_be_one_channel) {
  TextureSet set;
  ImageTexture<float> t;
  t.image = two_texels();
  const float expected[4] = {0.5f, 0.6f, 0.7f, 1.0f};
  for (int channel = 0; channel < 4; ++channel) {
    t.channel = channel;
    EXPECT_FLOAT_EQ(set.number(set.add(NumberTexture(t)), at(0.75f, 0.5f)), expected[channel]);
  }
}

TEST(ImageTexture, may_be_tinted) {
  TextureSet set;
  ImageTexture<Rgb> t;
  t.image = two_texels();
  t.tint = Rgb{{2, 3, 0}};
  const Rgb c = set.color(set.add(SpectrumTexture(t)), at(0.25f, 0.5f));
  EXPECT_FLOAT_EQ(c[0], 0.2f);
  EXPECT_FLOAT_EQ(c[1], 0.6f);
  EXPECT_FLOAT_EQ(c[2], 0);
}

// Along u: the texel that stands at each place, by the rules of the wrap modes.
TEST(ImageTexture, has_edges_by_axis) {
  TextureSet set;
  ImageTexture<float> t;
  t.image = two_texels();
  t.nearest = true, t.channel = 0;
  const auto row = [&](Fold fold) {
    t.folds = {fold, Fold::clamp};
    const NumberTextureId id = set.add(NumberTexture(t));
    std::string letters;
    for (float u : {-0.75f, -0.25f, 0.25f, 0.75f, 1.25f, 1.75f, 2.25f, 2.75f})
      letters += set.number(id, at(u, 7)) < 0.3f ? 'a' : 'b';
    return letters;
  };
  EXPECT_EQ(row(Fold::none), "abababab");
  EXPECT_EQ(row(Fold::clamp), "aaabbbbb");
  EXPECT_EQ(row(Fold::mirror), "baabbaab");
}

TEST(ImageTexture, does_not_mix_across_an_edge_that_is_clamped_or_mirrored) {
  TextureSet set;
  ImageTexture<float> t;
  t.image = two_texels();
  t.channel = 0;
  for (Fold fold : {Fold::clamp, Fold::mirror}) {
    t.folds = {fold, Fold::none};
    const NumberTextureId id = set.add(NumberTexture(t));
    EXPECT_FLOAT_EQ(set.number(id, at(0.01f, 0.5f)), 0.1f);
    EXPECT_FLOAT_EQ(set.number(id, at(0.99f, 0.5f)), 0.5f);
    EXPECT_FLOAT_EQ(set.number(id, at(1.01f, 0.5f)), 0.5f);
  }
  t.folds = {};
  EXPECT_NEAR(set.number(set.add(NumberTexture(t)), at(0, 0.5f)), 0.3f, 1e-6);
}

TEST(ImageTexture, may_lie_by_any_affine_map_and_is_the_same_in_lanes) {
  TextureSet set;
  ImageTexture<Rgb> t;
  t.image = two_texels();
  t.mapping = AffineUvMapping{{0, 1, 0.25f, -1, 0, 0}};  // s = v + 1/4
  t.tint = Rgb{{1, 2, 3}};
  t.folds = {Fold::mirror, Fold::clamp};
  const SpectrumTextureId id = set.add(SpectrumTexture(t));
  EXPECT_FLOAT_EQ(set.color(id, at(0.3f, 0.5f))[0], 0.5f);
  TexturePoints<NativeFloats> points;
  for (int k = 0; k < lanes_of<NativeFloats>; ++k) {
    set_lane(points.uv, k, Vec2f{0.3f * float(k) - 1, 0.37f * float(k) - 2});
    set_lane(points.p, k, Vec3f{0, 0, 0});
    set_lane(points.n, k, Vec3f{0, 0, 1});
  }
  const RgbOf<NativeFloats> all = set.color(id, points, Mask<NativeFloats>(true));
  for (int k = 0; k < lanes_of<NativeFloats>; ++k) {
    const Rgb one = set.color(id, TexturePoint{lane(points.uv, k), lane(points.p, k), lane(points.n, k)});
    for (int c = 0; c < 3; ++c) EXPECT_EQ(lane(all.c[c], k), one[c]) << k;
  }
}

TEST(ThresholdTexture, is_one_from_its_edge_on) {
  TextureSet set;
  ImageTexture<float> t;
  t.image = two_texels();
  t.channel = 3, t.nearest = true;
  const NumberTextureId alpha = set.add(NumberTexture(t));
  const NumberTextureId cut = set.add(NumberTexture(ThresholdTexture<float>{alpha, 0.5f}));
  EXPECT_EQ(set.number(cut, at(0.25f, 0.5f)), 0);
  EXPECT_EQ(set.number(cut, at(0.75f, 0.5f)), 1);
}

}  // namespace
}  // namespace montelux
