// Which integrator, with which settings and point set, is better on a scene: montelux compare.
#pragma once
#include "api/scene.h"
#include "lab/compare/comparison.h"
#include "math/result.h"

namespace montelux {

// More than this share of the smallest error may not be the reference's own.
inline constexpr double largest_reference_share = 0.25;

struct ComparisonOptions {
  // As --integrator takes them, with `sampler=NAME` among the settings if need be, and with a name before them if
  // wanted: "path:mis=balance,sampler=halton", "mine=path:mis=balance".
  std::vector<std::string> methods;
  // That all methods are to have, but where they have their own.
  std::vector<std::pair<std::string, std::string>> settings;
  lab::ErrorMeasure measure = lab::ErrorMeasure::relative_mse;  // that verdicts go by
  std::optional<double> seconds;                                // for each method, over all repeats
  std::optional<int> samples;                                   // a pixel, in each repeat; default 64
  int repeats = 8;
  std::optional<std::filesystem::path> reference;  // a picture; none: made by the most efficient unbiased method
  bool cache = true;                               // keep the reference that was made, and use it again
  double confidence = 0.95;
  std::uint32_t seed = 0;
  int threads = 0;
  std::optional<PixelBounds> crop;
  bool warm_frames = false;     // frames of a sequence: the time of warm-up frames does not count
  bool processor_time = false;  // the time of all threads on processors, instead of the clock on the wall
  bool slopes = true;           // of the squared error, by samples and by time
  bool attribution = true;      // tell which layers of light the variance of each method comes from
};

// A comparison in a file: what it is of, and all that it has gathered. `fingerprint` is of the scene's files.
struct SavedComparison {
  std::filesystem::path scene;
  LoadOptions load;
  std::uint64_t fingerprint = 0;
  ComparisonOptions options;
  std::vector<std::string> notes;  // of the reference
  lab::ComparisonState state;
};

// How much more, where a comparison goes on: so many repeats, or as many as fit in this time for each method; by
// default as many as it was first asked for.
struct ComparisonBudget {
  std::optional<int> repeats;
  std::optional<double> seconds;
};

// Seconds that a comparison is expected to take, by its pilots.
struct ComparisonForecast {
  double pilots = 0;     // that have been taken
  double reference = 0;  // 0 where there is one
  double repeats = 0;    // of all methods, with slopes and attribution
  double total() const { return pilots + reference + repeats; }
};
struct ComparisonProgress {
  double fraction = 0;                // of the time, in [0, 1]
  double elapsed = 0, remaining = 0;  // seconds; the remaining ones are estimated
  std::string what;                   // is under way
};
// Told of how a comparison gets on; may ask to stop. Each may be empty.
struct ComparisonObserver {
  std::function<bool()> stop;
  std::function<void(const ComparisonForecast&)> forecast;  // once, before the reference and the repeats
  std::function<void(const ComparisonProgress&)> progress;  // several times a second
};

// What the pictures of one method lack of what the scene's file names.
struct MethodShortcomings {
  std::vector<std::string> missing;   // sorts of light of the scene that it cannot find
  std::vector<Replacement> replaced;  // of what the file names and the method does not choose itself
};

// Everything that was found. `refusal` says why the verdicts do not count, where the reference is not good enough.
struct Comparison {
  lab::ComparisonResult result;
  std::string refusal;
  std::vector<std::string> notes;
  std::vector<MethodShortcomings> shortcomings;  // of each method
  std::vector<std::string> left_out;             // of the scene by a lenient reading, so from every picture
  SavedComparison saved;                         // but for the scene, how it was loaded, and its fingerprint
  ComparisonForecast forecast;
  double seconds = 0;  // that all of it took, by the machine's clock
};

// What the verdict says, in a sentence: by the measure of the comparison, and what the other measures say. Where the
// time of warm-up does not count, it says that, and what it would be.
std::string sentence_of(const Comparison& comparison, const lab::PairVerdict& verdict, double confidence);

// Whether the mean of a method is that of the reference, in a sentence with the power of the test.
std::string sentence_of(const lab::Agreement& agreement, double reference_mean);

// What a comparison is of, as pairs of a name and a value: what the page states on top.
std::vector<std::pair<std::string, std::string>> conditions_of(const Comparison& comparison, const std::string& scene);

// Writes the report, one HTML page that needs no network. `commands` are those that make it again. Fails where the file
// cannot be written or the program was built without the page.
Status write_comparison(const std::filesystem::path& file, const Comparison& comparison, const std::string& scene,
                        double confidence, const std::vector<std::string>& commands);

// Whether every method can be made and has a name of its own; a scene is not needed to tell.
Status check_methods(const ComparisonOptions& options);

// Fails where a method does not fit the scene, none has the warm-up that is not to count, or the reference cannot be
// read or has another size.
Result<Comparison> compare_methods(const LoadedScene& scene, const ComparisonOptions& options,
                                   const ComparisonObserver& observer);
// Goes on with a comparison: its repeats and those that follow are as those of one comparison. Fails where its methods
// or its size do not fit the scene.
Result<Comparison> continue_comparison(const LoadedScene& scene, SavedComparison saved, const ComparisonBudget& more,
                                       const ComparisonObserver& observer);

// Changes with the content of the scene's file and of every file beside it or below that its text, or that of a text it
// includes, names; and with that of an environment that takes the place of the scene's own. Files of the names in
// `written` are none of the scene: it names the picture that is made of it.
std::uint64_t scene_fingerprint(const std::filesystem::path& scene,
                                const std::optional<EnvironmentOptions>& environment = {},
                                const std::vector<std::string>& written = {});
Status save_contest(const std::filesystem::path& file, const SavedContest& contest);
// Fails where the file cannot be read, is of another kind or version, or its scene has changed.
Result<SavedComparison> load_comparison(const std::filesystem::path& file);

}  // namespace montelux
