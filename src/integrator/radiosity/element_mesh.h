// The surfaces of a scene cut into small elements, over each of which irradiance is taken to be constant.
#pragma once
#include <cstdint>
#include <vector>

#include "math/result.h"
#include "scene/scene.h"

namespace montelux {

// A uniform point of an element: as a hit for `surface`, seen by a ray that starts at the point itself.
struct ElementPoint {
  Hit<float> hit;
  Vec3f o;       // where `surface` takes a ray's origin
  float weight;  // mean 1 over the element: how the point's area compares with that of a uniform one
};

// Triangles are cut into n^2 alike; quadrics and patches along their parameters. Elements are numbered through.
class ElementMesh {
 public:
  // Edges of elements are `edge` long at most, world space. Fails where the scene has curves or instances, or where
  // that would make more elements than memory should hold.
  static Result<ElementMesh> cut(const Scene& scene, float edge);

  std::size_t size() const { return size_; }
  // The element that was hit.
  std::uint32_t element_of(const Hit<float>& hit) const;
  // Of the element, as u in [0, 1)^2 says.
  ElementPoint place(std::uint32_t element, Vec2f u) const;

 private:
  // One triangle, quadric or patch.
  struct Primitive {
    std::uint32_t row = 0, index = 0;  // of the geometry, and within it
    std::uint32_t first = 0;           // element
    std::uint32_t nu = 1, nv = 1;      // cells along u and v; the same for a triangle
  };
  explicit ElementMesh(const GeometryStore& store) : store_(&store) {}
  void add_triangles(std::uint32_t row, float edge);
  void add_shape(std::uint32_t row, float edge);
  void append(Primitive primitive, bool is_triangle);
  ElementPoint place_in_triangle(const Primitive& p, std::uint32_t cell, Vec2f u) const;
  ElementPoint place_in_shape(const Primitive& p, std::uint32_t cell, Vec2f u) const;

  const GeometryStore* store_;
  std::vector<Primitive> primitives_;
  std::vector<std::uint32_t> first_primitive_;  // of each row
  std::vector<std::uint32_t> primitive_of_;     // of each element
  std::vector<float> areas_;                    // of the elements of shapes, world space; 0 for triangles
  std::size_t size_ = 0;
};

}  // namespace montelux
