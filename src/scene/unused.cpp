#include "scene/unused.h"

#include <set>
#include <tuple>

namespace montelux {

namespace {

class UnusedReport {
 public:
  explicit UnusedReport(Diagnostics& diagnostics) : diagnostics_(diagnostics) {}

  void add(const std::string& owner, const ParameterList& parameters) {
    for (const Parameter* p : parameters.unused()) {
      // Defaults of attributes, and area lights, are copied to many shapes.
      if (p->where.line > 0 && !places_.insert({p->where.file.get(), p->where.line, p->where.column}).second) continue;
      diagnostics_.warning(p->where, "'" + p->name + "' of " + owner + " has no effect here");
    }
  }
  void add(const std::string& family, const Entity& entity) {
    add(family + " '" + entity.type + "'", entity.parameters);
  }

 private:
  Diagnostics& diagnostics_;
  std::set<std::tuple<const std::string*, int, int>> places_;
};

}  // namespace

void report_unused(const SceneDesc& scene, Diagnostics& diagnostics) {
  UnusedReport report(diagnostics);
  for (const TextureDesc& texture : scene.textures) report.add("texture", texture.entity);
}

}  // namespace montelux
