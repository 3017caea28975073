// Renders a film: gives the passes of tiles to threads, until the plan is done or a rule stops the render.
#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "film/film.h"
#include "integrator/integrator.h"
#include "render/image_settings.h"
#include "render/keeping.h"
#include "render/measured_bias.h"
#include "render/memories.h"
#include "render/observer.h"
#include "render/pass_plan.h"
#include "render/stopping_rule.h"
#include "render/stopwatch.h"
#include "render/target_judge.h"
#include "render/work_plan.h"

namespace montelux {

struct RenderSettings {
  ImageSettings image;                        // what is measured
  PassPlan plan;                              // with how many samples, in which passes
  std::shared_ptr<const WorkPlan> work;       // in which order; null: PassByPass. It ends series, too
  std::shared_ptr<const StoppingRule> stop;   // when it stops before the plan is done; null: never
  std::optional<TargetJudge> target;          // whose time left the progress shows; a rule or a plan ends the render
  BegunFilm* begun = nullptr;                 // the film to continue, of the same image; it is moved from
  FilmKeeping keeping;                        // where the film is saved; nowhere if `keep` is empty
  SequenceSettings sequence;                  // what series keep for the next image
  int threads = 0;                            // 0: all of the machine
  SecondsClock clock;                         // of the rule and of the result's time; empty: the machine's
  const PixelIntegrator* unbiased = nullptr;  // the same without its limits, to measure their bias; or null
};

struct RenderResult {
  Film film;
  RayCounts rays;
  double seconds = 0;        // including those of a film that is continued
  bool interrupted = false;  // the observer requested a stop before the plan was done
  double ending = 0;         // of the seconds, those after the last frame; only with series or synchronous passes
  double warm_up = 0;        // of the seconds, those of frames that are not shown, without beginning and ending series
  int forgotten = 0;         // series that stored no memory because it did not fit
  int frames = 0;            // of series, including those that are not shown
  BiasOfPasses bias{};       // as far as the integrator measures it
  MixingOfPasses mixing{};   // of integrators with Markov chains
  std::vector<std::uint64_t> rays_of_tiles{};  // in their order; only of pixel integrators
  double shown_seconds() const { return seconds - warm_up; }
};

// The film has the same bits for any number of threads, unless a rule or the observer stops the render.
RenderResult render(const AnyIntegrator& integrator, const RenderSettings& settings, RenderObserver& observer);

}  // namespace montelux
