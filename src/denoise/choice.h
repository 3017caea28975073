// How far what a pixel takes depends on the pixels around it.
#pragma once
#include "denoise/padded_image.h"
#include "denoise/weighted_sums.h"

namespace montelux {

// In pixels. Estimated errors are averaged to choose a filter, and further the bias of filters and the noise of the
// image; the choices are averaged in turn: neighbours share what the estimates say.
inline constexpr int choice_reach = 4, bias_reach = 16, choice_spread = 10;
// Of all of these with the mean brightness of 3 x 3 pixels, the filter, the patches that it compares, and the variances
// of features over 5 x 5 pixels.
inline constexpr int reach_of_colors = choice_spread + bias_reach + choice_reach + 1 + filter_reach + patch + 2;

}  // namespace montelux
