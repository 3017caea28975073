#include "io/gltf/textures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>

#include "io/text_file.h"

namespace montelux::gltf {

std::optional<std::string> TextureReader::image_file(const Element& image, std::size_t number) {
  const auto embed = [&](std::string bytes) {
    // A name that no file in the scene's folder has.
    std::string name =
        std::filesystem::path(*document_.whole().file).filename().string() + "#images/" + std::to_string(number);
    scene_.embedded[name] = std::make_shared<const std::string>(std::move(bytes));
    return name;
  };
  if (const Element uri = image["uri"]) {
    std::optional<Document::Link> link = document_.link(uri);
    if (!link) return std::nullopt;
    if (link->data) return embed(*std::move(link->data));
    const std::string path = resolve_path(document_.folder(), link->file);
    if (is_regular_file(path)) return link->file;
    uri.error("there is no file '" + printable(path) + "'");
    return std::nullopt;
  }
  const auto view_number = image.required("bufferView").index_of(document_.list("bufferViews"), "a buffer view");
  if (!view_number) return std::nullopt;
  const auto view = document_.view(*view_number);
  if (!view) return std::nullopt;
  return embed(std::string(view->bytes.begin(), view->bytes.end()));
}

void TextureReader::read_sampler(const Element& sampler, TextureUse& use) const {
  const std::array<const char*, 2> names{"wrapS", "wrapT"};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const Element wrap = sampler[names[axis]];
    const auto code = wrap.whole();
    if (!code || *code == 10497) continue;
    if (*code == 33071)
      use.folds[axis] = Fold::clamp;
    else if (*code == 33648)
      use.folds[axis] = Fold::mirror;
    else
      wrap.error("must be 10497 (repeat), 33071 (clamp to the edge) or 33648 (mirrored)");
  }
  const Element filter = sampler["magFilter"];
  const auto code = filter.whole();
  use.nearest = code && *code == 9728;
  if (code && *code != 9728 && *code != 9729) filter.error("must be 9728 (nearest) or 9729 (linear)");
}

// In glTF's parameters, with v downward: scale, then rotation (counter-clockwise as u and v are drawn), then offset.
void TextureReader::read_transform(const Element& transform, TextureUse& use) const {
  const auto offset = transform["offset"].numbers(2).value_or(std::vector<double>{0, 0});
  const auto scale = transform["scale"].numbers(2).value_or(std::vector<double>{1, 1});
  const double angle = transform["rotation"].number().value_or(0), c = std::cos(angle), s = std::sin(angle);
  if (const auto set = transform["texCoord"].whole(7)) use.uv_set = int(*set);
  // u' = a u + b (1 - v) + e and 1 - v' = p u + q (1 - v) + f, with v upward.
  const double a = c * scale[0], b = s * scale[1], p = -s * scale[0], q = c * scale[1];
  use.uv_map = {a, -b, b + offset[0], -p, q, 1 - q - offset[1]};
}

std::optional<TextureUse> TextureReader::use(const Element& info) {
  if (!info) return std::nullopt;
  const Element textures = document_.list("textures"), images = document_.list("images");
  const auto number = info.required("index").index_of(textures, "a texture");
  if (!number) return std::nullopt;
  const Element texture = textures[*number];
  TextureUse use;
  use.where = info.where();
  if (const auto set = info["texCoord"].whole(7)) use.uv_set = int(*set);
  if (const Element transform = info["extensions"]["KHR_texture_transform"]) read_transform(transform, use);
  if (const auto sampler = texture["sampler"].index_of(document_.list("samplers"), "a sampler"))
    read_sampler(document_.list("samplers")[*sampler], use);
  if (!texture["source"]) {
    texture.warning("the texture has no supported image: it is omitted");
    return std::nullopt;
  }
  const auto image = texture["source"].index_of(images, "an image");
  if (!image) return std::nullopt;
  auto [place, is_new] = files_.try_emplace(*image);
  if (is_new) place->second = image_file(images[*image], *image);
  if (!place->second) return std::nullopt;
  use.file = *place->second;
  return use;
}

ImageTextureDesc TextureReader::image_of(const TextureUse& use) {
  ImageTextureDesc image;
  image.file = use.file, image.folds = use.folds;
  if (use.nearest) image.filter = TextureFilter::point;
  if (use.uv_map != TextureUse().uv_map) {
    auto& matrix = image.mapping.uv_matrix.emplace();
    std::transform(use.uv_map.begin(), use.uv_map.end(), matrix.begin(), [](double x) { return float(x); });
  }
  return image;
}

std::string TextureReader::add(bool is_spectrum, TextureModel model, const SourceLocation& where) {
  std::string name = "texture " + std::to_string(scene_.textures.size());
  scene_.textures.push_back({name, is_spectrum, std::move(model), {}, where});
  return name;
}

std::string TextureReader::spectrum(const TextureUse& use, const Rgb& factor, TexelMeaning meaning) {
  ImageTextureDesc image = image_of(use);
  if (meaning == TexelMeaning::data) image.encoding = ColorEncoding{};
  const bool is_gray = factor[0] == factor[1] && factor[1] == factor[2];
  if (is_gray)
    image.scale = factor[0];
  else
    image.tint = RgbValue{factor};
  return add(true, std::move(image), use.where);
}

std::string TextureReader::number(const TextureUse& use, ImageChannel channel, double factor) {
  ImageTextureDesc image = image_of(use);
  // Alpha is linear in every encoding, so it shares the texels of the colour.
  if (channel != ImageChannel::a) image.encoding = ColorEncoding{};
  image.channel = channel, image.scale = float(factor);
  return add(false, std::move(image), use.where);
}

std::string TextureReader::squared(const std::string& texture) {
  const TextureName name{texture};
  return add(false, ScaleTextureDesc{{name, document_.whole()}, {name, document_.whole()}}, document_.whole());
}

std::string TextureReader::threshold(const std::string& texture, double edge) {
  return add(false, ThresholdTextureDesc{{TextureName{texture}, document_.whole()}, float(edge)}, document_.whole());
}

}  // namespace montelux::gltf
