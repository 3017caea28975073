// The closed list of scattering models. A new one is an include and a name here: its number, what scenes state, tables
// and dispatch follow.
#pragma once
#include <tuple>
#include <utility>

#include "material/coated_conductor.h"
#include "material/coated_diffuse.h"
#include "material/coated_metallic_roughness.h"
#include "material/conductor.h"
#include "material/dielectric.h"
#include "material/diffuse.h"
#include "material/diffuse_transmission.h"
#include "material/measured.h"
#include "material/metallic_roughness.h"
#include "material/phong.h"
#include "material/thin_dielectric.h"
#include "material/tinted_dielectric.h"

namespace montelux {

template <class F>
using BsdfModels = std::tuple<Diffuse<F>, Conductor<F>, Dielectric<F>, CoatedDiffuse<F>, CoatedConductor<F>,
                              DiffuseTransmission<F>, ThinDielectric<F>, Phong<F>, MetallicRoughness<F>,
                              CoatedMetallicRoughness<F>, TintedDielectric<F>, Measured<F>>;
inline constexpr std::size_t bsdf_kind_count = std::tuple_size_v<BsdfModels<float>>;

// The place of a model in the list.
enum class BsdfKind : std::uint32_t {};

template <BsdfKind kind, class F>
using BsdfOf = std::tuple_element_t<std::size_t(kind), BsdfModels<F>>;

// The first place whose model is, or is stated by, the type.
template <class Type>
inline constexpr BsdfKind kind_where = []<std::size_t... I>(std::index_sequence<I...>) {
  std::size_t place = 0;
  const auto matches = [&]<class Model>() {
    if (std::is_same_v<Type, Model> || std::is_same_v<Type, typename Model::Stated>) return true;
    ++place;
    return false;
  };
  (void)(matches.template operator()<std::tuple_element_t<I, BsdfModels<float>>>() || ...);
  return BsdfKind(place);
}
(std::make_index_sequence<bsdf_kind_count>());
// kind_of<Phong>, and kind_stated_by<PhongDesc>.
template <template <class> class Model>
inline constexpr BsdfKind kind_of = kind_where<Model<float>>;
template <class Stated>
inline constexpr BsdfKind kind_stated_by = kind_where<Stated>;

template <class F>
inline constexpr bool all_are_bsdf_models = []<std::size_t... I>(std::index_sequence<I...>) {
  return (BsdfModel<std::tuple_element_t<I, BsdfModels<F>>, F> && ...);
}
(std::make_index_sequence<bsdf_kind_count>());
static_assert(all_are_bsdf_models<float> && all_are_bsdf_models<NativeFloats>);

}  // namespace montelux
