// What the models of textures have in common.
//
// A model is a header that defines two structs: what a scene states of it (DotsTextureDesc), with
//   static constexpr std::string_view name, meaning;
//   static constexpr TextureValues values: what its textures can be of;
//   static Fields<DotsTextureDesc> rows(): its parameters, by which readers, writer and documentation know them;
// and the texture itself, template <class V> DotsTexture, plain data that refers to other textures by links, with
//   using Stated = DotsTextureDesc;
//   static TextureId<V> make(const Stated&, const TextureMaker<V>&);
//   V at(const TextureSet&, const TexturePoint&) const: the value at a point; allocates nothing;
//   PackOf<V> at(const TextureSet&, const TexturePack&, TextureMask on) const, where it has a form over lanes, with the
//     same values bit for bit. Idle lanes may contain anything.
#pragma once
#include <string_view>

#include "parameter/input.h"
#include "texture/mapping.h"
#include "texture/texture.h"

namespace montelux {

template <class S>
class Fields;
template <class V>
class TextureMaker;
class TextureSet;

// Of parameters that may have any value.
inline constexpr double any_magnitude = 1e30;

}  // namespace montelux
