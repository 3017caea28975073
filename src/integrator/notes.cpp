#include "integrator/notes.h"

#include <fmt/format.h>

#include <algorithm>

#include "scene/smoothness.h"

namespace montelux {

void note_depth(ChosenIntegrator& chosen, std::optional<int> max_depth) {
  if (!max_depth) return;
  chosen.biases.push_back(fmt::format("maxdepth={}", *max_depth));
  chosen.notes.push_back(
      fmt::format("paths end after {} scattering events (maxdepth): the picture is biased by what longer paths would "
                  "contribute (--set maxdepth=none lifts it)",
                  *max_depth));
}

void note_masked(ChosenIntegrator& chosen, const Scene& scene, std::string_view setting) {
  if (!scene.lights.has_masked()) return;
  chosen.biases.push_back(fmt::format("{} with masked emitters", setting));
  chosen.missing.push_back("direct light of emitters with an alpha mask");
  chosen.notes.push_back(
      fmt::format("emitters with an alpha mask are found only by directions, which {} does not sample: the picture is "
                  "biased by their light",
                  setting));
}

void note_smooth_coats(ChosenIntegrator& chosen, const Scene& scene, std::string_view setting) {
  const auto is_coated = [&](const GeometryRow& row) { return may_be_partly_smooth(scene.materials, row.material); };
  if (std::ranges::none_of(scene.geometry.rows, is_coated)) return;
  chosen.biases.push_back(fmt::format("{} with smooth coats", setting));
  chosen.missing.push_back("reflections in smooth coats");
  chosen.notes.push_back(
      fmt::format("surfaces here have smooth coats, whose reflections {} cannot find: the picture is biased by their "
                  "light (path finds it)",
                  setting));
}

void note_facing_curves(ChosenIntegrator& chosen, const Scene& scene) {
  const auto turns = [](const GeometryRow& row) { return (row.flags & GeometryRow::ray_facing) != 0; };
  if (std::ranges::none_of(scene.geometry.rows, turns)) return;
  chosen.biases.push_back("curves that face the light");
  chosen.notes.push_back(
      "curves face every ray that meets them, and here rays come from the lights: the picture is biased where the "
      "shape of a curve matters");
}

void note_radius(ChosenIntegrator& chosen, float radius) {
  chosen.biases.push_back(fmt::format("radius={:.4g}", radius));
  chosen.notes.push_back(fmt::format(
      "photons are gathered within {:.4g} at first: the picture is biased where light changes over that distance; more "
      "frames, or a smaller radius, bias it less",
      radius));
}

}  // namespace montelux
