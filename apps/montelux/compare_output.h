// The results of a comparison, as text, JSON and CSV, on standard output.
#pragma once
#include <string>

#include "api/contest.h"

namespace montelux::cli {

void print_contest_text(const std::string& scene, const Contest& contest);
void print_contest_json(const std::string& scene, const Contest& contest);
// A line for every repeat of every method.
void print_contest_csv(const Contest& contest);

// "about 1 min 28 s: pilots 3.0 s, reference 20.0 s, 8 repeats of 2 methods 1 min 05 s".
std::string forecast_text(const ContestForecast& forecast, int repeats, std::size_t methods);

}  // namespace montelux::cli
