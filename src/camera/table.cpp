#include "camera/table.h"

namespace montelux {

namespace {

using S = CameraDesc;

constexpr double unlimited = 1e30;

Fields<S> shutter() {
  Fields<S> fields;
  fields.number("shutteropen", &S::shutter_open, "time at which the shutter opens", -unlimited, unlimited);
  fields.number("shutterclose", &S::shutter_close, "time at which the shutter closes", -unlimited, unlimited);
  return fields;
}

Fields<S> lens() {
  Fields<S> fields;
  fields.optional("frameaspectratio", &S::aspect, "width over height; default that of the film", 1e-6, 1e6);
  fields.list<4>("screenwindow", &S::screen_window, "x0 x1 y0 y1 on the screen; default [-1, 1] on the shorter side",
                 -unlimited, unlimited);
  fields.choice<FovAxis>("fovaxis", &S::fov_axis,
                         "the axis of the field of view and of the default screen window: the shorter side, or always "
                         "the height (Montelux alone)",
                         {{"shorter", FovAxis::shorter}, {"y", FovAxis::y}});
  fields.number("lensradius", &S::lens_radius, "radius of the aperture", 0, unlimited);
  fields.number("focaldistance", &S::focal_distance, "distance in focus", 1e-30, unlimited);
  fields.integer("apertureblades", &S::aperture_blades,
                 "corners of the aperture, on the circle of lensradius; 0: a round one (Montelux alone)", 0, 64);
  fields.number("aperturerotation", &S::aperture_rotation,
                "rotation of the first corner from the right of the image upward, in degrees (Montelux alone)",
                -unlimited, unlimited);
  return fields;
}

S initial(CameraKind kind) {
  S camera;
  camera.kind = kind;
  return camera;
}

Model<S> perspective() {
  Fields<S> fields;
  fields.number("fov", &S::fov, "field of view of the shorter side in degrees", 1e-3, 179.99);
  fields.append(lens()).append(shutter());
  return {name_of(CameraKind::perspective), "a thin lens or a pinhole", initial(CameraKind::perspective), fields};
}

Model<S> orthographic() {
  return {name_of(CameraKind::orthographic), "parallel projection", initial(CameraKind::orthographic),
          lens().append(shutter())};
}

Model<S> spherical() {
  Fields<S> fields;
  fields.choice<SpherePicture>(
      "mapping", &S::mapping, "how directions are laid out on the image",
      {{"equalarea", SpherePicture::equal_area}, {"equirectangular", SpherePicture::equirectangular}});
  return {name_of(CameraKind::spherical), "all directions from one point", initial(CameraKind::spherical),
          fields.append(shutter())};
}

Model<S> realistic() {
  using enum ParameterType;
  Fields<S> fields;
  fields.other({"lensfile", {string}, "description of the lenses"});
  fields.other({"aperturediameter", {number}, "in mm; default 1", 0, unlimited});
  fields.other({"focusdistance", {number}, "in m; default 10", 0, unlimited});
  fields.other({"aperture", {string}, "shape of the aperture or an image of it; default circular"});
  return {"realistic", "a lens system traced lens by lens", initial(CameraKind::perspective), fields.append(shutter()),
          true,        name_of(CameraKind::perspective)};
}

}  // namespace

const Models<CameraDesc>& camera_models() {
  static const Models<S> models({perspective(), orthographic(), spherical(), realistic()});
  return models;
}

}  // namespace montelux
