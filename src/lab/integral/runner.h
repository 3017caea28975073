// Work units of an integral on threads.
#pragma once
#include <span>

#include "lab/integral/technique.h"
#include "work/scheduler.h"

namespace montelux::lab {

// Extends a state by complete parts of passes: all of them, or none if it is stopped. Memory is bounded
// for any number of samples.
class Runner {
 public:
  Runner(const Technique& technique, const Execution& execution, IntegralState& state)
      : technique_(technique),
        traits_(technique.traits()),
        execution_(execution),
        scheduler_(execution.threads),
        state_(state) {}

  // Adds samples [first, first + count) to passes [begin, end) of this run. False: stopped, and the state is unchanged.
  bool add(std::uint32_t begin, std::uint32_t end, std::uint64_t first, std::uint64_t count);

 private:
  struct Unit {
    PassPart part;
    std::uint32_t pass = 0;
    TermSums sums{};
  };

  bool run_all(std::span<Unit> units);
  void enter(std::uint32_t pass, const TermSums& sums);
  PassRecord& record_of(std::uint32_t pass);

  const Technique& technique_;
  TechniqueTraits traits_;
  const Execution& execution_;
  Scheduler scheduler_;
  IntegralState& state_;
  std::size_t last_ = 0;  // the record used last
};

}  // namespace montelux::lab
