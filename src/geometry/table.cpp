#include "geometry/table.h"

namespace montelux {

namespace {

using enum ParameterType;
using List = std::vector<ParameterSpec>;

constexpr double most = 1e30;
constexpr double positive = 1e-30;

ParameterSpec array(std::string_view name, ParameterType type, const char* meaning, double low = -most) {
  return {name, {type}, meaning, low, most, {}, true};
}
ParameterSpec later(ParameterSpec spec) {
  spec.later = true;
  return spec;
}

// Every shape may have an alpha texture.
List with_alpha(List list) {
  list.push_back({"alpha", {number, texture}, "opacity; default 1", 0, 1});
  return list;
}

std::vector<EntitySpec> meshes() {
  ParameterSpec face_indices = later(array("faceIndices", integer, "face indices, for ptex"));
  return {
      {"trianglemesh", "triangles",
       with_alpha({array("P", point3, "vertices"),
                   array("N", normal, "normals, one per vertex"),
                   later(array("S", vector3, "tangents, one per vertex; computed from uv instead")),
                   array("uv", point2, "texture coordinates, one per vertex"),
                   array("indices", integer, "three per triangle; default 0 1 2", 0),
                   array("P1", point3,
                         "vertices at later times, time by time, evenly spaced to the end "
                         "of TransformTimes (Montelux alone)"),
                   {"onesided",
                    {ParameterType::boolean},
                    "the camera does not see its back, as in glTF; default false (Montelux alone)"},
                   array("N1", normal, "the normals at the same times (Montelux alone)"),
                   face_indices})},
      {"plymesh", "triangles and quadrilaterals of a PLY file",
       with_alpha({{"filename", {string}, "the file"},
                   array("filename1", string,
                         "files with the same vertices at later times, evenly spaced to the end of TransformTimes "
                         "(Montelux alone)"),
                   later({"displacement", {number, texture}, "height of displacement; default none"}),
                   later({"edgelength", {number}, "edge length of displaced triangles; default 1", positive, most})})},
      {"bilinearmesh", "bilinear patches",
       with_alpha({array("P", point3, "vertices"), array("N", normal, "normals, one per vertex"),
                   array("uv", point2, "texture coordinates, one per vertex"),
                   array("indices", integer, "four per patch; default 0 1 2 3", 0), face_indices,
                   later({"emissionfilename", {string}, "image of the emission over the patch"})})},
      {"loopsubdiv", "Loop's subdivision surface",
       with_alpha({array("P", point3, "control vertices"),
                   array("indices", integer, "three per triangle", 0),
                   {"levels", {integer}, "levels of subdivision; default 3", 0, 10},
                   {"scheme", {string}, "default loop", 0, 0, {"loop"}}})},
  };
}

std::vector<EntitySpec> quadrics_and_curves() {
  ParameterSpec sweep{"phimax", {number}, "sweep in degrees; default 360", 1e-3, 360};
  return {
      {"sphere", "a sphere around the origin, or a part of it",
       with_alpha({{"radius", {number}, "default 1", positive, most},
                   {"zmin", {number}, "default -radius"},
                   {"zmax", {number}, "default radius"},
                   sweep})},
      {"disk", "a disk or ring orthogonal to the z axis",
       with_alpha({{"radius", {number}, "default 1", positive, most},
                   {"innerradius", {number}, "default 0", 0, most},
                   {"height", {number}, "its z; default 0"},
                   sweep})},
      {"cylinder", "an open cylinder around the z axis",
       with_alpha({{"radius", {number}, "default 1", positive, most},
                   {"zmin", {number}, "default -1"},
                   {"zmax", {number}, "default 1"},
                   sweep})},
      {"curve", "Bezier or B-spline curves of varying width",
       with_alpha({array("P", point3, "control points"),
                   array("N", normal, "normals of a ribbon"),
                   {"basis", {string}, "default bezier", 0, 0, {"bezier", "bspline"}},
                   {"degree", {integer}, "2 or 3; default 3", 2, 3},
                   {"type", {string}, "default flat", 0, 0, {"flat", "ribbon", "cylinder"}},
                   {"width", {number}, "default 1", 0, most},
                   {"width0", {number}, "at the start; default width", 0, most},
                   {"width1", {number}, "at the end; default width", 0, most},
                   later({"splitdepth", {integer}, "levels of splitting for the kernel; default 3", 0, 20})})},
  };
}

}  // namespace

std::span<const EntitySpec> shape_table() {
  static const std::vector<EntitySpec> table = [] {
    std::vector<EntitySpec> all = meshes(), more = quadrics_and_curves();
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }();
  return table;
}

}  // namespace montelux
