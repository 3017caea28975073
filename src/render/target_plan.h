// Renders that end when their film has a requested error.
#pragma once
#include "render/render.h"
#include "render/target_judge.h"

namespace montelux {

// Passes over all tiles until a look shows the requested error. Depends only on the film, and so gives the same bits
// for any number of threads; a film that is continued continues as if it had never stopped. Coupled integrators, whose
// passes are series, end by it as well.
class TargetPlan final : public WorkPlan {
 public:
  explicit TargetPlan(const TargetJudge& judge) : judge_(judge), looks_(judge.target().measure) {}
  WorkRound next_round(const Film& film, const PassPlan& passes, const std::function<bool()>& stops) const override;
  std::uint64_t expected_units(const Film& film, const PassPlan& passes) const override;

 private:
  TargetJudge judge_;
  Looks looks_;
};

// A short render of passes of numbers that no other render takes.
struct Pilot {
  Film film;
  std::vector<std::uint64_t> rays;  // of each tile; none of coupled integrators
};
Pilot pilot_of(const AnyIntegrator& integrator, RenderSettings settings, int samples_per_pass, int passes,
               RenderObserver& observer);

// A plan, and the last pilot that it is based on.
struct PlanOfPilot {
  PassPlan plan;
  Pilot pilot;
};

// The plan for a render to a target, of at most `max_samples` samples per pixel. Passes should be as long as possible
// while there are enough of them, so the number of samples is predicted from a few passes of numbers that the render
// itself never takes. Each such pilot has two passes over all pixels, and takes at most a sixteenth of the predicted
// samples (an eighth if the noise is removed); it is replaced by a longer one as long as that is so. Ends early if the
// observer requests a stop.
PlanOfPilot plan_for_target(const AnyIntegrator& integrator, RenderSettings settings, const TargetJudge& judge,
                            int max_samples, RenderObserver& observer);

// The same in two stages: a pilot of about a quarter of the samples decides their number, which the picture of other
// samples then has. Its mean is unbiased whatever the pilot's is.
PlanOfPilot plan_in_two_stages(const AnyIntegrator& integrator, RenderSettings settings, const TargetJudge& judge,
                               int max_samples, RenderObserver& observer);

}  // namespace montelux
