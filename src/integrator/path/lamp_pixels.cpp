#include "integrator/path/lamp_pixels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace montelux {

namespace {

// An emitter of so many pixels along both axes is large: what nine points of a pixel's filter do not show is missed.
constexpr float large = 4;

// Of a camera whose rays through one point of the lens have different places on the picture; null: of another one.
const ThinLens* lens_of(const Camera& camera) {
  if (const auto* perspective = std::get_if<PerspectiveCamera>(&camera.variant())) return &perspective->lens;
  const auto* orthographic = std::get_if<OrthographicCamera>(&camera.variant());
  return orthographic ? &orthographic->lens : nullptr;
}

bool has_surface(LightKind kind) { return kind <= LightKind::cylinder; }

struct RasterBox {
  Vec2f low, high;
  Vec2f size() const { return high - low; }
};

// Of the places of the corners, as these points of the lens see them; none where one of them is behind the camera.
std::optional<RasterBox> places_of(const LightBounds& box, const Camera& camera, std::span<const Vec2f> lens_points) {
  std::optional<RasterBox> all;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3f p{corner & 1 ? box.high.x : box.low.x, corner & 2 ? box.high.y : box.low.y,
                  corner & 4 ? box.high.z : box.low.z};
    for (const Vec2f& u : lens_points) {
      const LensConnection<float> at = camera.toward(p, u);
      if (!at.seen || !std::isfinite(at.raster.x) || !std::isfinite(at.raster.y)) return std::nullopt;
      if (!all) all = {at.raster, at.raster};
      all->low = {std::min(all->low.x, at.raster.x), std::min(all->low.y, at.raster.y)};
      all->high = {std::max(all->high.x, at.raster.x), std::max(all->high.y, at.raster.y)};
    }
  }
  return all;
}
// The centre of the lens, and points of its rim.
constexpr float last = 0.999f;
constexpr std::array<Vec2f, 9> lens_points{
    {{0.5f, 0.5f}, {0, 0}, {0.5f, 0}, {last, 0}, {0, 0.5f}, {last, 0.5f}, {0, last}, {0.5f, last}, {last, last}}};

// Whether rays through the box, on a grid, meet an emitter: where none does it is behind something else.
bool shows_emitter(const Scene& scene, const Accel& accel, const RasterBox& box) {
  using F = NativeFloats;
  constexpr std::uint32_t side = 8;
  for (std::uint32_t first = 0; first < side * side; first += std::uint32_t(lanes_of<F>)) {
    // From all over the box at once: the numbers of neighbours in a pack are far apart.
    const Uint<F> i = (lane_index<F>() + Uint<F>(first)) * Uint<F>(29u);
    const F u = (to_float(i & Uint<F>(side - 1)) + 0.5f) * (1.0f / float(side)),
            v = (to_float((i >> 3) & Uint<F>(side - 1)) + 0.5f) * (1.0f / float(side));
    const Vec2<F> raster{u * box.size().x + box.low.x, v * box.size().y + box.low.y};
    const Ray<F> ray = scene.camera.generate(raster, Vec2<F>{F(0.5f), F(0.5f)}).ray;
    const auto [found, hit] = accel.trace<F>({ray.o, ray.d, F(ray_infinity), F(0.0f)}, Mask<F>(true), RayUse::camera);
    if (any(meets_emitter<F>(scene, hit, found))) return true;
  }
  return false;
}

}  // namespace

std::shared_ptr<const LampPixels> LampPixels::of(const Scene& scene, const Accel& accel, int width, int height) {
  const bool is_simple = !scene.moves() && !scene.pixel_centres && scene.media.empty() &&
                         !scene.materials.has_interfaces() && lens_of(scene.camera);
  if (!is_simple || width <= 0 || height <= 0) return nullptr;
  std::shared_ptr<LampPixels> lamps(new LampPixels(width, height));
  for (std::uint32_t light = 0; light < scene.lights.count(); ++light)
    if (const auto& box = scene.lights.bounds(LightId(light)); box && has_surface(scene.lights.kind(LightId(light))))
      lamps->mark(scene, accel, *box);
  return lamps->is_empty_ ? nullptr : lamps;
}

LampPixels::LampPixels(int width, int height)
    : width_(std::uint32_t(width)), height_(std::uint32_t(height)), states_(std::size_t(width) * std::size_t(height)) {}

void LampPixels::mark(const Scene& scene, const Accel& accel, const LightBounds& box) {
  const Vec2f size{float(width_), float(height_)}, reach = scene.filter.radius();
  const bool is_pinhole = !lens_of(scene.camera)->open;
  const std::optional<RasterBox> sharp = places_of(box, scene.camera, std::span(lens_points).first(1)),
                                 seen = is_pinhole ? sharp : places_of(box, scene.camera, lens_points);
  const RasterBox at = seen.value_or(RasterBox{{0, 0}, size});
  // Pixel i has its samples within the filter's radius of i + 0.5.
  constexpr float rounding = 0.01f;
  const auto first_of = [](float from, std::uint32_t end) {
    return std::uint32_t(std::clamp(std::ceil(from - 0.5f - rounding), 0.0f, float(end)));
  };
  const auto end_of = [](float to, std::uint32_t end) {
    return std::uint32_t(std::clamp(std::floor(to - 0.5f + rounding) + 1, 0.0f, float(end)));
  };
  const std::uint32_t x0 = first_of(at.low.x - reach.x, width_), x1 = end_of(at.high.x + reach.x, width_),
                      y0 = first_of(at.low.y - reach.y, height_), y1 = end_of(at.high.y + reach.y, height_);
  if (x0 >= x1 || y0 >= y1) return;
  const bool is_large = !sharp || (sharp->size().x >= large && sharp->size().y >= large);
  if (!is_large && is_pinhole && !shows_emitter(scene, accel, at)) return;
  is_empty_ = false;
  for (std::uint32_t y = y0; y < y1; ++y)
    for (std::uint32_t x = x0; x < x1; ++x) {
      SharedByte& state = states_[index(x, y)];
      state.set(std::max(state.get(), std::uint8_t(is_large ? unknown : some)));
    }
}

}  // namespace montelux
