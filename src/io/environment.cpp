#include "io/environment.h"

#include <cmath>
#include <filesystem>
#include <numbers>

#include "io/text_file.h"

namespace montelux {

void replace_environment(const Environment& environment, SceneDesc& scene, Diagnostics& diagnostics) {
  const SourceLocation where{std::make_shared<const std::string>(printable(environment.file)), 0, 0};
  if (!is_regular_file(environment.file)) return diagnostics.error(where, "there is no file of this environment");
  const std::size_t replaced = std::erase_if(
      scene.lights, [](const LightDesc& l) { return std::holds_alternative<InfiniteLightDesc>(l.model); });
  if (replaced > 0)
    diagnostics.note(where, "this environment replaces the scene's " +
                                (replaced == 1 ? std::string("own one") : std::to_string(replaced) + " own ones"));
  LightDesc light;
  light.where = where, light.scale = float(environment.scale);
  InfiniteLightDesc sphere;
  // Paths of the description are relative to its folder; an absolute one stays.
  sphere.file = std::filesystem::absolute(environment.file).string();
  sphere.mapping = EnvironmentMapping::automatic;
  light.model = std::move(sphere);
  // The pole of the image, its own +z, is +y of the world; its azimuth goes from +x towards +z.
  const double angle = environment.rotation * std::numbers::pi / 180, c = std::cos(angle), s = std::sin(angle);
  Matrix4 m;
  m.m = {{{c, -s, 0, 0}, {0, 0, 1, 0}, {s, c, 0, 0}, {0, 0, 0, 1}}};
  light.light_to_world = *from_matrix(m);
  scene.lights.push_back(std::move(light));
}

}  // namespace montelux
