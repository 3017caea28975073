#include "integrator/restir/entry.h"

#include "integrator/notes.h"
#include "integrator/restir/integrator.h"

namespace montelux {

namespace {

template <const char* name>
Result<ChosenIntegrator> make_restir(const IntegratorRequest& r) {
  auto settings = restir_settings(name, r.list, r.max_depth);
  if (!settings) return settings.failure();
  settings->path.width = r.defaults.width, settings->path.height = r.defaults.height;
  std::string note;
  // A candidate by the BSDF has passed such surfaces by chance, and would be tested by chance again when it is shown.
  if (settings->direct && settings->bsdf_candidate && !settings->visibility_reuse && r.scene.geometry.has_half_open()) {
    settings->visibility_reuse = true;
    note =
        "visibility-reuse is on, because surfaces here have alpha masks or are mixed with interfaces (with bsdf=off it "
        "may be off)";
  }
  ChosenIntegrator chosen = chosen_integrator(name, std::make_unique<RestirIntegrator>(r.scene, r.accel, *settings));
  if (!note.empty()) chosen.notes.push_back(std::move(note));
  note_depth(chosen, r.max_depth);
  if (settings->direct && !settings->bsdf_candidate) note_masked(chosen, r.scene, "bsdf=off");
  const bool reuses = settings->temporal || (settings->rounds > 0 && settings->neighbours > 0);
  if (settings->weights == ReuseWeights::naive && reuses) {
    chosen.biases.push_back("weights=naive");
    chosen.notes.push_back(
        "reservoirs are combined as if every pixel could make every sample: the picture is biased where pixels see "
        "different lights (--set weights=pairwise is not)");
  }
  return chosen;
}

constexpr char restir_di[] = "restir-di", restir_gi[] = "restir-gi", restir_pt[] = "restir-pt";

constexpr std::uint32_t shared_samples = bits_of({Ability::shared_samples, Ability::absorption});

}  // namespace

IntegratorEntry restir_di_entry() {
  return {restir_di_spec(), make_restir<restir_di>, LightSearch::any_length, Content::light, shared_samples};
}
IntegratorEntry restir_gi_entry() {
  return {restir_gi_spec(), make_restir<restir_gi>, LightSearch::any_length, Content::light, shared_samples};
}
IntegratorEntry restir_pt_entry() {
  return {restir_pt_spec(), make_restir<restir_pt>, LightSearch::any_length, Content::light, shared_samples};
}

}  // namespace montelux
