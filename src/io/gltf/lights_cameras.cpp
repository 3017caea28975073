#include "io/gltf/lights_cameras.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "io/gltf/choice.h"

namespace montelux::gltf {

namespace {

constexpr int longer_side = 1280;

// The size of an image with this aspect ratio.
void state_film(double aspect, SceneDesc& scene) {
  const int width = aspect >= 1 ? longer_side : std::max(int(std::lround(longer_side * aspect)), 1);
  const int height = aspect >= 1 ? std::max(int(std::lround(longer_side / aspect)), 1) : longer_side;
  scene.film.width = width, scene.film.height = height;
}

// A node's matrix without scale and shear: its axes orthogonal, z kept first (glTF 2.0, 3.10: scale is ignored).
Matrix4 rigid(const Matrix4& m) {
  const auto column = [&](std::size_t j) { return std::array<double, 3>{m.m[0][j], m.m[1][j], m.m[2][j]}; };
  const auto dot = [](const auto& a, const auto& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; };
  const auto unit = [&](std::array<double, 3> a) {
    const double length = std::sqrt(dot(a, a));
    for (double& x : a) x = length > 0 ? x / length : 0;
    return a;
  };
  const auto z = unit(column(2));
  auto y = column(1);
  const double along = dot(y, z);
  for (std::size_t i = 0; i < 3; ++i) y[i] -= along * z[i];
  y = unit(y);
  const std::array<double, 3> x{y[1] * z[2] - y[2] * z[1], y[2] * z[0] - y[0] * z[2], y[0] * z[1] - y[1] * z[0]};
  Matrix4 r = m;
  for (std::size_t i = 0; i < 3; ++i) r.m[i][0] = x[i], r.m[i][1] = y[i], r.m[i][2] = z[i];
  return r;
}

Vec3f color_of(const Element& light) {
  const Element color = light["color"];
  const auto c = color.numbers(3);
  if (c && std::any_of(c->begin(), c->end(), [](double x) { return x < 0; })) color.error("must not be negative");
  return c ? Vec3f{float((*c)[0]), float((*c)[1]), float((*c)[2])} : Vec3f{1, 1, 1};
}

SpotLightDesc spot_of(const Element& spot, const SpectrumValue& intensity) {
  constexpr double right_angle = std::numbers::pi / 2, degrees = 180 / std::numbers::pi;
  const double outer = spot["outerConeAngle"].number(1e-4, right_angle + 1e-6).value_or(std::numbers::pi / 4);
  const double inner = spot["innerConeAngle"].number(0, right_angle).value_or(0);
  if (inner > outer) spot.error("innerConeAngle must be less than outerConeAngle");
  SpotLightDesc light;
  light.intensity = intensity, light.to = {0, 0, -1}, light.falloff = SpotFalloff::squared;
  light.cone_angle = float(std::min(outer, right_angle) * degrees);
  light.cone_delta_angle = float(std::max(outer - inner, 0.0) * degrees);
  return light;
}

}  // namespace

std::optional<std::size_t> choose_camera(Document& document, const NodeTree& tree,
                                         const std::optional<std::string>& choice) {
  const Element cameras = document.list("cameras");
  std::optional<std::size_t> first;
  std::vector<std::string> names;
  const std::optional<std::size_t> wanted = choice ? as_number(*choice) : std::nullopt;
  for (std::size_t i : tree.shown) {
    const Node& node = tree.nodes[i];
    if (!node.camera) continue;
    if (!first) first = i;
    for (const std::string& name : {node.name, cameras[*node.camera]["name"].text().value_or("")}) {
      if (choice && !name.empty() && name == *choice) return i;
      names.push_back(name);
    }
    if (wanted == node.camera) return i;
  }
  if (!choice) return first;
  report_no_such(document, "camera", *choice, first ? cameras.size() : 0, names);
  return std::nullopt;
}

// For an orthographic camera the vertical half of the image, ymag, becomes 1 in camera space.
Matrix4 camera_to_world(const Document& document, std::size_t camera, const Matrix4& node_to_world) {
  // The camera looks along its own -z.
  Matrix4 own;
  own.m[2][2] = -1;
  const Element element = document.list("cameras")[camera];
  if (element["type"].text().value_or("") == "orthographic") {
    const double half = std::abs(element["orthographic"]["ymag"].number().value_or(1));
    if (half > 0) own.m[0][0] = own.m[1][1] = half;
  }
  return rigid(node_to_world) * own;
}

void state_camera(Document& document, std::size_t camera, const Matrix4& node_to_world, SceneDesc& scene) {
  const Element element = document.list("cameras")[camera];
  const auto type = element.required("type").choice({"perspective", "orthographic"});
  CameraDesc stated;
  stated.where = element.where();
  double aspect = 16.0 / 9;
  if (type == "perspective") {
    const Element perspective = element.required("perspective");
    const auto yfov = perspective.required("yfov").number(1e-4, std::numbers::pi - 1e-4);
    stated.fov = float(yfov.value_or(1) * 180 / std::numbers::pi);
    aspect = perspective["aspectRatio"].number(1e-3, 1e3).value_or(aspect);
  } else if (type == "orthographic") {
    stated.kind = CameraKind::orthographic;
    const Element orthographic = element.required("orthographic");
    const double x = std::abs(orthographic.required("xmag").number().value_or(1));
    const double y = std::abs(orthographic.required("ymag").number().value_or(1));
    if (!(x > 0) || !(y > 0)) orthographic.error("xmag and ymag must not be zero");
    aspect = x > 0 && y > 0 ? std::clamp(x / y, 1e-3, 1e3) : 1;
  }
  stated.fov_axis = FovAxis::y;
  state_film(aspect, scene);
  scene.camera = stated;
  if (const auto placed = from_matrix(camera_to_world(document, camera, node_to_world)))
    scene.world_to_camera = placed->inverted();
  else
    element.error("the node of the camera leaves it no direction");
}

void state_default_camera(const Bounds3& box, SceneDesc& scene) {
  constexpr double fov = 40;
  std::array<double, 3> centre{}, eye{};
  double radius = 1;
  if (!box.is_empty()) {
    centre = {0.5 * (double(box.low.x) + double(box.high.x)), 0.5 * (double(box.low.y) + double(box.high.y)),
              0.5 * (double(box.low.z) + double(box.high.z))};
    radius = std::max(0.5 * double(length(box.high - box.low)), 1e-6);
  }
  const double distance = radius / std::sin(fov * std::numbers::pi / 360);
  const std::array<double, 3> way{0.4, 0.35, 0.85};
  const double length = std::sqrt(way[0] * way[0] + way[1] * way[1] + way[2] * way[2]);
  for (std::size_t i = 0; i < 3; ++i) eye[i] = centre[i] + way[i] / length * distance;
  // look_at() assumes a left-handed world: seen from there, x points to the left.
  if (const auto look = look_at(eye, centre, {0, 1, 0})) scene.world_to_camera = scale(-1, 1, 1) * *look;
  scene.camera = {};
  scene.camera.fov = float(fov);
}

std::optional<LightDesc> light_of(Document& document, std::size_t light, const Matrix4& node_to_world) {
  const Element element = document.root()["extensions"]["KHR_lights_punctual"]["lights"][light];
  const auto type = element.required("type").choice({"directional", "point", "spot"});
  const double intensity = element["intensity"].number(0, 1e30).value_or(1);
  const Vec3f c = color_of(element);
  if (!type) return std::nullopt;
  const SpectrumValue emission = RgbValue{Rgb{{c.x, c.y, c.z}} * float(intensity)};
  LightDesc desc;
  desc.where = element.where();
  // Lights emit along their own -z.
  if (*type == "directional")
    desc.model = DistantLightDesc{emission, {0, 0, 0}, {0, 0, -1}};
  else if (*type == "spot")
    desc.model = spot_of(element["spot"], emission);
  else
    desc.model = PointLightDesc{emission};
  if (const auto placed = from_matrix(rigid(node_to_world))) {
    desc.light_to_world = *placed;
    return desc;
  }
  element.warning("the node of the light leaves it no direction: it is omitted");
  return std::nullopt;
}

std::optional<LightDesc> environment_of(Document& document, const Element& scene) {
  const Element extras = scene["extras"];
  // Extras may contain anything.
  if (!extras.is_object() || !extras["environment"].is_text()) return std::nullopt;
  const auto link = document.link(extras["environment"]);
  if (!link) return std::nullopt;
  if (link->data || !is_regular_file(resolve_path(document.folder(), link->file))) {
    extras["environment"].error("there is no file '" + printable(link->file) + "'");
    return std::nullopt;
  }
  InfiniteLightDesc sphere;
  sphere.file = link->file, sphere.mapping = EnvironmentMapping::latlong;
  LightDesc desc;
  desc.model = std::move(sphere), desc.where = extras["environment"].where();
  // The pole of the image, its own +z, is +y of the world; its azimuth goes from +x towards +z.
  Matrix4 m;
  m.m = {{{1, 0, 0, 0}, {0, 0, 1, 0}, {0, 1, 0, 0}, {0, 0, 0, 1}}};
  desc.light_to_world = *from_matrix(m);
  return desc;
}

}  // namespace montelux::gltf
