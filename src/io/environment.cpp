#include "io/environment.h"

#include <cmath>
#include <filesystem>
#include <numbers>

#include "io/text_file.h"

namespace montelux {

namespace {

void put(Entity& e, std::string name, ParameterType type, Values values) {
  e.parameters.add({std::move(name), type, std::move(values), e.where});
}

}  // namespace

void replace_environment(const Environment& environment, SceneDesc& scene, Diagnostics& diagnostics) {
  const SourceLocation where{std::make_shared<const std::string>(printable(environment.file)), 0, 0};
  if (!is_regular_file(environment.file)) return diagnostics.error(where, "there is no file of this environment");
  const std::size_t replaced =
      std::erase_if(scene.lights, [](const LightDesc& l) { return l.entity.type == "infinite"; });
  if (replaced > 0)
    diagnostics.note(where, "this environment replaces the scene's " +
                                (replaced == 1 ? std::string("own one") : std::to_string(replaced) + " own ones"));
  Entity e{"infinite", {}, where};
  // Paths of the description are relative to its folder; an absolute one stays.
  put(e, "filename", ParameterType::string,
      std::vector<std::string>{std::filesystem::absolute(environment.file).string()});
  put(e, "mapping", ParameterType::string, std::vector<std::string>{"auto"});
  put(e, "scale", ParameterType::number, std::vector<float>{float(environment.scale)});
  // The pole of the image, its own +z, is +y of the world; its azimuth goes from +x towards +z.
  const double angle = environment.rotation * std::numbers::pi / 180, c = std::cos(angle), s = std::sin(angle);
  Matrix4 m;
  m.m = {{{c, -s, 0, 0}, {0, 0, 1, 0}, {s, c, 0, 0}, {0, 0, 0, 1}}};
  scene.lights.push_back({std::move(e), *from_matrix(m)});
}

}  // namespace montelux
