// The laboratory: the experiments of the source documents, run and written as reports.
#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "math/result.h"

namespace montelux {

struct ExperimentSetting {
  std::string name, meaning;
  double value;  // unless it is set otherwise
};

// What is known of an experiment before it runs; texts may hold formulas in dollars.
struct ExperimentEntry {
  std::string name, title, group, question, fault;
  std::vector<ExperimentSetting> settings;
};

// In the order of the documents.
std::vector<ExperimentEntry> list_experiments();

struct LabOptions {
  std::vector<std::string> names;          // none: all
  std::map<std::string, double> settings;  // only with a single experiment
  std::uint32_t seed = 0;
  bool planted_fault = false;  // makes the mistake that each experiment names, which its verdict must find
  int threads = 0;             // 0: as many as there are processors
};

struct LabVerdict {
  std::string claim, detail;
  bool passed;
};
struct LabOutcome {
  std::string name, title;
  bool passed;
  double seconds;
  std::vector<LabVerdict> verdicts;
};
struct LabRun {
  std::vector<LabOutcome> outcomes;
  std::vector<std::filesystem::path> files;   // written, relative to the folder
  std::optional<std::filesystem::path> page;  // the self-contained page
  std::string why_no_page;
  std::string why_not_written;  // a file that could not be written, and why; empty: all were
  double seconds = 0;

  bool passed() const;
};

// Told of each experiment that is done, from one thread at a time; asked now and then whether to stop.
class LabObserver {
 public:
  virtual ~LabObserver() = default;
  virtual void finished(const LabOutcome& outcome, std::size_t done, std::size_t total) = 0;
  virtual bool stop_requested() = 0;
};

// Runs experiments and writes their reports into the folder: report.html, report.json, and for each experiment its
// figures as SVG, its data as CSV and its pictures as PNG. Stopped early, it writes those that are done. Fails where a
// name or a setting is unknown, or where the folder cannot be written.
Result<LabRun> run_lab(const LabOptions& options, const std::filesystem::path& folder, LabObserver& observer);

// The documentation of an experiment in Markdown, with the files of its pictures by name.
struct ExperimentPage {
  std::string name, title, group, markdown;
  std::map<std::string, std::string> pictures;
};
std::vector<ExperimentPage> document_experiments();

}  // namespace montelux
