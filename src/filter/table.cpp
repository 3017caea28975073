#include "filter/table.h"

namespace montelux {

namespace {

using S = FilterDesc;

Model<S> model(FilterKind kind, std::string_view meaning) {
  Fields<S> fields;
  fields.number("xradius", &S::x_radius, "half the width in pixels", 1e-3, 64);
  fields.number("yradius", &S::y_radius, "half the height in pixels", 1e-3, 64);
  if (kind == FilterKind::gaussian) fields.number("sigma", &S::sigma, "standard deviation in pixels", 1e-3, 1e3);
  if (kind == FilterKind::mitchell) {
    fields.number("B", &S::b, "first parameter of the cubic", -1e3, 1e3);
    fields.number("C", &S::c, "second parameter of the cubic", -1e3, 1e3);
  }
  if (kind == FilterKind::sinc) fields.number("tau", &S::tau, "cycles of the window", 1e-3, 1e3);
  return {name_of(kind), meaning, FilterDesc::usual(kind), fields};
}

}  // namespace

const Models<FilterDesc>& filter_models() {
  static const Models<S> models({model(FilterKind::box, "the mean of the pixel"),
                                 model(FilterKind::gaussian, "a Gaussian that falls to zero at the radius"),
                                 model(FilterKind::mitchell, "Mitchell and Netravali's cubic"),
                                 model(FilterKind::sinc, "a Lanczos-windowed sinc"),
                                 model(FilterKind::triangle, "a tent")});
  return models;
}

}  // namespace montelux
