#include "integrator/path/entry.h"

#include "integrator/notes.h"
#include "integrator/path/tracer.h"

namespace montelux {

namespace {

template <bool naive>
Result<ChosenIntegrator> make_path(const IntegratorRequest& r) {
  auto settings = path_settings(r.list, r.max_depth);
  if (!settings) return settings.failure();
  if (naive) settings->nee = false;
  if (settings->manifold > 0 && r.scene.has_participating_media())
    return Failure{"the scene has participating media, through which manifold does not look for light (manifold=off)"};
  settings->width = r.defaults.width, settings->height = r.defaults.height;
  ChosenIntegrator chosen =
      chosen_integrator(naive ? "naive" : "path", std::make_unique<PathTracer>(r.scene, r.accel, *settings));
  chosen.chain_length = settings->manifold;
  if (naive) chosen.chance_lights = ChanceLights::all;
  note_depth(chosen, r.max_depth);
  return chosen;
}

LightSearch path_search(const ParameterList& list) {
  const auto settings = path_settings(list, {});
  return settings && settings->manifold > 0 ? LightSearch::with_chains : LightSearch::any_length;
}

constexpr std::uint32_t path_abilities = bits_of({Ability::layers, Ability::media, Ability::paths});

}  // namespace

IntegratorEntry path_entry() {
  return {path_spec(), make_path<false>, LightSearch::any_length, Content::light, path_abilities, path_search};
}
IntegratorEntry naive_entry() {
  return {naive_spec(), make_path<true>, LightSearch::any_length, Content::light, path_abilities, path_search};
}

}  // namespace montelux
