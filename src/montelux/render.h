// Rendering, and estimates of a picture with their errors.
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "montelux/result.h"

namespace montelux::api {

struct Progress {
  double fraction = 0;   // of the work, or of the time, in [0, 1]
  double elapsed = 0;    // seconds
  double remaining = 0;  // seconds, estimated
  std::uint64_t samples = 0;
};

struct RenderSettings {
  std::optional<int> samples{};             // a pixel; default: what the scene's sampler states, else 16
  std::optional<double> seconds{};          // of wall time, instead of a number of samples
  std::optional<std::uint32_t> seed{};      // default: the scene's, else 0
  int threads = 0;                          // 0: all of the machine. The picture does not depend on it
  std::optional<std::string> integrator{};  // "path", "direct:strategy=ris"; default: the scene's
  std::optional<std::string> sampler{};     // a name of `montelux list samplers`; default: the scene's
  // Called a few times a second, by one thread. Returning false ends the render after the samples in work. What it
  // throws ends the render, too, and becomes the error that render() returns.
  std::function<bool(const Progress&)> progress{};
};

struct Interval {
  double low = 0, high = 0;
};

// The estimate of an expectation, by channel (red, green, blue). It is the mean over passes: independent, identically
// distributed realisations of the picture, so that the spread over them measures the error, however the samples within
// a pass depend on each other.
struct Estimate {
  std::array<double, 3> mean{};            // radiance, W/(m^2 sr), unless the integrator computes something else
  std::array<double, 3> standard_error{};  // of `mean`; infinite where it is not known: below two passes, or no light
  int passes = 0;
  double samples = 0;            // of a pixel; of the whole picture the sum over its pixels
  std::uint64_t non_finite = 0;  // samples that were no finite numbers and are not in the mean

  // The interval that holds the true value with this probability, by Student's t with passes - 1 degrees of freedom;
  // none where the standard error is not known, for another channel than 0, 1 and 2, and for a probability that is not
  // between 0 and 1. It supposes that the distribution of the mean is nearly normal.
  std::optional<Interval> interval(int channel, double probability = 0.95) const;
};

// A rendered picture.
class Picture {
 public:
  struct Parts;
  explicit Picture(std::unique_ptr<Parts> parts);
  Picture(Picture&&) noexcept;
  Picture& operator=(Picture&&) noexcept;
  ~Picture();

  // In pixels.
  int width() const;
  int height() const;
  // Pixel (0, 0) is the upper left one; 0 <= x < width(), 0 <= y < height() is required.
  Estimate pixel(int x, int y) const;
  // Of the mean over all pixels; its error accounts for the correlation between pixels.
  Estimate mean() const;
  // Means of all pixels: red, green, blue, row by row from the top.
  std::vector<float> rgb() const;

  double seconds() const;                  // that the render took
  bool interrupted() const;                // `progress` ended it early
  std::vector<std::string> notes() const;  // what was replaced by what, biased settings: a sentence each

  // .exr with all layers (error, albedo, normal, ...), .hdr and .pfm with the colours, .png and .jpg as for a display.
  // The file is replaced in one step.
  Status write(const std::filesystem::path& file) const;

 private:
  std::unique_ptr<Parts> parts_;
};

// "0.1.0".
std::string version();

}  // namespace montelux::api
