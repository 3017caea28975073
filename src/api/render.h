// Rendering a scene, and the picture with everything that is known of it.
#pragma once
#include "api/denoise.h"
#include "api/frames.h"
#include "api/layers.h"
#include "api/scene.h"
#include "film/intervals.h"
#include "image/display.h"
#include "image/image_file.h"
#include "math/result.h"
#include "mc/confidence.h"
#include "render/render.h"

namespace montelux {

// Files that a picture will be written to.
struct FilesToWrite {
  std::vector<std::filesystem::path> paths;
  bool half = false;  // of an .exr, as write_rendering() has it
};

struct SavedFilm;  // api/saved_film.h

// Passes by their numbers, the last one included.
struct PassRange {
  int first = 0, last = 0;
  int count() const { return last - first + 1; }
  bool operator==(const PassRange&) const = default;
};

// A file in which the film is saved now and then, and at the end.
struct FilmCheckpoint {
  std::filesystem::path file;
  double every = 300;  // seconds
};

// An error at which a render ends.
struct TargetRequest {
  ErrorTarget error;
  // Two stages: a pilot decides the number of samples, and the picture has others.
  bool unbiased = false;
};

struct RenderOptions {
  std::optional<int> samples;           // a pixel; default: what the file states
  std::optional<double> seconds;        // instead of a number of samples; includes preparation and what follows
  FilesToWrite files{};                 // `seconds` includes the time to encode them
  std::optional<double> budget;         // seconds: whole frames of one series, or passes of one sample, as many as fit
  std::optional<TargetRequest> target;  // the samples that reach it; `samples` or `seconds` are then the most
  std::optional<bool> adaptive;         // more passes where they lower the error most; default: no
  std::optional<std::uint32_t> seed;    // default: the file's
  int threads = 0;                      // 0: all of the machine
  std::optional<PixelBounds> crop;      // within the picture; default: the file's
  std::optional<std::string> integrator;                      // "path", "direct:strategy=ris"; default: the file's
  std::vector<std::pair<std::string, std::string>> settings;  // of the integrator: name, value as text
  std::optional<std::string> preset;                          // integrator and samples, by name; see preset_names()
  std::optional<std::string> sampler;                         // name of a point set; default: the file's
  std::optional<LayerRequest> layers;                         // of an integrator that has them
  bool denoise = false;                                       // remove noise; adds the layers of both halves
  std::optional<std::string> denoiser;                        // by this filter, as parse_denoiser() takes it
  std::optional<bool> shared_filters;   // count for all pixels whose filters contain them; default: where that pays
  std::optional<ShutterTimes> shutter;  // default: the file's
  bool measure_bias = false;            // by paired samples of an unbiased integrator
  std::optional<int> samples_per_pass;  // default: by the number of samples
  std::optional<PassRange> passes;      // only these, of those that the samples make
  std::optional<FilmCheckpoint> checkpoint;
  SavedFilm* resume = nullptr;  // to be continued, with the options that take_options() gives; its film is moved from

  // By request, with a filter that is requested, or for the error that is requested.
  bool removes_noise() const;
  // The layers, with those that other options need.
  std::optional<LayerRequest> all_layers() const;
};

// What became of a requested error.
struct TargetResult {
  TargetRequest request;
  TargetState state;
  double samples = 0, seconds = 0;  // of a pixel, and of the render
  bool reached() const { return state.reaches(request.error); }
  // What a render with `work` times the samples, as TargetState has it, would take in addition.
  double more_samples(double work) const { return samples * (work > 1 ? work - 1 : 0); }
  double more_seconds(double work) const { return seconds * (work > 1 ? work - 1 : 0); }
};

// What --integrator auto chose, and why.
struct AutomaticChoice {
  std::string integrator;  // "restir-pt"
  std::string reason;      // a part of a sentence
  double share = 0;        // of the work, that pilots took
  // Of the candidates that were measured: the efficiency over that of path, with an interval for about 95 %.
  struct Ratio {
    std::string integrator;
    double ratio = 1, low = 0, high = 0;
  };
  std::vector<Ratio> ratios{};
};
// "restir-pt: 4.2 (3.1 to 5.6) times as efficient as path; pilots took 3.9 % of the work".
std::string to_text(const AutomaticChoice& choice);

// A rendered picture, its error and its layers.
struct Rendering {
  RenderResult result;
  std::vector<Attribute> header;   // seed, passes, samples, biased options, non-finite count, version, ...
  std::vector<std::string> notes;  // for the user: what was replaced by what
  PassPlan plan;
  std::optional<LayerPlan> layers;
  std::size_t history_bytes = 0;                // that the series of a sequence keep for the next picture
  std::optional<PixelBuffer> motion;            // to the picture before, as motion_vectors() has it
  ImageEstimate image;                          // the mean of the whole picture
  ErrorEstimate error;                          // of the pixels
  std::optional<TargetResult> target{};         // if an error was requested
  std::optional<BiasEstimate> measured_bias{};  // of the mean, where the integrator measures it in two passes or more
  std::vector<std::string> missing{};           // sorts of light of the scene that the integrator cannot find
  std::vector<Replacement> replaced{};          // of what the file names and no option replaces
  std::vector<std::string> left_out{};          // by a lenient reading, as SceneInfo has it
  Content content = Content::light;             // what the colours hold
  bool has_own_exposure = false;                // the scene states one
  bool found_no_light = false;                  // every sample of a picture of light is zero: no error can be estimated
  Status saved{Done{}};                         // of the checkpoint's last writing
  std::optional<DenoisedLayers> denoised{};     // if requested and possible
  std::optional<PixelIntervals> intervals{};    // likewise
  std::optional<AutomaticChoice> choice{};      // of the integrator, if none was stated
  int threads = 0;                              // that write its files; 0: all of the machine
  // Whether a standard error of the mean is known: it takes two independent passes, and light.
  bool has_error_bar() const { return image.passes >= 2 && !found_no_light; }
  // Whether the error of the pixels is: it takes two passes of each, and light.
  bool has_pixel_error() const { return error.whole() && !found_no_light; }
  // The interval that holds the true mean of a channel of the picture with this probability, by Student's t over the
  // passes; none where there is no error bar.
  std::optional<Interval> interval_of_mean(int channel, double confidence = default_confidence) const;
};

// What changes from one picture of a sequence to the next.
struct SequencePicture {
  std::uint32_t seed = 0;
  ShutterTimes shutter, before;  // of this picture, and of the one before it
  bool is_last = false;          // nothing is kept for another one
};

// Pictures of one scene with the same options, one after the other: what an integrator prepares is prepared once, and
// the state of its series continues from each image to the next, where possible.
class PictureSequence {
 public:
  // Fails as render_scene() does. The scene must outlive it.
  static Result<PictureSequence> prepare(const LoadedScene& scene, const RenderOptions& options);
  ~PictureSequence();
  PictureSequence(PictureSequence&&) noexcept;

  // With this seed and shutter instead of the options'.
  Rendering render(const SequencePicture& picture, RenderObserver& observer);

 private:
  struct State;
  explicit PictureSequence(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

// Fails where an option does not fit the scene (an unknown integrator, setting or sampler, a crop outside the picture,
// layers of an integrator that has none).
Result<Rendering> render_scene(const LoadedScene& scene, const RenderOptions& options, RenderObserver& observer);

// The layers of the picture under the names that other tools expect: R, G, B, A; stderr.R ...; albedo.R ...; N.X ...;
// P.X ...; Z; samples; id. Both halves of the passes are first_half.R ..., denoise() adds its layers. Intervals
// are low.R ..., high.R .... Then the
// requested layers of light: bounce0.R ..., Combined_key.R ..., with errors bounce0_stderr.R ..., and with halves
// first_half_bounce0.R .... Each family of these sums to R, G, B: exactly in the film, here to rounding. Motion is
// motion.X, motion.Y.
PixelBuffer layers_of(const Rendering& rendering);

// How an 8-bit picture shows the colours (those without noise if there are any), by the request and by the image
// itself.
ChosenDisplay choose_display(const Rendering& rendering, const DisplayRequest& request);

// Writes .exr with all layers, .hdr and .pfm with the colour alone, .png and .jpg through the display transform. The
// file is replaced in one step. `half`: of an .exr, light, albedo, normals and coverage as 16-bit floats; standard
// errors, places, depths, counts and numbers of objects stay 32-bit floats.
Status write_rendering(const std::filesystem::path& file, const Rendering& rendering, const DisplayTransform& display,
                       bool half = false);

// What a picture of this size takes once its last sample is there, in seconds of one thread.
struct FinishTime {
  double error = 0;     // to estimate its error and its intervals, and to remove its noise
  double encoding = 0;  // for its files
  double coarse = 0;    // for those of a picture that samples one pixel of 4 x 4
  double even = 0;      // for those of a picture of one color
  // For the files of a picture that samples one pixel of stride x stride: their size, and so the time, falls about as
  // the length of the edges between such squares.
  double encoding_of(int stride) const {
    constexpr double coarse_stride = 4;
    if (stride >= coarse_stride) return even + (coarse - even) * coarse_stride / stride;
    const double share = (1.0 / stride - 1 / coarse_stride) / (1 - 1 / coarse_stride);
    return coarse + (encoding - coarse) * share;
  }
};
// What is done with a picture before it is written.
struct PictureSteps {
  bool denoise = false, intervals = false;
  std::size_t earlier_images = 0;  // of a sequence, which help to remove the noise
  std::optional<LayerPlan> layers = {};
  std::shared_ptr<const ColorFilter> filter = {};  // as DenoiseOptions has it
  int threads = 0;                                 // 0: all of the machine
};
// Measured on a strip of noise, which takes some percent of that time itself.
FinishTime seconds_to_finish(const PixelBounds& bounds, const FilesToWrite& files, PictureSteps steps = {});

// Sorts of light that the scene's own integrator, with the scene's settings, cannot find: a line each.
std::vector<std::string> missing_light_of(const LoadedScene& scene);

// Whether there is such an integrator with such settings, "direct:strategy=ris"; a scene is not needed to tell.
Status check_integrator_text(const std::string& text);

// Names that --integrator and --sampler take, with a line for each.
std::vector<std::pair<std::string, std::string>> integrator_names();
std::vector<std::pair<std::string, std::string>> sampler_names();
// Integrators with numbers of samples, as published comparisons have them.
std::vector<std::pair<std::string, std::string>> preset_names();

// "0.1.0".
std::string version();

}  // namespace montelux
