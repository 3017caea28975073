#include "lab/experiments/floor_scene.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mc/hemisphere.h"
#include "mc/point_set.h"

namespace montelux::lab {

namespace {

struct Rectangle {
  double x0, x1, y0, y1;
  bool contains(double x, double y) const { return x >= x0 && x < x1 && y >= y0 && y < y1; }
};

constexpr double light_height = 2, blocker_height = 1, half_floor = 2;
constexpr Rectangle light{-0.5, 0.5, -0.5, 0.5};
constexpr Rectangle blocker{-0.1, 0.6, -0.35, 0.25};

// The irradiance from a rectangle between the foot of the normal and (x, y), on a parallel plane at the given height,
// signed as x and y are (the configuration factor of a parallel rectangle; Howell, catalogue, C-11).
double corner_irradiance(double x, double y, double height) {
  const double a = x / height, b = y / height, p = std::sqrt(1 + a * a), q = std::sqrt(1 + b * b);
  return 0.5 * (a / p * std::atan(b / p) + b / q * std::atan(a / q));
}

double rectangle_irradiance(const Rectangle& r, double x, double y, double height) {
  if (r.x1 <= r.x0 || r.y1 <= r.y0) return 0;
  return corner_irradiance(r.x1 - x, r.y1 - y, height) - corner_irradiance(r.x0 - x, r.y1 - y, height) -
         corner_irradiance(r.x1 - x, r.y0 - y, height) + corner_irradiance(r.x0 - x, r.y0 - y, height);
}

// Where the line from a point of the floor to (lx, ly) at the light's height goes through the blocker's plane.
bool blocked(double x, double y, double lx, double ly) {
  const double t = blocker_height / light_height;
  return blocker.contains(x + t * (lx - x), y + t * (ly - y));
}

double by_area(double x, double y, Vec2f u) {
  const double lx = light.x0 + (light.x1 - light.x0) * double(u.x), ly = light.y0 + (light.y1 - light.y0) * double(u.y);
  if (blocked(x, y, lx, ly)) return 0;
  const double d2 = (lx - x) * (lx - x) + (ly - y) * (ly - y) + light_height * light_height;
  const double area = (light.x1 - light.x0) * (light.y1 - light.y0);
  return area * light_height * light_height / (d2 * d2);
}

double by_direction(double x, double y, Vec2f u, const FloorSettings& settings) {
  const bool projected = settings.sampling == Sampling::projected_solid_angle;
  const Vec3f w = projected ? sample_cosine_hemisphere(u) : sample_hemisphere(u);
  const double z = std::max(1e-9, double(w.z));
  const double lx = x + light_height * double(w.x) / z, ly = y + light_height * double(w.y) / z;
  if (!light.contains(lx, ly) || blocked(x, y, lx, ly)) return 0;
  using std::numbers::pi;
  return projected ? pi : (settings.wrong_factor ? pi : 2 * pi) * z;
}

// The point of the pattern for one shadow ray, as the sampler of the eye ray gives it.
Vec2f point_of(Pattern pattern, std::uint32_t index, std::uint32_t count, const Sampler<float>& sampler,
               std::uint32_t ray) {
  if (pattern == Pattern::fixed) return {0.5f, 0.5f};
  const auto side = std::uint32_t(std::lround(std::sqrt(double(count))));
  const auto column = float(index % side), row = float(index / side);
  if (pattern == Pattern::grid) return {(column + 0.5f) / float(side), (row + 0.5f) / float(side)};
  if (pattern == Pattern::quasi_random) return sampler.get2(2);
  RandomStream<float> stream = sampler.stream(2 + ray);
  const Vec2f u = stream.next2();
  return pattern == Pattern::random ? u : Vec2f{(column + u.x) / float(side), (row + u.y) / float(side)};
}

}  // namespace

double floor_irradiance(double x, double y) {
  // The shadow volume of the blocker, seen from the floor, cuts a rectangle out of the light's plane.
  const double grow = light_height / blocker_height;
  const Rectangle hidden{
      std::max(light.x0, x + grow * (blocker.x0 - x)), std::min(light.x1, x + grow * (blocker.x1 - x)),
      std::max(light.y0, y + grow * (blocker.y0 - y)), std::min(light.y1, y + grow * (blocker.y1 - y))};
  return rectangle_irradiance(light, x, y, light_height) - rectangle_irradiance(hidden, x, y, light_height);
}

double FloorScene::pixel(const FloorSettings& settings, std::uint32_t pixel, std::uint32_t seed,
                         std::uint32_t pass) const {
  const std::uint32_t column = pixel % size, row = pixel / size, rays = settings.eye_rays * settings.shadow_rays;
  const bool quasi = settings.pattern == Pattern::quasi_random;
  const PointSet set{quasi ? PointSetKind::padded_sobol : PointSetKind::independent, seed, pass, rays};
  const double step = 2 * half_floor / size;
  double sum = 0;
  for (std::uint32_t e = 0; e < settings.eye_rays; ++e) {
    const std::uint32_t first = e * settings.shadow_rays;
    const Vec2f jitter = Sampler<float>(set, column, row, first).get2(0);
    const double x = -half_floor + step * (column + double(jitter.x)), y = half_floor - step * (row + double(jitter.y));
    for (std::uint32_t s = 0; s < settings.shadow_rays; ++s) {
      const Sampler<float> sampler(set, column, row, first + s);
      const Vec2f u = point_of(settings.pattern, s, settings.shadow_rays, sampler, s);
      sum += settings.sampling == Sampling::area ? by_area(x, y, u) : by_direction(x, y, u, settings);
    }
  }
  return sum / rays;
}

std::vector<double> FloorScene::reference() const {
  std::vector<double> values;
  const double step = 2 * half_floor / size;
  // The shadow's edges bend the irradiance, so many small panels by the middle serve better than few nodes of high
  // order.
  constexpr int panels = 24;
  for (std::uint32_t row = 0; row < size; ++row)
    for (std::uint32_t column = 0; column < size; ++column) {
      double sum = 0;
      for (int i = 0; i < panels; ++i)
        for (int j = 0; j < panels; ++j)
          sum += floor_irradiance(-half_floor + step * (column + (i + 0.5) / panels),
                                  half_floor - step * (row + (j + 0.5) / panels));
      values.push_back(sum / (panels * panels));
    }
  return values;
}

Picture gray_picture(const std::vector<double>& values, int width, double white) {
  Picture picture;
  picture.width = width, picture.height = int(values.size()) / width;
  for (double v : values) {
    const double linear = std::clamp(v / white, 0.0, 1.0);
    const double display = linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
    picture.rgb.insert(picture.rgb.end(), 3, std::uint8_t(std::lround(255 * display)));
  }
  return picture;
}

}  // namespace montelux::lab
