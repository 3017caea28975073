// Photons are found where they are, each once, in the same order whoever stored them; and the weights by which they are
// gathered.
#include "integrator/photons/photon_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <thread>

#include "integrator/photons/gathering.h"
#include "integrator/photons/sppm.h"
#include "mc/random.h"

namespace montelux::test {
namespace {

// So many photons in the unit cube, and half of them in one plane.
std::vector<Photon> some_photons(std::uint32_t count) {
  const RandomStream<float> all(3, 7);
  std::vector<Photon> photons;
  for (std::uint32_t i = 0; i < count; ++i) {
    RandomStream<float> random = all.fork(i);
    const Vec2f place = random.next2();
    const float height = i % 2 == 0 ? 0.25f : random.next();
    photons.push_back({{place.x, height, place.y}, {0, 1, 0}, {0, 1, 0}, gray(float(i)), i % 3, i / 3});
  }
  return photons;
}

// The map of photons that `tiles` tiles have stored, whose steps so many threads run.
void fill(PhotonMap& map, const std::vector<Photon>& photons, float radius, std::size_t tiles, std::size_t threads) {
  for (int stage = 0; stage < PhotonMap::stages; ++stage) {
    std::vector<std::jthread> running;
    for (std::size_t t = 0; t < threads; ++t)
      running.emplace_back([&, t] {
        for (std::size_t unit = t; unit < map.units(stage); unit += threads)
          map.run_unit(stage, unit, radius, [&](std::vector<Photon>& box) {
            if (unit < tiles)
              for (std::size_t i = unit; i < photons.size(); i += tiles) box.push_back(photons[i]);
            return RayCounts{};
          });
      });
  }
}
std::vector<float> found_near(const PhotonMap& map, const Vec3f& p, const Vec3f& n) {
  NearPhotons near;
  map.near(p, n, near);
  std::vector<float> names;
  for (std::size_t i = 0; i < near.count; ++i) names.push_back(map.photons()[near.photon[i]].flux.c[0]);
  return names;
}

// Cells share entries of the table, and each photon is found once for all that.
TEST(PhotonMap, finds_every_photon_within_the_radius_once) {
  const std::vector<Photon> photons = some_photons(6000);
  const Vec3f up{0, 1, 0};
  for (const std::uint32_t before : {1u, 100u, 20000u})
    for (const float radius : {0.003f, 0.04f, 0.3f, 2.0f}) {
      PhotonMap map(8);
      // A second frame finds nothing of the first.
      fill(map, some_photons(before), 2 * radius, 3, 1);
      fill(map, photons, radius, 7, 2);
      EXPECT_EQ(map.size(), photons.size());
      std::size_t all = 0;
      RandomStream<float> random(1, 2);
      for (int i = 0; i < 40; ++i) {
        const Vec2f place = random.next2();
        const Vec3f p{place.x, 0.25f, place.y};
        std::vector<float> near = found_near(map, p, up), truth;
        for (const Photon& photon : photons)
          if (length(photon.p - p) < radius && std::abs(photon.p.y - p.y) <= similar_height * radius)
            truth.push_back(photon.flux.c[0]);
        std::ranges::sort(near), std::ranges::sort(truth);
        EXPECT_EQ(near, truth) << radius;
        all += truth.size();
      }
      EXPECT_GT(all, radius < 0.01f ? 0u : 100u);
    }
}

TEST(PhotonMap, has_its_photons_in_the_same_order_whoever_stored_them) {
  const std::vector<Photon> photons = some_photons(5000);
  const Vec3f p{0.5f, 0.25f, 0.5f}, up{0, 1, 0};
  PhotonMap one(1);
  fill(one, photons, 0.2f, 1, 1);
  const std::vector<float> order = found_near(one, p, up);
  EXPECT_GT(order.size(), 100u);
  EXPECT_FALSE(std::ranges::is_sorted(order)) << "photons of several cells";
  for (const std::size_t tiles : {2u, 16u, 61u}) {
    PhotonMap other(tiles);
    fill(other, photons, 0.2f, tiles, 4);
    EXPECT_EQ(found_near(other, p, up), order) << tiles;
  }
}

// In a medium there is no plane that photons lie near.
TEST(PhotonMap, finds_every_photon_of_a_ball_once) {
  std::vector<Photon> photons = some_photons(6000);
  for (Photon& photon : photons) photon.ng = {0, 0, 0}, photon.p.y = photon.p.z;
  for (const float radius : {0.04f, 0.3f}) {
    PhotonMap map(8);
    fill(map, photons, radius, 7, 2);
    std::size_t all = 0;
    for (const float along : {0.2f, 0.5f, 0.8f}) {
      const Vec3f p{along, 0.4f, 0.4f};
      NearPhotons near;
      map.near(p, near);
      std::vector<float> found, truth;
      for (std::size_t i = 0; i < near.count; ++i) found.push_back(map.photons()[near.photon[i]].flux.c[0]);
      for (const Photon& photon : photons)
        if (length(photon.p - p) < radius) truth.push_back(photon.flux.c[0]);
      std::ranges::sort(found), std::ranges::sort(truth);
      EXPECT_EQ(found, truth) << radius;
      all += truth.size();
    }
    EXPECT_GT(all, 3u);
  }
}

// On two sides of zero, far from it, and exactly on a radius's multiple.
TEST(PhotonMap, finds_photons_wherever_the_scene_lies) {
  for (const float at : {0.0f, -1000.0f, 1e6f, 0.5f}) {
    PhotonMap map(2);
    const float radius = at == 1e6f ? 1.0f : 0.25f;
    std::vector<Photon> photons;
    for (const float along : {-0.4f, 0.0f, 0.4f})
      photons.push_back({{at + along * 2 * radius, at, at}, {0, 1, 0}, {0, 1, 0}, gray(along), 0, 0});
    fill(map, photons, radius, 2, 1);
    EXPECT_EQ(found_near(map, {at, at, at}, {0, 1, 0}).size(), 3u) << at;
  }
}

TEST(PhotonKernels, integrate_to_one_over_the_disk) {
  constexpr int rings = 4096;
  for (const PhotonKernel kernel : {PhotonKernel::constant, PhotonKernel::epanechnikov, PhotonKernel::cone})
    for (const float radius : {0.01f, 3.0f}) {
      double sum = 0;
      for (int i = 0; i < rings; ++i) {
        const double rho = (i + 0.5) / rings * radius;
        sum +=
            2 * double(pi) * rho * (radius / rings) * kernel_weight<float>(kernel, float(rho * rho), radius * radius);
      }
      EXPECT_NEAR(sum, 1, 1e-5);
    }
}

TEST(PhotonKernels, integrate_to_one_over_the_ball) {
  constexpr int shells = 4096;
  for (const PhotonKernel kernel : {PhotonKernel::constant, PhotonKernel::epanechnikov, PhotonKernel::cone})
    for (const float radius : {0.01f, 3.0f}) {
      double sum = 0;
      for (int i = 0; i < shells; ++i) {
        const double rho = (i + 0.5) / shells * radius;
        sum += 4 * double(pi) * rho * rho * (radius / shells) *
               ball_kernel_weight<float>(kernel, float(rho * rho), radius * radius);
      }
      EXPECT_NEAR(sum, 1, 1e-5);
    }
}

// r_n^2 = r_1^2 Gamma(n + alpha - 1 + 1) / (Gamma(1 + alpha) Gamma(n + 1)), the product in closed form.
TEST(PhotonRadius, follows_the_sequence_of_Knaus_and_Zwicker) {
  for (const double alpha : {0.3, 2.0 / 3, 1.0})
    for (const int frame : {0, 1, 2, 10, 1000}) {
      const double n = frame + 1;
      const double squared = std::exp(std::lgamma(n + alpha) - std::lgamma(1 + alpha) - std::lgamma(n + 1));
      EXPECT_NEAR(sppm_radius(0.5, alpha, frame), 0.5 * std::sqrt(squared), 1e-10) << alpha << " " << frame;
      EXPECT_NEAR(sppm_radius(0.5, alpha, frame, 3), 0.5 * std::cbrt(squared), 1e-10) << alpha << " " << frame;
    }
  EXPECT_NEAR(sppm_radius(1, 0.5, 1), std::sqrt(1.5 / 2), 1e-12);
}

}  // namespace
}  // namespace montelux::test
