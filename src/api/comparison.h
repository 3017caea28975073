// Which integrator, with which settings and point set, is better on a scene: montelux compare.
#pragma once
#include "api/scene.h"
#include "lab/compare/comparison.h"
#include "math/result.h"
#include "mc/confidence.h"

namespace montelux {

// The maximum share of the reference's own variance in the smallest error.
inline constexpr double largest_reference_share = 0.25;

struct ComparisonOptions {
  // As for --integrator, optionally with `sampler=NAME` among the settings and with a name before the
  // integrator: "path:mis=balance,sampler=halton", "mine=path:mis=balance".
  std::vector<std::string> methods;
  // Settings of all methods that do not state their own.
  std::vector<std::pair<std::string, std::string>> settings;
  lab::ErrorMeasure measure = lab::ErrorMeasure::relative_mse;  // that verdicts use
  std::optional<double> seconds;                                // for each method, over all repeats
  std::optional<int> samples;                                   // per pixel, in each repeat; default 64
  int repeats = 8;
  std::optional<std::filesystem::path> reference;  // none: rendered by the most efficient unbiased method
  bool cache = true;                               // store the rendered reference, and use stored ones
  double confidence = default_confidence;
  std::uint32_t seed = 0;
  int threads = 0;
  std::optional<PixelBounds> crop;
  bool warm_frames = false;     // frames of a sequence: the time of warm-up frames does not count
  bool processor_time = false;  // processor time of all threads instead of the wall clock
  bool slopes = true;           // of the squared error, by samples and by time
  bool attribution = true;      // attribute the variance of each method to layers of light
};

// A comparison in a file: its conditions and its state. `fingerprint` is that of the scene's files.
struct SavedComparison {
  std::filesystem::path scene;
  LoadOptions load;
  std::uint64_t fingerprint = 0;
  ComparisonOptions options;
  std::vector<std::string> notes;  // about the reference
  lab::ComparisonState state;
};

// The budget with which a comparison continues: a number of repeats, or as many as fit in this time for each method;
// by default the number of repeats of the original budget.
struct ComparisonBudget {
  std::optional<int> repeats;
  std::optional<double> seconds;
};

// The duration of a comparison in seconds, as predicted by its pilots.
struct ComparisonForecast {
  double pilots = 0;     // elapsed
  double reference = 0;  // 0 if there is one
  double repeats = 0;    // of all methods, with slopes and attribution
  double total() const { return pilots + reference + repeats; }
};
struct ComparisonProgress {
  double fraction = 0;                // of the time, in [0, 1]
  double elapsed = 0, remaining = 0;  // seconds; the remaining ones are estimated
  std::string what;                   // the current step
};
// Receives the progress of a comparison and may request a stop. Each function may be empty.
struct ComparisonObserver {
  std::function<bool()> stop;
  std::function<void(const ComparisonForecast&)> forecast;  // once, before the reference and the repeats
  std::function<void(const ComparisonProgress&)> progress;  // several times a second
};

// What the images of one method lack in comparison with the scene file.
struct MethodShortcomings {
  std::vector<std::string> missing;   // kinds of light in the scene that it cannot find
  std::vector<Replacement> replaced;  // for names in the file that the method does not override
};

// All results. `refusal` states why there is no verdict if the reference is not good enough.
struct Comparison {
  lab::ComparisonResult result;
  std::string refusal;
  std::vector<std::string> notes;
  std::vector<MethodShortcomings> shortcomings;  // by method
  std::vector<std::string> left_out;             // omitted from the scene by lenient reading, so from every image
  SavedComparison saved;                         // without the scene, its load options and its fingerprint
  ComparisonForecast forecast;
  double seconds = 0;  // total elapsed time
};

// The verdict as a sentence: by the measure of the comparison, and the results by the other measures. If warm-up time
// does not count, the sentence says so and states the ratio that includes it.
std::string sentence_of(const Comparison& comparison, const lab::PairVerdict& verdict, double confidence);

// Whether the mean of a method agrees with the reference, as a sentence with the power of the test.
std::string sentence_of(const lab::Agreement& agreement, double reference_mean);

// The conditions of a comparison as pairs of name and value, for the top of the page.
std::vector<std::pair<std::string, std::string>> conditions_of(const Comparison& comparison, const std::string& scene);

// Writes the report, one HTML page that needs no network. `commands` reproduce it. Fails if the file
// cannot be written or the program was built without the page.
Status write_comparison(const std::filesystem::path& file, const Comparison& comparison, const std::string& scene,
                        double confidence, const std::vector<std::string>& commands);

// Whether every method is valid and has a unique name; does not need a scene.
Status check_methods(const ComparisonOptions& options);

// Fails if a method does not fit the scene, if warm-up frames are excluded but no method has any, or if the reference
// cannot be read or has another size.
Result<Comparison> compare_methods(const LoadedScene& scene, const ComparisonOptions& options,
                                   const ComparisonObserver& observer);
// Continues a comparison: all repeats together are equivalent to a single comparison. Fails if its methods
// or its size do not fit the scene.
Result<Comparison> continue_comparison(const LoadedScene& scene, SavedComparison saved, const ComparisonBudget& more,
                                       const ComparisonObserver& observer);

// Changes with the content of the scene's file and of every file beside it or below that its text, or that of a text it
// includes, names; and with that of an environment that takes the place of the scene's own. Files in `written`
// are not part of the scene: the scene names the picture that is rendered from it.
std::uint64_t scene_fingerprint(const std::filesystem::path& scene,
                                const std::optional<EnvironmentOptions>& environment = {},
                                const std::vector<std::string>& written = {});
Status save_comparison(const std::filesystem::path& file, const SavedComparison& comparison);
// Fails where the file cannot be read, is of another kind or version, or its scene has changed.
Result<SavedComparison> load_comparison(const std::filesystem::path& file);
// Why a comparison could not be saved to this file, as check_film_file().
Status check_comparison_file(const std::filesystem::path& file);

}  // namespace montelux
