// Spectra that a scene refers to by name.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "io/reporter.h"
#include "parameter/value.h"

namespace montelux::pbrt {

// Wavelengths and values from pairs; reports errors in them (odd number, not increasing) at `where`.
std::optional<SampledValue> sampled_from_pairs(const std::vector<float>& pairs, const SourceLocation& where,
                                               Reporter& report);

// A spectrum by name, or from a file of pairs in `folder`.
std::optional<SpectrumValue> named_spectrum(const std::string& name, const std::string& folder,
                                            const SourceLocation& where, Reporter& report);

}  // namespace montelux::pbrt
