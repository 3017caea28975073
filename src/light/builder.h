// From shapes and parameters to the tables of a LightSet.
#pragma once
#include <functional>

#include "light/light_set.h"
#include "math/transform.h"
#include "parameter/spec.h"

namespace montelux {

// What an emitting surface sends from each of its points.
struct Emission {
  Rgb radiance{};                // L, W / (m^2 sr) on each component
  float scale = 1;               // factor of L and of the image
  std::optional<float> power{};  // of the whole shape, W: scales the light so that L of luminance 1 emits it
  bool two_sided = false;
  std::shared_ptr<const LightImage> image{};  // instead of L, by uv; none: L everywhere
};

// In world space. The normal is that of (p1 - p0) x (p2 - p0), or its opposite where `flip`.
struct TriangleShape {
  Vec3f p0, p1, p2;
  Vec2f uv0{0, 0}, uv1{1, 0}, uv2{1, 1};
  bool flip = false;
};

// What the builder asks the scene for. A callback that cannot answer reports that itself and returns what is sensible.
struct LightInputs {
  std::function<Rgb(const SpectrumValue&)> emission;  // of L, I, ...: a spectrum that is not an RGB has luminance 1
  std::function<std::shared_ptr<const LightImage>(const std::string&)> image;  // null: cannot be read
};

class LightSetBuilder {
 public:
  LightId add_triangle(const TriangleShape& shape, const Emission& emission);

  // The same from all directions; the radiance includes every scale.
  LightId add_uniform_infinite(Rgb radiance);
  LightId add_point(Vec3f p, Rgb intensity);
  // From the direction `toward` the light (need not be unit): irradiance at normal incidence.
  LightId add_distant(Vec3f toward, Rgb irradiance);

  // The bounding sphere of the scene is where infinite lights are taken to be.
  LightSet build(LightSettings settings, Vec3f scene_centre, float scene_radius) &&;

 private:
  LightId add(LightKind kind, const LightRow& row, std::optional<LightBounds> bounds, float power);
  // The row of a surface of this area, and the mean of what it emits (average over components and image).
  struct SurfaceRow {
    LightRow row;
    float mean_radiance;
  };
  SurfaceRow surface_row(const Emission& emission, float area, bool flip);

  LightTables tables_;
};

}  // namespace montelux
