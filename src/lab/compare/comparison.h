// Which estimator of an image is better, by how much, and with what confidence: methods take turns on one scene in
// independent repeats, from which every figure gets an error bar.
#pragma once
#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "image/pixel_buffer.h"
#include "image/welch.h"
#include "lab/compare/agreement.h"
#include "lab/compare/attribution.h"
#include "lab/compare/error_measure.h"
#include "lab/compare/statistics.h"
#include "render/render.h"

namespace montelux::lab {

// One method: an integrator with a point set. The integrator must outlive the comparison.
struct ComparedMethod {
  std::string label;  // "a"
  std::string text;   // as stated by the user: "direct:strategy=ris,candidates=32"
  AnyIntegrator integrator;
  PointSetKind sampler = PointSetKind::blue_noise;
  std::vector<std::string> biases;
  std::optional<LayerPlan> layers{};   // for the attribution of its variance; none: the integrator has no layers
  std::string name{};                  // the name in results, unique in the comparison; empty: the text
  std::vector<std::string> missing{};  // light of the scene that it cannot find
  std::string settings{};              // all settings in a canonical order: equal for identical methods

  const std::string& shown_name() const { return name.empty() ? text : name; }
};

struct ComparisonSettings {
  // Bounds, size, seed, threads and clock; sampler, plan and stopping rule depend on the method.
  RenderSettings render;
  bool warm_up_counts = true;     // in seconds; false: only the time of frames that are shown counts
  std::optional<double> seconds;  // for each method, over all repeats; otherwise
  int samples = 64;               // per pixel, in each repeat
  int repeats = 8;
  double confidence = 0.95;
  bool slopes = true;                                 // also render passes of increasing length
  ErrorMeasure measure = ErrorMeasure::relative_mse;  // that verdicts use
};

// The reference of all methods. `variance` is that of the mean, by pixel and channel; zero where it is exact.
struct Reference {
  PixelBuffer mean, variance;  // R, G, B
  double degrees_of_freedom = 0;
  // The variance of the image mean, R, G, B, over passes: valid for correlated pixels. None: they are independent.
  std::optional<std::array<double, 3>> variance_of_image{};
  std::string origin;  // "path, 4096 samples per pixel", or a file
};

// One repeat of one method, compared with the reference. The reference's own variance has been subtracted from the
// squared errors, so that they are unbiased estimates of the true ones; a value may be negative by chance.
struct Repeat {
  double seconds = 0;                   // counted time
  double all_seconds = 0, warm_up = 0;  // total time; the part of it for frames that are not shown
  double rays = 0, samples = 0;         // rays of all frames; samples per pixel of those that are shown
  double mse = 0, relative_mse = 0, flip = 0;
  double variance = 0;  // that the method's own error bars state, mean over pixels
  double coverage = 0;  // share of pixels whose 95 % interval contains the reference
  double image_mean[3] = {};
  // Complete passes, and the standard error of the image mean over them. 0 passes: unknown.
  double passes = 0;
  double image_error[3] = {};
};

// The error of a repeat by a measure, in a form that is inversely proportional to time: squared errors unchanged, FLIP
// squared.
double squared_error_by(ErrorMeasure measure, const Repeat& repeat);

// The squared error of single passes of 1, 2, 4, ... samples, and the counted seconds.
struct ConvergencePoint {
  double samples = 0;
  Measured mse, seconds;
};

// The same in one repeat; empty without slopes.
struct ConvergenceRun {
  std::vector<double> samples, mse, seconds;
};

// The state of one method over its repeats.
struct MethodState {
  PassPlan plan;
  std::vector<Repeat> repeats;
  std::vector<std::vector<float>> luminance;  // of each repeat, one value per pixel
  std::vector<ConvergenceRun> convergence;    // of each repeat
  std::vector<AttributionRound> attribution;  // of each repeat, if there are layers
  PixelShares pixel_shares;
  std::vector<PixelEstimate> pixels;  // over the passes of all repeats
  int passes = 0;
  std::uint64_t non_finite = 0;
  double repeat_seconds = 0;  // expected duration of a complete repeat; 0: unknown
};

// A comparison that can be continued. It depends only on the methods, the settings and the number of rounds, except for
// the times.
struct ComparisonState {
  Reference reference;
  std::vector<MethodState> methods;
};

struct MethodResult {
  ComparedMethod compared_method;
  std::vector<Repeat> repeats;
  Measured seconds, all_seconds, warm_up, rays, samples, mse, relative_mse, flip, variance, coverage;
  // 1 / (squared error x seconds), by the measure of the error; and the same with the total time.
  ByMeasure<Measured> efficiency, whole_efficiency;
  std::vector<ConvergencePoint> convergence;
  Measured slope_by_samples, slope_by_time;   // of log mse
  PixelBuffer mean, standard_error;           // over all repeats
  std::vector<std::vector<float>> luminance;  // of each repeat, one value per pixel
  WelchReport bias;                           // against the reference; assumes normal pass means of blocks and pixels
  Measured bias_squared;  // of luminance, mean over pixels: from products of the errors of different repeats
  Agreement agreement;    // of its mean with the reference
  std::uint64_t non_finite = 0;
  std::optional<Attribution> attribution;  // if the method has layers
};

// Ways in which two methods may be equal.
enum class Likeness {
  none,
  settings,  // one method with the same settings
  pictures,  // every repeat gave the same image, bit for bit
};

// The ratio of the efficiency of `first` to that of `second`.
struct PairVerdict {
  std::size_t first = 0, second = 0;
  ByMeasure<Measured> ratio;        // of efficiencies
  ByMeasure<Measured> whole_ratio;  // the same with the total time
  Likeness likeness = Likeness::none;
  bool decided = false;     // by the measure of the settings
  double times_longer = 1;  // the factor of the time that would decide it, if the ratio is as estimated
};
// Whether the interval excludes one: 1 in favour of the first, -1 of the second; 0: it does not.
int winner_of(const Measured& ratio);

struct ComparisonResult {
  bool warm_up_counts = true;  // in seconds and efficiencies; false: only the time of frames that are shown counts
  ErrorMeasure measure = ErrorMeasure::relative_mse;  // that verdicts use
  std::vector<MethodResult> methods;
  std::vector<PairVerdict> verdicts;  // of every pair
  Reference reference;
  // The reference's variance over the smallest error by each measure. That of relMSE and FLIP is that of MSE if this
  // is larger, because the noise of a reference is also in the divisor of its own relative variance.
  ByMeasure<double> reference_share;
  bool interrupted = false;
};

// The mean of an image over its pixels and channels.
double mean_value(const PixelBuffer& image);
// The mean variance of the reference as a squared error by this measure; for FLIP, as one by relMSE.
double variance_by(ErrorMeasure measure, const Reference& reference);

// A piece of work of a comparison: a pilot, the reference, a repeat.
struct WorkPiece {
  std::string what;    // "pilot of path"
  double seconds = 0;  // expected duration
};
// Receives progress several times a second; may request a stop.
struct ComparisonWatch {
  std::function<bool()> stop;
  // The finished share of the piece: 0 at its beginning, 1 at its end.
  std::function<void(const WorkPiece& piece, double done)> progress;

  bool stopped() const { return stop && stop(); }
};

// The plan of passes of each method, without results.
ComparisonState begin_comparison(const std::vector<ComparedMethod>& compared_methods, Reference reference,
                                 const ComparisonSettings& settings);
// Runs more rounds. Repeats are numbered consecutively, and no two share random numbers. False if it was stopped; the
// current repeat is then discarded.
bool run_rounds(const std::vector<ComparedMethod>& compared_methods, const ComparisonSettings& settings, int rounds,
                const ComparisonWatch& watch, ComparisonState& state);
// The expected duration of one complete repeat of a method in seconds, if a sample of the image
// takes `sample_seconds`.
double expected_repeat_seconds(const ComparedMethod& compared_method, const ComparisonSettings& settings, PassPlan plan,
                               double sample_seconds);
ComparisonResult result_of(const std::vector<ComparedMethod>& compared_methods, const ComparisonState& state,
                           const ComparisonSettings& settings);
// A complete comparison with settings.repeats rounds.
ComparisonResult run_comparison(const std::vector<ComparedMethod>& compared_methods, Reference reference,
                                const ComparisonSettings& settings, const ComparisonWatch& watch);

}  // namespace montelux::lab
