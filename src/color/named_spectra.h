// Spectra that scenes refer to by name, as defined by the pbrt-v4 format.
#pragma once
#include <optional>
#include <string_view>
#include <vector>

#include "color/sampled_spectrum.h"

namespace montelux {

// "metal-X-eta" and "metal-X-k" for X of Ag, Al, Au, Cu, CuZn, MgO, TiO2; "glass-X" (the index) for X of BK7, BAF10,
// FK51A, LASF9, F5, F10, F11 (also by their full names SF5, SF10, SF11); "stdillum-X" for X of A, D50, D65, F1 to F12;
// "illum-acesD60". Illuminants have luminance one (photometric_scale). Nothing for any other name.
std::optional<SampledSpectrum> named_spectrum(std::string_view name);
// All names of the above, sorted.
std::vector<std::string_view> named_spectra();

}  // namespace montelux
