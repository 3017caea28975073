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
#include "lab/compare/agreement.h"
#include "lab/compare/attribution.h"
#include "lab/compare/error_measure.h"
#include "lab/compare/statistics.h"
#include "render/render.h"

namespace montelux::lab {

// One method: an integrator with a point set. The integrator must outlive the comparison.
struct ComparedMethod {
  std::string label;  // "a"
  std::string text;   // as it was asked for: "direct:strategy=ris,candidates=32"
  AnyIntegrator integrator;
  PointSetKind sampler = PointSetKind::blue_noise;
  std::vector<std::string> biases;
  std::optional<LayerPlan> layers{};   // that its variance is attributed to; none: the integrator has no layers
  std::string name{};                  // what people call it, unique in the comparison; empty: the text
  std::vector<std::string> missing{};  // light of the scene that it cannot find
  std::string settings{};              // all that it was asked for, in one order: equal for methods that are the same

  const std::string& shown_name() const { return name.empty() ? text : name; }
};

struct ComparisonSettings {
  // Bounds, size, seed, threads, clock, and whether the time of warm-up frames counts; sampler and plan are the
  // methods' own.
  RenderSettings render;
  std::optional<double> seconds;  // for each method, over all repeats; else
  int samples = 64;               // a pixel, in each repeat
  int repeats = 8;
  double confidence = 0.95;
  bool slopes = true;                                 // render passes of growing length, too
  ErrorMeasure measure = ErrorMeasure::relative_mse;  // that verdicts go by
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
  // Complete passes, and the standard error of the image mean over them. 0 passes: not known.
  double passes = 0;
  double image_error[3] = {};
};

// The error of a repeat by a measure, in a form that falls as one over the time: squared errors as they are, FLIP
// squared.
double squared_error_by(ErrorMeasure measure, const Repeat& repeat);

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
  double repeat_seconds = 0;  // that a repeat is expected to take with all that belongs to it; 0: not known
};

// A comparison that can go on. It is a function of the methods, the settings and the number of rounds, but for
// the times.
struct ComparisonState {
  Reference reference;
  std::vector<MethodState> methods;
};

struct MethodResult {
  ComparedMethod compared_method;
  std::vector<Repeat> repeats;
  Measured seconds, all_seconds, warm_up, rays, samples, mse, relative_mse, flip, variance, coverage;
  // 1 / (squared error x seconds), by the measure of the error; and the same by all seconds.
  ByMeasure<Measured> efficiency, whole_efficiency;
  std::vector<ConvergencePoint> convergence;
  Measured slope_by_samples, slope_by_time;   // of log mse
  PixelBuffer mean, standard_error;           // over all repeats
  std::vector<std::vector<float>> luminance;  // of each repeat, one a pixel
  WelchReport bias;                           // against the reference; blocks and pixels take pass means for normal
  Measured bias_squared;  // of luminance, mean over pixels: by products of the errors of different repeats
  Agreement agreement;    // of its mean with the reference
  std::uint64_t non_finite = 0;
  std::optional<Attribution> attribution;  // where the method has layers
};

// How two methods may be alike.
enum class Likeness {
  none,
  settings,  // they are one method with the same settings
  pictures,  // every repeat gave the same picture, to the bit
};

// How much more efficient `first` is than `second`.
struct PairVerdict {
  std::size_t first = 0, second = 0;
  ByMeasure<Measured> ratio;        // of efficiencies
  ByMeasure<Measured> whole_ratio;  // the same by all seconds
  Likeness likeness = Likeness::none;
  bool decided = false;     // by the measure of the settings
  double times_longer = 1;  // how many times the time would decide it, if the ratio is what it seems
};
// The interval excludes one: 1 in favour of the first, -1 of the second; 0: it does not.
int winner_of(const Measured& ratio);

struct ComparisonResult {
  bool warm_up_counts = true;  // in seconds and efficiencies; no: only the time of frames that are shown does
  ErrorMeasure measure = ErrorMeasure::relative_mse;  // that verdicts go by
  std::vector<MethodResult> methods;
  std::vector<PairVerdict> verdicts;  // of every pair
  Reference reference;
  // The reference's variance over the smallest error by each measure. That of relMSE and FLIP is that of MSE where this
  // is larger: the noise of a reference is in the divisor of its own relative variance, too.
  ByMeasure<double> reference_share;
  bool interrupted = false;
};

// The mean of a picture over its pixels and channels.
double mean_value(const PixelBuffer& image);
// The reference's mean variance as a squared error by this measure; of FLIP, as one by relMSE.
double variance_by(ErrorMeasure measure, const Reference& reference);

// A piece of work of a comparison: a pilot, the reference, a repeat.
struct WorkPiece {
  std::string what;    // "pilot of path"
  double seconds = 0;  // that it is expected to take
};
// Told of progress, several times a second; may ask to stop.
struct ComparisonWatch {
  std::function<bool()> stop;
  // How much of the piece is done: 0 as it begins, 1 as it ends.
  std::function<void(const WorkPiece& piece, double done)> progress;

  bool stopped() const { return stop && stop(); }
};

// The plan of passes of each method; nothing is gathered yet.
ComparisonState begin_comparison(const std::vector<ComparedMethod>& compared_methods, Reference reference,
                                 const ComparisonSettings& settings);
// So many rounds more. Repeats are numbered through, and no two share random numbers. False where it was stopped; what
// was under way is then left out.
bool run_rounds(const std::vector<ComparedMethod>& compared_methods, const ComparisonSettings& settings, int rounds,
                const ComparisonWatch& watch, ComparisonState& state);
// Seconds that one repeat of a method is expected to take with all that belongs to it, where a sample of the picture
// takes `sample_seconds`.
double expected_repeat_seconds(const ComparedMethod& compared_method, const ComparisonSettings& settings, PassPlan plan,
                               double sample_seconds);
ComparisonResult result_of(const std::vector<ComparedMethod>& compared_methods, const ComparisonState& state,
                           const ComparisonSettings& settings);
// All of it: settings.repeats rounds.
ComparisonResult run_comparison(const std::vector<ComparedMethod>& compared_methods, Reference reference,
                                const ComparisonSettings& settings, const ComparisonWatch& watch);

}  // namespace montelux::lab
