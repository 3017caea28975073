// montelux compare: methods take turns on a scene, and the better one is named, with how sure that is.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "api/contest.h"
#include "api/images.h"
#include "api/json_text.h"
#include "api/render.h"
#include "options.h"
#include "progress.h"
#include "signals.h"
#include "status.h"
#include "verbs.h"

namespace montelux::cli {

namespace {

using Json = nlohmann::ordered_json;
using lab::Measured;
using lab::MethodResult;

struct CompareArguments {
  std::string scene;
  LoadOptions load;
  ContestOptions contest;
  std::optional<std::string> report, save, resume;
  std::optional<int> repeats;  // as typed
  bool json = false, csv = false, quiet = false, no_progress = false, no_cache = false, no_attribution = false;
  bool no_slopes = false;
};

constexpr const char* examples = R"(Examples:
  montelux compare room.pbrt -a path -b 'direct:strategy=ris,candidates=32' --spp 64
  montelux compare room.pbrt -a path -b path:mis=balance -c naive --time 20s --repeats 12 -o report.html
  montelux compare room.pbrt -a path:sampler=halton -b path:sampler=blue-noise --reference truth.exr --json
  montelux compare room.pbrt -a path -b restir-di:chain=1,warm-up=12 --warm-frames --spp 4
  montelux compare room.pbrt -a path -b naive --time 20s --save run.json
  montelux compare --resume run.json --time 60s --save run.json -o report.html

Each method is run in independent repeats, the methods taking turns, so every figure has an error bar. Efficiency is
1 / (mean squared error x seconds). Where the interval of a ratio holds one, nothing is decided.
Exit status: 0 compared (decided or not); 1 the reference is not good enough; 2 and above as for render.
)";

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json to_json(const Measured& m) {
  return {{"mean", m.count > 0 ? number(m.mean) : Json()},
          {"interval", {number(m.low), number(m.high)}},
          {"standard_error", number(m.standard_error)}};
}

Json to_json(const WelchScale& scale) {
  return {{"tests", scale.tests}, {"smallest_p", scale.smallest_p}, {"t", number(scale.t)}, {"differs", scale.differs}};
}

// The shares of the variance by family and layer.
Json to_json(const lab::Attribution& attribution) {
  Json json = Json::object();
  for (const lab::FamilyShares& family : attribution.families)
    for (const lab::LayerShare& layer : family.layers) json[family.name][layer.name] = to_json(layer.share);
  return json;
}

Json to_json(const MethodResult& m) {
  Json json;
  json["label"] = m.contestant.label;
  json["method"] = m.contestant.text;
  json["sampler"] = name_of(m.contestant.sampler);
  json["biases"] = m.contestant.biases;
  json["repeats"] = m.repeats.size();
  json["mse"] = to_json(m.mse);
  json["relative_mse"] = to_json(m.relative_mse);
  json["flip"] = to_json(m.flip);
  json["variance"] = to_json(m.variance);
  json["seconds"] = to_json(m.seconds);
  json["warm_up_seconds"] = to_json(m.warm_up);
  json["seconds_with_warm_up"] = to_json(m.all_seconds);
  json["samples"] = to_json(m.samples);
  json["rays"] = to_json(m.rays);
  json["efficiency"] = to_json(m.efficiency);
  json["relative_efficiency"] = to_json(m.relative_efficiency);
  json["efficiency_with_warm_up"] = to_json(m.whole_efficiency);
  json["relative_efficiency_with_warm_up"] = to_json(m.whole_relative_efficiency);
  json["coverage"] = to_json(m.coverage);
  json["slope_by_samples"] = to_json(m.slope_by_samples);
  json["slope_by_time"] = to_json(m.slope_by_time);
  json["differs_from_reference"] = lab::differs_from_reference(m);
  json["bias_squared"] = to_json(m.bias_squared);
  json["bias"] = {
      {"image", to_json(m.bias.image)}, {"blocks", to_json(m.bias.blocks)}, {"pixels", to_json(m.bias.pixels)}};
  json["non_finite"] = m.non_finite;
  Json curve = Json::array();
  for (const lab::ConvergencePoint& p : m.convergence)
    curve.push_back({{"samples", p.samples}, {"mse", to_json(p.mse)}, {"seconds", to_json(p.seconds)}});
  json["convergence"] = curve;
  json["attribution"] = m.attribution ? to_json(*m.attribution) : Json();
  return json;
}

void print_json(const CompareArguments& arguments, const Contest& contest) {
  const lab::ContestResult& r = contest.result;
  Json json;
  json["version"] = version();
  json["scene"] = arguments.scene;
  json["seed"] = arguments.contest.seed;
  json["confidence"] = arguments.contest.confidence;
  json["reference"] = {{"origin", r.reference.origin}, {"share_of_smallest_mse", number(r.reference_share)}};
  json["refused"] = contest.refusal.empty() ? Json() : Json(contest.refusal);
  json["interrupted"] = r.interrupted;
  json["warm_up_counts"] = r.warm_up_counts;
  json["clock"] = arguments.contest.processor_time ? "processor" : "wall";
  json["methods"] = Json::array();
  for (const MethodResult& m : r.methods) json["methods"].push_back(to_json(m));
  json["verdicts"] = Json::array();
  for (const lab::PairVerdict& v : r.verdicts)
    json["verdicts"].push_back({{"first", r.methods[v.first].contestant.label},
                                {"second", r.methods[v.second].contestant.label},
                                {"efficiency_ratio", to_json(v.ratio)},
                                {"relative_efficiency_ratio", to_json(v.relative_ratio)},
                                {"efficiency_ratio_with_warm_up", to_json(v.whole_ratio)},
                                {"relative_efficiency_ratio_with_warm_up", to_json(v.whole_relative_ratio)},
                                {"decided", v.decided && contest.refusal.empty()},
                                {"times_longer_to_decide", number(v.times_longer)}});
  fmt::print("{}\n", json_text(std::move(json), 2));
}

std::string spread(const Measured& m) {
  if (m.count < 2) return fmt::format("{:.4g}", m.mean);
  return fmt::format("{:.4g} ± {:.1g}", m.mean, m.high - m.mean);
}

void print_csv(const Contest& contest) {
  fmt::print("label,method,repeat,seconds,samples,rays,mse,relative_mse,flip,variance,coverage");
  // The layers are those of the scene, so all methods that have them have the same.
  std::vector<std::string> layers;
  for (const MethodResult& m : contest.result.methods)
    if (layers.empty() && m.contestant.layers) layers = layer_names(*m.contestant.layers);
  if (!contest.result.warm_up_counts) fmt::print(",warm_up_seconds");
  for (const std::string& name : layers) fmt::print(",share_{}", name);
  fmt::print("\n");
  for (std::size_t k = 0; k < contest.result.methods.size(); ++k) {
    const MethodResult& m = contest.result.methods[k];
    const std::vector<lab::AttributionRound>& attribution = contest.saved.state.methods[k].attribution;
    for (std::size_t i = 0; i < m.repeats.size(); ++i) {
      const lab::Repeat& r = m.repeats[i];
      fmt::print("{},\"{}\",{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}", m.contestant.label,
                 m.contestant.text, i, r.seconds, r.samples, r.rays, r.mse, r.relative_mse, r.flip, r.variance,
                 r.coverage);
      if (!contest.result.warm_up_counts) fmt::print(",{:.9g}", r.warm_up);
      for (std::size_t layer = 0; layer < layers.size(); ++layer)
        fmt::print(",{}", attribution.empty()
                              ? std::string()
                              : fmt::format("{:.9g}", attribution[i].layers[layer] / attribution[i].all));
      fmt::print("\n");
    }
  }
}

// "variance by bounces: bounce1 62 ± 3 %, ..."; what has less than half a percent is left out.
void print_attribution(const lab::Attribution& attribution) {
  for (const lab::FamilyShares& family : attribution.families) {
    if (family.layers.size() < 2) continue;
    std::string line;
    for (const lab::LayerShare& layer : family.layers) {
      const Measured& share = layer.share;
      if (std::abs(share.mean) < 0.005) continue;
      line += fmt::format("{}{} {:.0f}", line.empty() ? "" : ", ", layer.name, 100 * share.mean);
      if (share.count >= 2) line += fmt::format(" ± {:.1g}", 100 * (share.high - share.mean));
      line += " %";
    }
    fmt::print("   variance by {}: {}\n", family.name, line.empty() ? "there is none" : line);
  }
}

void print_text(const CompareArguments& arguments, const Contest& contest) {
  const lab::ContestResult& r = contest.result;
  for (const MethodResult& m : r.methods) {
    const Measured& s = m.slope_by_samples;
    fmt::print("{}  {}\n", m.contestant.label, m.contestant.text);
    fmt::print("   mse {}   relMSE {}   FLIP {}\n", spread(m.mse), spread(m.relative_mse), spread(m.flip));
    fmt::print("   {} repeats of {:.3g} s{} and {:.4g} samples a pixel, {:.3g} rays\n", m.repeats.size(),
               m.seconds.mean, arguments.contest.processor_time ? " on processors" : "", m.samples.mean, m.rays.mean);
    if (!r.warm_up_counts && m.warm_up.mean > 0)
      fmt::print("   not counted: {:.3g} s of warm-up in each repeat; with it efficiency {}\n", m.warm_up.mean,
                 spread(m.whole_efficiency));
    fmt::print("   efficiency {}   slope by samples {}   error bars hold {}\n", spread(m.efficiency),
               s.count >= 2 ? spread(s) : "-",
               std::isfinite(m.coverage.mean) ? fmt::format("{:.1f} %", 100 * m.coverage.mean) : "-");
    fmt::print("   mean {} the reference (image {}, squared bias {})\n",
               lab::differs_from_reference(m) ? "differs from" : "agrees with",
               fmt::format("{:+.1f} standard errors", m.bias.image.t), spread(m.bias_squared));
    if (m.attribution) print_attribution(*m.attribution);
  }
  fmt::print("reference  {} ({:.2g} of the smallest mse)\n", r.reference.origin, r.reference_share);
  for (const lab::PairVerdict& v : r.verdicts)
    fmt::print("{}\n", sentence_of(contest, v, arguments.contest.confidence));
}

// The command line that makes the comparison again.
std::string repeat_command(const CompareArguments& arguments, std::size_t repeats) {
  const ContestOptions& c = arguments.contest;
  std::string line = fmt::format("montelux compare {}", arguments.scene);
  for (std::size_t i = 0; i < c.methods.size(); ++i) line += fmt::format(" -{} '{}'", char('a' + int(i)), c.methods[i]);
  if (c.seconds) line += fmt::format(" --time {}s", *c.seconds * double(repeats) / c.repeats);
  if (c.samples) line += fmt::format(" --spp {}", *c.samples);
  if (c.reference) line += fmt::format(" --reference {}", c.reference->string());
  if (arguments.load.resolution)
    line += fmt::format(" --resolution {}x{}", arguments.load.resolution->first, arguments.load.resolution->second);
  if (c.crop) line += fmt::format(" --crop {},{},{},{}", c.crop->x0, c.crop->y0, c.crop->x1, c.crop->y1);
  if (arguments.load.camera) line += fmt::format(" --camera '{}'", *arguments.load.camera);
  if (arguments.load.animation) line += fmt::format(" --animation '{}'", *arguments.load.animation);
  if (arguments.load.shutter)
    line += fmt::format(" --shutter {}:{}", arguments.load.shutter->open, arguments.load.shutter->close);
  if (arguments.load.lenient) line += " --lenient";
  if (c.confidence != ContestOptions{}.confidence) line += fmt::format(" --confidence {}", c.confidence);
  if (c.warm_frames) line += " --warm-frames";
  if (c.processor_time) line += " --clock processor";
  if (!c.slopes) line += " --no-slopes";
  if (!c.attribution) line += " --no-attribution";
  return line + fmt::format(" --repeats {} --seed {} -o {}", repeats, c.seed, *arguments.report);
}

// The comparison of a file, to be gone on with: everything but the budget is the file's.
Result<SavedContest> resumed(CompareArguments& arguments) {
  ContestOptions& now = arguments.contest;
  if (!arguments.scene.empty() || !now.methods.empty() || now.samples || now.reference || now.crop || now.seed != 0 ||
      arguments.load.resolution || arguments.load.lenient || arguments.load.camera || arguments.load.animation ||
      arguments.load.shutter || arguments.no_cache || now.confidence != ContestOptions{}.confidence ||
      arguments.no_attribution || arguments.no_slopes || now.warm_frames || now.processor_time)
    return Failure{
        "--resume takes the scene, the methods, the seed and all settings from the file; only the budget (--time or "
        "--repeats) may be given"};
  Result<SavedContest> saved = load_contest(*arguments.resume);
  if (!saved) return saved;
  saved->options.threads = now.threads;
  saved->load.threads = now.threads;
  arguments.scene = saved->scene.string(), arguments.load = saved->load;
  return saved;
}

int run_compare(CompareArguments& arguments) {
  for (const auto& file : {arguments.save, arguments.report})
    if (file)
      if (Status good = check_output_file(*file); !good) return complain(good.error());
  std::optional<SavedContest> saved;
  const ContestBudget more{arguments.repeats, arguments.contest.seconds};
  if (arguments.resume) {
    Result<SavedContest> found = resumed(arguments);
    if (!found) return complain(found.error());
    saved = *std::move(found);
    arguments.contest = saved->options;
  } else {
    if (arguments.scene.empty()) return complain("a scene is missing: montelux compare SCENE -a METHOD -b METHOD");
    if (arguments.contest.methods.size() < 2)
      return complain("at least two methods are needed: -a METHOD -b METHOD; montelux list integrators names them");
    if (Status known = check_methods(arguments.contest.methods); !known) return complain(known.error());
    if (arguments.repeats && *arguments.repeats < 2) return complain("at least two repeats are needed: --repeats 2");
    arguments.contest.repeats = arguments.repeats.value_or(arguments.contest.repeats);
    arguments.contest.cache = !arguments.no_cache;
    arguments.contest.attribution = !arguments.no_attribution;
    arguments.contest.slopes = !arguments.no_slopes;
    arguments.load.threads = arguments.contest.threads;
  }
  LoadResult loaded = load_scene(arguments.scene, arguments.load);
  print_diagnostics(loaded.diagnostics, arguments.quiet);
  if (!loaded.scene) return bad_input;

  StopSignals signals;
  StatusLine line(!arguments.quiet && !arguments.no_progress);
  lab::ContestWatch watch;
  watch.stop = [&] { return signals.received() != 0; };
  watch.progress = [&](double fraction, double elapsed, const std::string& what) {
    line.show(fraction, elapsed, [&] { return what; });
  };
  Result<Contest> contest = saved ? continue_contest(*loaded.scene, *std::move(saved), more, watch)
                                  : compare_methods(*loaded.scene, arguments.contest, watch);
  line.finish();
  if (!contest) return complain(contest.error());
  if (arguments.save) {
    contest->saved.scene = std::filesystem::absolute(arguments.scene);
    contest->saved.load = arguments.load;
    contest->saved.fingerprint = scene_fingerprint(arguments.scene);
    if (Status written = save_contest(*arguments.save, contest->saved); !written) {
      complain(written.error());
      return failed;
    }
  }
  if (!arguments.quiet)
    for (const std::string& note : contest->notes) warn(note);
  if (!contest->refusal.empty()) warn(contest->refusal);
  if (contest->result.interrupted) warn("interrupted: the figures are of the repeats that were done");
  if (arguments.report)
    if (Status written = write_contest(*arguments.report, *contest, arguments.scene, arguments.contest.confidence,
                                       {repeat_command(arguments, contest->result.methods.front().repeats.size())});
        !written) {
      complain(written.error());
      return failed;
    }
  if (arguments.json)
    print_json(arguments, *contest);
  else if (arguments.csv)
    print_csv(*contest);
  else
    print_text(arguments, *contest);
  if (contest->result.interrupted) return 128 + signals.received();
  return contest->refusal.empty() ? done : differs;
}

void add_method_options(CLI::App& verb, ContestOptions& contest) {
  const auto add = [&contest](const std::string& text) -> Status {
    contest.methods.push_back(text);
    return check_methods({text});
  };
  const char* help[] = {
      "first method: an integrator with settings, as --integrator of render takes it; sampler=NAME too",
      "second method"};
  for (char letter = 'a'; letter <= 'f'; ++letter)
    add_option(verb, {fmt::format("-{}", letter), "METHOD", letter <= 'b' ? help[letter - 'a'] : "and so on"}, add);
}

}  // namespace

void add_compare(CLI::App& app, Action& chosen) {
  auto arguments = std::make_shared<CompareArguments>();
  ContestOptions& contest = arguments->contest;
  CLI::App& verb = *app.add_subcommand("compare", "Compare integrators on a scene at equal time, with error bars");
  verb.footer(examples);
  add_scene_options(verb, arguments->scene, arguments->load);
  verb.get_option("SCENE")->required(false);
  add_method_options(verb, contest);
  add_option(verb, {"-o,--output", "FILE", "write the report, one HTML page that needs no network"},
             [arguments](const std::string& file) -> Status {
               arguments->report = file;
               return Done{};
             });
  add_option(verb, {"--time", "TIME", "for each method, over all its repeats (500ms, 30s, 10m)"},
             into(contest.seconds, parse_time));
  add_option(verb, {"--spp", "N", "samples a pixel in each repeat instead (default 64)"},
             into(contest.samples, [](const std::string& t) { return parse_whole(t, 1, 1 << 20); }));
  verb.get_option("--time")->excludes("--spp");
  add_option(verb, {"--repeats", "R", "independent repeats of each method (default 8); with --resume: that many more"},
             into(arguments->repeats, [](const std::string& t) { return parse_whole(t, 1, 10000); }));
  verb.add_flag("--warm-frames", contest.warm_frames,
                "frames of a sequence: those of a warm-up have been shown anyway, so their time does not count");
  const std::vector<std::string> clocks{"wall", "processor"};
  add_option(verb, {"--clock", alternatives(clocks), "processor: time of all threads on processors, for busy machines"},
             [&contest, clocks](const std::string& text) -> Status {
               const auto name = parse_choice(text, clocks);
               if (!name) return name.failure();
               contest.processor_time = *name == "processor";
               return Done{};
             });
  add_option(verb, {"--reference", "FILE", "picture to hold them against; default: made by the most efficient method"},
             [&contest](const std::string& file) -> Status {
               if (file != "auto") contest.reference = file;
               return Done{};
             });
  add_option(verb, {"--confidence", "C", "of the intervals (default 0.95)"},
             into(contest.confidence, [](const std::string& t) { return parse_number(t, 0.5, 0.9999); }));
  add_option(verb, {"--seed", "S", "number of the realisation (default 0)"},
             into(contest.seed, [](const std::string& t) { return parse_whole(t, 0, 0x7fffffff); }));
  add_option(verb, {"--threads", "T", "threads; default: one for each processor"},
             into(contest.threads, [](const std::string& t) { return parse_whole(t, 1, 4096); }));
  add_option(verb, {"--crop", "x0,y0,x1,y1", "only these pixels (x1 and y1 are just outside)"},
             into(contest.crop, parse_crop));
  add_option(verb, {"--save", "FILE", "keep everything that was gathered, to be resumed"},
             [arguments](const std::string& file) -> Status {
               arguments->save = file;
               return Done{};
             });
  add_option(verb, {"--resume", "FILE", "go on with a saved comparison, by --time or --repeats more"},
             [arguments](const std::string& file) -> Status {
               arguments->resume = file;
               return Done{};
             });
  verb.add_flag("--no-attribution", arguments->no_attribution,
                "do not tell which layers of light the variance comes from (saves a fifth of the time)");
  verb.add_flag("--no-slopes", arguments->no_slopes,
                "no passes of growing length, which the slopes are fitted over (saves a third of the time)");
  verb.add_flag("--no-cache", arguments->no_cache, "neither use nor keep a reference of an earlier comparison");
  verb.add_flag("--json", arguments->json, "results as one JSON object");
  verb.add_flag("--csv", arguments->csv, "every repeat as a line of CSV");
  verb.add_flag("--quiet", arguments->quiet, "no progress, no warnings but of the reference");
  verb.add_flag("--no-progress", arguments->no_progress, "no progress");
  verb.callback([arguments, &chosen] { chosen = [arguments] { return run_compare(*arguments); }; });
}

}  // namespace montelux::cli
