// Work on parts of an image that do not depend on each other.
#pragma once
#include <algorithm>
#include <cstddef>
#include <stdexcept>

#include "denoise/denoise.h"
#include "work/scheduler.h"

namespace montelux {

// Calls f(unit) for each unit in [0, count), by all threads of the settings. Throws std::runtime_error if it was
// stopped.
template <class Function>
void for_each_unit(std::size_t count, const DenoiseSettings& settings, Function f) {
  Scheduler scheduler(settings.threads);
  if (scheduler.run(count, [&](std::size_t unit, int) { f(unit); }, {0, settings.stop}) < count)
    throw std::runtime_error("the removal of noise was interrupted");
}

// Calls f(i) for each i in [0, pixels), by all threads of the settings.
template <class Function>
void for_each_pixel_in_parallel(std::size_t pixels, const DenoiseSettings& settings, Function f) {
  constexpr std::size_t band = 16384;
  for_each_unit((pixels + band - 1) / band, settings, [&](std::size_t unit) {
    for (std::size_t i = unit * band; i < std::min((unit + 1) * band, pixels); ++i) f(i);
  });
}

}  // namespace montelux
