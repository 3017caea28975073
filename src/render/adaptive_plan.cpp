#include "render/adaptive_plan.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "render/pass_shares.h"

namespace montelux {

namespace {

// The progress of the first part of an image as that of the whole.
class FirstPartObserver final : public RenderObserver {
 public:
  FirstPartObserver(double share, RenderObserver& other) : share_(share), other_(other) {}
  void progress(const Progress& of_part) override {
    if (of_part.finished) return;
    Progress whole = of_part;
    whole.fraction *= share_;
    whole.remaining = whole.fraction > 0 ? whole.elapsed * (1 / whole.fraction - 1) : 0;
    other_.progress(whole);
  }
  bool stop_requested() override { return other_.stop_requested(); }

 private:
  double share_;
  RenderObserver& other_;
};

}  // namespace

AdaptivePlan::AdaptivePlan(std::vector<double> shares, int first_passes, const std::optional<TargetJudge>& judge)
    : shares_(std::move(shares)),
      first_passes_(first_passes),
      judge_(judge),
      looks_(judge ? judge->target().measure : TargetMeasure::relative) {}

int AdaptivePlan::passes_at(int level, std::size_t tile) const {
  return std::max(std::min(level, first_passes_),
                  int(std::lround(std::min(level * shares_[tile], double(endless_passes)))));
}

int AdaptivePlan::level_of(const Film& film, const PassPlan& passes) const {
  int low = 0, high = passes.passes;
  while (low < high) {
    const int middle = low + (high - low + 1) / 2;
    std::size_t number = 0;
    bool has_all = true;
    for (const auto& [index, tile] : film.tiles()) has_all &= int(tile.passes.size()) >= passes_at(middle, number++);
    has_all ? low = middle : high = middle - 1;
  }
  return low;
}

WorkRound AdaptivePlan::next_round(const Film& film, const PassPlan& passes, const std::function<bool()>& stops) const {
  const int level = level_of(film, passes);
  if (level >= passes.passes) return {};
  bool is_whole = true;
  std::size_t number = 0;
  for (const auto& [index, tile] : film.tiles()) is_whole &= int(tile.passes.size()) == passes_at(level, number++);
  if (judge_ && is_whole && looks_.is_look(level) && judge_->is_reached(film, stops)) return {};
  const int end = std::min(looks_.after(level), passes.passes);
  // Level by level, so that a render that is stopped has about the same shares.
  std::vector<WorkUnit> units;
  for (int of_level = level + 1; of_level <= end; ++of_level)
    for (std::size_t tile = 0; tile < shares_.size(); ++tile)
      for (int pass = passes_at(of_level - 1, tile); pass < passes_at(of_level, tile); ++pass)
        units.push_back({tile, passes.first_pass + pass});
  const std::size_t count = units.size();
  return {count, [all = std::move(units)](std::size_t i) { return all[i]; }};
}

std::uint64_t AdaptivePlan::expected_units(const Film&, const PassPlan& passes) const {
  std::uint64_t units = 0;
  for (std::size_t tile = 0; tile < shares_.size(); ++tile) units += std::uint64_t(passes_at(passes.passes, tile));
  return units;
}

int adaptive_tile_side(int samples_per_pass) {
  constexpr int samples = 256;
  int side = 4;
  while (side < 32 && side * side * samples_per_pass < samples) side *= 2;
  return side;
}

std::optional<int> first_passes(int passes) {
  if (passes < 2 * min_adaptive_passes) return std::nullopt;
  return std::max(passes / 4, min_adaptive_passes);
}

FirstPart render_first_part(const AnyIntegrator& integrator, const RenderSettings& settings, TargetMeasure measure,
                            double share, RenderObserver& observer) {
  FirstPartObserver of_part(share, observer);
  RenderResult result = render(integrator, settings, of_part);
  const bool is_complete =
      units_of(result.film, settings.plan) == PassByPass{}.expected_units(result.film, settings.plan);
  std::vector<double> shares;
  if (is_complete)
    shares = pass_shares(figures_of(result.film, result.rays_of_tiles, measure, settings.plan.tile_side()), share);
  BegunFilm begun{std::move(result.film), result.rays, result.seconds, {}, {}, std::move(result.rays_of_tiles)};
  return {std::move(begun), std::move(shares), is_complete};
}

}  // namespace montelux
