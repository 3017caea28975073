#include "integrator/radiosity/element_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "geometry/quadrature.h"
#include "mc/triangle.h"

namespace montelux {

namespace {

constexpr std::size_t max_elements = std::size_t(1) << 24;

std::uint32_t parts(float length, float edge) {
  return std::uint32_t(std::clamp(std::ceil(double(length) / double(edge)), 1.0, 4096.0));
}

// Area of the surface per area of its parameters, by central differences.
float stretch(const Shape& shape, Vec2f uv) {
  constexpr float h = 1e-3f;
  const auto at = [&](float du, float dv) {
    return surface_point(shape, {std::clamp(uv.x + du, 0.0f, 1.0f), std::clamp(uv.y + dv, 0.0f, 1.0f)}).p;
  };
  const float across = std::min(uv.x + h, 1.0f) - std::max(uv.x - h, 0.0f);
  const float along = std::min(uv.y + h, 1.0f) - std::max(uv.y - h, 0.0f);
  return length(cross((at(h, 0) - at(-h, 0)) * (1 / across), (at(0, h) - at(0, -h)) * (1 / along)));
}

// Length of the longest of a few lines along one parameter.
float longest_line(const Shape& shape, bool along_u) {
  constexpr int lines = 5, steps = 16;
  float longest = 0;
  for (int line = 0; line < lines; ++line) {
    const float fixed = float(line) / (lines - 1);
    float sum = 0;
    Vec3f last{};
    for (int step = 0; step <= steps; ++step) {
      const float t = float(step) / steps;
      const Vec3f p = surface_point(shape, along_u ? Vec2f{t, fixed} : Vec2f{fixed, t}).p;
      if (step > 0) sum += length(p - last);
      last = p;
    }
    longest = std::max(longest, sum);
  }
  return longest;
}

}  // namespace

Result<ElementMesh> ElementMesh::cut(const Scene& scene, float edge) {
  const GeometryStore& store = scene.geometry;
  if (!store.instances.empty())
    return Failure{"radiosity divides every surface into elements and does not support object instances"};
  ElementMesh mesh(store);
  for (std::uint32_t row = 0; row < store.rows.size(); ++row) {
    mesh.first_primitive_.push_back(std::uint32_t(mesh.primitives_.size()));
    if (store.rows[row].kind == GeometryKind::curves)
      return Failure{"radiosity supports triangle meshes, quadrics and bilinear patches, but no curves"};
    if (store.rows[row].kind == GeometryKind::triangles)
      mesh.add_triangles(row, edge);
    else
      mesh.add_shape(row, edge);
    if (mesh.size_ > max_elements)
      return Failure{
          fmt::format("elements of edge {:.3g} exceed the maximum of {}: choose a larger edge", edge, max_elements)};
  }
  return mesh;
}

void ElementMesh::append(Primitive primitive, bool is_triangle) {
  const std::uint32_t cells = primitive.nu * primitive.nv;
  primitive.first = std::uint32_t(size_);
  size_ += cells;
  if (size_ > max_elements) return;
  primitive_of_.insert(primitive_of_.end(), cells, std::uint32_t(primitives_.size()));
  if (is_triangle) areas_.insert(areas_.end(), cells, 0.0f);
  primitives_.push_back(primitive);
}

void ElementMesh::add_triangles(std::uint32_t row, float edge) {
  const GeometryRow& r = store_->rows[row];
  for (std::uint32_t i = 0; i < r.count; ++i) {
    const auto corner = [&](std::size_t k) { return store_->vertices[store_->triangles[r.first + i][k % 3]].position; };
    float longest = 0;
    for (std::size_t k = 0; k < 3; ++k) longest = std::max(longest, length(corner(k + 1) - corner(k)));
    const std::uint32_t n = parts(longest, edge);
    append({row, i, 0, n, n}, true);
  }
}

void ElementMesh::add_shape(std::uint32_t row, float edge) {
  const Shape& shape = store_->shapes[store_->rows[row].first];
  const Primitive p{row, 0, 0, parts(longest_line(shape, true), edge), parts(longest_line(shape, false), edge)};
  append(p, false);
  if (size_ > max_elements) return;
  const double du = 1 / double(p.nu), dv = 1 / double(p.nv);
  for (std::uint32_t cell = 0; cell < p.nu * p.nv; ++cell) {
    const double u = du * double(cell % p.nu), v = dv * double(cell / p.nu);
    areas_.push_back(float(integrate_panels(u, u + du, 1, [&](double x) {
      return integrate_panels(v, v + dv, 1, [&](double y) { return double(stretch(shape, {float(x), float(y)})); });
    })));
  }
}

std::uint32_t ElementMesh::element_of(const Hit<float>& hit) const {
  const Primitive& p = primitives_[first_primitive_[hit.geometry] + hit.primitive];
  const auto cell = [](float x, std::uint32_t n) {
    return std::min(std::uint32_t(std::max(x, 0.0f) * float(n)), n - 1);
  };
  if (store_->rows[p.row].kind == GeometryKind::shape) return p.first + cell(hit.v, p.nv) * p.nu + cell(hit.u, p.nu);
  // Row j along v holds the n - j triangles that stand on an edge, each followed by the one upside down beside it.
  const std::uint32_t n = p.nu, j = cell(hit.v, n), i = std::min(cell(hit.u, n), n - 1 - j);
  const float x = hit.u * float(n) - float(i), y = hit.v * float(n) - float(j);
  const bool upside_down = x + y > 1 && i + j + 1 < n;
  return p.first + j * (2 * n - j) + 2 * i + (upside_down ? 1 : 0);
}

ElementPoint ElementMesh::place(std::uint32_t element, Vec2f u) const {
  const Primitive& p = primitives_[primitive_of_[element]];
  const std::uint32_t cell = element - p.first;
  return store_->rows[p.row].kind == GeometryKind::shape ? place_in_shape(p, cell, u) : place_in_triangle(p, cell, u);
}

ElementPoint ElementMesh::place_in_triangle(const Primitive& p, std::uint32_t cell, Vec2f u) const {
  const std::uint32_t n = p.nu;
  std::uint32_t j = 0;
  while (cell >= (j + 1) * (2 * n - j - 1)) ++j;
  const std::uint32_t within = cell - j * (2 * n - j);
  Vec2f b = sample_triangle(u);
  if (within % 2 == 1) b = {1 - b.x, 1 - b.y};
  const float scale = 1 / float(n);
  return {{0, (float(within / 2) + b.x) * scale, (float(j) + b.y) * scale, p.row, p.index, 0}, {0, 0, 0}, 1};
}

ElementPoint ElementMesh::place_in_shape(const Primitive& p, std::uint32_t cell, Vec2f u) const {
  const Shape& shape = store_->shapes[store_->rows[p.row].first];
  const Vec2f uv{(float(cell % p.nu) + u.x) / float(p.nu), (float(cell / p.nu) + u.y) / float(p.nv)};
  const float cell_area = areas_[p.first + cell];
  const float weight = cell_area > 0 ? stretch(shape, uv) / (float(p.nu) * float(p.nv) * cell_area) : 0;
  return {{0, uv.x, uv.y, p.row, 0, 0}, surface_point(shape, uv).p, weight};
}

}  // namespace montelux
