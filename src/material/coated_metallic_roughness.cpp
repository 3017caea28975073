#include "material/coated_metallic_roughness.h"

#include <cmath>

#include "material/row_builder.h"
#include "material/rows.h"

namespace montelux {

Fields<CoatedMetallicRoughnessDesc> CoatedMetallicRoughnessDesc::rows() {
  using M = CoatedMetallicRoughnessDesc;
  Fields<M> fields;
  fields.part(&M::base, MetallicRoughnessDesc::rows());
  fields.input<NumberInput>("clearcoat", &M::coat, "share of the coat", 0, 1);
  fields.input<NumberInput>("clearcoatroughness", &M::coat_roughness, "alpha of its facets is the square", 0, 1);
  fields.part(&M::coat_normals,
              rows_of_normals("coatnormaltexture",
                              "tangent-space normals of the coat; default: those of the surface, not of the base",
                              "coatnormalscale", "factors of their x and y"));
  fields.input<NumberInput>("anisotropy", &M::anisotropy, "strength of the grain", 0, 1);
  fields.number("anisotropyrotation", &M::grain_rotation, "rotation of the grain from u towards v in degrees",
                -no_upper_bound, no_upper_bound);
  fields.input<NumberInput>("grainx", &M::grain_x, "the unrotated grain, u component, from 0 (-1) to 1 (1)", 0, 1);
  fields.input<NumberInput>("grainy", &M::grain_y, "the same along v, where 0.5 is none", 0, 1);
  fields.flag("grainmirrored", &M::grain_is_mirrored, "v is against n x u");
  return fields;
}

void CoatedMetallicRoughnessDesc::fill(RowBuilder& row) const {
  using Slots = CoatedMetallicRoughnessSlots;
  base.fill(row);
  row.number(Slots::coat, coat, RowEncoding::unit);
  row.number(Slots::coat_roughness, coat_roughness, RowEncoding::unit);
  row.number(Slots::anisotropy, anisotropy, RowEncoding::unit);
  // Encoded as an image stores a direction: 1 and 1/2 decode to 1 and 0.
  row.number(Slots::grain_x, grain_x, RowEncoding::signed_unit);
  row.number(Slots::grain_y, grain_y, RowEncoding::signed_unit);
  const float angle = grain_rotation * (pi / 180);
  row.put(Slots::turn_cos, std::cos(angle)), row.put(Slots::turn_sin, std::sin(angle));
  row.put(Slots::side, grain_is_mirrored ? -1.0f : 1.0f);
  row.put(Slots::coat_normal + 2, 1);
  row.coat_normals(coat_normals);
}

}  // namespace montelux
