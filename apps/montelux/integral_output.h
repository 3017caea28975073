// The results of an integral, for people and for programs.
#pragma once
#include <string>
#include <vector>

#include "api/integrate.h"

namespace CLI {
class App;
}

namespace montelux::cli {

// One value with its interval, cost and checks; or a table for several methods. `brief`: only the values.
void print_integral_text(const std::vector<IntegralRun>& runs, bool brief);
// An object; with several methods an array "results" in it.
void print_integral_json(const IntegralOptions& options, const std::vector<IntegralRun>& runs);
// A header and one row per method.
void print_integral_csv(const std::vector<IntegralRun>& runs);
// How results of integrals are printed, and whether doubtful ones are an error.
struct IntegralOutput {
  bool json = false, csv = false, quiet = false, strict = false;
};
void add_output_options(CLI::App& verb, IntegralOutput& output);
// Prints results and warnings; returns the exit status.
int print_integrals(const IntegralOutput& output, const IntegralOptions& options, const std::vector<IntegralRun>& runs);

// What makes results less than they claim, on standard error.
void print_integral_warnings(const std::vector<IntegralRun>& runs);

}  // namespace montelux::cli
