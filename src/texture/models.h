// The closed list of textures. A new one is an include and a name here: what scenes state, tables and look-ups follow.
#pragma once
#include <variant>

#include "texture/bilerp.h"
#include "texture/checkerboard.h"
#include "texture/constant.h"
#include "texture/direction_mix.h"
#include "texture/dots.h"
#include "texture/fbm.h"
#include "texture/image.h"
#include "texture/marble.h"
#include "texture/mix.h"
#include "texture/scale.h"
#include "texture/threshold.h"
#include "texture/windy.h"
#include "texture/wrinkled.h"

namespace montelux {

template <template <class> class... Model>
struct TextureList {};
using TextureModels = TextureList<ConstantTexture, ScaleTexture, MixTexture, ThresholdTexture, DirectionMixTexture,
                                  ImageTexture, CheckerboardTexture, BilerpTexture, DotsTexture, FbmTexture,
                                  WrinkledTexture, WindyTexture, MarbleTexture>;

namespace texture_list {

template <class V, class Variant, template <class> class... Model>
struct WithValues {
  using Type = Variant;
};
template <class V, class... Before, template <class> class First, template <class> class... Rest>
struct WithValues<V, std::variant<Before...>, First, Rest...> {
  using Grown = std::conditional_t<can_be_of<V>(First<V>::Stated::values), std::variant<Before..., First<V>>,
                                   std::variant<Before...>>;
  using Type = typename WithValues<V, Grown, Rest...>::Type;
};

template <template <class> class... Model>
std::variant<typename Model<float>::Stated...> stated(TextureList<Model...>);
template <class V, template <class> class... Model>
typename WithValues<V, std::variant<>, Model...>::Type with_values(TextureList<Model...>);

}  // namespace texture_list

// What scenes state of them.
using TextureModel = decltype(texture_list::stated(TextureModels()));
// Those that can have values V.
template <class V>
using Texture = decltype(texture_list::with_values<V>(TextureModels()));
using NumberTexture = Texture<float>;
using SpectrumTexture = Texture<Rgb>;

}  // namespace montelux
