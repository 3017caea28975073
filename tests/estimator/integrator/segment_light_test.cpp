// Light of lamps at one point that a medium scatters along one segment: the path's own event and the one that is drawn
// by the angle at the lamp, together, against the integral in closed form.
#include "integrator/path/segment_light.h"

#include <gtest/gtest.h>

#include <array>
#include <numbers>
#include <vector>

#include "render_scenes.h"
#include "statistics.h"

namespace montelux::test {
namespace {

constexpr double absorption[] = {0.1, 0.2, 0.05}, scattering[] = {0.2, 0.3, 0.5}, g = 0.4;
// The segment is on the z axis.
struct Lamp {
  double x, z, intensity[3];
};
constexpr Lamp lamps[] = {{0.005, 2, {1, 2, 3}}, {-1.5, 3, {5, 1, 2}}};

std::string fog_with_lamps() {
  const auto rgb = [](const double* c) {
    return "[ " + std::to_string(c[0]) + " " + std::to_string(c[1]) + " " + std::to_string(c[2]) + " ]";
  };
  std::string text = "MakeNamedMedium \"m\" \"string type\" \"homogeneous\" \"rgb sigma_a\" " + rgb(absorption) +
                     " \"rgb sigma_s\" " + rgb(scattering) + " \"float g\" " + std::to_string(g) +
                     "\nMediumInterface \"\" \"m\"\nCamera \"perspective\"\nWorldBegin\nMediumInterface \"m\" \"m\"\n";
  for (const Lamp& lamp : lamps)
    text += "LightSource \"point\" \"rgb I\" " + rgb(lamp.intensity) + " \"point3 from\" [ " + std::to_string(lamp.x) +
            " 0 " + std::to_string(lamp.z) + " ]\n";
  // A spot that the middle of the segment is not in: it shines at the end alone.
  return text +
         "LightSource \"spot\" \"rgb I\" [ 4 4 8 ] \"point3 from\" [ 0 0.3 5 ] \"point3 to\" [ 0 0 5 ]\n"
         "    \"float coneangle\" 30 \"float conedeltaangle\" 0\n";
}

// By the midpoint rule in the angle at each lamp.
double truth(std::size_t c, double length) {
  const double extinction = absorption[c] + scattering[c];
  const auto scattered = [&](double t, double z, double r) {  // along -z, of light that has come from the lamp
    const double cosine = -(t - z) / r, d = 1 + g * g - 2 * g * cosine;
    return scattering[c] * (1 - g * g) / (4 * std::numbers::pi * d * std::sqrt(d)) * std::exp(-extinction * (t + r));
  };
  constexpr int steps = 200000;
  double sum = 0;
  const auto add = [&](double gap, double z, double from, double to, double intensity) {
    double ray = 0;
    for (int i = 0; i < steps; ++i) {
      const double t = z + gap * std::tan(from + (to - from) * (i + 0.5) / steps);
      ray += scattered(t, z, std::hypot(gap, t - z));
    }
    sum += intensity * ray * (to - from) / steps / gap;
  };
  for (const Lamp& lamp : lamps) {
    const double gap = std::abs(lamp.x);
    add(gap, lamp.z, std::atan(-lamp.z / gap), std::atan((length - lamp.z) / gap), lamp.intensity[c]);
  }
  const double edge = std::numbers::pi / 6, end = std::atan((length - 5) / 0.3);
  add(0.3, 5, -edge, std::min(edge, end), c == 2 ? 8 : 4);
  return sum;
}

constexpr int groups = 64, samples_per_group = 8192;

// Means of groups of samples, by component.
struct Terms {
  std::array<std::vector<double>, rgb_size> combined, without_share, without_second;  // the last two are planted faults
  double largest = 0, largest_of_path = 0;  // of one sample: of both events, and of the path's own without a share
};

// As the path loop combines them.
Terms estimate(const Scene& scene, const Accel& accel, float length, const Spectrum<float>& throughput) {
  const LightSet& lights = scene.lights;
  Segment<float> segment{{{0, 0, 0}, {0, 0, 1}, float(ray_infinity), 0}, {}, media_of<float>(scene.media, 1)};
  segment.hit.t = length;
  const SegmentLight<float> light_of_segment(scene, lights, segment, throughput, true);
  Terms terms;
  const RandomStream<float> all(5, 77);
  for (std::uint32_t group = 0; group < groups; ++group) {
    Spectrum<double> combined = gray(0.0), without_share = gray(0.0), without_second = gray(0.0);
    for (std::uint32_t i = 0; i < samples_per_group; ++i) {
      RandomStream<float> random = all.fork(group * samples_per_group + i);
      const Vec2<float> u = random.next2();
      const DistanceSample<float> s = scene.media.sample_distance<float>(1, throughput, length, u);
      Spectrum<float> whole = gray(0.0f);
      float share = 1;
      if (s.is_event) {
        const Vec3f p{0, 0, s.distance};
        const float u_choice = random.next();
        const LightSample<float> light = lights.sample<float>(p, {0, 0, 0}, u_choice, {0.5f, 0.5f}, true);
        if (light.valid) {
          const float phase = scene.media.phase<float>(1).evaluate(Vec3f{0, 0, -1}, light.wi).value;
          whole = throughput * s.weight * light.radiance * segment.media.left(light.distance) * phase;
          share = light_of_segment.share(p, s.distance, light, u_choice, true);
        }
      }
      std::uint64_t rays = 0;
      const auto also = light_of_segment.sample(accel, random.fork(9), rays);
      const Spectrum<float> second = also.on ? also.contribution : gray(0.0f);
      const Spectrum<float> both = whole * share + second, doubled = whole + second, own = whole * share;
      for (int c = 0; c < spectrum_size; ++c) {
        combined.c[c] += double(both.c[c]), without_share.c[c] += double(doubled.c[c]);
        without_second.c[c] += double(own.c[c]);
      }
      terms.largest = std::max(terms.largest, double(max_component(both)));
      terms.largest_of_path = std::max(terms.largest_of_path, double(max_component(whole)));
    }
    const auto add = [](std::array<std::vector<double>, rgb_size>& means, const Spectrum<double>& sum) {
      const RgbOf<double> mean = to_rgb(sum);
      for (std::size_t c = 0; c < rgb_size; ++c) means[c].push_back(mean.c[c] / samples_per_group);
    };
    add(terms.combined, combined), add(terms.without_share, without_share), add(terms.without_second, without_second);
  }
  return terms;
}

TEST(SegmentLight, is_the_integral_along_the_segment_and_planted_faults_are_found) {
  const TestScene scene(fog_with_lamps());
  const Rgb throughput{{0.7f, 0.2f, 0.4f}};
  const double level = sidak_level(family_level, 2 * 3);
  for (const float length : {5.5f, 30.0f}) {
    SCOPED_TRACE(length);
    const Terms terms = estimate(scene.scene(), scene.accel(), length, from_rgb(throughput));
    for (std::size_t c = 0; c < 3; ++c) {
      SCOPED_TRACE(c);
      const double expected = double(throughput.c[c]) * truth(c, double(length));
      EXPECT_GT(t_test(terms.combined[c], expected).p_value, level)
          << summarize(terms.combined[c]).mean << " for " << expected;
      EXPECT_LT(t_test(terms.combined[c], 1.05 * expected).p_value, level);
      EXPECT_LT(t_test(terms.without_share[c], expected).p_value, level);
      EXPECT_LT(t_test(terms.without_second[c], expected).p_value, level);
    }
    // A sample is bounded by pi times the light that the segment scatters from the point nearest the lamp, over the
    // probability of the lamp; light sampling alone is not bounded.
    const double phase = (1 - g * g) / (4 * std::numbers::pi * std::pow(1 - g, 3));
    const double bound = 2 * 0.4 * 0.5 * phase * 3 * std::numbers::pi / lamps[0].x / 0.1;
    EXPECT_LT(terms.largest, bound);
    EXPECT_GT(terms.largest_of_path, bound);
  }
}

// A lamp that is hidden sends nothing, by either event.
TEST(SegmentLight, is_hidden_by_surfaces) {
  const std::string screen =
      "Material \"diffuse\"\nShape \"bilinearmesh\" \"point3 P\" [ 0.0025 -9 -1  0.0025 -9 9  0.0025 9 -1  0.0025 9 "
      "9 ]\n";
  std::string text = fog_with_lamps();
  text.resize(text.find("LightSource \"point\" \"rgb I\" [ 5"));
  for (const bool hidden : {false, true}) {
    const TestScene scene(text + (hidden ? screen : ""));
    std::uint64_t rays = 0;
    Segment<float> segment{{{0, 0, 0}, {0, 0, 1}, float(ray_infinity), 0}, {}, media_of<float>(scene.scene().media, 1)};
    segment.hit.t = 9;
    const Spectrum<float> throughput = gray(1.0f);
    const SegmentLight<float> light(scene.scene(), scene.scene().lights, segment, throughput, true);
    for (std::uint32_t i = 0; i < 64; ++i)
      EXPECT_EQ(light.sample(scene.accel(), RandomStream<float>(3, 4).fork(i), rays).on, !hidden);
    EXPECT_EQ(rays, 64u);
  }
}

}  // namespace
}  // namespace montelux::test
