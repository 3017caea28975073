// Integrals stated as text: reading them, running them by one or several methods, storing results in files.
#pragma once
#include <filesystem>
#include <functional>
#include <memory>

#include "lab/integral/diagnosis.h"
#include "lab/statement/statement.h"
#include "lab/statement/value_text.h"
#include "math/result.h"
#include "mc/confidence.h"

namespace montelux {

// The budget of a method if nothing else ends it.
inline constexpr std::uint64_t default_integral_samples = 1u << 20;

struct IntegralOptions {
  lab::IntegralStatement statement;
  // "vegas", "qmc:points=lattice"; none: importance or mis if densities are given, control if a control variate
  // is, ris if a target is, else auto.
  std::vector<std::string> methods;
  lab::Budget budget;
  std::uint64_t seed = 0;
};

// An integral that has been read and checked.
struct PreparedIntegral {
  IntegralOptions options;  // with the methods that are used
  std::vector<lab::Method> methods;
  lab::StatedProblem stated;
};

// Either the integral, or all errors in it; notes state restrictions of the result.
struct IntegralPreparation {
  std::optional<PreparedIntegral> integral;
  std::vector<std::string> mistakes, notes;
};
IntegralPreparation prepare_integral(const IntegralOptions& options);

// The result of one method: the requested name, and the outcome.
struct IntegralRun {
  std::string method;
  lab::IntegralResult result;
};

// A saved run.
struct SavedIntegral {
  IntegralOptions options;
  std::vector<std::string> methods;        // one per state
  std::vector<lab::IntegralState> states;  // fewer than the requested methods if the run was interrupted
};

// How a run is observed. `progress` receives the number of the method and its progress.
struct IntegralWatch {
  int threads = 0;  // 0: all of the machine. The bits do not depend on it.
  std::function<bool()> stop;
  std::function<void(std::size_t method, const lab::IntegralProgress&)> progress;
};

// Runs the methods one after the other; a stop ends the current one and omits the rest. With `resume`
// each continues from its state. Fails if a method does not support the problem.
Result<std::vector<IntegralRun>> run_integral(const PreparedIntegral& integral, const IntegralWatch& watch,
                                              const SavedIntegral* resume = nullptr);

SavedIntegral saved_of(const PreparedIntegral& integral, const std::vector<IntegralRun>& runs);
// Methods of one integral that contradict each other, at the level lab::disagreement_level for all pairs together.
std::vector<lab::Disagreement> disagreements_of(const std::vector<IntegralRun>& runs);
// Whether any result has a warning.
bool has_warnings(const std::vector<IntegralRun>& runs);

// The results that the states represent.
std::vector<IntegralRun> runs_of(const SavedIntegral& saved);

// The remainder of the budget in the file; nothing if it is used up.
std::optional<lab::Budget> rest_of_budget(const SavedIntegral& saved);

Status save_integral(const std::filesystem::path& file, const SavedIntegral& saved);
Result<SavedIntegral> load_integral(const std::filesystem::path& file);
// Whether the file claims to be saved integrals; and why they could not be saved to it, as check_film_file().
bool is_saved_integral(const std::filesystem::path& file);
Status check_integral_file(const std::filesystem::path& file);
// Equivalent to a single run. Fails if integrals or methods differ, or two runs share a seed.
Result<SavedIntegral> merge_integrals(const std::vector<SavedIntegral>& parts);

}  // namespace montelux
