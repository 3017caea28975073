// False colours: a number in [0, 1] as a colour whose lightness increases uniformly.
#pragma once
#include <array>
#include <string_view>

#include "color/rgb.h"

namespace montelux {

// Colours of viridis and magma (van der Walt and Smith 2015, in the public domain under CC0): nine of each,
// interpolated linearly in Oklab (Ottosson 2020), where equal steps look equal. Viridis ranges from dark violet through
// green to yellow, magma from black through red to pale yellow.
enum class ColorMap { viridis, magma };
inline constexpr std::array<std::string_view, 2> color_map_names{"viridis", "magma"};

// The linear colour at t, which is clamped to [0, 1]; not a number counts as 0.
Rgb color_at(ColorMap map, float t);

// A colour for each integer, chosen so that neighbouring numbers look different: hues at steps of the golden ratio, in
// three lightnesses. 0 (nothing) is black.
Rgb color_of_number(std::uint32_t number);

}  // namespace montelux
