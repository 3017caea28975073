#include "integrator/automatic/entry.h"

#include "integrator/automatic/settings.h"
#include "integrator/catalogue.h"
#include "integrator/notes.h"
#include "integrator/path/tracer.h"

namespace montelux {

namespace {

// Path, since nothing is known of the render: the choice is made where its length is known.
Result<ChosenIntegrator> make_automatic(const IntegratorRequest& r) {
  auto settings = automatic_settings(r.list);
  if (!settings) return settings.failure();
  for (const std::string& text : settings->among) {
    auto choice = parse_choice(text);
    if (!choice) return Failure{"among: " + choice.error()};
    if (choice->name == "auto") return Failure{"among: auto cannot be one of its own candidates"};
    if (Status known = check_integrator(*choice); !known) return Failure{"among: " + known.error()};
  }
  PathSettings path;
  path.max_depth = r.max_depth;
  ChosenIntegrator chosen = chosen_integrator("auto", std::make_unique<PathTracer>(r.scene, r.accel, path));
  note_depth(chosen, r.max_depth);
  return chosen;
}

}  // namespace

IntegratorEntry automatic_entry() {
  return {automatic_spec(), make_automatic, LightSearch::any_length, Content::light,
          bits_of({Ability::layers, Ability::media, Ability::paths})};
}

}  // namespace montelux
