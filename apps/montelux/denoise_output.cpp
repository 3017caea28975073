#include "denoise_output.h"

#include <fmt/format.h>

#include <cmath>

namespace montelux::cli {

std::string by_whom(const std::string& denoiser) {
  return denoiser.empty() || denoiser == "montelux" ? "" : fmt::format("by {}: ", denoiser);
}

std::string denoising_text(const Denoising& d) {
  return fmt::format("{}{:.3g} % per pixel is left (root mean square of the relative errors, bias included)",
                     by_whom(d.denoiser), 100 * std::sqrt(d.relative_mse));
}

}  // namespace montelux::cli
