#include "lab/experiments/experiment.h"

#include <fmt/format.h>

#include <cmath>

#include "lab/experiments/table.h"

namespace montelux::lab {

std::span<const Experiment* const> experiments() { return experiment_table; }

const Experiment* find_experiment(std::string_view name) {
  for (const Experiment* experiment : experiments())
    if (experiment->name == name) return experiment;
  return nullptr;
}

Result<Setup> Setup::make(const Experiment& experiment, std::uint32_t seed,
                          const std::map<std::string, double>& changes, bool planted_fault) {
  Setup setup;
  setup.seed_ = seed, setup.fault_ = planted_fault;
  for (const Knob& knob : experiment.knobs)
    if (!knob.name.empty()) setup.knobs_.emplace(knob.name, knob.value);
  for (const auto& [name, value] : changes) {
    const auto place = setup.knobs_.find(name);
    if (place == setup.knobs_.end()) {
      std::vector<std::string> names;
      for (const auto& knob : setup.knobs_) names.push_back(knob.first);
      return Failure{fmt::format("{} has no setting \"{}\"; it has {}", experiment.name, name, fmt::join(names, ", "))};
    }
    if (!(value > 0) || !std::isfinite(value) || value > 1e9)
      return Failure{fmt::format("the setting {} of {} must be a positive number, at most 1e9", name, experiment.name)};
    place->second = value;
  }
  return setup;
}

double Setup::operator[](std::string_view knob) const { return knobs_.find(knob)->second; }

double check_level() {
  double checks = 0;
  for (const Experiment* experiment : experiments()) checks += double(experiment->checks);
  return -std::expm1(std::log1p(-1e-3) / checks);
}

bool holds(const Check& check) { return (check.p_value < check_level()) == check.to_reject; }

namespace {

Verdict verdict_of(const Check& check) {
  const double level = check_level();
  std::string detail = check.statistic;
  if (check.p_value > 0 && check.p_value < 1)
    detail += fmt::format("; p = {:.2g}, {} at the level {:.2g}", check.p_value,
                          check.p_value < level ? "rejected" : "not rejected", level);
  if (check.to_reject) detail += check.p_value < level ? " (as it should be)" : " (it should have been)";
  return {check.claim, detail, holds(check)};
}

std::string how_to_vary(const Experiment& experiment) {
  std::string text = "Vary it by `--seed` and by `--set name=value` of";
  for (const Knob& knob : experiment.knobs)
    if (!knob.name.empty())
      text += fmt::format("{} `{}` ({}; {:g})", &knob == experiment.knobs.data() ? "" : ",", knob.name, knob.meaning,
                          knob.value);
  return text +
         fmt::format(". With `--fault` a mistake is planted, which the verdict must find: {}.", experiment.fault);
}

Commands commands_of(const Experiment& experiment) {
  const Knob& knob = experiment.knobs.front();
  return {{fmt::format("montelux lab run {} -o out", experiment.name),
           fmt::format("montelux lab run {} -o out --seed 7 --set {}={:g}", experiment.name, knob.name, 2 * knob.value),
           fmt::format("montelux lab run {} -o out --fault", experiment.name)}};
}

// A section in Markdown; figures and pictures are those that write_reports makes.
struct MarkdownWriter {
  std::string folder;

  std::string operator()(const Text& text) const { return text.text + "\n\n"; }
  std::string operator()(const Formula& formula) const {
    return fmt::format("$$\n{}\n$$\n\n{}\n\n", formula.latex, formula.source);
  }
  // Numbers belong to a run, not to the documentation.
  std::string operator()(const Table&) const { return ""; }
  std::string operator()(const Facts&) const { return ""; }
  std::string operator()(const Figure& figure) const {
    return fmt::format("![{0}]({1}/{0}.svg)\n\n*{2}*\n\n", figure.name, folder, figure.caption);
  }
  std::string operator()(const Images& images) const {
    std::string text;
    for (std::size_t i = 0; i < images.pictures.size(); ++i)
      text += fmt::format("![{0}]({1}/{2}-{3}.png)\n", "picture " + std::to_string(i + 1), folder, images.name, i + 1);
    return text + fmt::format("\n*{}*\n\n", images.caption);
  }
  std::string operator()(const PictureComparison& comparison) const { return comparison.caption + "\n\n"; }
  std::string operator()(const Verdict& verdict) const { return "- " + verdict.claim + "\n"; }
  std::string operator()(const Commands& commands) const {
    return fmt::format("    {}\n", fmt::join(commands.lines, "\n    "));
  }
};

}  // namespace

Report run_experiment(const Experiment& experiment, const Setup& setup) {
  Report report{std::string(experiment.name), std::string(experiment.title), std::string(experiment.group), {}};
  report.sections.push_back(Text{std::string(experiment.question)});
  report.sections.push_back(Formula{std::string(experiment.formula), std::string(experiment.source)});
  Findings findings = experiment.run(setup);
  for (Section& section : findings.sections) report.sections.push_back(std::move(section));
  for (const Check& check : findings.checks) report.sections.push_back(verdict_of(check));
  if (findings.checks.size() != experiment.checks)
    report.sections.push_back(Verdict{"The table states how many checks there are.",
                                      fmt::format("{} stated, {} made", experiment.checks, findings.checks.size()),
                                      false});
  report.sections.push_back(Text{how_to_vary(experiment)});
  report.sections.push_back(commands_of(experiment));
  return report;
}

std::string documentation(const Experiment& experiment, const Report& report, std::string_view pictures) {
  std::string text = fmt::format("# {}\n\n{}\n\n", experiment.title, experiment.group);
  bool in_verdicts = false;
  for (const Section& section : report.sections) {
    const bool verdict = std::holds_alternative<Verdict>(section);
    if (verdict && !in_verdicts) text += "What the verdict decides:\n\n";
    if (in_verdicts && !verdict) text += "\n";
    text += std::visit(MarkdownWriter{std::string(pictures)}, section);
    in_verdicts = verdict;
  }
  return text;
}

}  // namespace montelux::lab
