#include "io/gltf.h"

#include "io/gltf/scene_builder.h"

namespace montelux {

ReadResult read_gltf(const std::string& path, const ReadOptions& options) {
  ReadResult result;
  Reporter report(result.diagnostics, options.lenient);
  gltf::Document document(path, report);
  if (document.read()) {
    document.check_asset();
    SceneDesc scene = gltf::SceneBuilder(document, options).build();
    if (!result.diagnostics.has_errors()) result.scene = std::move(scene);
  }
  result.omissions = report.omissions();
  report.finish();
  return result;
}

}  // namespace montelux
