// A comparison as a report.
#pragma once
#include "lab/compare/comparison.h"
#include "lab/report/report.h"

namespace montelux::lab {

// The text of the report besides the figures.
struct ComparisonText {
  std::string scene;
  std::vector<std::pair<std::string, std::string>> conditions;
  std::vector<std::string> sentences;     // one per verdict
  std::vector<std::string> agreement;     // one per method: does its mean agree with the reference?
  std::vector<std::string> shortcomings;  // one per method: what its images lack; empty: nothing
  std::vector<std::string> notes;         // for the reader
  std::vector<std::string> commands;      // that reproduce it
};

ReportSet report_of(const ComparisonResult& result, const ComparisonText& words);

}  // namespace montelux::lab
