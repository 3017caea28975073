// Which passes of which tiles are rendered, and in which order.
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>

#include "film/film.h"
#include "render/pass_plan.h"

namespace montelux {

// One pass of one tile. Tiles are numbered from 0 in the order of Film::tiles().
struct WorkUnit {
  std::size_t tile = 0;
  int pass = 0;
};

// Units that do not depend on each other. Threads take them in the order of their numbers; units that the film has are
// skipped.
struct WorkRound {
  std::size_t count = 0;
  std::function<WorkUnit(std::size_t)> unit{};  // of a number in [0, count); called by several threads at once
};

// Divides the passes of a plan into rounds. A plan has no state: a round depends only on the film, which contains all
// passes of the rounds before. The film therefore has the same bits for any number of threads, and a saved film
// continues where it stopped.
class WorkPlan {
 public:
  virtual ~WorkPlan() = default;
  // The units to render next, at least one of which the film lacks; none: the render is done. A decision that takes
  // long queries `stops`: true: the render ends, whatever is decided.
  virtual WorkRound next_round(const Film& film, const PassPlan& passes, const std::function<bool()>& stops) const = 0;
  // The expected number of units of all rounds, including those that the film has; for the progress.
  virtual std::uint64_t expected_units(const Film& film, const PassPlan& passes) const = 0;
};

// Every tile gets every pass: one pass over all tiles after the other, in one round.
class PassByPass final : public WorkPlan {
 public:
  WorkRound next_round(const Film& film, const PassPlan& passes, const std::function<bool()>& stops) const override;
  std::uint64_t expected_units(const Film& film, const PassPlan& passes) const override;
};

// How many units of the plan the film has.
std::uint64_t units_of(const Film& film, const PassPlan& passes);

}  // namespace montelux
