#include "io/scene_file.h"

#include <algorithm>
#include <filesystem>

#include "io/gltf.h"
#include "io/pbrt.h"
#include "io/text_file.h"

namespace montelux {

namespace {

bool ends_like(const std::string& path, std::string_view ending) {
  return path.size() > ending.size() &&
         std::equal(ending.begin(), ending.end(), path.end() - std::ptrdiff_t(ending.size()),
                    [](char a, char b) { return a == (b >= 'A' && b <= 'Z' ? char(b - 'A' + 'a') : b); });
}

}  // namespace

std::span<const SceneFormat> scene_formats() {
  static const std::vector<SceneFormat> formats{
      {"pbrt", {".pbrt", ".pbrt.gz"}, false, read_pbrt, [](const std::string& content) { return content; }},
      {"glTF", {".gltf", ".glb"}, true, read_gltf, gltf_strings}};
  return formats;
}

const SceneFormat* scene_format_of(const std::string& path) {
  for (const SceneFormat& format : scene_formats())
    for (std::string_view ending : format.extensions)
      if (ends_like(path, ending)) return &format;
  return nullptr;
}

static std::vector<std::string_view> all_extensions() {
  std::vector<std::string_view> all;
  for (const SceneFormat& format : scene_formats())
    all.insert(all.end(), format.extensions.begin(), format.extensions.end());
  return all;
}

std::string scene_file_extensions() {
  std::string text;
  for (std::string_view ending : all_extensions()) (text += text.empty() ? "" : ", ") += ending;
  return text;
}

static ReadResult read_scene_alone(const std::string& path, const ReadOptions& options) {
  if (const SceneFormat* format = scene_format_of(path)) {
    ReadResult result = format->read(path, options);
    if (format->has_choices) return result;
    for (const auto& [choice, kind] : {std::pair{&options.camera, "camera"}, {&options.animation, "animation"}})
      if (*choice)
        result.diagnostics.warning({std::make_shared<std::string>(path), 0, 0}, std::string("the choice of a ")
                                                                                    .append(kind)
                                                                                    .append(" is ignored: a ")
                                                                                    .append(format->name)
                                                                                    .append(" file has only one"));
    return result;
  }
  ReadResult result;
  const std::string valid = scene_file_extensions();
  std::string ending = std::filesystem::path(path).extension().string();
  if (ending == ".gz") ending = std::filesystem::path(path).stem().extension().string() + ending;
  const std::string_view nearest = nearest_name(ending, all_extensions());
  result.diagnostics.error({std::make_shared<std::string>(printable(path)), 0, 0},
                           ending.empty()
                               ? "the name of a scene file must end in " + valid
                               : "'" + printable(ending) + "' is not an extension of a scene file; valid: " + valid,
                           nearest.empty() ? std::string() : "did you mean '" + std::string(nearest) + "'?");
  return result;
}

ReadResult read_scene(const std::string& path, const ReadOptions& options) {
  ReadResult result = read_scene_alone(path, options);
  if (result.scene && options.environment) replace_environment(*options.environment, *result.scene, result.diagnostics);
  if (result.diagnostics.has_errors()) result.scene.reset();
  return result;
}

}  // namespace montelux
