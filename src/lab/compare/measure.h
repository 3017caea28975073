// Holding films against a reference.
#pragma once
#include "lab/compare/comparison.h"

namespace montelux::lab {

// Mean and variance of the mean of a film's pixels, as pictures R, G, B. Pixels of one pass have infinite variance.
PixelBuffer mean_of(const Film& film);
PixelBuffer variance_of(const Film& film);

// Everything of a Repeat but time, rays and samples.
Repeat measure(const Film& film, const Reference& reference);

// Mean over pixels and channels of (x - reference)^2 less the reference's variance.
double squared_error(const PixelBuffer& mean, const Reference& reference);

}  // namespace montelux::lab
