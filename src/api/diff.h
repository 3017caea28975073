// How two images differ, and whether their noise explains it.
#pragma once
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "api/images.h"
#include "image/flip.h"
#include "image/metrics.h"
#include "image/welch.h"

namespace montelux {

// The error bars of an image: one standard deviation of the mean for every pixel.
struct ErrorBars {
  PixelBuffer standard_error;                          // R, G, B
  double degrees_of_freedom;                           // infinite if unknown
  std::optional<std::array<double, 3>> error_of_mean;  // of the whole image, over its passes
  bool pixels_share_samples = false;                   // by integrator and filter, as the header states
};

// An image as an estimate.
struct PictureEstimate {
  PixelBuffer color;              // R, G, B, linear
  bool display = false;           // stored in 8 or 16 bits, so values end at one
  std::optional<ErrorBars> bars;  // if the file, or a separate one, has them
};

struct PictureFiles {
  std::filesystem::path picture;
  std::optional<std::filesystem::path> standard_error;  // R, G, B of this file instead of the image's stderr layer
  std::optional<double> degrees_of_freedom;             // if the image does not state its number of passes
};

// Fails if a file cannot be read, or the sizes of image and error bars differ.
Result<PictureEstimate> read_estimate(const PictureFiles& files);

struct PictureDifference {
  bool equal = false;  // every colour value is the same
  std::array<double, 3> mean_a{}, mean_b{};
  ErrorMeasures measures;
  FlipResult flip;
  bool hdr_flip = false;
  std::optional<WelchReport> welch;  // if both have error bars

  // By the error bars if both have them, by equality otherwise.
  bool differs() const { return welch ? welch->differs : !equal; }
};

// a is the test, b the reference. The level is family-wise. Fails if the sizes differ.
Result<PictureDifference> compare_pictures(const PictureEstimate& a, const PictureEstimate& b, double level);

// Maps of the difference: "relative" (squared, over b^2 + 0.01), "squared", "absolute", "flip".
std::vector<std::pair<std::string, std::string>> difference_maps();
// One channel. Fails for an unknown name.
Result<PixelBuffer> difference_map(std::string_view name, const PictureEstimate& a, const PictureEstimate& b,
                                   const PictureDifference& difference);

// Writes a map with one channel: to .exr, .hdr and .pfm as numbers, to other formats in false colours up to the 99th
// percentile.
Status write_map(const std::filesystem::path& file, const PixelBuffer& map);

}  // namespace montelux
