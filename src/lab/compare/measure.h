// Comparing films with a reference.
#pragma once
#include "lab/compare/comparison.h"

namespace montelux::lab {

// Mean and variance of the mean of a film's pixels, as images R, G, B. Pixels with one pass have infinite variance.
PixelBuffer mean_of(const Film& film);
PixelBuffer variance_of(const Film& film);

// Everything in a Repeat except time, rays and samples.
Repeat measure(const Film& film, const Reference& reference);

// Mean over pixels and channels of (x - reference)^2 minus the reference's variance.
double squared_error(const PixelBuffer& mean, const Reference& reference);

}  // namespace montelux::lab
