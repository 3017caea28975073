#include "camera/table.h"

namespace montelux {

namespace {

using enum ParameterType;
using List = std::vector<ParameterSpec>;

constexpr double most = 1e30;

List shutter() {
  return {{"shutteropen", {number}, "time at which the shutter opens; default 0"},
          {"shutterclose", {number}, "time at which the shutter closes; default 1"}};
}

List lens(List more) {
  List list{{"frameaspectratio", {number}, "width over height; default that of the film", 1e-6, 1e6},
            {"screenwindow",
             {number},
             "x0 x1 y0 y1 on the screen; default [-1, 1] on the shorter side",
             -most,
             most,
             {},
             true},
            {"fovaxis",
             {string},
             "the axis of the field of view and of the default screen window: the shorter side, or always the height; "
             "default shorter (Montelux alone)",
             0,
             0,
             {"shorter", "y"}},
            {"lensradius", {number}, "radius of the aperture; default 0", 0, most},
            {"focaldistance", {number}, "distance in focus; default 1e6", 1e-30, most},
            {"apertureblades",
             {integer},
             "corners of the aperture, on the circle of lensradius; default 0, a round one (Montelux alone)",
             0,
             64},
            {"aperturerotation",
             {number},
             "rotation of the first corner from the right of the image upward, in degrees; default 0 (Montelux "
             "alone)",
             -most,
             most}};
  for (const List& part : {more, shutter()}) list.insert(list.end(), part.begin(), part.end());
  return list;
}

List with_shutter(List list) {
  for (const ParameterSpec& spec : shutter()) list.push_back(spec);
  return list;
}

}  // namespace

std::span<const EntitySpec> camera_table() {
  static const std::vector<EntitySpec> table{
      {"perspective", "a thin lens or a pinhole",
       lens({{"fov", {number}, "field of view of the shorter side in degrees; default 90", 1e-3, 179.99}})},
      {"orthographic", "parallel projection", lens({})},
      {"spherical", "all directions from one point",
       with_shutter({{"mapping", {string}, "default equalarea", 0, 0, {"equalarea", "equirectangular"}}})},
      {"realistic", "a lens system traced lens by lens",
       with_shutter({{"lensfile", {string}, "description of the lenses"},
                     {"aperturediameter", {number}, "in mm; default 1", 0, most},
                     {"focusdistance", {number}, "in m; default 10", 0, most},
                     {"aperture", {string}, "shape of the aperture or an image of it; default circular"}}),
       true, "perspective"},
  };
  return table;
}

}  // namespace montelux
