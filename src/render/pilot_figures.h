// What pilots show of the efficiencies of integrators.
#pragma once
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "film/error_target.h"
#include "mc/tail.h"
#include "render/pilot_windows.h"

namespace montelux {

// What a candidate showed of a window; errors are those of one sample.
struct WindowError {
  double pixels = 0, cost = 0;
  double relative = 0;  // sum over pixels of relative squared errors
  double of_sum = 0;    // squared error of the sum over pixels and channels
  double sum = 0;       // its expectation, by all pilots
};

// Sums over a window of what one pilot shows and another one does not. Both have the mean zero.
struct MissingLightOfPilot {
  double light = 0;  // relative to the expectation of each pixel
  double error = 0;  // by how much the squared errors against the other pilot's mean exceed those of its own spread
};

// What two pilots, the first one and another one, show of the same windows.
struct PilotPair {
  std::vector<WindowError> first, other;
  std::vector<MissingLightOfPilot> first_misses, first_shows;
  LargestTerms largest{};  // of the relative squared errors of the other one's pixels
  // The windows are all of a coarse image. Rare light is then looked for: errors of windows are independent, and what
  // is rare for the other one, whose strategies are to include those of the first one, is rare for the first one, too.
  bool is_whole_image = false;
  double first_samples = 0;  // of a pixel or cell
  // Adds what pilots of the same candidates show of more windows.
  void append(const PilotPair& more);
};

// Pilot 0 beside each of the pilots, beginning with itself.
std::vector<PilotPair> pairs_of(std::span<const CandidatePilot> pilots, std::span<const PixelBounds> windows);

// The number of samples of a pixel at which the error is 1: inversely proportional to the squared error that is
// requested. Infinite where the windows do not show it. `weights`: how much each window counts, on average once.
double samples_for_unit_error(const std::vector<WindowError>& errors, std::span<const double> weights,
                              const ErrorTarget& target, std::size_t all_windows);

// The efficiency of a candidate, 1 / (squared error x cost), over that of the first one, with an interval for about
// 95 %, by its last pilot.
struct CandidateRatio {
  std::string name;
  double ratio = 1, low = 0, high = std::numeric_limits<double>::infinity();
  bool finds_more_light = false;  // than the first candidate's pilot, with significance
  // Few bright samples determine its error, which may be far larger: the tail of its squared errors is so heavy that
  // they have no mean (ErrorEstimate::tail_index).
  bool is_unsure = false;
};

// The ratio of efficiencies of the other candidate, of this name, and the first one.
CandidateRatio ratio_of(const std::string& name, PilotPair pair, const ErrorTarget& target, std::size_t all_windows);

}  // namespace montelux
