// Integrals stated in texts: reading them, running them by one or several methods, keeping what was done in files.
#pragma once
#include <filesystem>
#include <functional>
#include <memory>

#include "lab/integral/diagnosis.h"
#include "lab/statement/statement.h"
#include "lab/statement/value_text.h"
#include "math/result.h"

namespace montelux {

// What a method gets where nothing else ends it.
inline constexpr std::uint64_t default_integral_samples = 1u << 20;

struct IntegralOptions {
  lab::IntegralStatement statement;
  // "vegas", "qmc:points=lattice"; none: importance or mis where densities are given, control where a control variate
  // is, ris where a target is, else auto.
  std::vector<std::string> methods;
  lab::Budget budget;
  std::uint64_t seed = 0;
};

// An integral that has been read and checked.
struct PreparedIntegral {
  IntegralOptions options;  // with the methods that are taken
  std::vector<lab::Method> methods;
  lab::StatedProblem stated;
};

// Either the integral, or all that is wrong with it; notes say what the result will suffer from.
struct IntegralPreparation {
  std::optional<PreparedIntegral> integral;
  std::vector<std::string> mistakes, notes;
};
IntegralPreparation prepare_integral(const IntegralOptions& options);

// One method's work: its name as it was asked for, and what came out.
struct IntegralRun {
  std::string method;
  lab::IntegralResult result;
};

// What was done, as a file keeps it.
struct SavedIntegral {
  IntegralOptions options;
  std::vector<std::string> methods;        // one a state
  std::vector<lab::IntegralState> states;  // may be fewer than the methods asked for: the run was interrupted
};

// How a run is watched. `progress` gets the number of the method and how far it is.
struct IntegralWatch {
  int threads = 0;  // 0: all of the machine. The bits do not depend on it.
  std::function<bool()> stop;
  std::function<void(std::size_t method, const lab::IntegralProgress&)> progress;
};

// Runs the methods one after the other; a stop ends the one that is under way and leaves the rest out. With `resume`
// each goes on from its state. Fails where a method cannot do the problem.
Result<std::vector<IntegralRun>> run_integral(const PreparedIntegral& integral, const IntegralWatch& watch,
                                              const SavedIntegral* resume = nullptr);

SavedIntegral saved_of(const PreparedIntegral& integral, const std::vector<IntegralRun>& runs);
// Methods of one integral that contradict each other, at the level lab::disagreement_level for all pairs together.
std::vector<lab::Disagreement> disagreements_of(const std::vector<IntegralRun>& runs);
// Whether anything makes a result less than it claims.
bool has_warnings(const std::vector<IntegralRun>& runs);

// What the states stand for.
std::vector<IntegralRun> runs_of(const SavedIntegral& saved);

// The budget that is left of the one in the file; nothing where it is spent.
std::optional<lab::Budget> rest_of_budget(const SavedIntegral& saved);

Status save_integral(const std::filesystem::path& file, const SavedIntegral& saved);
Result<SavedIntegral> load_integral(const std::filesystem::path& file);
// As if all had been one run. Fails where integrals or methods differ, or two runs share a seed.
Result<SavedIntegral> merge_integrals(const std::vector<SavedIntegral>& parts);

}  // namespace montelux
