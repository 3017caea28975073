// Pass numbers by purpose, so that no two passes ever share random numbers.
#pragma once

namespace montelux::lab {

inline constexpr int reference_pass = 1 << 28, convergence_pass = 1 << 29, pilot_pass = 3 << 28,
                     attribution_pass = 5 << 28, timing_pass = 6 << 28;

}  // namespace montelux::lab
