#include "api/images.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "parameter/diagnostic.h"

namespace montelux {

namespace {

constexpr std::array<std::string_view, 3> linear_extensions{".exr", ".hdr", ".pfm"};
constexpr std::array<std::string_view, 3> display_extensions{".png", ".jpg", ".jpeg"};

template <class List>
bool contains(const List& list, std::string_view name) {
  return std::find(list.begin(), list.end(), name) != list.end();
}

struct NamedCurve {
  std::string_view name;
  ToneCurve curve;
  std::string_view meaning;
};
constexpr std::array<NamedCurve, 3> curves{{
    {"clip", ToneCurve::clip, "values above one are clipped"},
    {"hable", ToneCurve::hable, "filmic curve of Hable (2010)"},
    {"aces", ToneCurve::aces, "fit of Narkowicz (2015) to the ACES reference transform"},
}};

// A text in the header; empty if there is none.
std::string attribute_of(const Image& image, std::string_view name) {
  for (const Attribute& attribute : image.attributes)
    if (attribute.name == name)
      if (auto* text = std::get_if<std::string>(&attribute.value)) return *text;
  return {};
}

bool states_exposure(const Image& image) {
  return image.stored == SampleType::uint8 || image.stored == SampleType::uint16 ||
         attribute_of(image, "montelux:exposure") == "stated by the scene";
}

// The colours, with the content that the header states.
PictureLayer colors_with_content(Image image) {
  PictureLayer all{{}, Content::light, states_exposure(image)};
  const std::string content = attribute_of(image, "montelux:display");
  for (std::size_t i = 0; i < content_names.size(); ++i)
    if (content_names[i] == content) all.content = Content(i);
  all.pixels = std::move(image.pixels);
  return all;
}

}  // namespace

std::vector<std::pair<std::string, std::string>> color_maps() {
  return {{"viridis", "dark violet through green to yellow"},
          {"magma", "black through red to pale yellow"},
          {"none", "no false colours"}};
}

std::string extension_of(const std::filesystem::path& file) {
  std::string e = file.extension().string();
  std::transform(e.begin(), e.end(), e.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  return e;
}

std::vector<std::pair<std::string, std::string>> tone_curves() {
  std::vector<std::pair<std::string, std::string>> names;
  for (const NamedCurve& c : curves) names.emplace_back(c.name, c.meaning);
  return names;
}

std::optional<ToneCurve> tone_curve_named(std::string_view name) {
  for (const NamedCurve& c : curves)
    if (c.name == name) return c.curve;
  return std::nullopt;
}

bool is_picture_name(const std::filesystem::path& file) {
  const std::string extension = extension_of(file);
  return contains(linear_extensions, extension) || contains(display_extensions, extension);
}

Status check_picture_file(const std::filesystem::path& file) {
  if (!is_picture_name(file))
    return Failure{fmt::format("cannot write '{}': its extension must be one of {}, {}", file.string(),
                               fmt::join(linear_extensions, ", "), fmt::join(display_extensions, ", "))};
  return check_output_file(file);
}

bool is_display_file(const std::filesystem::path& file) { return contains(display_extensions, extension_of(file)); }

Status write_picture(const std::filesystem::path& file, const PixelBuffer& picture, const DisplayTransform& display) {
  if (!is_display_file(file)) return write_image(file, picture);
  return write_image(file, to_display(picture, display));
}

Result<PictureLayer> read_layer(const std::filesystem::path& file, const std::string& name) {
  Result<Image> image = read_image(file);
  if (!image) return image.failure();
  PixelBuffer& pixels = image->pixels;
  if (name.empty()) return colors_with_content(*std::move(image));
  const Content content = content_of_layer(name);
  const bool has_own_exposure = states_exposure(*image);
  if (auto found = layer(pixels, name)) return PictureLayer{std::move(*found), content, has_own_exposure};
  if (auto channel = find_channel(pixels, name)) {
    PixelBuffer single = make_pixel_buffer(pixels.width, pixels.height, {"Y"});
    for (std::size_t i = 0; i < single.values.size(); ++i)
      single.values[i] = pixels.values[i * pixels.channels.size() + std::size_t(*channel)];
    return PictureLayer{std::move(single), content, has_own_exposure};
  }
  std::vector<std::string> names;
  for (const std::string& channel : pixels.channels) {
    std::string candidate = channel.substr(0, channel.rfind('.'));
    if (!contains(names, candidate)) names.push_back(candidate);
  }
  return Failure{fmt::format("'{}' has no layer \"{}\"; it has {}{}", file.string(), name, fmt::join(names, ", "),
                             did_you_mean(name, {names.begin(), names.end()}))};
}

}  // namespace montelux
