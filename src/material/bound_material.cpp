#include "material/bound_material.h"

#include "material/coat_table.h"

namespace montelux {

namespace {

template <class F>
F encoded_value(F x, const RowBinding& binding) {
  switch (binding.encoding) {
    case RowEncoding::plain:
      break;
    case RowEncoding::unit:
      return clamp(x * binding.scale, 0.0f, 1.0f);
    case RowEncoding::signed_unit:
      x = 2.0f * x - 1.0f;
      break;
    case RowEncoding::roughness:
      x = safe_sqrt(x);
      break;
    case RowEncoding::reflectance_to_k: {
      F r = clamp(x, 0.0f, 0.9999f);
      x = 2.0f * sqrt(r / (1.0f - r));
    }
  }
  return x * binding.scale;
}

}  // namespace

float encoded(float x, const RowBinding& binding) { return encoded_value(x, binding); }

bool uses_parameters(const Material& material) {
  if (!material.is_plain()) return true;
  // A grain: different roughness along u and v.
  const float* v = material.row.v;
  bool has_grain = false;
  for_each_present_model<float>(std::uint32_t(material.kind), true, [&]<class Model>(bool) {
    for (const FacetSlots& facets : Model::facet_slots) has_grain = has_grain || v[facets.u] != v[facets.v];
    if constexpr (HasGrain<Model>) has_grain = has_grain || Model::has_grain(BsdfRows<float>{&material.row});
  });
  return has_grain;
}

// What the table knows of the roughnesses in the slots.
template <class F>
static void look_up_coat(const CoatTable& table, Mask<F> on, BsdfSlots<F>& slots) {
  using Slots = CoatedDiffuseSlots;
  const CoatKnowledge<F> known = table.at(select(on, slots.v[Slots::alpha_x], F(0.0f)));
  slots.v[Slots::internal] = select(on, known.internal, slots.v[Slots::internal]);
  for (int k = 0; k < coat_transmittance::terms; ++k)
    slots.v[Slots::series + k] = select(on, known.series[std::size_t(k)], slots.v[Slots::series + k]);
}

template <class F>
void look_up_slots(const Material& material, const TextureSet& textures, const TexturePoints<F>& points, Mask<F> on,
                   BsdfSlots<F>& slots) {
  const auto put = [&](int slot, F value, const RowBinding& binding) {
    slots.v[slot] = select(on, encoded_value(value, binding), slots.v[slot]);
  };
  for (const RowBinding& binding : material.bindings) {
    if (!binding.is_spectrum) {
      put(binding.slot, textures.number(NumberTextureId(binding.texture), points, on), binding);
      continue;
    }
    const Spectrum<F> value = textures.spectrum(SpectrumTextureId(binding.texture), points, on);
    for (int i = 0; i < spectrum_size; ++i) put(binding.slot + i, value.c[i], binding);
  }
  if (material.coat) look_up_coat(*material.coat, on, slots);
}

BsdfRow material_row(const Material& material, const TextureSet& textures, const TexturePoint& point) {
  BsdfRow row = material.row;
  look_up_slots<float>(material, textures, {point.uv, point.p, point.n}, true, row);
  return row;
}

// The direction that an image stores as a colour, with x and y scaled.
template <class F>
static Vec3<F> normal_of(const RgbOf<F>& c, const Vec2f& scale) {
  return {scale.x * (2.0f * c.c[0] - 1.0f), scale.y * (2.0f * c.c[1] - 1.0f), 2.0f * c.c[2] - 1.0f};
}

template <class F>
Vec3<F> mapped_normal(const Material& material, const TextureSet& textures, const TexturePoints<F>& points,
                      Mask<F> on) {
  const Vec2<F> st{points.uv.x, 1.0f - points.uv.y};
  RgbOf<F> c;
  if (material.normal_texture)
    c = textures.color(*material.normal_texture, points, on);
  else if constexpr (lanes_of<F> == 1)
    c = material.normal_map->bilinear(st, Wrap::repeat);
  else
    c = material.normal_map->bilinear(st, Wrap::repeat, on);
  return normal_of(c, material.normal_scale);
}

template <class F>
Vec3<F> mapped_coat_normal(const Material& material, const TextureSet& textures, const TexturePoints<F>& points,
                           Mask<F> on) {
  return normal_of(textures.color(*material.coat_normal_texture, points, on), material.coat_normal_scale);
}

template void look_up_slots(const Material&, const TextureSet&, const TexturePoints<float>&, bool, BsdfSlots<float>&);
template void look_up_slots(const Material&, const TextureSet&, const TexturePoints<NativeFloats>&, Mask<NativeFloats>,
                            BsdfSlots<NativeFloats>&);
template Vec3f mapped_normal(const Material&, const TextureSet&, const TexturePoints<float>&, bool);
template Vec3<NativeFloats> mapped_normal(const Material&, const TextureSet&, const TexturePoints<NativeFloats>&,
                                          Mask<NativeFloats>);
template Vec3f mapped_coat_normal(const Material&, const TextureSet&, const TexturePoints<float>&, bool);
template Vec3<NativeFloats> mapped_coat_normal(const Material&, const TextureSet&, const TexturePoints<NativeFloats>&,
                                               Mask<NativeFloats>);

}  // namespace montelux
