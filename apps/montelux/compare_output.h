// The results of a comparison, as text, JSON and CSV, on standard output.
#pragma once
#include <string>

#include "api/comparison.h"

namespace montelux::cli {

void print_comparison_text(const std::string& scene, const Comparison& comparison);
void print_comparison_json(const std::string& scene, const Comparison& comparison);
// A line for every repeat of every method.
void print_comparison_csv(const Comparison& comparison);

// "about 1 min 28 s: pilots 3.0 s, reference 20.0 s, 8 repeats of 2 methods 1 min 05 s".
std::string forecast_text(const ComparisonForecast& forecast, int repeats, std::size_t methods);

}  // namespace montelux::cli
