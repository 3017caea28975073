#include "io/scene_file.h"

#include <algorithm>
#include <array>
#include <filesystem>

#include "io/gltf.h"
#include "io/pbrt.h"
#include "io/text_file.h"

namespace montelux {

namespace {

constexpr std::array<std::string_view, 4> endings{".pbrt", ".pbrt.gz", ".gltf", ".glb"};

bool ends_like(const std::string& path, std::string_view ending) {
  return path.size() > ending.size() &&
         std::equal(ending.begin(), ending.end(), path.end() - std::ptrdiff_t(ending.size()),
                    [](char a, char b) { return a == (b >= 'A' && b <= 'Z' ? char(b - 'A' + 'a') : b); });
}

}  // namespace

std::span<const std::string_view> scene_file_endings() { return endings; }

static ReadResult read_scene_alone(const std::string& path, const ReadOptions& options) {
  if (ends_like(path, ".gltf") || ends_like(path, ".glb")) return read_gltf(path, options);
  if (ends_like(path, ".pbrt") || ends_like(path, ".pbrt.gz")) {
    ReadResult result = read_pbrt(path, options);
    for (const auto& [choice, kind] : {std::pair{&options.camera, "camera"}, {&options.animation, "animation"}})
      if (*choice)
        result.diagnostics.warning({std::make_shared<std::string>(path), 0, 0},
                                   std::string("the choice of a ") + kind + " is ignored: a pbrt file has one only");
    return result;
  }
  ReadResult result;
  std::string valid;
  for (std::string_view ending : endings) (valid += valid.empty() ? "" : ", ") += ending;
  std::string ending = std::filesystem::path(path).extension().string();
  if (ending == ".gz") ending = std::filesystem::path(path).stem().extension().string() + ending;
  const std::string_view nearest = nearest_name(ending, {endings.begin(), endings.end()});
  result.diagnostics.error({std::make_shared<std::string>(printable(path)), 0, 0},
                           ending.empty() ? "the name of a scene file must end in " + valid
                                          : "'" + printable(ending) + "' is no ending of a scene file; valid: " + valid,
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
