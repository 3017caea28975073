// Parameters that depend on each other.
#include <algorithm>
#include <cstdint>

#include "camera/description.h"
#include "io/checks.h"
#include "io/numbers.h"
#include "io/text_file.h"
#include "light/point.h"
#include "scene/description.h"
#include "scene/picture.h"

namespace montelux {

namespace {

SourceLocation place_of(const Entity& entity, std::string_view parameter) {
  const Parameter* p = entity.parameters.find(parameter);
  return p ? p->where : entity.where;
}

// Checks that a parameter, if given, has `count` values of T.
template <class T>
const std::vector<T>* counted(const Entity& entity, std::string_view name, std::size_t count, Reporter& report) {
  const Parameter* p = entity.parameters.find(name);
  if (!p) return nullptr;
  const std::vector<T>& values = entity.parameters.array<T>(name);
  if (values.size() == count) return &values;
  report.error(p->where, "'" + std::string(name) + "' takes " + std::to_string(count) + " values; there are " +
                             std::to_string(values.size()));
  return nullptr;
}

template <class T>
void check_window(const Entity& entity, std::string_view name, Reporter& report) {
  const std::vector<T>* window = counted<T>(entity, name, 4, report);
  if (window && !((*window)[0] < (*window)[1] && (*window)[2] < (*window)[3]))
    report.error(place_of(entity, name),
                 "'" + std::string(name) + "' is empty: it takes x0 x1 y0 y1 with x0 < x1 and y0 < y1");
}

void check_film(const Entity& film, Reporter& report) {
  const FilmDesc defaults;
  std::int64_t x = film.parameters.integer("xresolution", defaults.width);
  std::int64_t y = film.parameters.integer("yresolution", defaults.height);
  // A side that is out of its own range was reported there.
  if (std::string complaint = size_complaint(x, y); !complaint.empty() && std::max(x, y) <= max_picture_side)
    report.error(place_of(film, "xresolution"), complaint);
  check_window<float>(film, "cropwindow", report);
  check_window<int>(film, "pixelbounds", report);
  if (const auto* bounds = film.parameters.find("pixelbounds") ? &film.parameters.array<int>("pixelbounds") : nullptr)
    if (bounds->size() == 4 && ((*bounds)[1] > x || (*bounds)[3] > y))
      report.error(place_of(film, "pixelbounds"), "'pixelbounds' reaches beyond the film of " + std::to_string(x) +
                                                      " x " + std::to_string(y) + " pixels");
}

void check_camera(const Entity& camera, Reporter& report) {
  check_window<float>(camera, "screenwindow", report);
  const CameraDesc defaults;
  float open = camera.parameters.number("shutteropen", defaults.shutter_open);
  float close = camera.parameters.number("shutterclose", defaults.shutter_close);
  if (open > close) report.error(place_of(camera, "shutterclose"), "the shutter closes before it opens");
  if (open == close)
    report.error(place_of(camera, "shutterclose"), "the shutter closes when it opens, so every image is black");
}

void check_material(const Entity& material, Reporter& report) {
  const ParameterList& p = material.parameters;
  if (material.type == "mix") {
    if (!p.find("materials"))
      report.error(material.where, "material 'mix' needs 'materials', the names of two materials");
    else
      counted<std::string>(material, "materials", 2, report);
  }
  if (material.type == "measured" && !p.find("filename"))
    report.error(material.where, "material 'measured' needs 'filename', its table");
  for (std::string_view name : {"normalscale", "coatnormalscale"}) counted<float>(material, name, 2, report);
  bool is_conductor = material.type == "conductor" || material.type == "coatedconductor";
  if (!is_conductor || !p.find("reflectance")) return;
  for (std::string_view name : {"eta", "k", "conductor.eta", "conductor.k"})
    if (const Parameter* stated = p.find(name))
      report.error(stated->where, "'reflectance' and '" + std::string(name) + "' exclude each other");
}

void check_light(const Entity& light, Reporter& report) {
  const ParameterList& p = light.parameters;
  const SpotLightDesc spot;  // a distant light has the same default points
  if (light.type == "spot" || light.type == "distant") {
    Vec3f from = p.vec3("from", spot.from), to = p.vec3("to", spot.to);
    if (from.x == to.x && from.y == to.y && from.z == to.z)
      report.error(place_of(light, "to"), "'from' and 'to' of a " + light.type + " light are the same point");
  }
  if (light.type == "spot" &&
      p.number("conedeltaangle", spot.cone_delta_angle) > p.number("coneangle", spot.cone_angle))
    report.error(place_of(light, p.find("conedeltaangle") ? "conedeltaangle" : "coneangle"),
                 "'conedeltaangle' is wider than 'coneangle'");
  if (light.type == "projection" && !p.find("filename"))
    report.error(light.where, "light 'projection' needs 'filename', the slide");
  if (light.type == "infinite") {
    counted<Vec3f>(light, "portal", 4, report);
    if (p.find("filename") && p.find("L"))
      report.error(place_of(light, "L"), "'L' and 'filename' of an infinite light exclude each other");
  }
}

void check_curve(const Entity& curve, Reporter& report) {
  std::size_t points = curve.parameters.array<Vec3f>("P").size();
  std::size_t degree = static_cast<std::size_t>(curve.parameters.integer("degree", CurveDesc{}.degree));
  bool bspline = curve.parameters.string("basis", "bezier") == "bspline";
  if (points == 0) {
    report.error(curve.where, "shape 'curve' needs 'P', its control points");
    return;
  }
  bool good = points > degree && (bspline || (points - 1) % degree == 0);
  if (!good)
    report.error(place_of(curve, "P"), "a " + std::string(bspline ? "B-spline" : "Bezier") + " curve of degree " +
                                           std::to_string(degree) + " cannot have " + std::to_string(points) +
                                           " control points");
  bool ribbon = curve.parameters.string("type", "flat") == "ribbon";
  std::size_t normals = curve.parameters.array<Vec3f>("N").size();
  std::size_t segments = bspline ? points - std::min(points, degree) : (points - 1) / degree;
  if (good && ribbon && normals != segments + 1)
    report.error(place_of(curve, "N"), "a ribbon of " + std::to_string(segments) + " segments takes " +
                                           std::to_string(segments + 1) + " normals; found " + std::to_string(normals));
}

void check_shape(const Entity& shape, Reporter& report) {
  const ParameterList& p = shape.parameters;
  if (shape.type == "curve") check_curve(shape, report);
  if (shape.type == "plymesh" && !p.find("filename")) report.error(shape.where, "shape 'plymesh' needs 'filename'");
  if (shape.type == "disk" && p.number("innerradius", DiskForm{}.inner_radius) >= p.number("radius", DiskForm{}.radius))
    report.error(place_of(shape, "innerradius"), "'innerradius' must be smaller than 'radius'");
  bool is_sphere = shape.type == "sphere", is_cylinder = shape.type == "cylinder";
  if (!is_sphere && !is_cylinder) return;
  const float radius = p.number("radius", SphereForm{}.radius);
  const CylinderForm cylinder;
  float low = p.number("zmin", is_sphere ? -radius : cylinder.z_min);
  float high = p.number("zmax", is_sphere ? radius : cylinder.z_max);
  if (low == high)
    report.error(place_of(shape, "zmax"), "'zmin' and 'zmax' are equal: nothing is left of the " + shape.type);
  if (is_sphere && (std::min(low, high) >= radius || std::max(low, high) <= -radius))
    report.error(place_of(shape, "zmin"), "nothing is left of the sphere between 'zmin' and 'zmax'");
}

void check_texture(const Entity& tex, const CheckContext& context) {
  const ParameterList& p = tex.parameters;
  Reporter& report = context.report;
  counted<float>(tex, "uvmatrix", 6, report);
  if (tex.type == "imagemap") {
    if (!p.find("filename")) report.error(tex.where, "texture 'imagemap' needs 'filename'");
    const bool is_spectrum = context.kind == TextureKind::spectrum;
    if (const Parameter* other = p.find(is_spectrum ? "channel" : "tint"))
      report.warning(other->where, "'" + other->name + "' of texture 'imagemap' has no effect here: it is for " +
                                       (is_spectrum ? "numbers" : "spectra"));
  }
  const Parameter* encoding = p.find("encoding");
  if (!encoding) return;
  std::string value = p.string("encoding", "");
  auto exponent = value.starts_with("gamma ") ? to_float(std::string_view(value).substr(6)) : std::nullopt;
  bool good = value == "sRGB" || value == "linear" || (exponent && *exponent > 0);
  if (!good)
    report.error(encoding->where, "'" + printable(value) + "' is not an encoding",
                 "valid: sRGB, linear, gamma 2.2 (or another exponent)");
}

// Files that are read must exist.
void check_files(const Entity& entity, const CheckContext& context) {
  for (std::string_view name : {"filename", "filename1", "normalmap", "lensfile", "emissionfilename"}) {
    const Parameter* p = entity.parameters.find(name);
    if (!p) continue;
    for (const std::string& file : entity.parameters.array<std::string>(name)) {
      if (file.empty())
        context.report.error(p->where, "'" + std::string(name) + "' is empty");
      else if (const std::string path = resolve_path(context.folder, file); !is_regular_file(path))
        context.report.error(p->where, "there is no file '" + printable(file) + "'",
                             path == file ? "" : "its path is '" + printable(path) + "'");
    }
  }
}

}  // namespace

void check_entity(Family family, const Entity& entity, const CheckContext& context) {
  switch (family) {
    case Family::film:
      // Its file is an output file.
      return check_film(entity, context.report);
    case Family::camera:
      check_camera(entity, context.report);
      break;
    case Family::material:
      check_material(entity, context.report);
      break;
    case Family::light:
      check_light(entity, context.report);
      break;
    case Family::shape:
      check_shape(entity, context.report);
      break;
    case Family::texture:
      check_texture(entity, context);
      break;
    case Family::option:
      return;
    default:
      break;
  }
  check_files(entity, context);
}

}  // namespace montelux
