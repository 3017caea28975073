// Removal of noise from images, with an estimate of the error that is left.
#pragma once
#include <array>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "denoise/reproject.h"
#include "image/image_file.h"
#include "math/result.h"
#include "render/target_judge.h"

namespace montelux {

class ColorFilter;
class Film;
struct LayerPlan;

struct DenoiseOptions {
  int threads = 0;                  // 0: all of the machine
  std::function<bool()> stop = {};  // queried now and then: true ends it early
  // Of a file: the images of the sequence before it, the latest first, rendered with independent samples and with the
  // layers of both halves. The image has motion vectors, and so has each of these but the last.
  std::vector<std::filesystem::path> before = {};
  // Of a film: the names of its layers of light, all of which are filtered as well; none: they are not.
  std::vector<std::string> layers = {};
  std::shared_ptr<const ColorFilter> filter = {};  // as parse_denoiser() has it; null: ours
  // Called now and then, by one thread at a time, with the share that is done.
  std::function<void(double)> progress = {};
};

// For a film with these layers of light.
DenoiseOptions denoise_options(const std::optional<LayerPlan>& layers, int threads,
                               std::shared_ptr<const ColorFilter> filter);

// Estimated mean squared errors before and after, over channels and pixels. The relative ones are divided by the square
// of the filtered image, plus 0.01.
struct Denoising {
  std::string denoiser;  // its name, and the version of one that is not ours
  double noisy_mse = 0, noisy_relative_mse = 0;
  double mse = 0, relative_mse = 0;  // bias included
  double unfiltered = 0;             // of relative_mse, noise of pixels that the filter leaves as it is
  double relative_deviation = 0;     // the standard deviation of relative_mse
  double filtered = 0;               // share of the pixels that changed
  double seconds = 0;
};

// The layers denoised.R, .G, .B and denoised_error.R, .G, .B (root of the estimated mean squared error, bias included),
// and what is known of them. For each layer NAME of light also denoised_NAME.R, .G, .B, and denoised_error_NAME.R, .G,
// .B where its standard error is known. Our filter keeps sums: the layers of a family sum to `denoised`.
struct DenoisedLayers {
  PixelBuffer layers;
  Denoising estimate;
};

// Fails where the film has no halves, or no pixel with a pass in each of them, or where it was stopped.
Result<DenoisedLayers> denoise(const Film& film, const DenoiseOptions& options = {});

// The layers that a judge has made last, so that an image that has been judged is not filtered again.
class JudgedLayers {
 public:
  void keep(const Film& film, DenoisedLayers layers);
  // Those of this film, which are then gone; nothing if they are of another.
  std::optional<DenoisedLayers> take(const Film& film);

 private:
  std::optional<FilmMark> film_;
  std::optional<DenoisedLayers> layers_;
};

// Judges films, which have halves if the target is the error that is left. `kept`, if there is one, keeps the layers of
// the last of these. `filter`: as DenoiseOptions has it.
TargetJudge judge_of(const ErrorTarget& target, int threads, std::shared_ptr<JudgedLayers> kept = {},
                     std::shared_ptr<const ColorFilter> filter = {});

// The images of a sequence, whose noise is removed one after the other: the last few before an image help it, as
// DenoiseOptions::before does. Their samples must be independent. By our own filter.
class SequenceDenoiser {
 public:
  // `motion`: from this image to the one before, as motion_vectors() has it. Fails as denoise() does; the next image
  // then has none before it.
  Result<DenoisedLayers> denoise(const Film& film, const PixelBuffer& motion, const DenoiseOptions& options = {});
  // The next image has none before it.
  void forget() { earlier_.clear(); }

  // Each takes as much time as the image itself, and 140 bytes of memory per pixel.
  static constexpr std::size_t max_earlier = 2;

 private:
  struct Earlier {
    NoisyImage image;
    MotionPlanes motion;  // to the image before it
  };
  std::deque<Earlier> earlier_;  // the latest first
};

// An .exr that was rendered with the layers of both halves, and the layers above, which it loses if it had them.
struct DenoisedFile {
  Image image;
  PixelBuffer layers;
  Denoising estimate;

  // With all layers. This must outlive it.
  ImageRows rows() const;
};
Result<DenoisedFile> denoise_file(const std::filesystem::path& file, const DenoiseOptions& options = {});

// Entries of a header.
std::vector<Attribute> header_of(const Denoising& estimate);

// Names of the layers of both halves: colours, the part of them that the camera sees directly of emitters, albedos,
// normals, and the share of the passes. The colours of the layer NAME of light are first_half_NAME and
// second_half_NAME.
struct HalfLayerNames {
  std::string_view color, emission, albedo, normal, share;
  std::string of_layer(std::string_view name) const { return std::string(color).append("_").append(name); }
};
inline constexpr std::array<HalfLayerNames, 2> half_layer_names{
    {{"first_half", "first_half_emission", "first_half_albedo", "first_half_N", "first_half.share"},
     {"second_half", "second_half_emission", "second_half_albedo", "second_half_N", "second_half.share"}}};

// The number of rays of both halves that show their emission.
inline constexpr std::string_view emission_rays_layer = "emission_rays";

}  // namespace montelux
