// What the file of a picture says about itself.
#pragma once
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "image/image_file.h"
#include "math/result.h"
#include "mc/confidence.h"

namespace montelux {

// A layer and its channels: "stderr" and R, G, B. The name is empty for those that have none.
struct LayerChannels {
  std::string name;
  std::vector<std::string> channels;
};

// Of the mean of the picture, by channel.
struct MeanOfFile {
  std::array<double, 3> mean{};
  std::optional<std::array<double, 3>> standard_error;
  std::optional<std::array<Interval, 3>> interval;  // by Student's t over the passes
};

// The bias of the mean, as measured by the render.
struct BiasOfFile {
  std::array<double, 3> mean{}, standard_error{};
};

struct RelativeErrorOfFile {
  double relative_mse = 0, low = 0, high = 0;
  bool is_unsure = false;  // few bright samples determine it
};

// What the header states; texts are empty, and numbers absent, where it does not state them.
struct RenderFacts {
  std::string version, scene, integrator, sampler;
  std::string biased_options, missing_light, replaced, left_out;  // "none", or what it is
  std::string error_bar, sparse;
  std::string target, target_reached;
  std::optional<double> seed, passes, samples_per_pass, non_finite, seconds;
  std::optional<double> interval_confidence;  // of the layers low and high
  std::optional<MeanOfFile> mean;
  std::optional<BiasOfFile> bias;
  std::optional<RelativeErrorOfFile> error;
  std::optional<double> missing_by_chance;  // over the mean, where it may be much
  std::string denoiser;                     // empty in images of older versions
  std::optional<double> denoised_relative_mse;
};

// Of the pixels of an image.
struct SampleCounts {
  double min = 0, mean = 0, max = 0;
};

struct PictureInfo {
  int width = 0, height = 0;
  std::vector<LayerChannels> layers;    // in the order of the file
  std::optional<SampleCounts> samples;  // if there is such a layer
  std::optional<RenderFacts> render;    // if Montelux rendered it
  std::vector<Attribute> header;        // all entries "montelux:NAME", as NAME
};

// Fails if it cannot be read. `confidence`: of the interval of the mean.
Result<PictureInfo> picture_info(const std::filesystem::path& file, double confidence = default_confidence);

}  // namespace montelux
