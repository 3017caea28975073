// Which estimator of a picture is better, by how much, and how sure that is: methods take turns on one scene in
// independent repeats, and every figure has an error bar from these.
#pragma once
#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "image/pixel_buffer.h"
#include "image/welch.h"
#include "lab/compare/attribution.h"
#include "lab/compare/statistics.h"
#include "render/render.h"

namespace montelux::lab {

// One method: an integrator with a point set. The integrator must outlive the contest.
struct Contestant {
  std::string label;  // "a"
  std::string text;   // as it was asked for: "direct:strategy=ris,candidates=32"
  AnyIntegrator integrator;
  PointSetKind sampler = PointSetKind::blue_noise;
  std::vector<std::string> biases;
  std::optional<LayerPlan> layers{};  // that its variance is attributed to; none: the integrator has no layers
};

struct ContestSettings {
  // Bounds, size, seed, threads, clock, and whether the time of warm-up frames counts; sampler and plan are the
  // contestants' own.
  RenderSettings render;
  std::optional<double> seconds;  // for each method, over all repeats; else
  int samples = 64;               // a pixel, in each repeat
  int repeats = 8;
  double confidence = 0.95;
  bool slopes = true;  // render passes of growing length, too
};

// What the methods are held against. `variance` is that of the mean, by pixel and channel; zero where it is exact.
struct Reference {
  PixelBuffer mean, variance;  // R, G, B
  double degrees_of_freedom = 0;
  // Of the image mean, R, G, B, over passes: right where pixels share their errors. None: they are independent.
  std::optional<std::array<double, 3>> variance_of_image{};
  std::string origin;  // "path, 4096 samples a pixel", or a file
};

// One repeat of one method, held against the reference. The reference's own variance has been taken off the squared
// errors, so that they estimate those against the truth without bias; a value may come out negative by chance.
struct Repeat {
  double seconds = 0;                   // that count
  double all_seconds = 0, warm_up = 0;  // all that it took; of these, seconds of frames that are not shown
  double rays = 0, samples = 0;         // of all frames; of those that are shown, a pixel
  double mse = 0, relative_mse = 0, flip = 0;
  double variance = 0;  // that the method's own error bars state, mean over pixels
  double coverage = 0;  // share of pixels whose 95 % interval holds the reference
  double image_mean[3] = {};
};

// The squared error of single passes of 1, 2, 4, ... samples, and the seconds that count.
struct ConvergencePoint {
  double samples = 0;
  Measured mse, seconds;
};

// The same in one repeat; empty without slopes.
struct ConvergenceRun {
  std::vector<double> samples, mse, seconds;
};

// What one method has gathered over its repeats.
struct MethodState {
  PassPlan plan;
  std::vector<Repeat> repeats;
  std::vector<std::vector<float>> luminance;  // of each repeat, one a pixel
  std::vector<ConvergenceRun> convergence;    // of each repeat
  std::vector<AttributionRound> attribution;  // of each repeat, where there are layers
  PixelShares pixel_shares;
  std::vector<PixelEstimate> pixels;  // over the passes of all repeats
  int passes = 0;
  std::uint64_t non_finite = 0;
};

// A contest that can go on. It is a function of the contestants, the settings and the number of rounds, but for the
// times.
struct ContestState {
  Reference reference;
  std::vector<MethodState> methods;
};

struct MethodResult {
  Contestant contestant;
  std::vector<Repeat> repeats;
  Measured seconds, all_seconds, warm_up, rays, samples, mse, relative_mse, flip, variance, coverage;
  Measured efficiency, relative_efficiency;              // 1 / (mse x seconds); 1 / (relative mse x seconds)
  Measured whole_efficiency, whole_relative_efficiency;  // the same by all seconds
  std::vector<ConvergencePoint> convergence;
  Measured slope_by_samples, slope_by_time;   // of log mse
  PixelBuffer mean, standard_error;           // over all repeats
  std::vector<std::vector<float>> luminance;  // of each repeat, one a pixel
  WelchReport bias;                           // against the reference
  Measured bias_squared;  // of luminance, mean over pixels: by products of the errors of different repeats
  std::uint64_t non_finite = 0;
  std::optional<Attribution> attribution;  // where the method has layers
};

// The mean is another than the reference's: that of the image, or pixel by pixel (bias_squared is above zero by more
// than its error explains). Tests of blocks and pixels are in `bias`, and do not count: they take pass means for
// normal, which those of a few samples of a heavy tail are not.
bool differs_from_reference(const MethodResult& m);

// How much more efficient `first` is than `second`.
struct PairVerdict {
  std::size_t first = 0, second = 0;
  Measured ratio, relative_ratio;
  Measured whole_ratio, whole_relative_ratio;  // the same by all seconds
  bool decided = false;
  double times_longer = 1;  // how many times the time would decide it, if the ratio is what it seems
};

struct ContestResult {
  bool warm_up_counts = true;  // in seconds and efficiencies; no: only the time of frames that are shown does
  std::vector<MethodResult> methods;
  std::vector<PairVerdict> verdicts;  // of every pair, by mse
  Reference reference;
  double reference_share = 0;  // the reference's variance over the smallest mse
  bool interrupted = false;
};

// The mean of a picture over its pixels and channels.
double mean_value(const PixelBuffer& image);

// Told between slices; may ask to stop.
struct ContestWatch {
  std::function<bool()> stop;
  std::function<void(double fraction, double elapsed, const std::string& what)> progress;
};

// The smallest mean squared error that the contest is going to see in one repeat, as short pilots say.
double expected_smallest_mse(const std::vector<Contestant>& contestants, const ContestSettings& settings,
                             const ContestWatch& watch);

// A reference by the most efficient of the methods that `may_serve`, with a mean variance of `goal` at most (unless
// that would take more than a million samples a pixel).
Reference make_reference(const std::vector<Contestant>& contestants, const std::vector<std::size_t>& may_serve,
                         const ContestSettings& settings, double goal, const ContestWatch& watch);

// The plan of passes of each method; nothing is gathered yet.
ContestState begin_contest(const std::vector<Contestant>& contestants, Reference reference,
                           const ContestSettings& settings);
// So many rounds more. Repeats are numbered through, and no two share random numbers. False where it was stopped; what
// was under way is then left out.
bool run_rounds(const std::vector<Contestant>& contestants, const ContestSettings& settings, int rounds,
                const ContestWatch& watch, ContestState& state);
ContestResult result_of(const std::vector<Contestant>& contestants, const ContestState& state,
                        const ContestSettings& settings);
// All of it: settings.repeats rounds.
ContestResult run_contest(const std::vector<Contestant>& contestants, Reference reference,
                          const ContestSettings& settings, const ContestWatch& watch);

}  // namespace montelux::lab
