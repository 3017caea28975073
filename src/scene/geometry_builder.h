// Shapes of a description -> the flat arrays of GeometryStore, and the lights on them.
#pragma once
#include <functional>
#include <optional>

#include "geometry/bounds.h"
#include "light/builder.h"
#include "scene/description.h"
#include "scene/geometry_store.h"

namespace montelux {

// What the builder asks about a shape's surroundings.
struct ShapeInputs {
  // Emission of an area light.
  std::function<Emission(const Entity& area_light)> emission;
  // 1 + number of the texture, or 0 for a surface without a mask; none where the surface is nowhere there.
  std::function<std::optional<std::uint32_t>(const Entity& shape)> alpha;
  // Whether light passes the material unchanged.
  std::function<bool(MaterialDescId)> is_interface;
  // Whether the material looks at the surface's parameters: textures, normal maps, a grain.
  std::function<bool(MaterialDescId)> uses_parameters;
};

class GeometryBuilder {
 public:
  GeometryBuilder(const ShapeInputs& inputs, LightSetBuilder& lights, Diagnostics& diagnostics)
      : inputs_(inputs), lights_(lights), diagnostics_(diagnostics) {}

  // Shapes of the world must all be added before the first object.
  void add_world_shape(const ShapeDesc& shape) { add_shape(shape, true); }
  void add_object(const ObjectDesc& object);
  void add_instance(const InstanceDesc& instance);

  // Box of the world's shapes and of all instances.
  Bounds3 bounds() const { return bounds_; }
  GeometryStore take() &&;

 private:
  void add_shape(const ShapeDesc& shape, bool in_world);
  void add_mesh(const Mesh& mesh, const ShapeDesc& shape, const GeometryRow& row,
                const std::optional<Emission>& emission);
  void add_triangles(const Mesh& world, bool flip, GeometryRow row, const std::optional<Emission>& emission);
  void add_patches(const Mesh& world, bool flip, GeometryRow row, const std::optional<Emission>& emission);
  void add_single(Shape shape, GeometryRow row, const std::optional<Emission>& emission);
  void add_curves(const ShapeDesc& shape, GeometryRow row);
  void grow(const Bounds3& box) {
    (in_object_ ? object_bounds_.back() : bounds_) = join(in_object_ ? object_bounds_.back() : bounds_, box);
  }

  const ShapeInputs& inputs_;
  LightSetBuilder& lights_;
  Diagnostics& diagnostics_;
  GeometryStore store_;
  Bounds3 bounds_;
  std::vector<Bounds3> object_bounds_;
  bool in_object_ = false;
  std::uint32_t next_object_number_ = 1;
};

}  // namespace montelux
