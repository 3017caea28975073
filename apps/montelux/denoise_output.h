// What the removal of noise came to, for people and for programs.
#pragma once
#include <string>

#include "api/denoise.h"

namespace montelux::cli {

// "by oidn 2.3.0: "; an empty text for our own filter.
std::string by_whom(const std::string& denoiser);

// The error that is left, in a line.
std::string denoising_text(const Denoising& d);

template <class Json>
Json denoising_json(const Denoising& d) {
  return {{"denoiser", d.denoiser}, {"noisy_mse", d.noisy_mse},       {"noisy_relative_mse", d.noisy_relative_mse},
          {"mse", d.mse},           {"relative_mse", d.relative_mse}, {"filtered_pixels", d.filtered},
          {"seconds", d.seconds}};
}

}  // namespace montelux::cli
