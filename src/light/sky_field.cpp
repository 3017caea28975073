#include "light/sky_field.h"

namespace montelux {

namespace {

// The share of the choices that follow the light alone: what training has not seen is found, too.
constexpr double own_share = 0.1;

std::vector<SkyDirections::Table> mixed(const std::vector<SkyDirections::Table>& learned,
                                        const std::vector<double>& own) {
  std::vector<SkyDirections::Table> tables = learned;
  for (SkyDirections::Table& table : tables) {
    double sum = 0;
    for (std::size_t c = 0; c < own.size(); ++c) {
      if (own[c] <= 0) table.weights[c] = 0;
      sum += double(table.weights[c]);
    }
    const double scale = sum > 0 ? (1 - own_share) / sum : 0, rest = sum > 0 ? own_share : 1;
    for (std::size_t c = 0; c < own.size(); ++c)
      table.weights[c] = float(scale * double(table.weights[c]) + rest * own[c]);
  }
  return tables;
}

}  // namespace

SkyField::SkyField(const SkyLight& of, PlaceTree tree, const std::vector<SkyDirections::Table>& learned)
    : light_(of.light),
      transform_(of.transform),
      tiles_(of.table, SkyDirections::side),
      field_(std::move(tree), mixed(learned, tiles_.masses())) {
  const double of_square = 4 * double(pi) / cells;
  for (double mass : tiles_.masses()) inverse_masses_.push_back(mass > 0 ? float(of_square / mass) : 0.0f);
}

float SkyField::cell_mass(const Vec3f& p, const Vec3f& n, const Vec3f& in_light) const {
  const std::uint32_t table = field_.tree().leaf_at<float>(p, n, true);
  return field_.density_of(table, SkyDirections::cell_of<float>(in_light)) * (4 * pi / float(cells));
}

template <class F>
SkySample<F> SkyField::sample(const Vec3<F>& p, const Vec3<F>& n, Vec2<F> u, Mask<F> on) const {
  const Uint<F> table = field_.tree().template leaf_at<F>(p, n, on);
  const FieldCell<F> cell = field_.sample_cell<F>(table, u);
  const PointSample2<F> at = tiles_.sample<F>(cell.column, cell.row, cell.rest);
  const Uint<F> number = cell.row * Uint<F>(SkyDirections::side) + cell.column;
  // The field's density is the probability of the cell over its solid angle, of which the light has its own share.
  const F of_cell = field_.density_of(table, number) * gather(inverse_masses_.data(), number);
  return {normalize(transform<F>().direction_to_world(sphere_from_square(at.p))),
          at.p,
          {of_cell * at.density.value * inv_four_pi}};
}

template <class F>
Density<SolidAngle, F> SkyField::density(const Vec3<F>& p, const Vec3<F>& n, const Vec3<F>& wi, Mask<F> on) const {
  const Vec2<F> at = inside_square(square_from_sphere(normalize(transform<F>().direction_to_light(wi))));
  const Uint<F> cell = SkyDirections::cell_at<F>(at), table = field_.tree().template leaf_at<F>(p, n, on);
  const F of_cell = field_.density_of(table, cell) * gather(inverse_masses_.data(), cell);
  return {select(on, of_cell * tiles_.table().density(at).value * inv_four_pi, F(0.0f))};
}

#define MONTELUX_SKY_FIELD(F)                                                                     \
  template SkySample<F> SkyField::sample(const Vec3<F>&, const Vec3<F>&, Vec2<F>, Mask<F>) const; \
  template Density<SolidAngle, F> SkyField::density(const Vec3<F>&, const Vec3<F>&, const Vec3<F>&, Mask<F>) const;
MONTELUX_SKY_FIELD(float)
MONTELUX_SKY_FIELD(NativeFloats)
#undef MONTELUX_SKY_FIELD

}  // namespace montelux
