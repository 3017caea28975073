#include "filter/filter.h"

namespace montelux {

namespace {

// The stated radii, or the default of the filter. Positive.
Vec2f radii(const ParameterList& parameters, float usual) {
  auto positive = [&](const char* name) {
    float radius = parameters.number(name, usual);
    return radius > 0 ? radius : usual;
  };
  return {positive("xradius"), positive("yradius")};
}

}  // namespace

Filter::Filter() : filter_(GaussianFilter(GaussianProfile{}, GaussianProfile{})) {}

Filter Filter::build(const Entity& entity) {
  const ParameterList& p = entity.parameters;
  if (entity.type == "box") return Filter(BoxFilter{radii(p, 0.5f)});
  if (entity.type == "triangle") return Filter(TriangleFilter{radii(p, 2.0f)});
  if (entity.type == "mitchell") {
    Vec2f radius = radii(p, 2.0f);
    float b = p.number("B", 1.0f / 3.0f), c = p.number("C", 1.0f / 3.0f);
    return Filter(MitchellFilter(MitchellProfile{radius.x, b, c}, MitchellProfile{radius.y, b, c}));
  }
  if (entity.type == "sinc") {
    Vec2f radius = radii(p, 4.0f);
    float tau = p.number("tau", 3.0f);
    return Filter(SincFilter(SincProfile{radius.x, tau}, SincProfile{radius.y, tau}));
  }
  Vec2f radius = radii(p, 1.5f);
  float sigma = p.number("sigma", 0.5f);
  return Filter(GaussianFilter(GaussianProfile{radius.x, sigma}, GaussianProfile{radius.y, sigma}));
}

}  // namespace montelux
