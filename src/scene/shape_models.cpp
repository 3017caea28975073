#include "scene/shape_models.h"

namespace montelux {

namespace {

using enum ParameterType;
using S = ShapeDesc;

constexpr double unlimited = 1e30;
constexpr double positive = 1e-30;

// The member of a form.
template <class Form, class T>
Fields<S>::Place<T> of(T Form::*member) {
  return [member](S& shape) -> T& { return std::get<Form>(shape.form).*member; };
}

// A parameter that the readers take or that has no effect yet.
ParameterSpec array(std::string_view name, ParameterType type, const char* meaning, double low = -unlimited) {
  return {name, {type}, meaning, low, unlimited, {}, true};
}
ParameterSpec later(ParameterSpec spec) {
  spec.later = true;
  return spec;
}

Model<S> model(std::string_view name, std::string_view meaning, ShapeForm form, Fields<S> fields) {
  fields.optional_input<NumberInput>("alpha", &S::alpha, "opacity; default 1", 0, 1);
  return {name, meaning, {std::move(form)}, std::move(fields)};
}

Model<S> triangles() {
  Fields<S> fields;
  fields.other(array("P", point3, "vertices"));
  fields.other(array("N", normal, "normals, one per vertex"));
  fields.other(later(array("S", vector3, "tangents, one per vertex; computed from uv instead")));
  fields.other(array("uv", point2, "texture coordinates, one per vertex"));
  fields.other(array("indices", integer, "three per triangle; default 0 1 2", 0));
  fields.other(array("P1", point3,
                     "vertices at later times, time by time, evenly spaced to the end of TransformTimes (Montelux "
                     "alone)"));
  fields.flag("onesided", &S::one_sided, "the camera does not see its back, as in glTF (Montelux alone)");
  fields.other(array("N1", normal, "the normals at the same times (Montelux alone)"));
  fields.other(later(array("faceIndices", integer, "face indices, for ptex")));
  return model("trianglemesh", "triangles", MeshForm{}, fields);
}

Model<S> ply() {
  Fields<S> fields;
  fields.words("filename", of(&MeshForm::file), "the file");
  fields.list<std::string>("filename1", string, of(&MeshForm::later_files),
                           "files with the same vertices at later times, evenly spaced to the end of TransformTimes "
                           "(Montelux alone)");
  fields.other(later({"displacement", {number, texture}, "height of displacement; default none"}));
  fields.other(later({"edgelength", {number}, "edge length of displaced triangles; default 1", positive, unlimited}));
  return model("plymesh", "triangles and quadrilaterals of a PLY file", MeshForm{}, fields);
}

Model<S> patches() {
  Fields<S> fields;
  fields.other(array("P", point3, "vertices"));
  fields.other(array("N", normal, "normals, one per vertex"));
  fields.other(array("uv", point2, "texture coordinates, one per vertex"));
  fields.other(array("indices", integer, "four per patch; default 0 1 2 3", 0));
  fields.other(later(array("faceIndices", integer, "face indices, for ptex")));
  fields.other(later({"emissionfilename", {string}, "image of the emission over the patch"}));
  return model("bilinearmesh", "bilinear patches", MeshForm{}, fields);
}

Model<S> subdivision() {
  Fields<S> fields;
  fields.other(array("P", point3, "control vertices"));
  fields.other(array("indices", integer, "three per triangle", 0));
  fields.integer("levels", of(&SubdivisionForm::levels), "levels of subdivision", 0, 10);
  fields.other({"scheme", {string}, "default loop", 0, 0, {"loop"}});
  return model("loopsubdiv", "Loop's subdivision surface", SubdivisionForm{}, fields);
}

template <class Form>
Fields<S>& sweep(Fields<S>& fields) {
  return fields.number("phimax", of(&Form::phi_max), "sweep in degrees", 1e-3, 360);
}

Model<S> sphere() {
  Fields<S> fields;
  fields.number("radius", of(&SphereForm::radius), "of the whole sphere", positive, unlimited);
  fields.optional("zmin", of(&SphereForm::z_min), "default -radius", -unlimited, unlimited);
  fields.optional("zmax", of(&SphereForm::z_max), "default radius", -unlimited, unlimited);
  return model("sphere", "a sphere around the origin, or a part of it", SphereForm{}, sweep<SphereForm>(fields));
}

Model<S> disk() {
  Fields<S> fields;
  fields.number("radius", of(&DiskForm::radius), "of its rim", positive, unlimited);
  fields.number("innerradius", of(&DiskForm::inner_radius), "of its hole", 0, unlimited);
  fields.number("height", of(&DiskForm::height), "its z", -unlimited, unlimited);
  return model("disk", "a disk or ring orthogonal to the z axis", DiskForm{}, sweep<DiskForm>(fields));
}

Model<S> cylinder() {
  Fields<S> fields;
  fields.number("radius", of(&CylinderForm::radius), "of the cylinder", positive, unlimited);
  fields.number("zmin", of(&CylinderForm::z_min), "its lower end", -unlimited, unlimited);
  fields.number("zmax", of(&CylinderForm::z_max), "its upper end", -unlimited, unlimited);
  return model("cylinder", "an open cylinder around the z axis", CylinderForm{}, sweep<CylinderForm>(fields));
}

Model<S> curve() {
  Fields<S> fields;
  fields.list<Vec3f>("P", point3, of(&CurveDesc::points), "control points");
  fields.list<Vec3f>("N", normal, of(&CurveDesc::normals), "normals of a ribbon");
  fields.choice<CurveBasis>("basis", of(&CurveDesc::basis), "what the control points are of",
                            {{"bezier", CurveBasis::bezier}, {"bspline", CurveBasis::bspline}});
  fields.integer("degree", of(&CurveDesc::degree), "2 or 3", 2, 3);
  fields.choice<CurveType>(
      "type", of(&CurveDesc::type), "what is swept along the curve",
      {{"flat", CurveType::flat}, {"ribbon", CurveType::ribbon}, {"cylinder", CurveType::cylinder}});
  fields.common({"width", {number}, "at both ends; default 1", 0, unlimited}, [](float width, S& shape) {
    CurveDesc& c = std::get<CurveDesc>(shape.form);
    c.width0 = c.width1 = width;
  });
  fields.number("width0", of(&CurveDesc::width0), "at the start, instead of width", 0, unlimited);
  fields.number("width1", of(&CurveDesc::width1), "at the end, instead of width", 0, unlimited);
  fields.other(later({"splitdepth", {integer}, "levels of splitting for the kernel; default 3", 0, 20}));
  return model("curve", "Bezier or B-spline curves of varying width", CurveDesc{}, fields);
}

}  // namespace

const Models<ShapeDesc>& shape_models() {
  static const Models<S> models({triangles(), ply(), patches(), subdivision(), sphere(), disk(), cylinder(), curve()});
  return models;
}

bool is_mesh(std::string_view name) {
  return name == "trianglemesh" || name == "plymesh" || name == "bilinearmesh" || name == "loopsubdiv";
}

void set_mesh(ShapeDesc& shape, std::shared_ptr<const Mesh> mesh) {
  if (auto* form = std::get_if<MeshForm>(&shape.form)) form->mesh = std::move(mesh);
  if (auto* surface = std::get_if<SubdivisionForm>(&shape.form)) surface->control = std::move(mesh);
}

std::string_view name_of(const ShapeForm& form) {
  struct Name {
    std::string_view operator()(const MeshForm& f) const {
      if (!f.file.empty()) return "plymesh";
      return f.mesh && !f.mesh->quads.empty() ? "bilinearmesh" : "trianglemesh";
    }
    std::string_view operator()(const SubdivisionForm&) const { return "loopsubdiv"; }
    std::string_view operator()(const SphereForm&) const { return "sphere"; }
    std::string_view operator()(const DiskForm&) const { return "disk"; }
    std::string_view operator()(const CylinderForm&) const { return "cylinder"; }
    std::string_view operator()(const CurveDesc&) const { return "curve"; }
  };
  return std::visit(Name{}, form);
}

}  // namespace montelux
