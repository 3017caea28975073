// Intervals that contain the expectations of pixels, from few passes.
#pragma once
#include "film/film_planes.h"
#include "mc/confidence.h"

namespace montelux {

class Film;

// By channel, for the rows of the bounds from the top. Without an end where a pixel has fewer than two passes.
struct PixelIntervals {
  PixelBounds bounds;
  double confidence = default_confidence;
  ColorPlanes low, high;
};

// The share `confidence` of all pixels, in the mean, has its expectation between `low` and `high`. The interval is the
// mean of the pixel's passes, plus and minus the quantile of Student's t times a standard error that is known from the
// pixel and from the pixels around it that show the like.
//
// The pixel's own standard error fails where few of its samples are bright: it is too small exactly where the mean is
// too low, because both lack the same samples. So it shrinks toward that of its neighbours (empirical Bayes: for a
// scaled inverse chi-square prior the variance is the mean of both, weighted by degrees of freedom, and these add up;
// Gelman et al., Bayesian Data Analysis, 2.6; Smyth 2004). That of the neighbours is the mean of their standard errors,
// not the root of the mean of their variances, which a bright sample that one pixel of a thousand has would determine.
// Pixels whose means surely differ count little. Where the standard errors around the pixel scatter so much that their
// mean is not known, it shrinks in turn toward the mean over a wider neighbourhood, less where that is surely brighter.
// At the edge of a lamp the samples of a pixel may all hit the lamp, or none: the half-width is at least what the part
// of the pixel is worth that they may have missed.
PixelIntervals pixel_intervals(const FilmPlanes& planes, double confidence = default_confidence);
// Requires a film without stride.
PixelIntervals pixel_intervals(const Film& film, double confidence = default_confidence);
// The degrees of freedom of the quantile for a pixel of so many passes among others that show the like.
double interval_freedom(double passes);

}  // namespace montelux
