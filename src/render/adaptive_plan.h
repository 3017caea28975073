// Passes where they lower the error most.
#pragma once
#include <optional>
#include <vector>

#include "film/error_target.h"
#include "render/target_plan.h"
#include "render/work_plan.h"

namespace montelux {

// Tile t has about `level` times shares[t] passes at each level, and at least the first ones, which all tiles have. The
// shares of a tile come from samples that are not its own, except for means over all tiles (see pass_shares()). Levels
// are what passes are to the other plans: looks at the film, if there is a target, come after whole levels, and the
// plan's number of passes is the last level.
class AdaptivePlan final : public WorkPlan {
 public:
  AdaptivePlan(std::vector<double> shares, int first_passes, const std::optional<TargetJudge>& judge);
  WorkRound next_round(const Film& film, const PassPlan& passes, const std::function<bool()>& stops) const override;
  std::uint64_t expected_units(const Film& film, const PassPlan& passes) const override;

 private:
  int passes_at(int level, std::size_t tile) const;
  // The last level that the film has all passes of.
  int level_of(const Film& film, const PassPlan& passes) const;

  std::vector<double> shares_;
  int first_passes_;
  std::optional<TargetJudge> judge_;
  Looks looks_;
};

// The side of tiles: small, but of so many samples that packs stay full.
int adaptive_tile_side(int samples_per_pass);

// A tile of fewer passes has no usable error.
inline constexpr int min_adaptive_passes = 4;

// How many of the passes of an image all tiles have: a quarter, and not too few to know an error. None: there are too
// few passes to give some tiles more than others.
std::optional<int> first_passes(int passes);

// The first passes of an adaptive image, the shares of the tiles in all of its passes that they decide, and whether
// they are complete.
struct FirstPart {
  BegunFilm begun;
  std::vector<double> shares;
  bool is_complete = false;
};

// Renders the passes of the settings' plan, which are this share of the image's; 0 if that is not known. The progress
// is that of the whole image.
FirstPart render_first_part(const AnyIntegrator& integrator, const RenderSettings& settings, TargetMeasure measure,
                            double share, RenderObserver& observer);

}  // namespace montelux
