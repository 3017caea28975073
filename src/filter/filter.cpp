#include "filter/filter.h"

namespace montelux {

Filter::Filter() : filter_(GaussianFilter(GaussianProfile{}, GaussianProfile{})) {}

Filter Filter::build(const FilterDesc& stated) {
  const FilterDesc usual = FilterDesc::usual(stated.kind);
  const Vec2f radius{stated.x_radius > 0 ? stated.x_radius : usual.x_radius,
                     stated.y_radius > 0 ? stated.y_radius : usual.y_radius};
  switch (stated.kind) {
    case FilterKind::box:
      return Filter(BoxFilter{radius});
    case FilterKind::triangle:
      return Filter(TriangleFilter{radius});
    case FilterKind::mitchell:
      return Filter(
          MitchellFilter(MitchellProfile{radius.x, stated.b, stated.c}, MitchellProfile{radius.y, stated.b, stated.c}));
    case FilterKind::sinc:
      return Filter(SincFilter(SincProfile{radius.x, stated.tau}, SincProfile{radius.y, stated.tau}));
    case FilterKind::gaussian:
      break;
  }
  return Filter(GaussianFilter(GaussianProfile{radius.x, stated.sigma}, GaussianProfile{radius.y, stated.sigma}));
}

}  // namespace montelux
