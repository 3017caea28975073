#include "denoise_output.h"

#include <fmt/format.h>

#include <cmath>

namespace montelux::cli {

std::string denoising_text(const Denoising& d) {
  return fmt::format("{:.3g} % per pixel is left (root mean square of the relative errors, bias included)",
                     100 * std::sqrt(d.relative_mse));
}

}  // namespace montelux::cli
