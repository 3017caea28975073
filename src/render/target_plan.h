// Renders that end when their film has a requested error.
#pragma once
#include "film/error_target.h"
#include "render/render.h"

namespace montelux {

// Looks at a film after whole passes over all tiles, at numbers of passes that grow by an eighth or by one. The
// probability of a wrong statement is spent over the looks (alpha spending, Lan and DeMets 1983). Most of it is spent
// where renders are planned to end, at 8 to 16 passes (plan_passes()), or, for the error of the mean, at 24 to 48: 16 %
// by the four looks before, 48 % by the next eight, 24 % by eight more, and of the rest the share
// 1 / ((i + 1) (i + 2)) by each look i = 0, 1, ... after these (Howard, Ramdas, McAuliffe and Sekhon 2021).
class Looks {
 public:
  explicit Looks(const ErrorTarget& target) : first_(target.measure == TargetMeasure::mean ? 8 : 4) {}
  // The first look after this number of passes.
  int after(int passes) const;
  bool is_look(int passes) const { return passes >= first_ && after(passes - 1) == passes; }
  // The share that a look at this number of passes spends; of a number between two looks, that of the later one.
  double spent(int passes) const;

 private:
  int first_;
};

// Passes over all tiles until a look shows the requested error. Depends only on the film, and so gives the same bits
// for any number of threads; a film that is continued continues as if it had never stopped. Coupled integrators, whose
// passes are series, end by it as well.
class TargetPlan final : public WorkPlan {
 public:
  explicit TargetPlan(const ErrorTarget& target) : target_(target), looks_(target) {}
  WorkRound next_round(const Film& film, const PassPlan& passes) const override;
  std::uint64_t expected_units(const Film& film, const PassPlan& passes) const override;

 private:
  ErrorTarget target_;
  Looks looks_;
};

// What is known of a whole film against the target, by the passes of the tile that has most. `single_look`: the film's
// number of samples does not depend on it.
TargetState judge(const ErrorTarget& target, const Film& film, bool single_look);

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
// samples; it is replaced by a longer one as long as that is so. Ends early if the observer requests a stop.
PlanOfPilot plan_for_target(const AnyIntegrator& integrator, RenderSettings settings, const ErrorTarget& target,
                            int max_samples, RenderObserver& observer);

// The same in two stages: a pilot of about a quarter of the samples decides their number, which the picture of other
// samples then has. Its mean is unbiased whatever the pilot's is.
PlanOfPilot plan_in_two_stages(const AnyIntegrator& integrator, RenderSettings settings, const ErrorTarget& target,
                               int max_samples, RenderObserver& observer);

}  // namespace montelux
