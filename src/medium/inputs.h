// What a model of a medium is built from.
//
// What a scene states of a model is a struct, with
//   static constexpr std::string_view name, meaning;
//   static Fields<...> rows(): its parameters, by which readers, writer and documentation know them;
//   Medium build(const MediumInputs&) const.
#pragma once
#include <functional>

#include "medium/medium.h"
#include "parameter/value.h"

namespace montelux {

template <class S>
class Fields;

// How the scene turns stated spectra into colours.
struct MediumInputs {
  std::function<Rgb(const SpectrumValue&)> coefficient;  // of a quantity without an upper bound
  std::function<Rgb(const SpectrumValue&)> emission;     // of emitted light
};

}  // namespace montelux
