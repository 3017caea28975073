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
  double value;  // default
};

// The description of an experiment; texts may contain formulas in dollar signs.
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
  bool planted_fault = false;  // plants the fault of each experiment, which its verdict must detect
  int threads = 0;             // 0: one per processor
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
  std::vector<std::filesystem::path> files;   // written files, relative to the folder
  std::optional<std::filesystem::path> page;  // the self-contained page
  std::string why_no_page;
  std::string why_not_written;  // a file that could not be written, and the reason; empty: all were written
  double seconds = 0;

  bool passed() const;
};

// Receives each finished experiment, from one thread at a time; is queried regularly whether to stop.
class LabObserver {
 public:
  virtual ~LabObserver() = default;
  virtual void finished(const LabOutcome& outcome, std::size_t done, std::size_t total) = 0;
  virtual bool stop_requested() = 0;
};

// Runs experiments and writes their reports to the folder: report.html, report.json, and for each experiment its
// figures as SVG, its data as CSV and its images as PNG. If stopped early, it writes the finished ones. Fails if a
// name or a setting is unknown, or if the folder cannot be written.
Result<LabRun> run_lab(const LabOptions& options, const std::filesystem::path& folder, LabObserver& observer);

// The documentation of an experiment in Markdown, with its image files by name.
struct ExperimentPage {
  std::string name, title, group, markdown;
  std::map<std::string, std::string> pictures;
};
std::vector<ExperimentPage> document_experiments();

}  // namespace montelux
