// Shapes of a description -> the flat arrays of GeometryStore, and the lights on them.
#pragma once
#include <functional>
#include <optional>

#include "geometry/bounds.h"
#include "light/builder.h"
#include "math/motion.h"
#include "scene/description.h"
#include "scene/geometry_store.h"

namespace montelux {

// Numbers of the media on the sides of a surface.
struct MediumSides {
  std::uint32_t inside = 0, outside = 0;
};

// What the builder needs to know about a shape's attributes.
struct ShapeInputs {
  // Emission of an area light.
  std::function<Emission(const AreaLightDesc&)> emission;
  // 1 + number of the texture, or 0 for a surface without a mask; none if the surface is fully transparent.
  std::function<std::optional<std::uint32_t>(const ShapeDesc&)> alpha;
  // Whether light passes the material unchanged.
  std::function<bool(MaterialDescId)> is_interface;
  // Whether light sometimes passes it unchanged: a mixture that contains an interface.
  std::function<bool(MaterialDescId)> is_partly_interface;
  // Whether the material uses the surface's parameters: textures, normal maps, a grain.
  std::function<bool(MaterialDescId)> uses_parameters;
  // Where they differ; none on a surface that bounds no medium.
  std::function<std::optional<MediumSides>(const ShapeDesc&)> media;
};

class GeometryBuilder {
 public:
  GeometryBuilder(const ShapeInputs& inputs, LightSetBuilder& lights, Diagnostics& diagnostics)
      : inputs_(inputs), lights_(lights), diagnostics_(diagnostics) {}

  // All shapes of the world must be added before the first object, and must outlive the builder: moving ones are
  // placed last, as separate instances.
  void add_world_shape(const ShapeDesc& shape);
  void add_object(const ObjectDesc& object);
  void add_instance(const InstanceDesc& instance);

  // Ends the building. The box of the world's shapes and of all instances is complete then.
  GeometryStore take();
  Bounds3 bounds() const { return bounds_; }

 private:
  // A motion, and the number of its keys less one.
  struct Placing {
    std::function<Transform(double)> at;
    int steps;
  };
  // An object of the description: its static part, and each shape that moves in it, as objects of the store.
  struct ObjectParts {
    std::uint32_t still;
    std::vector<std::pair<std::uint32_t, Motion>> moving;
  };

  void add_shape(const ShapeDesc& shape, bool in_world);
  std::uint32_t add_store_object(const std::function<void()>& add_shapes);
  std::uint32_t add_object_of(const ShapeDesc& moving);
  void place(std::uint32_t object, const Transform& object_to_world);
  void place_moving(std::uint32_t object, const Placing& placing);
  void add_mesh(const Mesh& mesh, const ShapeDesc& shape, const GeometryRow& row,
                const std::optional<Emission>& emission);
  void add_triangles(const Mesh& world, bool flip, const GeometryRow& like, const std::optional<Emission>& emission);
  void add_later_poses(const Mesh& world, GeometryRow& row);
  void add_patches(const Mesh& world, bool flip, const GeometryRow& like, const std::optional<Emission>& emission);
  void add_single(Shape shape, const GeometryRow& like, const std::optional<Emission>& emission);
  void add_curves(const CurveDesc& stated, const ShapeDesc& shape, const GeometryRow& like);
  void grow(const Bounds3& box) {
    (in_object_ ? object_bounds_.back() : bounds_) = join(in_object_ ? object_bounds_.back() : bounds_, box);
  }

  const ShapeInputs& inputs_;
  LightSetBuilder& lights_;
  Diagnostics& diagnostics_;
  GeometryStore store_;
  Bounds3 bounds_;
  std::vector<Bounds3> object_bounds_;
  std::vector<ObjectParts> objects_;  // of the description
  std::vector<const ShapeDesc*> moving_;
  bool in_object_ = false;
  std::uint32_t next_object_number_ = 1;
};

}  // namespace montelux
