// Rows of parameters that several lights have.
#pragma once
#include "light/stated.h"
#include "parameter/fields.h"

namespace montelux {

constexpr double unlimited_emission = 1e30;

template <class Light>
void power_row(Fields<Light>& fields) {
  fields.optional("power", &Light::power, "total power in watts to which the light is scaled; default: none", -1,
                  unlimited_emission);
}
template <class Light>
void illuminance_row(Fields<Light>& fields, std::string meaning) {
  fields.optional("illuminance", &Light::illuminance, std::move(meaning), -1, unlimited_emission);
}

}  // namespace montelux
