// What the removal of noise came to, for people and for programs.
#pragma once
#include <fmt/format.h>

#include <cmath>
#include <string>

#include "api/denoise.h"

namespace montelux::cli {

// Root of a relative error in percent.
inline double error_percent(double relative_mse) { return 100 * std::sqrt(std::max(relative_mse, 0.0)); }

inline std::string denoising_text(const Denoising& d) {
  return fmt::format("{:.3g} % per pixel is left (root mean square of the relative errors, bias included)",
                     error_percent(d.relative_mse));
}

template <class Json>
Json denoising_json(const Denoising& d) {
  return {{"noisy_mse", d.noisy_mse},
          {"noisy_relative_mse", d.noisy_relative_mse},
          {"mse", d.mse},
          {"relative_mse", d.relative_mse},
          {"filtered_pixels", d.filtered},
          {"seconds", d.seconds}};
}

}  // namespace montelux::cli
