// False colours: a number in [0, 1] as a colour whose lightness grows evenly.
#pragma once
#include <array>
#include <string_view>

#include "color/spectrum.h"

namespace montelux {

// Colours of viridis and magma (van der Walt and Smith 2015, in the public domain under CC0): nine of each, and between
// them straight lines in Oklab (Ottosson 2020), along which equal steps look equal. Viridis runs from dark violet over
// green to yellow, magma from black over red to pale yellow.
enum class ColorMap { viridis, magma };
inline constexpr std::array<std::string_view, 2> color_map_names{"viridis", "magma"};

// The linear colour at t, which is cut to [0, 1]; not a number counts as 0.
Rgb color_at(ColorMap map, float t);

// A colour for each number, so that neighbouring numbers look different: hues at steps of the golden ratio, in three
// lightnesses. 0 is black: nothing.
Rgb color_of_number(std::uint32_t number);

}  // namespace montelux
