// Passes where they lower the error most.
#pragma once
#include <vector>

#include "film/error_target.h"
#include "render/target_plan.h"
#include "render/work_plan.h"

namespace montelux {

// A part of an image as a pilot showed it.
struct PilotTile {
  double error = 0;  // the sum over its pixels of what passes lower, of one pass
  double cost = 1;   // of one pass
  double pixels = 1;
};

// How many passes each tile gets where the average is one, so that the error at equal cost is the least: proportional
// to the root of error over cost (Neyman 1934). `columns`: tiles in a row. The errors are noisy, and a pilot may have
// missed a rare sample: each is shrunk toward those of the tiles around it and toward the mean. The mean weighted by
// cost is 1. All are 1 where the pilot shows no error.
std::vector<double> pass_shares(const std::vector<PilotTile>& tiles, int columns);

// The factor by which the squared error at equal cost falls with these shares, if the tiles are as shown.
double expected_gain(const std::vector<PilotTile>& tiles, const std::vector<double>& shares);

// The tiles of an image (as Film names them) as a pilot shows them, and how many of them are in a row. `measure`: what
// is to be lowered.
struct PilotTiles {
  std::vector<PilotTile> tiles;
  int columns = 1;
};
PilotTiles tiles_of_pilot(const Pilot& pilot, TargetMeasure measure, int tile_side);

// Tile t has about `level` times shares[t] passes at each level. The shares come from samples that are not in the film,
// so that its mean stays unbiased. Levels are what passes are to the other plans: looks at the film, if there is a
// target, come after whole levels, and the plan's number of passes is the last level.
class AdaptivePlan final : public WorkPlan {
 public:
  AdaptivePlan(std::vector<double> shares, const std::optional<ErrorTarget>& target);
  WorkRound next_round(const Film& film, const PassPlan& passes) const override;
  std::uint64_t expected_units(const Film& film, const PassPlan& passes) const override;

 private:
  int passes_at(int level, std::size_t tile) const;
  // The last level that the film has all passes of.
  int level_of(const Film& film, const PassPlan& passes) const;

  std::vector<double> shares_;
  std::optional<ErrorTarget> target_;
  Looks looks_;
};

// The side of tiles: small, but of so many samples that packs stay full.
int adaptive_tile_side(int samples_per_pass);

// A pilot of about a fortieth of this number of samples, for renders without a target; none if that is less than two.
std::optional<Pilot> run_pilot(const AnyIntegrator& integrator, RenderSettings settings, int samples,
                               RenderObserver& observer);

}  // namespace montelux
