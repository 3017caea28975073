// What the models of textures use to become a texture of a set.
#pragma once
#include "texture/build.h"

namespace montelux {

// For one stated texture of values V.
template <class V>
class TextureMaker {
 public:
  TextureMaker(TextureBuilder& builder, const TextureDesc& texture) : builder_(builder), texture_(texture) {}

  // Inputs as textures, as TextureBuilder::number has it.
  TextureId<V> of(const ValueInput& input) const { return builder_.value<V>(input); }
  NumberTextureId number(const NumberInput& input) const { return builder_.number(input); }
  TextureId<V> constant(float value) const;
  // A value that is stated in place.
  V value(const ConstantInput& input) const;
  Rgb rgb(const SpectrumValue& stated) const { return builder_.rgb(stated); }
  // Null if it cannot be read, which is reported.
  std::shared_ptr<const TexelImage> image(const std::string& file, std::optional<ColorEncoding> encoding) const {
    return builder_.image(file, texture_.where, encoding);
  }

  Mapping mapping(const MappingDesc& stated) const { return build_mapping(stated, texture_.texture_to_world); }
  const Transform& to_world() const { return texture_.texture_to_world; }
  Transform world_to_texture() const { return texture_.texture_to_world.inverted(); }

  TextureId<V> add(Texture<V> made) const { return builder_.textures().add(std::move(made)); }
  // A texture that depends only on these inputs is replaced by a constant where they are constant.
  template <class... Inputs>
  TextureId<V> add_folded(Texture<V> made, Inputs... inputs) const {
    const TextureId<V> id = add(std::move(made));
    return (builder_.textures().is_constant(inputs) && ...) ? folded(id) : id;
  }

  void error(std::string message) const;
  // Once for all textures of a scene with this subject.
  void note_once(const std::string& subject, std::string message, std::string reason) const;

 private:
  TextureId<V> folded(TextureId<V> id) const;

  TextureBuilder& builder_;
  const TextureDesc& texture_;
};

}  // namespace montelux
