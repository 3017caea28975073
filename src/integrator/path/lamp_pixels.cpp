#include "integrator/path/lamp_pixels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <vector>

namespace montelux {

namespace {

// An emitter of so many pixels along both axes is large: what nine points of a pixel's filter do not show is missed.
constexpr float large = 4;
// Parts of filters are looked for in so many pixels, some of which are in many boxes; then filters are whole.
constexpr std::size_t max_parts = std::size_t(1) << 26;
// Of larger pictures the pixels are not looked for: it would take more memory than their parts do.
constexpr std::size_t max_pixels = std::size_t(1) << 25;

// Of a camera whose rays through one point of the lens have different places on the picture; null: of another one.
const ThinLens* lens_of(const Camera& camera) {
  if (const auto* perspective = std::get_if<PerspectiveCamera>(&camera.variant())) return &perspective->lens;
  const auto* orthographic = std::get_if<OrthographicCamera>(&camera.variant());
  return orthographic ? &orthographic->lens : nullptr;
}

bool has_surface(LightKind kind) { return kind <= LightKind::cylinder; }

// Where the picture shows an emitter, as some points of the lens see it.
struct Place {
  bool in_view = false;  // false: it is behind the camera
  bool known = true;     // false: a part of its box is behind the camera, and it may be seen anywhere
  RasterBox box{{0, 0}, {0, 0}};
};
Place place_of(const LightBounds& bounds, const Camera& camera, std::span<const Vec2f> lens_points) {
  Place place;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3f p{corner & 1 ? bounds.high.x : bounds.low.x, corner & 2 ? bounds.high.y : bounds.low.y,
                  corner & 4 ? bounds.high.z : bounds.low.z};
    for (const Vec2f& u : lens_points) {
      const LensConnection<float> at = camera.toward(p, u);
      if (!at.seen || !std::isfinite(at.raster.x) || !std::isfinite(at.raster.y)) {
        place.known = false;
        continue;
      }
      RasterBox& box = place.box;
      if (!place.in_view) box = {at.raster, at.raster}, place.in_view = true;
      box.low = {std::min(box.low.x, at.raster.x), std::min(box.low.y, at.raster.y)};
      box.high = {std::max(box.high.x, at.raster.x), std::max(box.high.y, at.raster.y)};
    }
  }
  return place;
}
// The centre of the lens, and points of its rim.
constexpr float last = 0.999f;
constexpr std::array<Vec2f, 9> lens_points{
    {{0.5f, 0.5f}, {0, 0}, {0.5f, 0}, {last, 0}, {0, 0.5f}, {last, 0.5f}, {0, last}, {0.5f, last}, {last, last}}};

// The corners of a quadrilateral of the picture, in order; two of them are the same in a triangle.
using RasterQuad = std::array<Vec2f, 4>;
RasterQuad quad_of(const RasterBox& box) {
  return {box.low, Vec2f{box.high.x, box.low.y}, box.high, Vec2f{box.low.x, box.high.y}};
}

// Whether rays through the quadrilateral, on a grid and over the exposure, meet an emitter: where none does it is
// behind something else. What is behind interfaces is not known.
bool shows_emitter(const Scene& scene, const Accel& accel, const RasterQuad& quad) {
  if (scene.materials.has_interfaces()) return true;
  using F = NativeFloats;
  constexpr std::uint32_t side = 8;
  for (std::uint32_t first = 0; first < side * side; first += std::uint32_t(lanes_of<F>)) {
    // From all over the box at once: the numbers of neighbours in a pack are far apart.
    const Uint<F> i = (lane_index<F>() + Uint<F>(first)) * Uint<F>(29u);
    const F u = (to_float(i & Uint<F>(side - 1)) + 0.5f) * (1.0f / float(side)),
            v = (to_float((i >> 3) & Uint<F>(side - 1)) + 0.5f) * (1.0f / float(side));
    const auto between = [&](float Vec2f::*c) {
      const F low = u * (quad[1].*c - quad[0].*c) + quad[0].*c, high = u * (quad[2].*c - quad[3].*c) + quad[3].*c;
      return v * (high - low) + low;
    };
    const Vec2<F> raster{between(&Vec2f::x), between(&Vec2f::y)};
    const Ray<F> ray = scene.camera.generate(raster, Vec2<F>{F(0.5f), F(0.5f)}).ray;
    const F moment = (to_float((i * Uint<F>(25u)) & Uint<F>(side * side - 1)) + 0.5f) * (1.0f / float(side * side));
    const F time = scene.moves() ? scene.shutter.time(moment) : F(0.0f);
    const auto [found, hit] = accel.trace<F>({ray.o, ray.d, F(ray_infinity), time}, Mask<F>(true), RayUse::camera);
    if (any(meets_emitter<F>(scene, hit, found))) return true;
  }
  return false;
}

// The pixels of many boxes, which may overlap: in a time of the number of boxes plus that of pixels.
class PixelBoxes {
 public:
  PixelBoxes(std::uint32_t width, std::uint32_t height)
      : width_(width), height_(height), steps_((std::size_t(width) + 1) * (std::size_t(height) + 1)) {}
  // Those whose filter meets the box. Pixel i has its samples within the filter's radius of i + 0.5.
  void add(const RasterBox& box, Vec2f radius) {
    const std::size_t x0 = first_of(box.low.x - radius.x, width_), x1 = end_of(box.high.x + radius.x, width_),
                      y0 = first_of(box.low.y - radius.y, height_), y1 = end_of(box.high.y + radius.y, height_);
    if (x0 >= x1 || y0 >= y1) return;
    ++at(x0, y0), --at(x1, y0), --at(x0, y1), ++at(x1, y1);
    is_empty_ = false;
  }
  bool is_empty() const { return is_empty_; }
  // Calls f(index) for each pixel of a box, from the top and from the left. Only once.
  template <class Function>
  void for_each(Function f) {
    for (std::size_t y = 0; y < height_; ++y)
      for (std::size_t x = 0; x < width_; ++x) {
        std::int32_t& boxes = at(x, y);
        if (x > 0) boxes += at(x - 1, y);
        if (y > 0) boxes += at(x, y - 1);
        if (x > 0 && y > 0) boxes -= at(x - 1, y - 1);
        if (boxes > 0) f(y * width_ + x);
      }
  }

 private:
  static constexpr float rounding = 0.01f;
  static std::size_t first_of(float from, std::uint32_t end) {
    return std::size_t(std::clamp(std::ceil(from - 0.5f - rounding), 0.0f, float(end)));
  }
  static std::size_t end_of(float to, std::uint32_t end) {
    return std::size_t(std::clamp(std::floor(to - 0.5f + rounding) + 1, 0.0f, float(end)));
  }
  std::int32_t& at(std::size_t x, std::size_t y) { return steps_[y * (std::size_t(width_) + 1) + x]; }

  std::uint32_t width_, height_;
  std::vector<std::int32_t> steps_;
  bool is_empty_ = true;
};

// A convex polygon of the picture.
using Outline = std::vector<Vec2f>;

RasterBox box_of(const Outline& outline) {
  RasterBox box{outline[0], outline[0]};
  for (const Vec2f& p : outline) {
    box.low = {std::min(box.low.x, p.x), std::min(box.low.y, p.y)};
    box.high = {std::max(box.high.x, p.x), std::max(box.high.y, p.y)};
  }
  return box;
}

float cross(Vec2f a, Vec2f b) { return a.x * b.y - a.y * b.x; }
float dot(Vec2f a, Vec2f b) { return a.x * b.x + a.y * b.y; }

// A flat emitter as the picture shows it; none: it has another shape, or is not wholly before the camera.
std::optional<Outline> outline_of(const Scene& scene, LightId light) {
  const std::optional<LightPolygon> polygon = scene.lights.polygon(light);
  if (!polygon) return std::nullopt;
  Outline outline;
  for (int i = 0; i < polygon->count; ++i) {
    const LensConnection<float> at = scene.camera.toward(polygon->corners[std::size_t(i)], lens_points[0]);
    if (!at.seen || !std::isfinite(at.raster.x) || !std::isfinite(at.raster.y)) return std::nullopt;
    outline.push_back(at.raster);
  }
  return outline;
}

RasterQuad quad_of(const Outline& corners) { return {corners[0], corners[1], corners[2], corners.back()}; }

// The smallest distance of two parallel lines that it is between.
float width_of(const Outline& outline) {
  float width = std::numeric_limits<float>::infinity();
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vec2f edge = outline[(i + 1) % outline.size()] - outline[i];
    const float length = std::sqrt(dot(edge, edge));
    if (length <= 0) continue;
    float farthest = 0;
    for (const Vec2f& p : outline) farthest = std::max(farthest, std::abs(cross(edge, p - outline[i])) / length);
    width = std::min(width, farthest);
  }
  return width;
}

// The part where dot(p, d) <= end (Sutherland and Hodgman 1974).
Outline part_before(const Outline& outline, Vec2f d, float end) {
  Outline part;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vec2f &p = outline[i], &next = outline[(i + 1) % outline.size()];
    const float a = dot(p, d) - end, b = dot(next, d) - end;
    if (a <= 0) part.push_back(p);
    if ((a < 0 && b > 0) || (a > 0 && b < 0)) part.push_back(p + (next - p) * (a / (a - b)));
  }
  return part;
}

// Boxes of the parts of an outline that is narrow and oblique, which its own box is much larger than.
std::vector<RasterBox> boxes_along(const Outline& outline, float part_length) {
  constexpr float max_pieces = 256;
  Vec2f axis{1, 0};
  float longest = 0;
  for (const Vec2f& p : outline)
    for (const Vec2f& q : outline)
      if (const float squared = dot(q - p, q - p); squared > longest) longest = squared, axis = q - p;
  const Vec2f d = axis * (1 / std::sqrt(std::max(longest, 1e-12f)));
  float first = dot(outline[0], d), end = first;
  for (const Vec2f& p : outline) first = std::min(first, dot(p, d)), end = std::max(end, dot(p, d));
  const int parts = int(std::clamp((end - first) / part_length, 1.0f, max_pieces));
  std::vector<RasterBox> boxes;
  for (int i = 0; i < parts; ++i) {
    const float from = first + (end - first) * float(i) / float(parts),
                to = first + (end - first) * float(i + 1) / float(parts);
    const Outline part = part_before(part_before(outline, d, to), d * -1.0f, -from);
    if (!part.empty()) boxes.push_back(box_of(part));
  }
  return boxes;
}

}  // namespace

std::shared_ptr<const LampPixels> LampPixels::of(const Scene& scene, const Accel& accel, int width, int height) {
  const ThinLens* lens = lens_of(scene.camera);
  const bool is_simple = !scene.camera.moves() && !scene.pixel_centres && lens && width > 0 && height > 0 &&
                         std::size_t(width) * std::size_t(height) <= max_pixels;
  if (!is_simple) return nullptr;
  std::shared_ptr<LampPixels> lamps(new LampPixels(scene.filter, width, height));
  PixelBoxes large_ones(lamps->width_, lamps->height_), small_ones(lamps->width_, lamps->height_),
      whole_ones(lamps->width_, lamps->height_);
  std::size_t parts = 0;
  const Vec2f radius = scene.filter.radius(), size{float(width), float(height)};
  for (std::uint32_t i = 0; i < scene.lights.count(); ++i) {
    const auto& bounds = scene.lights.bounds(LightId(i));
    if (!has_surface(scene.lights.kind(LightId(i)))) continue;
    if (!bounds) return nullptr;
    const Place sharp = place_of(*bounds, scene.camera, std::span(lens_points).first(1)),
                seen = lens->open ? place_of(*bounds, scene.camera, lens_points) : sharp;
    if (!seen.in_view) continue;
    const RasterBox box = seen.known ? seen.box : RasterBox{{0, 0}, size};
    // What is hidden by something else may still be seen in part: the part of a filter contains it, too.
    const auto add_to_parts = [&](const RasterBox& part) {
      if (parts < max_parts)
        parts += lamps->parts_.add(part), whole_ones.add(part, radius * -1.0f);
      else
        whole_ones.add(part, radius);
    };
    const std::optional<Outline> outline = lens->open ? std::nullopt : outline_of(scene, LightId(i));
    if (!sharp.known || (sharp.box.size().x >= large && sharp.box.size().y >= large)) {
      // Nine points miss what is narrow, and the tips of what is wide.
      if (outline && width_of(*outline) < large) {
        for (const RasterBox& part : boxes_along(*outline, large / 2)) {
          add_to_parts(part);
          if (shows_emitter(scene, accel, quad_of(part))) small_ones.add(part, radius);
        }
        continue;
      }
      add_to_parts(box);
      if (outline)
        for (const Vec2f& tip : *outline) small_ones.add({tip, tip}, radius);
      large_ones.add(box, radius);
      continue;
    }
    add_to_parts(box);
    if (lens->open || shows_emitter(scene, accel, outline ? quad_of(*outline) : quad_of(box)))
      small_ones.add(box, radius);
  }
  if (large_ones.is_empty() && small_ones.is_empty()) return nullptr;
  large_ones.for_each([&](std::size_t i) { lamps->states_[i].set(unknown); });
  small_ones.for_each([&](std::size_t i) { lamps->states_[i].set(some); });
  whole_ones.for_each([&](std::size_t i) { lamps->parts_.make_whole(i); });
  return lamps;
}

LampPixels::LampPixels(const Filter& filter, int width, int height)
    : width_(std::uint32_t(width)),
      height_(std::uint32_t(height)),
      parts_(filter, width_, height_),
      states_(std::size_t(width) * std::size_t(height)) {}

}  // namespace montelux
