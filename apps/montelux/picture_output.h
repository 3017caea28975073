// What a picture came to, for people and for programs.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "api/render.h"

namespace montelux::cli {

// What a render came to, in numbers.
struct Outcome {
  ImageEstimate image;
  ErrorEstimate error;
  double samples = 0;  // in all pixels
  std::uint64_t rays = 0, non_finite = 0;
};

Outcome outcome_of(const Rendering& rendering);

// A sentence on light that may be missing because paths meet it by chance; `share`: of the picture's mean.
std::string missing_text(double share);

// What is reported of a picture besides itself.
struct PictureReport {
  std::string scene;
  std::vector<std::string> files;
  std::optional<std::string> film;  // file of the saved film
  std::uint32_t seed = 0;
  std::optional<int> frame;  // of a sequence, with its shutter
  std::optional<ShutterTimes> shutter;
  std::optional<double> budget;            // seconds
  const ChosenDisplay* display = nullptr;  // of files of 8 bits
};

void print_picture_text(const PictureReport& report, const Rendering& rendering);
// An object; of a frame in one line.
void print_picture_json(const PictureReport& report, const Rendering& rendering);

}  // namespace montelux::cli
