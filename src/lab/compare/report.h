// A comparison as a report.
#pragma once
#include "lab/compare/comparison.h"
#include "lab/report/report.h"

namespace montelux::lab {

// What the report says beside the figures.
struct ComparisonText {
  std::string scene;
  std::vector<std::pair<std::string, std::string>> conditions;
  std::vector<std::string> sentences;     // one a verdict
  std::vector<std::string> agreement;     // one a method: is its mean the reference's?
  std::vector<std::string> shortcomings;  // one a method: what its pictures lack of the scene; empty: nothing
  std::vector<std::string> notes;         // what the reader must know
  std::vector<std::string> commands;      // that make it again
};

ReportSet report_of(const ComparisonResult& result, const ComparisonText& words);

}  // namespace montelux::lab
