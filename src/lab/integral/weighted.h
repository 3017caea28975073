// Techniques that sample by densities of the user's: importance, mis and ris.
#pragma once
#include "lab/integral/technique.h"

namespace montelux::lab {

std::unique_ptr<Technique> make_importance(const Problem& problem);
std::unique_ptr<Technique> make_mis(const Problem& problem, const Method& method);
std::unique_ptr<Technique> make_ris(const Problem& problem, const Method& method);

}  // namespace montelux::lab
