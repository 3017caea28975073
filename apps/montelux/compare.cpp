// montelux compare: methods take turns on a scene; the better one is named, with the confidence of the verdict.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "api/comparison.h"
#include "api/images.h"
#include "api/render.h"
#include "compare_output.h"
#include "options.h"
#include "progress.h"
#include "signals.h"
#include "status.h"
#include "verbs.h"

namespace montelux::cli {

namespace {

struct CompareArguments {
  std::string scene;
  LoadOptions load;
  ComparisonOptions comparison;
  std::optional<std::string> report, save, resume;
  std::optional<int> repeats;  // as typed
  std::optional<lab::ErrorMeasure> measure;
  bool json = false, csv = false, quiet = false, no_progress = false, no_cache = false, no_attribution = false;
  bool no_slopes = false;
};

constexpr const char* examples = R"(Examples:
  montelux compare room.pbrt -a path -b 'direct:strategy=ris,candidates=32' --spp 64
  montelux compare room.pbrt -a path -b path:mis=balance -c naive --time 20s --repeats 12 -o report.html
  montelux compare room.pbrt -a old=path:sampler=halton -b new=path:sampler=blue-noise --reference truth.exr --json
  montelux compare room.pbrt -a path -b naive --set maxdepth=8 --measure mse
  montelux compare room.pbrt -a path -b restir-di:frames=1,warm-up=12 --warm-frames --spp 4
  montelux compare room.pbrt -a path -b naive --time 20s --save run.json
  montelux compare --resume run.json --time 60s --save run.json -o report.html

The methods take turns in independent repeats, so every figure has an error bar. Efficiency is
1 / (error x seconds), with the error by --measure. If the interval of a ratio contains one, it is undecided.
--time is for each method, over all of its repeats; pilots, the reference, slopes and attribution take additional time.
After the pilots the total duration is predicted.
Exit status: 0 compared (decided or not); 1 the reference is not good enough; 2 and above as for render.
)";

// The command line that repeats the comparison.
std::string repeat_command(const CompareArguments& arguments, std::size_t repeats) {
  const ComparisonOptions& c = arguments.comparison;
  std::string line = fmt::format("montelux compare {}", arguments.scene);
  for (std::size_t i = 0; i < c.methods.size(); ++i) line += fmt::format(" -{} '{}'", char('a' + int(i)), c.methods[i]);
  if (c.seconds) line += fmt::format(" --time {}s", *c.seconds * double(repeats) / c.repeats);
  if (c.samples) line += fmt::format(" --spp {}", *c.samples);
  if (c.reference) line += fmt::format(" --reference {}", c.reference->string());
  if (arguments.load.resolution)
    line += fmt::format(" --resolution {}x{}", arguments.load.resolution->first, arguments.load.resolution->second);
  if (arguments.load.resolution_scale) line += fmt::format(" --resolution {}%", 100 * *arguments.load.resolution_scale);
  if (c.crop) line += fmt::format(" --crop {},{},{},{}", c.crop->x0, c.crop->y0, c.crop->x1, c.crop->y1);
  if (arguments.load.camera) line += fmt::format(" --camera '{}'", *arguments.load.camera);
  if (arguments.load.animation) line += fmt::format(" --animation '{}'", *arguments.load.animation);
  if (arguments.load.shutter)
    line += fmt::format(" --shutter {}:{}", arguments.load.shutter->open, arguments.load.shutter->close);
  if (const auto& e = arguments.load.environment)
    line += fmt::format(" --environment '{}:rotation={},scale={}'", e->file, e->rotation, e->scale);
  if (arguments.load.lenient) line += " --lenient";
  for (const auto& [key, value] : c.settings) line += fmt::format(" --set '{}={}'", key, value);
  if (c.measure != ComparisonOptions{}.measure) line += fmt::format(" --measure {}", lab::key_of(c.measure));
  if (c.confidence != ComparisonOptions{}.confidence) line += fmt::format(" --confidence {}", c.confidence);
  if (c.warm_frames) line += " --warm-frames";
  if (c.processor_time) line += " --clock processor";
  if (!c.slopes) line += " --no-slopes";
  if (!c.attribution) line += " --no-attribution";
  return line + fmt::format(" --repeats {} --seed {} -o {}", repeats, c.seed, *arguments.report);
}

// The comparison in a file, to be continued: everything except the budget and the measure comes from the file.
Result<SavedComparison> resumed(CompareArguments& arguments) {
  ComparisonOptions& now = arguments.comparison;
  if (!arguments.scene.empty() || !now.methods.empty() || now.samples || now.reference || now.crop || now.seed != 0 ||
      arguments.load.resolution || arguments.load.resolution_scale || arguments.load.lenient || arguments.load.camera ||
      arguments.load.animation || arguments.load.shutter || arguments.load.environment || arguments.no_cache ||
      now.confidence != ComparisonOptions{}.confidence || arguments.no_attribution || arguments.no_slopes ||
      now.warm_frames || now.processor_time || !now.settings.empty())
    return Failure{
        "--resume takes the scene, the methods, the seed and all settings from the file; only the budget (--time or "
        "--repeats) and --measure may be given"};
  Result<SavedComparison> saved = load_comparison(*arguments.resume);
  if (!saved) return saved;
  saved->options.threads = now.threads;
  saved->options.measure = arguments.measure.value_or(saved->options.measure);
  saved->load.threads = now.threads;
  arguments.scene = saved->scene.string(), arguments.load = saved->load;
  return saved;
}

// Checks the options of a new comparison, as far as possible without the scene.
Status check_new(CompareArguments& arguments) {
  if (arguments.scene.empty()) return Failure{"a scene is missing: montelux compare SCENE -a METHOD -b METHOD"};
  if (arguments.comparison.methods.size() < 2)
    return Failure{"at least two methods are needed: -a METHOD -b METHOD; montelux list integrators names them"};
  if (Status known = check_methods(arguments.comparison); !known) return known;
  if (arguments.repeats && *arguments.repeats < 2) return Failure{"at least two repeats are needed: --repeats 2"};
  arguments.comparison.repeats = arguments.repeats.value_or(arguments.comparison.repeats);
  arguments.comparison.measure = arguments.measure.value_or(arguments.comparison.measure);
  arguments.comparison.cache = !arguments.no_cache;
  arguments.comparison.attribution = !arguments.no_attribution;
  arguments.comparison.slopes = !arguments.no_slopes;
  arguments.load.threads = arguments.comparison.threads;
  return Done{};
}

// Prints the predicted duration, and then the progress.
ComparisonObserver observer_of(const CompareArguments& arguments, const StopSignals& signals, StatusLine& line) {
  ComparisonObserver observer;
  observer.stop = [&signals] { return signals.received() != 0; };
  const std::size_t methods = arguments.comparison.methods.size();
  const int repeats =
      arguments.resume ? arguments.repeats.value_or(arguments.comparison.repeats) : arguments.comparison.repeats;
  if (!arguments.quiet)
    observer.forecast = [&line, methods, repeats](const ComparisonForecast& forecast) {
      line.finish();
      fmt::print(stderr, "{}\n", forecast_text(forecast, repeats, methods));
    };
  observer.progress = [&line](const ComparisonProgress& p) {
    line.show(
        p.fraction, p.elapsed,
        [&p] { return fmt::format("{}  left {}  {}", time_text(p.elapsed), time_text(p.remaining), p.what); }, p.what);
  };
  return observer;
}

Status write_results(const CompareArguments& arguments, Comparison& comparison) {
  if (arguments.save) {
    comparison.saved.scene = std::filesystem::absolute(arguments.scene);
    comparison.saved.load = arguments.load;
    comparison.saved.fingerprint = scene_fingerprint(arguments.scene, arguments.load.environment);
    if (Status written = save_comparison(*arguments.save, comparison.saved); !written) return written;
  }
  if (!arguments.report) return Done{};
  return write_comparison(*arguments.report, comparison, arguments.scene, arguments.comparison.confidence,
                          {repeat_command(arguments, comparison.result.methods.front().repeats.size())});
}

// Prints notes and results of a comparison; returns the exit status.
int finish_compare(const CompareArguments& arguments, Comparison& comparison, const StopSignals& signals) {
  const Status written = write_results(arguments, comparison);
  if (!arguments.quiet) {
    for (const std::string& note : comparison.notes) warn(note);
    if (!comparison.refusal.empty()) warn(comparison.refusal);
    if (comparison.result.interrupted) warn("interrupted: the figures are those of the finished repeats");
  }
  if (!written) {
    complain(written.error());
    return failed;
  }
  if (arguments.json)
    print_comparison_json(arguments.scene, comparison);
  else if (arguments.csv)
    print_comparison_csv(comparison);
  else
    print_comparison_text(arguments.scene, comparison);
  if (comparison.result.interrupted) return 128 + signals.received();
  return comparison.refusal.empty() ? done : differs;
}

// A report replaces no file that is something else by its name.
Status check_report_file(const std::string& file) {
  const std::string extension = extension_of(file);
  if (!extension.empty() && extension != ".html" && extension != ".htm")
    return Failure{fmt::format("cannot write '{}': the report is an HTML page, so its ending must be .html", file)};
  return check_output_file(file);
}

int run_compare(CompareArguments& arguments) {
  if (arguments.save)
    if (Status good = check_comparison_file(*arguments.save); !good) return complain(good.error());
  if (arguments.report)
    if (Status good = check_report_file(*arguments.report); !good) return complain(good.error());
  std::optional<SavedComparison> saved;
  const ComparisonBudget more{arguments.repeats, arguments.comparison.seconds};
  if (arguments.resume) {
    Result<SavedComparison> found = resumed(arguments);
    if (!found) return complain(found.error());
    saved = *std::move(found);
    arguments.comparison = saved->options;
  } else if (Status good = check_new(arguments); !good) {
    return complain(good.error());
  }
  LoadResult loaded = load_scene(arguments.scene, arguments.load);
  print_diagnostics(loaded.diagnostics, arguments.quiet);
  if (!loaded.scene) return bad_input;

  StopSignals signals;
  StatusLine line(!arguments.quiet && !arguments.no_progress);
  const ComparisonObserver observer = observer_of(arguments, signals, line);
  Result<Comparison> comparison = saved ? continue_comparison(*loaded.scene, *std::move(saved), more, observer)
                                        : compare_methods(*loaded.scene, arguments.comparison, observer);
  line.finish();
  if (comparison) return finish_compare(arguments, *comparison, signals);
  complain(comparison.error());
  return signals.received() != 0 ? 128 + signals.received() : bad_input;
}

void add_method_options(CLI::App& verb, ComparisonOptions& comparison) {
  const auto add = [&comparison](const std::string& text) -> Status {
    ComparisonOptions alone;
    alone.methods = {text};
    comparison.methods.push_back(text);
    return check_methods(alone);
  };
  const char* help[] = {
      "first method: an integrator with settings, as for --integrator of render, or sampler=NAME; NAME=METHOD "
      "sets its name",
      "second method"};
  for (char letter = 'a'; letter <= 'f'; ++letter)
    add_option(verb, {fmt::format("-{}", letter), "METHOD", letter <= 'b' ? help[letter - 'a'] : "and so on"}, add);
  add_option(verb,
             {"--set", "key=value", "a setting for all methods that do not state their own; may be repeated", true},
             [&comparison](const std::string& text) -> Status {
               auto setting = parse_setting(text);
               if (!setting) return setting.failure();
               comparison.settings.push_back(*setting);
               return Done{};
             });
}

}  // namespace

void add_compare(CLI::App& app, Action& chosen) {
  auto arguments = std::make_shared<CompareArguments>();
  ComparisonOptions& comparison = arguments->comparison;
  CLI::App& verb = *app.add_subcommand("compare", "Compare integrators on a scene at equal time, with error bars");
  verb.footer(examples);
  add_scene_options(verb, arguments->scene, arguments->load);
  verb.get_option("SCENE")->required(false);
  add_method_options(verb, comparison);
  add_option(verb, {"-o,--output", "FILE", "write the report, one HTML page that needs no network"},
             [arguments](const std::string& file) -> Status {
               arguments->report = file;
               return Done{};
             });
  add_option(verb,
             {"--time", "TIME",
              "for each method, over all its repeats (500ms, 30s, 10m); pilots, reference, slopes and attribution take "
              "additional time, which is predicted"},
             into(comparison.seconds, parse_time));
  add_option(verb, {"--spp", "N", "instead: samples per pixel in each repeat (default 64)"},
             into(comparison.samples, [](const std::string& t) { return parse_whole(t, 1, 1 << 20); }));
  verb.get_option("--time")->excludes("--spp");
  add_option(verb, {"--repeats", "R", "independent repeats of each method (default 8); with --resume: that many more"},
             into(arguments->repeats, [](const std::string& t) { return parse_whole(t, 1, 10000); }));
  verb.add_flag(
      "--warm-frames", comparison.warm_frames,
      "compare frames of a sequence: the warm-up frames have been shown anyway, so their time does not count");
  const std::vector<std::string> clocks{"wall", "processor"};
  add_option(verb, {"--clock", alternatives(clocks), "processor: processor time of all threads, for busy machines"},
             [&comparison, clocks](const std::string& text) -> Status {
               const auto name = parse_choice(text, clocks);
               if (!name) return name.failure();
               comparison.processor_time = *name == "processor";
               return Done{};
             });
  add_option(verb,
             {"--reference", "FILE",
              "reference image, finite in every pixel; default: rendered by the most efficient method by the "
              "measure"},
             [&comparison](const std::string& file) -> Status {
               if (file != "auto") comparison.reference = file;
               return Done{};
             });
  const std::vector<std::string> measures{"relmse", "mse", "flip"};
  add_option(verb, {"--measure", alternatives(measures), "the error that verdicts use (default relmse)"},
             [arguments, measures](const std::string& text) -> Status {
               const auto name = parse_choice(text, measures);
               if (!name) return name.failure();
               arguments->measure = lab::measure_named(*name);
               return Done{};
             });
  add_option(verb, {"--confidence", "C", "of the intervals (default 0.95)"},
             into(comparison.confidence, [](const std::string& t) { return parse_number(t, 0.5, 0.9999); }));
  add_option(verb, {"--seed", "S", "seed of all random numbers (default 0)"},
             into(comparison.seed, [](const std::string& t) { return parse_whole(t, 0, 0x7fffffff); }));
  add_option(verb, {"--threads", "T", "threads; default: one for each processor"},
             into(comparison.threads, [](const std::string& t) { return parse_whole(t, 1, 4096); }));
  add_option(verb, {"--crop", "x0,y0,x1,y1", "only these pixels (x1 and y1 are excluded)"},
             into(comparison.crop, parse_crop));
  add_option(verb, {"--save", "FILE", "save the state of the comparison, to be resumed"},
             [arguments](const std::string& file) -> Status {
               arguments->save = file;
               return Done{};
             });
  add_option(verb, {"--resume", "FILE", "continue a saved comparison with more --time or --repeats"},
             [arguments](const std::string& file) -> Status {
               arguments->resume = file;
               return Done{};
             });
  verb.add_flag("--no-attribution", arguments->no_attribution,
                "do not attribute the variance to layers of light (saves a fifth of the time)");
  verb.add_flag("--no-slopes", arguments->no_slopes, "do not measure convergence slopes (saves a third of the time)");
  verb.add_flag("--no-cache", arguments->no_cache, "do not use or store references in the cache");
  verb.add_flag("--json", arguments->json, "results as one JSON object");
  verb.add_flag("--csv", arguments->csv, "each repeat as one line of CSV");
  verb.add_flag("--quiet", arguments->quiet, "no progress, notes or warnings");
  verb.add_flag("--no-progress", arguments->no_progress, "no progress");
  verb.callback([arguments, &chosen] { chosen = [arguments] { return run_compare(*arguments); }; });
}

}  // namespace montelux::cli
