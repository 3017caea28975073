#include "api/lab.h"

#include <fmt/format.h>

#include <algorithm>
#include <mutex>

#include "lab/experiments/experiment.h"
#include "lab/report/write.h"
#include "parameter/choice.h"
#include "render/stopwatch.h"
#include "work/scheduler.h"

namespace montelux {

namespace {

struct Task {
  const lab::Experiment* experiment;
  lab::Setup setup;
  std::optional<lab::Report> report;
  LabOutcome outcome;
};

Result<std::vector<Task>> tasks_of(const LabOptions& options) {
  std::vector<const lab::Experiment*> chosen;
  for (const std::string& name : options.names) {
    const lab::Experiment* experiment = lab::find_experiment(name);
    if (!experiment) {
      std::vector<std::string_view> names;
      for (const lab::Experiment* known : lab::experiments()) names.push_back(known->name);
      return unknown_name("experiment", name, names);
    }
    chosen.push_back(experiment);
  }
  if (chosen.empty()) chosen.assign(lab::experiments().begin(), lab::experiments().end());
  if (!options.settings.empty() && chosen.size() != 1)
    return Failure{"settings can be given to a single experiment only"};
  std::vector<Task> tasks;
  for (const lab::Experiment* experiment : chosen) {
    Result<lab::Setup> setup = lab::Setup::make(*experiment, options.seed, options.settings, options.planted_fault);
    if (!setup) return setup.failure();
    tasks.push_back({experiment, *setup, std::nullopt, {}});
  }
  return tasks;
}

void run_task(Task& task) {
  const Stopwatch since_begin;
  task.report = lab::run_experiment(*task.experiment, task.setup);
  task.outcome = {task.report->name, task.report->title, task.report->passed(), since_begin.seconds(), {}};
  for (const lab::Section& section : task.report->sections)
    if (const auto* verdict = std::get_if<lab::Verdict>(&section))
      task.outcome.verdicts.push_back({verdict->claim, verdict->detail, verdict->passed});
}

// The reports stay in the order of the table, whichever thread makes them.
void run_tasks(std::vector<Task>& tasks, int threads, LabObserver& observer) {
  std::mutex mutex;
  std::size_t done = 0;
  const auto work = [&](std::size_t i, int) {
    run_task(tasks[i]);
    const std::scoped_lock lock(mutex);
    observer.finished(tasks[i].outcome, ++done, tasks.size());
  };
  const auto stop = [&] {
    const std::scoped_lock lock(mutex);
    return observer.stop_requested();
  };
  Scheduler(threads).run(tasks.size(), work, {.stop = stop});
}

}  // namespace

bool LabRun::passed() const {
  return std::all_of(outcomes.begin(), outcomes.end(), [](const LabOutcome& outcome) { return outcome.passed; });
}

std::vector<ExperimentEntry> list_experiments() {
  std::vector<ExperimentEntry> entries;
  for (const lab::Experiment* e : lab::experiments()) {
    ExperimentEntry entry{std::string(e->name),     std::string(e->title), std::string(e->group),
                          std::string(e->question), std::string(e->fault), {}};
    for (const lab::Knob& knob : e->knobs)
      if (!knob.name.empty()) entry.settings.push_back({std::string(knob.name), std::string(knob.meaning), knob.value});
    entries.push_back(std::move(entry));
  }
  return entries;
}

Result<LabRun> run_lab(const LabOptions& options, const std::filesystem::path& folder, LabObserver& observer) {
  const Stopwatch since_begin;
  Result<std::vector<Task>> tasks = tasks_of(options);
  if (!tasks) return tasks.failure();
  run_tasks(*tasks, options.threads, observer);

  lab::ReportSet set{"The Monte Carlo laboratory", "", {}};
  LabRun run;
  for (Task& task : *tasks) {
    if (!task.report) continue;
    set.reports.push_back(std::move(*task.report));
    run.outcomes.push_back(std::move(task.outcome));
  }
  set.subtitle = fmt::format(
      "Experiments of the source documents, each with its data, its figures and a verdict against the "
      "closed form; seed {}. In a correct program one run in a thousand has a verdict that fails.",
      options.seed);
  if (options.planted_fault) set.subtitle = "With planted faults, which the verdicts must detect. " + set.subtitle;
  Result<lab::WrittenReports> written = lab::write_reports(set, folder);
  if (!written) {
    run.why_not_written = written.error();
    return run;
  }
  run.files = std::move(written->files), run.page = std::move(written->page);
  run.why_no_page = std::move(written->why_no_page);
  run.seconds = since_begin.seconds();
  return run;
}

std::vector<ExperimentPage> document_experiments() {
  std::vector<ExperimentPage> pages;
  for (const lab::Experiment* e : lab::experiments()) {
    const lab::Report report = lab::run_experiment(*e, lab::Setup::make(*e, 0).value());
    ExperimentPage page{report.name, report.title, report.group, lab::documentation(*e, report, report.name), {}};
    for (const lab::Section& section : report.sections) {
      if (const auto* figure = std::get_if<lab::Figure>(&section))
        page.pictures[figure->name + ".svg"] = lab::to_svg(*figure);
      if (const auto* images = std::get_if<lab::Images>(&section))
        for (std::size_t i = 0; i < images->pictures.size(); ++i)
          page.pictures[images->name + "-" + std::to_string(i + 1) + ".png"] = lab::to_png(images->pictures[i]);
    }
    pages.push_back(std::move(page));
  }
  return pages;
}

}  // namespace montelux
