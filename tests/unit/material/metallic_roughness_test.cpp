// The metallic-roughness model against appendix B.3 of the glTF 2.0 specification, written down here in its own terms.
#include "material/metallic_roughness.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace montelux {
namespace {

struct Parameters {
  double base, metallic, roughness, specular = 1, color = 1, reflected = 0.04;
};

MetallicRoughness<float> model_of(const Parameters& p) {
  BsdfRow row;
  using Slots = MetallicRoughnessSlots;
  for (int i = 0; i < spectrum_size; ++i)
    row.v[Slots::base + i] = float(p.base), row.v[Slots::specular_color + i] = float(p.color);
  row.v[Slots::metallic] = float(p.metallic), row.v[Slots::roughness] = float(p.roughness);
  row.v[Slots::specular] = float(p.specular), row.v[Slots::reflected] = float(p.reflected);
  return MetallicRoughness<float>(BsdfRows<float>{&row});
}

Vec3f direction_of(double polar, double azimuth) {
  return {float(std::sin(polar) * std::cos(azimuth)), float(std::sin(polar) * std::sin(azimuth)),
          float(std::cos(polar))};
}

// Both parts of f cos i; `limited`: the diffuse part under the largest of the three Fresnel terms instead of F(V.H).
struct Parts {
  double diffuse, limited, specular;
};
Parts appendix_b(const Parameters& p, Vec3f l, Vec3f v) {
  const double hx = double(l.x + v.x), hy = double(l.y + v.y), hz = double(l.z + v.z);
  const double h_length = std::sqrt(hx * hx + hy * hy + hz * hz), n_h = hz / h_length;
  const double v_h = (double(v.x) * hx + double(v.y) * hy + double(v.z) * hz) / h_length;
  const double n_l = double(l.z), n_v = double(v.z);
  const double dielectric = std::min(p.reflected * p.color, 1.0) * p.specular;
  const double f0 = dielectric + (p.base - dielectric) * p.metallic, f90 = p.specular + (1 - p.specular) * p.metallic;
  const auto fresnel = [&](double c) { return f0 + (f90 - f0) * std::pow(1 - c, 5); };
  const double pi_ = 3.14159265358979323846, a = p.roughness * p.roughness, a2 = a * a;
  const double d = a2 / (pi_ * std::pow(n_h * n_h * (a2 - 1) + 1, 2));
  const double visibility =
      0.5 / (n_l * std::sqrt(a2 + (1 - a2) * n_v * n_v) + n_v * std::sqrt(a2 + (1 - a2) * n_l * n_l));
  const double lambert = p.base * (1 - p.metallic) / pi_ * n_l;
  return {lambert * (1 - fresnel(v_h)), lambert * (1 - fresnel(std::min({v_h, n_l, n_v}))),
          fresnel(v_h) * d * visibility * n_l};
}

TEST(MetallicRoughness, is_appendix_b_except_for_the_light_that_the_diffuse_part_is_left) {
  for (const Parameters& p : {Parameters{0.8, 0, 0.5}, Parameters{0.8, 1, 0.3}, Parameters{0.6, 0.4, 0.9},
                              Parameters{0.5, 0.2, 0.6, 0.5, 3, 0.1}, Parameters{0.7, 0, 1, 0}})
    for (double polar : {0.1, 0.7, 1.3})
      for (double other : {0.05, 0.6, 1.2})
        for (double azimuth : {0.0, 1.0, 3.0}) {
          const Vec3f v = direction_of(polar, 0.3), l = direction_of(other, azimuth);
          const Parts expected = appendix_b(p, l, v);
          const float found = model_of(p).evaluate(v, l, {}).f_cos[1];
          EXPECT_NEAR(found, expected.limited + expected.specular, 2e-5 * (1 + expected.specular));
          // Never more than the appendix has.
          EXPECT_LE(found, expected.diffuse + expected.specular + 2e-5 * (1 + expected.specular));
        }
}

TEST(MetallicRoughness, looks_the_same_from_both_sides) {
  const MetallicRoughness<float> model = model_of({0.6, 0.4, 0.5});
  const Vec3f v = direction_of(0.5, 0.3), l = direction_of(0.9, 2);
  const Vec3f v_below{v.x, v.y, -v.z}, l_below{l.x, l.y, -l.z};
  EXPECT_EQ(model.evaluate(v, l, {}).f_cos[0], model.evaluate(v_below, l_below, {}).f_cos[0]);
  EXPECT_EQ(model.evaluate(v, l_below, {}).f_cos[0], 0);
}

// The whole of a white surface's light at grazing angles, by quadrature: that of appendix B is more than came in.
TEST(MetallicRoughness, gains_no_light_where_the_appendix_does) {
  const Parameters p{1, 0, 0.35};
  const Vec3f v = direction_of(1.5, 0);
  double own = 0, appendix = 0;
  const int n = 400;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      // Uniform in the square of the sine, so by cosine; azimuth all round.
      const double sine = std::sqrt((i + 0.5) / n);
      const Vec3f l = direction_of(std::asin(sine), (j + 0.5) / n * 6.283185307179586);
      const double weight = 3.14159265358979323846 / (double(l.z) * n * n);
      const Parts parts = appendix_b(p, l, v);
      own += double(model_of(p).evaluate(v, l, {}).f_cos[0]) * weight;
      appendix += (parts.diffuse + parts.specular) * weight;
    }
  EXPECT_LE(own, 1);
  EXPECT_GT(own, 0.5);
  EXPECT_GT(appendix, 1.1);
}

}  // namespace
}  // namespace montelux
