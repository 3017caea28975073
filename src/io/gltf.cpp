#include "io/gltf.h"

#include <algorithm>

#include "io/gltf/scene_builder.h"

namespace montelux {

namespace {

// Lists the names of all cameras and animations, with the durations given by the bounds of their times.
void list_choices(gltf::Document& document, ReadResult& result) {
  const gltf::Element cameras = document.list("cameras"), animations = document.list("animations");
  const gltf::Element accessors = document.list("accessors");
  for (std::size_t i = 0; i < cameras.size(); ++i) result.cameras.push_back(cameras[i]["name"].text().value_or(""));
  for (std::size_t i = 0; i < animations.size(); ++i) {
    NamedAnimation animation{animations[i]["name"].text().value_or("")};
    const gltf::Element samplers = animations[i]["samplers"];
    for (std::size_t k = 0; k < samplers.size(); ++k)
      if (const auto input = samplers[k]["input"].index_of(accessors, "an accessor"))
        animation.seconds = std::max(animation.seconds, accessors[*input]["max"][std::size_t(0)].number().value_or(0));
    result.animations.push_back(std::move(animation));
  }
}

}  // namespace

ReadResult read_gltf(const std::string& path, const ReadOptions& options) {
  ReadResult result;
  Reporter report(result.diagnostics, options.lenient);
  gltf::Document document(path, report);
  if (document.read()) {
    document.check_asset();
    list_choices(document, result);
    SceneDesc scene = gltf::SceneBuilder(document, options).build();
    if (!result.diagnostics.has_errors()) result.scene = std::move(scene);
  }
  result.omissions = report.omissions();
  report.finish();
  return result;
}

}  // namespace montelux
