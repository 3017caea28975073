#include "render/work_plan.h"

#include <algorithm>

namespace montelux {

WorkRound PassByPass::next_round(const Film& film, const PassPlan& passes, const std::function<bool()>&) const {
  const std::uint64_t units = expected_units(film, passes);
  if (units_of(film, passes) == units) return {};
  const std::size_t tiles = film.tiles().size();
  const auto unit = [tiles, first = passes.first_pass](std::size_t i) {
    return WorkUnit{i % tiles, first + int(i / tiles)};
  };
  return {std::size_t(units), unit};
}

std::uint64_t PassByPass::expected_units(const Film& film, const PassPlan& passes) const {
  return std::uint64_t(film.tiles().size()) * std::uint64_t(passes.passes);
}

std::uint64_t units_of(const Film& film, const PassPlan& passes) {
  std::uint64_t units = 0;
  for (const auto& [index, tile] : film.tiles())
    units +=
        std::uint64_t(std::ranges::count_if(tile.passes, [&](const FilmPass& p) { return passes.contains(p.pass); }));
  return units;
}

}  // namespace montelux
