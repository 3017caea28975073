// montelux lab: the experiments of the source documents, with their verdicts and reports.
#include "api/lab.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "api/images.h"
#include "api/json_text.h"
#include "options.h"
#include "progress.h"
#include "signals.h"
#include "status.h"
#include "verbs.h"

namespace montelux::cli {

namespace {

using Json = nlohmann::ordered_json;

struct LabArguments {
  std::string action, name, output;
  LabOptions options;
  bool json = false, quiet = false;
};

constexpr const char* examples = R"(Examples:
  montelux lab list
  montelux lab list circle
  montelux lab run all -o out/lab
  montelux lab run neighbour-bias -o out --seed 7 --set candidates=8
  montelux lab run roulette -o out --fault

Writes report.html (one file, needs no network), report.json, and for each experiment its figures (.svg), its data
(.csv) and its images (.png).
Exit status: 0 every verdict holds; 1 one does not; 2 error.
)";

// Formulas without their dollar signs.
std::string plain(std::string text) {
  std::erase(text, '$');
  return text;
}

Json to_json(const ExperimentEntry& e) {
  Json settings = Json::array();
  for (const ExperimentSetting& s : e.settings)
    settings.push_back({{"name", s.name}, {"value", s.value}, {"meaning", s.meaning}});
  return {{"name", e.name},         {"title", e.title}, {"group", e.group},
          {"question", e.question}, {"fault", e.fault}, {"settings", settings}};
}

int list_all(bool json) {
  const std::vector<ExperimentEntry> entries = list_experiments();
  if (json) {
    Json array = Json::array();
    for (const ExperimentEntry& e : entries) array.push_back(to_json(e));
    fmt::print("{}\n", json_text(std::move(array), 2));
    return done;
  }
  std::string group;
  for (const ExperimentEntry& e : entries) {
    if (e.group != group) fmt::print("{}{}\n", group.empty() ? "" : "\n", e.group);
    group = e.group;
    fmt::print("  {:20} {}\n", e.name, e.title);
  }
  return done;
}

int list_one(const std::string& name, bool json) {
  const std::vector<ExperimentEntry> entries = list_experiments();
  std::vector<std::string> names;
  for (const ExperimentEntry& e : entries) names.push_back(e.name);
  if (Result<std::string> known = parse_choice(name, names); !known) return complain("lab list: " + known.error());
  for (const ExperimentEntry& e : entries) {
    if (e.name != name) continue;
    if (json) {
      fmt::print("{}\n", json_text(to_json(e), 2));
      return done;
    }
    fmt::print("{}: {}\n\n{}\n\nSettings (--set NAME=VALUE):\n", e.name, e.title, plain(e.question));
    for (const ExperimentSetting& s : e.settings) fmt::print("  {:14} {} (default {:g})\n", s.name, s.meaning, s.value);
    fmt::print("Planted by --fault: {}\n", e.fault);
  }
  return done;
}

class LabProgress final : public LabObserver {
 public:
  LabProgress(bool visible, const StopSignals& signals) : visible_(visible), signals_(signals) {}

  void finished(const LabOutcome& outcome, std::size_t count, std::size_t total) override {
    if (!visible_) return;
    print_log(fmt::format("{:>3}/{} {:20} {:>8}  {}\n", count, total, outcome.name, time_text(outcome.seconds),
                          outcome.passed ? "holds" : "FAILS"));
  }
  bool stop_requested() override { return signals_.received() != 0; }

 private:
  bool visible_;
  const StopSignals& signals_;
};

void print_json(const LabRun& run, const LabOptions& options, const std::string& folder) {
  Json json{{"seed", options.seed}, {"planted_fault", options.planted_fault}, {"passed", run.passed()}};
  json["seconds"] = run.seconds, json["folder"] = folder;
  json["page"] = run.page ? Json(run.page->string()) : Json();
  json["experiments"] = Json::array();
  for (const LabOutcome& outcome : run.outcomes) {
    Json one{
        {"name", outcome.name}, {"passed", outcome.passed}, {"seconds", outcome.seconds}, {"verdicts", Json::array()}};
    for (const LabVerdict& v : outcome.verdicts)
      one["verdicts"].push_back({{"claim", v.claim}, {"detail", v.detail}, {"passed", v.passed}});
    json["experiments"].push_back(std::move(one));
  }
  fmt::print("{}\n", json_text(std::move(json), 2));
}

void print_text(const LabRun& run, const std::string& folder) {
  std::size_t verdicts = 0, failures = 0;
  for (const LabOutcome& outcome : run.outcomes)
    for (const LabVerdict& v : outcome.verdicts) {
      ++verdicts, failures += !v.passed;
      if (!v.passed) fmt::print("{}: FAILS: {} ({})\n", outcome.name, plain(v.claim), plain(v.detail));
    }
  fmt::print("{} experiments, {} verdicts, {}; {}\n", run.outcomes.size(), verdicts,
             failures == 0 ? "all hold" : fmt::format("{} fail", failures), time_text(run.seconds));
  fmt::print("{} files in {}\n", run.files.size(), folder);
  if (run.page) fmt::print("report: {}\n", run.page->string());
}

int run_experiments(LabArguments& arguments) {
  if (arguments.name.empty()) return complain("lab run: an experiment is missing: a name of montelux lab list, or all");
  if (arguments.output.empty()) return complain("lab run: -o DIR is missing, the folder for the report");
  if (Status good = check_output_folder(arguments.output); !good) return complain(good.error());
  if (arguments.name != "all") arguments.options.names = {arguments.name};
  const StopSignals signals;
  LabProgress progress(!arguments.quiet, signals);
  Result<LabRun> run = run_lab(arguments.options, arguments.output, progress);
  if (!run) return complain(run.error());
  if (!run->why_not_written.empty()) return complain(run->why_not_written, failed);
  if (!run->page && !arguments.quiet) warn(run->why_no_page);
  if (arguments.json)
    print_json(*run, arguments.options, arguments.output);
  else
    print_text(*run, arguments.output);
  if (signals.received() != 0) return 128 + signals.received();
  return run->passed() ? done : differs;
}

int run_lab_verb(LabArguments& arguments) {
  if (arguments.action == "run") return run_experiments(arguments);
  return arguments.name.empty() ? list_all(arguments.json) : list_one(arguments.name, arguments.json);
}

}  // namespace

void add_lab(CLI::App& app, Action& chosen) {
  auto arguments = std::make_shared<LabArguments>();
  CLI::App& verb = *app.add_subcommand("lab", "Run the experiments of the source documents, each with a verdict");
  verb.footer(examples);
  const std::vector<std::string> actions{"list", "run"};
  add_option(verb, {"ACTION", alternatives(actions), "list the experiments, or run them"},
             into(arguments->action, [actions](const std::string& text) { return parse_choice(text, actions); }));
  verb.add_option("NAME", arguments->name, "an experiment, or all")->type_name("NAME");
  verb.add_option("-o,--output", arguments->output, "folder of the report")->type_name("FILE");
  add_option(verb, {"--seed", "N", "seed of all random numbers (default 0)"},
             [arguments](const std::string& text) -> Status {
               Result<int> seed = parse_whole(text, 0, 2147483647);
               if (!seed) return seed.failure();
               arguments->options.seed = std::uint32_t(*seed);
               return Done{};
             });
  add_option(verb, {"--set", "NAME=VALUE", "setting of the experiment; repeatable", true},
             [arguments](const std::string& text) -> Status {
               Result<std::pair<std::string, std::string>> setting = parse_setting(text);
               if (!setting) return setting.failure();
               Result<double> value = parse_number(setting->second, 0, 1e9);
               if (!value) return value.failure();
               arguments->options.settings[setting->first] = *value;
               return Done{};
             });
  verb.add_flag("--fault", arguments->options.planted_fault, "plant the fault that the verdict must detect");
  add_option(verb, {"--threads", "N", "number of threads; default: one for each processor"},
             into(arguments->options.threads, [](const std::string& text) { return parse_whole(text, 1, 1024); }));
  verb.add_flag("--json", arguments->json, "results as JSON");
  verb.add_flag("-q,--quiet", arguments->quiet, "no progress, notes or warnings");
  verb.callback([arguments, &chosen] { chosen = [arguments] { return run_lab_verb(*arguments); }; });
}

}  // namespace montelux::cli
