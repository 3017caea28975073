// Techniques whose pass is one structure that cannot be cut: vegas, miser and metropolis.
#pragma once
#include "lab/integral/technique.h"

namespace montelux::lab {

std::unique_ptr<Technique> make_vegas(const Problem& problem, std::uint64_t seed, const MapTraining& training);
std::unique_ptr<Technique> make_miser(const Problem& problem);
std::unique_ptr<Technique> make_metropolis(const Problem& problem, const Method& method);

// The sums of a part of `samples` samples that is known by its estimate and the estimate's variance; `terms` holds the
// single terms that went into it, and the counts.
TermSums sums_of_estimate(double mean, double variance, std::uint64_t samples, const TermSums& terms);

}  // namespace montelux::lab
