// Experiments: a question from the source documents, data that answer it, and a verdict against the closed form.
#pragma once
#include <array>
#include <map>
#include <span>
#include <string>
#include <string_view>

#include "lab/report/report.h"
#include "math/result.h"
#include "mc/random.h"

namespace montelux::lab {

// A number that an experiment depends on, with the value it has unless the user says otherwise.
struct Knob {
  std::string_view name;
  double value = 0;
  std::string_view meaning;
};

// A hypothesis and its p-value. `to_reject`: the claim is that the hypothesis is false, as of a formula misprinted.
struct Check {
  std::string claim, statistic;
  double p_value = 1;
  bool to_reject = false;
};

// Texts, captions and claims are the same in every run: the documentation prints them. Numbers belong in figures,
// tables and statistics.
struct Findings {
  std::vector<Section> sections;
  std::vector<Check> checks;
};

class Setup;

// One experiment: a row of the table. `formula` is LaTeX, `source` where it stands; texts may hold formulas in dollars.
// `fault` names a mistake that can be planted, at which at least one check must fail. `checks` is the number of checks
// that `run` returns.
struct Experiment {
  std::string_view name, title, group, question, formula, source, fault;
  std::array<Knob, 3> knobs;
  std::size_t checks;
  Findings (*run)(const Setup&);
};

// All experiments, in the order of the documents.
std::span<const Experiment* const> experiments();
// Nothing where there is none of that name.
const Experiment* find_experiment(std::string_view name);

// What one run of an experiment is given.
class Setup {
 public:
  // The experiment's own knobs, some of them set otherwise. A name that the experiment does not have, or a value that
  // is not a positive number, is a failure that names the valid ones.
  static Result<Setup> make(const Experiment& experiment, std::uint32_t seed,
                            const std::map<std::string, double>& changes = {}, bool planted_fault = false);

  std::uint32_t seed() const { return seed_; }
  bool fault() const { return fault_; }
  double operator[](std::string_view knob) const;
  std::uint32_t count(std::string_view knob) const { return std::uint32_t((*this)[knob] + 0.5); }
  // Independent streams of random numbers: one for each pair of numbers.
  RandomStream<float> stream(std::uint32_t purpose, std::uint32_t realisation = 0) const {
    return RandomStream<float>(realisation, mix_bits(seed_ * 0x9e3779b9u + mix_bits(purpose + 0x51ab3c07u)));
  }

 private:
  std::uint32_t seed_ = 0;
  bool fault_ = false;
  std::map<std::string, double, std::less<>> knobs_;
};

// The level of each single check that keeps all checks of all experiments at 1e-3 (Sidak 1967).
double check_level();
bool holds(const Check& check);

// Runs it and makes the page: question, formula, findings, a verdict for each check, and how to vary it.
Report run_experiment(const Experiment& experiment, const Setup& setup);

// The documentation of an experiment: Markdown whose pictures lie in `pictures`, a folder relative to it.
std::string documentation(const Experiment& experiment, const Report& report, std::string_view pictures);

}  // namespace montelux::lab
