// From shapes and parameters to the tables of a LightSet.
#pragma once
#include <functional>

#include "light/description.h"
#include "light/light_set.h"
#include "math/transform.h"

namespace montelux {

// What an emitting surface emits at each of its points.
struct Emission {
  Rgb radiance{};                             // L, W / (m^2 sr) on each component
  float scale = 1;                            // factor of L or of the image
  std::optional<float> power{};               // of the whole shape, W: scales it so that L of luminance 1 emits that
  bool two_sided = false;                     // false: only on the side of the normal
  std::shared_ptr<const LightImage> image{};  // instead of L, by uv with v upward; none: L everywhere
  std::string group = "default";              // of lights that share a layer of an image
  Rgb tint = gray_rgb(1.0f);                  // factor of the image
  std::optional<Rgb> image_mean{};            // mean of the image, if already computed: images are large
  bool local_power = false;  // triangles are chosen by the texels of the image on them instead of by its mean
  // The shape has an alpha mask. Light sampling would sample points in its holes, so the light is found only by rays
  // that hit it.
  bool masked = false;
  bool seen_through = false;  // the surface lets rays pass, so that its inside is visible from outside
};

// Shapes that can emit. Each defines its normal; `flip` reverses it.

// In world space; the normal is that of (p1 - p0) x (p2 - p0).
struct TriangleShape {
  Vec3f p0, p1, p2;
  Vec2f uv0{0, 0}, uv1{1, 0}, uv2{1, 1};
  bool flip = false;
};
// In world space; the normal is that of (p10 - p00) x (p01 - p00) at that corner.
struct PatchShape {
  Vec3f p00, p10, p01, p11;
  Vec2f uv00{0, 0}, uv10{1, 0}, uv01{0, 1}, uv11{1, 1};
  bool flip = false;
};
// At the height z, around the z axis from x towards y; the normal is that of +z. Angles in degrees.
struct DiskShape {
  Transform to_world;
  float radius = 1, inner_radius = 0, height = 0, phi_max = 360;
  bool flip = false;
};
// The part of a sphere about the origin between two heights; the normal points outward.
struct SphereShape {
  Transform to_world;
  float radius = 1, z_min = -1e30f, z_max = 1e30f, phi_max = 360;
  bool flip = false;
};
// About the z axis; the normal points outward.
struct CylinderShape {
  Transform to_world;
  float radius = 1, z_min = -1, z_max = 1, phi_max = 360;
  bool flip = false;
};

// What the builder needs from the scene. A callback that fails reports that itself and returns a sensible value.
struct LightInputs {
  std::function<Rgb(const SpectrumValue&)> emission;  // of L, I, ...: a spectrum that is not an RGB has luminance 1
  std::function<std::shared_ptr<const LightImage>(const std::string& filename, const SourceLocation&)>
      image;  // or null
};

// The emission that an area light states.
Emission emission_of(const AreaLightDesc& stated, const LightInputs& inputs, Diagnostics& diagnostics);

// Half angles in degrees: where a spot ends, and where its falloff begins; and the form of the falloff.
struct SpotCone {
  float end, edge;
  bool squared = false;  // false: a smooth step
};
// The solid angle of the sphere weighted by the falloff.
float solid_angle(const SpotCone& cone);

class LightSetBuilder {
 public:
  // Returns the light's number. Shapes without area are accepted, too; they are never sampled.
  LightId add(const TriangleShape& shape, const Emission& emission);
  LightId add(const PatchShape& shape, const Emission& emission);
  LightId add(const DiskShape& shape, const Emission& emission);
  LightId add(const SphereShape& shape, const Emission& emission);
  LightId add(const CylinderShape& shape, const Emission& emission);

  // A light that is not a shape. No value if something is wrong, which is then reported as an error.
  std::optional<LightId> add(const LightDesc& light, const LightInputs& inputs, Diagnostics& diagnostics);

  // The same for single kinds. All scales are included.
  LightId add_point(Vec3f p, Rgb intensity);
  LightId add_spot(Vec3f p, Vec3f axis, const SpotCone& cone, Rgb intensity);
  // The image is square and equal-area; null: constant.
  LightId add_goniometric(const Transform& to_world, Rgb intensity, std::shared_ptr<const LightImage> image);
  LightId add_projection(const Transform& to_world, float fov, Rgb factor, std::shared_ptr<const LightImage> image);
  // `toward` points to the light; irradiance at normal incidence.
  LightId add_distant(Vec3f toward, Rgb irradiance);
  LightId add_uniform_infinite(Rgb radiance);
  // The image is square and equal-area.
  LightId add_image_infinite(const Transform& to_world, Rgb factor, std::shared_ptr<const LightImage> image);

  // For lights that make their own rows. `power` is for the choice of a light; `bounds`: none for lights without a
  // place.
  LightId add_row(LightKind kind, const LightRow& row, std::optional<LightBounds> bounds, float power);
  // What a row has of an image, with a table for drawing texels by their mean component, and of a transform.
  std::uint32_t number_of_directions(std::shared_ptr<const LightImage> image);
  std::uint32_t number_of(const Transform& to_world);

  // Infinite lights are assumed to be on the bounding sphere of the scene.
  LightSet build(LightSettings settings, Vec3f scene_centre, float scene_radius) &&;

 private:
  // Sets the group of the lights that follow.
  void begin_group(const std::string& name);
  // What a surface of this area stores, and what the light selection needs of it.
  struct Surface {
    LightRow row;
    LightBounds bounds;
    float power;
  };
  Surface surface(const Emission& emission, float area, bool flip);
  LightId add_quadric(LightKind kind, const Transform& to_world, LightRow own, float own_area, bool flip,
                      const Emission& emission);
  std::uint32_t number_of(std::shared_ptr<const LightImage> image);

  LightTables tables_;
  std::string group_ = "default";
};

}  // namespace montelux
