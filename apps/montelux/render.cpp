// montelux render: a scene becomes pictures.
#include "api/render.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "api/images.h"
#include "api/json_text.h"
#include "display_json.h"
#include "options.h"
#include "progress.h"
#include "shortcomings.h"
#include "signals.h"
#include "status.h"
#include "verbs.h"

namespace montelux::cli {

namespace {

using Json = nlohmann::ordered_json;

struct RenderArguments {
  std::string scene;
  std::vector<std::string> files;
  LoadOptions load;
  RenderOptions render;
  DisplayRequest display;
  // Of the first picture of a sequence, for those after it.
  std::shared_ptr<std::optional<ChosenDisplay>> shown = std::make_shared<std::optional<ChosenDisplay>>();
  bool json = false, quiet = false, no_progress = false, half = false;
  std::optional<FrameRange> frames;
  std::optional<double> fps;
  std::optional<int> frame;  // the one at hand
  // Whether a picture took longer than its budget.
  bool is_late(const Rendering& rendering) const { return render.budget && rendering.result.seconds > *render.budget; }
};

bool has_display_file(const RenderArguments& arguments);
const ChosenDisplay& display_of(const RenderArguments& arguments, const Rendering& rendering);

constexpr const char* examples = R"(Examples:
  montelux render room.pbrt                                 writes room.exr
  montelux render room.pbrt -o room.exr -o room.png --tone aces --spp 256
  montelux render room.pbrt --time 10m --resolution 1920x1080
  montelux render room.pbrt --crop 100,100,200,200 --seed 7 --json
  montelux render flight.pbrt --frames 0:23 -o flight.####.exr
  montelux render walk.glb --frames 0:47 --fps 24 --shutter 0:0.02 -o walk.####.exr
  montelux render flight.pbrt --frames 0:23 --interactive-budget 33ms --integrator restir-di
  montelux render room.pbrt --layers bounces:3,light-groups  layers that sum to the picture

Ctrl-C (or SIGTERM, SIGHUP) ends the render early and writes what is done; a second one exits at once.
)";

// The values of one channel each; what is not finite (an error that is not known) is null.
template <std::size_t n>
Json to_json(const double (&values)[n]) {
  Json list = Json::array();
  for (double value : values) list.push_back(std::isfinite(value) ? Json(value) : Json());
  return list;
}

Json number_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json nulls() { return Json::array({nullptr, nullptr, nullptr}); }

constexpr double confidence = 0.95;

// The interval of each channel of the picture's mean, with its confidence; null where there is no error bar.
Json interval_to_json(const Rendering& rendering) {
  Json low = Json::array(), high = Json::array();
  for (int c = 0; c < spectrum_size; ++c) {
    const std::optional<Interval> interval = rendering.interval_of_mean(c, confidence);
    if (!interval) return Json();
    low.push_back(interval->low), high.push_back(interval->high);
  }
  return {{"confidence", confidence}, {"low", low}, {"high", high}};
}

// Of the pixels of the picture, those that have samples; below 1 where time did not allow for all.
double sampled_share(const Rendering& rendering) {
  const Film& film = rendering.result.film;
  const PixelBounds& b = film.bounds();
  double sampled = 0;
  for (int y = b.y0; y < b.y1; ++y)
    for (int x = b.x0; x < b.x1; ++x) sampled += film.samples(x, y) > 0;
  return sampled / b.area();
}

// The mean of each layer over the picture.
Json layers_to_json(const Rendering& rendering) {
  const LayerFilm& film = *rendering.result.film.layers();
  const PixelBounds& b = rendering.result.film.grid().cells();
  Json json = Json::object();
  const std::vector<std::string> names = layer_names(*rendering.layers);
  for (int i = 0; i < film.count(); ++i) {
    double mean[spectrum_size] = {};
    for (int c = 0; c < spectrum_size; ++c) {
      for (int y = b.y0; y < b.y1; ++y)
        for (int x = b.x0; x < b.x1; ++x) mean[c] += film.layer_mean(x, y, i, c);
      mean[c] /= double(b.area());
    }
    json[names[std::size_t(i)]] = to_json(mean);
  }
  return json;
}

std::string header_text(const Rendering& rendering, std::string_view name) {
  for (const Attribute& attribute : rendering.header)
    if (attribute.name == name)
      if (auto* text = std::get_if<std::string>(&attribute.value)) return *text;
  return {};
}

// What a render came to, in numbers.
struct Outcome {
  ImageEstimate image;
  ErrorEstimate error;
  double samples = 0;  // in all pixels
  std::uint64_t rays = 0, non_finite = 0;
};

Outcome outcome_of(const Rendering& rendering) {
  const RenderResult& result = rendering.result;
  const PixelBounds& b = result.film.bounds();
  Outcome outcome{rendering.image, rendering.error, 0, result.rays.all(), result.film.non_finite()};
  for (int y = b.y0; y < b.y1; ++y)
    for (int x = b.x0; x < b.x1; ++x) outcome.samples += result.film.samples(x, y);
  return outcome;
}

void print_json(const RenderArguments& arguments, const Rendering& rendering, const Outcome& outcome) {
  const double seconds = rendering.result.seconds;
  const bool known = rendering.has_pixel_error();
  Json json;
  json["version"] = version();
  json["scene"] = arguments.scene;
  json["files"] = arguments.files;
  json["interrupted"] = rendering.result.interrupted;
  json["seed"] = arguments.render.seed.value_or(0);
  if (arguments.frame) {
    json["frame"] = *arguments.frame;
    json["shutter"] = {arguments.render.shutter->open, arguments.render.shutter->close};
  }
  json["mean"] = outcome.image.passes > 0 ? to_json(outcome.image.mean) : nulls();
  json["standard_error"] = rendering.has_error_bar() ? to_json(outcome.image.standard_error) : nulls();
  json["interval_of_mean"] = interval_to_json(rendering);
  json["mse"] = known ? number_or_null(outcome.error.mse) : Json();
  json["relative_mse"] = known ? number_or_null(outcome.error.relative_mse) : Json();
  json["relative_mse_range"] =
      known ? Json{number_or_null(outcome.error.relative_low), number_or_null(outcome.error.relative_high)} : Json();
  json["tail_index"] = known ? number_or_null(outcome.error.tail_index) : Json();
  json["unsure_error"] = known && outcome.error.is_unsure();
  json["sampled_pixels"] = sampled_share(rendering);
  json["passes"] = outcome.image.passes;
  json["samples_per_pass"] = rendering.plan.samples_per_pass;
  json["samples"] = outcome.samples;
  json["error_bar"] = rendering.has_error_bar();
  json["seconds"] = seconds;
  if (arguments.render.budget) {
    json["budget"] = *arguments.render.budget;
    json["over_budget"] = arguments.is_late(rendering);
  }
  if (arguments.frame) json["history_bytes"] = rendering.history_bytes;
  json["rays"] = outcome.rays;
  if (rendering.result.rays.by_depth[0] > 0) json["rays_by_depth"] = rendering.result.rays.by_depth;
  json["rays_per_second"] = number_or_null(double(outcome.rays) / seconds);
  json["non_finite"] = outcome.non_finite;
  if (rendering.layers) json["layers"] = layers_to_json(rendering);
  json["biased_options"] = header_text(rendering, "montelux:biasedOptions");
  if (has_display_file(arguments)) json["display"] = display_json<Json>(display_of(arguments, rendering));
  add_to(json, {rendering.missing, rendering.replaced, rendering.left_out});
  // A line for each frame of a sequence.
  fmt::print("{}\n", json_text(std::move(json), arguments.frame ? -1 : 2));
}

// The mean of the picture with its standard error, and with its interval.
void print_mean(const Rendering& rendering) {
  if (rendering.image.passes == 0) {
    fmt::print("mean     -\n");
    return;
  }
  std::string mean = "mean    ", interval = fmt::format("         {:.0f} %:", 100 * confidence);
  for (int c = 0; c < spectrum_size; ++c) {
    mean += fmt::format(" {} {:.6g}", "RGB"[c], rendering.image.mean[c]);
    if (const auto range = rendering.interval_of_mean(c, confidence)) {
      mean += fmt::format(" ± {:.2g}", rendering.image.standard_error[c]);
      interval += fmt::format(" {} {:.6g} to {:.6g}", "RGB"[c], (*range).low, (*range).high);
    }
  }
  fmt::print("{}\n", mean);
  if (rendering.has_error_bar()) fmt::print("{}\n", interval);
}

// The error of a pixel; never that of a part of the picture.
std::string error_line(const Rendering& rendering) {
  const ErrorEstimate& error = rendering.error;
  if (rendering.found_no_light) return "not known: no sample found light";
  if (!rendering.has_pixel_error()) return "not known: it takes two independent passes of every pixel";
  std::string line = fmt::format("{} of a pixel, root of the mean relative square", error_text(error));
  if (error.is_unsure())
    line += fmt::format("; few bright samples decide it: {:.3g} to {:.3g} %", 100 * std::sqrt(error.relative_low),
                        100 * std::sqrt(error.relative_high));
  return line;
}

void print_text(const RenderArguments& arguments, const Rendering& rendering, const Outcome& outcome) {
  const double seconds = std::max(rendering.result.seconds, 1e-9);
  const int k = rendering.plan.samples_per_pass, passes = outcome.image.passes;
  for (const std::string& file : arguments.files) fmt::print("picture  {}\n", file);
  print_mean(rendering);
  fmt::print("error    {}\n", error_line(rendering));
  if (outcome.non_finite > 0) fmt::print("not finite {} samples, which are not in the mean\n", outcome.non_finite);
  print_text(Shortcomings{rendering.missing, rendering.replaced, rendering.left_out}, 9);
  const double pixels = rendering.result.film.bounds().area(), share = sampled_share(rendering);
  fmt::print("samples  {:.3g} a pixel ({} passes of {}), {} in all\n", outcome.samples / pixels, passes, k,
             count_text(outcome.samples));
  if (share < 1) fmt::print("         {:.3g} % of the pixels have samples\n", 100 * share);
  fmt::print(
      "time     {}, {}, {}{}\n", time_text(seconds), count_text(outcome.samples / seconds, "samples/s"),
      count_text(double(outcome.rays) / seconds, "rays/s"),
      arguments.is_late(rendering) ? fmt::format(", over the budget of {}", time_text(*arguments.render.budget)) : "");
}

// How 8-bit pictures show the rendering. All pictures of a sequence are shown like the first.
const ChosenDisplay& display_of(const RenderArguments& arguments, const Rendering& rendering) {
  if (!*arguments.shown) *arguments.shown = choose_display(rendering, arguments.display);
  return **arguments.shown;
}

bool has_display_file(const RenderArguments& arguments) {
  return std::ranges::any_of(arguments.files, is_display_file);
}

// Writes every file, also when one of them fails.
int write_files(const RenderArguments& arguments, const Rendering& rendering) {
  int status = done;
  for (const std::string& file : arguments.files) {
    const DisplayTransform display =
        is_display_file(file) ? display_of(arguments, rendering).transform : DisplayTransform{};
    if (Status written = write_rendering(file, rendering, display, arguments.half); !written) {
      complain(written.error());
      status = failed;
    }
  }
  return status;
}

// Pictures that cannot be written are found out before the render.
Status check_files(const RenderArguments& arguments) {
  for (const std::string& file : arguments.files)
    if (Status good = check_picture_file(file); !good) return good;
  const auto is_exr = [](const std::string& file) { return extension_of(file) == ".exr"; };
  if (arguments.render.layers && arguments.render.layers->motion && std::ranges::none_of(arguments.files, is_exr))
    return Failure{"the layer of motion needs an .exr file: -o PICTURE.exr"};
  if (arguments.render.layers && !arguments.json && std::ranges::none_of(arguments.files, is_exr))
    return Failure{"layers need an .exr file: -o PICTURE.exr (or --json for their means)"};
  return Done{};
}

// One picture: written and told of. A frame that is interrupted is not written.
int finish_picture(const RenderArguments& arguments, const Result<Rendering>& rendering, const StopSignals& signals) {
  if (!rendering) return complain(rendering.error());

  const int signal = signals.received();
  const Outcome outcome = outcome_of(*rendering);
  if (rendering->result.interrupted && arguments.frame) {
    if (!arguments.quiet)
      warn(fmt::format("interrupted in frame {}, which is not written; the frames before it are", *arguments.frame));
    return 128 + signal;
  }
  if (rendering->result.interrupted && outcome.samples == 0) {
    complain("interrupted before any sample was taken; nothing is written");
    return 128 + signal;
  }
  const int status = write_files(arguments, *rendering);
  if (rendering->result.interrupted && !arguments.quiet)
    warn(outcome.image.passes > 0
             ? fmt::format("interrupted after {} passes; the picture is of what was done", outcome.image.passes)
             : "interrupted in the first pass; parts of the picture are missing");
  // Notes are the same for every frame.
  if (!arguments.quiet && (!arguments.frame || *arguments.frame == arguments.frames->first))
    for (const std::string& note : rendering->notes) warn(note);
  if (!arguments.quiet && has_display_file(arguments) &&
      (!arguments.frame || *arguments.frame == arguments.frames->first))
    if (const std::string text = choice_text(display_of(arguments, *rendering)); !text.empty()) warn(text);
  if (outcome.non_finite > 0 && !arguments.quiet)
    warn(fmt::format("{} samples were not finite; they are not in the mean", outcome.non_finite));
  if (status != done) return status;
  if (arguments.json)
    print_json(arguments, *rendering, outcome);
  else
    print_text(arguments, *rendering, outcome);
  flush_results();
  return rendering->result.interrupted ? 128 + signal : done;
}

// What one frame is rendered with; fails where a pattern of names has no good place for its number.
Result<RenderArguments> arguments_of_frame(const RenderArguments& all, const SceneInfo& scene, int frame) {
  RenderArguments one = all;
  one.frame = frame;
  for (std::string& file : one.files) {
    Result<std::string> name = frame_file(file, frame);
    if (!name) return name.failure();
    file = *name;
  }
  one.render.seed = frame_seed(all.render.seed.value_or(0), frame);
  one.render.shutter = frame_shutter(scene, *all.frames, frame);
  return one;
}

// What came of some frames of a sequence.
struct FramesOutcome {
  int status = done;
  int late = 0;
};

// The frames from `first` to `last`, which the scene has motion for.
FramesOutcome render_part(const RenderArguments& all, const LoadedScene& scene, const StopSignals& signals,
                          ProgressLine& observer, int first, int last) {
  Result<PictureSequence> sequence = PictureSequence::prepare(scene, all.render);
  if (!sequence) return {complain(sequence.error())};
  int late = 0;
  for (int frame = first; frame <= last; ++frame) {
    const Result<RenderArguments> one = arguments_of_frame(all, scene.info(), frame);
    if (!one) return {complain(one.error()), late};
    observer.begin(frame - all.frames->first,
                   fmt::format("frame {} of {}:{}  ", frame, all.frames->first, all.frames->last));
    const ShutterTimes before = frame_shutter(scene.info(), *all.frames, frame - 1);
    const Result<Rendering> rendering =
        sequence->render({*one->render.seed, *one->render.shutter, before, frame == last}, observer);
    if (rendering->result.forgotten > 0 && !all.quiet && frame == first)
      warn(fmt::format(
          "chains keep histories of {} in all, and no more: {} of {} start the next frame without a history",
          count_text(double(rendering->history_bytes), "B"), rendering->result.forgotten,
          rendering->result.film.image().passes));
    late += one->is_late(*rendering);
    if (const int status = finish_picture(*one, rendering, signals); status != done) return {status, late};
    // A frame may be over before anybody asks for signals.
    if (const int signal = signals.received(); signal != 0 && frame < all.frames->last) {
      if (!all.quiet) warn(fmt::format("interrupted after frame {}", frame));
      return {128 + signal, late};
    }
  }
  return {done, late};
}

int render_frames(const RenderArguments& all, LoadedScene loaded_first, const StopSignals& signals) {
  std::optional<LoadedScene> scene(std::move(loaded_first));
  if (!scene->info().moves && scene->info().frames_held >= all.frames->count() && !all.quiet)
    warn("nothing moves in the scene: its frames differ by their seeds alone");
  ProgressLine observer({!all.quiet && !all.no_progress, !all.quiet}, signals, all.frames->count());
  int late = 0;
  for (int first = all.frames->first; first <= all.frames->last;) {
    const int last = int(std::min<std::int64_t>(std::int64_t(first) + scene->info().frames_held - 1, all.frames->last));
    const FramesOutcome part = render_part(all, *scene, signals, observer, first, last);
    late += part.late;
    if (part.status != done) return part.status;
    first = last + 1;
    if (first > all.frames->last) break;
    // A scene holds so many moments of its motion: what follows is loaded anew, and histories begin again.
    if (!all.quiet) warn(fmt::format("frames from {} on: the scene is loaded with its next moments", first));
    LoadOptions load = all.load;
    load.frames->first = first;
    scene.reset();
    LoadResult loaded = load_scene(all.scene, load);
    if (!loaded.scene) {
      print_diagnostics(loaded.diagnostics, all.quiet);
      return bad_input;
    }
    scene.emplace(*std::move(loaded.scene));
  }
  if (late > 0 && !all.quiet)
    warn(fmt::format("{} of {} pictures took longer than the budget of {}", late, all.frames->count(),
                     time_text(*all.render.budget)));
  return done;
}

// room.exr of room.pbrt and of room.pbrt.gz.
std::string default_picture(std::filesystem::path scene) {
  if (extension_of(scene) == ".gz") scene = scene.stem();
  return scene.stem().string() + ".exr";
}

// The pictures of all frames: only their numbers differ.
Status check_output(const RenderArguments& arguments) {
  if (!arguments.frames) return check_files(arguments);
  const Result<RenderArguments> last = arguments_of_frame(arguments, {}, arguments.frames->last);
  if (!last) return last.failure();
  return check_files(*last);
}

int run_render(RenderArguments& arguments) {
  if (arguments.fps && arguments.frames->of)
    return complain("--fps and the /N of --frames exclude each other: both say how long a frame lasts");
  if (arguments.frames) arguments.frames->fps = arguments.fps;
  if (!arguments.frames && arguments.render.layers && arguments.render.layers->motion)
    return complain("motion is between the pictures of a sequence: --layers motion needs --frames");
  if (!arguments.files.empty())
    if (Status good = check_output(arguments); !good) return complain(good.error());

  arguments.load.threads = arguments.render.threads;
  arguments.load.frames = arguments.frames;
  LoadResult loaded = load_scene(arguments.scene, arguments.load);
  print_diagnostics(loaded.diagnostics, arguments.quiet);
  if (!loaded.scene) return bad_input;
  if (!arguments.render.seed) arguments.render.seed = loaded.scene->info().seed;
  if (arguments.files.empty()) {
    const std::string& by_scene = loaded.scene->info().picture_file;
    arguments.files = {by_scene.empty() ? default_picture(arguments.scene) : by_scene};
    if (Status good = check_output(arguments); !good)
      return complain(by_scene.empty() ? good.error()
                                       : good.error() + "; the scene's film names this picture, -o names another one");
  }

  arguments.render.files = {{arguments.files.begin(), arguments.files.end()}, arguments.half};
  StopSignals signals;
  if (arguments.frames) return render_frames(arguments, *std::move(loaded.scene), signals);
  ProgressLine observer({!arguments.quiet && !arguments.no_progress, !arguments.quiet}, signals);
  return finish_picture(arguments, render_scene(*loaded.scene, arguments.render, observer), signals);
}

// A sequence of pictures.
void add_frame_options(CLI::App& verb, RenderArguments& arguments) {
  add_option(verb,
             {"--frames", "A[:B][/N]",
              "a picture for each of these frames (A: for one), into which the time of the scene's transforms falls in "
              "equal parts "
              "(A:B/N: N parts, counted from 0); their number goes to #### or %04d in -o, else before the extension"},
             into(arguments.frames, parse_frames));
  add_option(verb, {"--fps", "F", "frames in a unit of the scene's time: frame f has the scene's shutter, f / F later"},
             into(arguments.fps, [](const std::string& t) { return parse_number(t, 1e-6, 1e6); }));
  verb.get_option("--fps")->needs("--frames");
}

// How many samples, and which.
void add_sampling_options(CLI::App& verb, RenderOptions& render) {
  add_option(verb, {"--spp", "N", "samples a pixel; default: as the scene states"},
             into(render.samples, [](const std::string& t) { return parse_whole(t, 1, 1 << 24); }));
  add_option(verb,
             {"--time", "TIME",
              "be done that long after the scene is loaded, with as many samples as fit (500ms, 30s, 10m, 2h)"},
             into(render.seconds, parse_time));
  verb.get_option("--time")->excludes("--spp");
  add_option(verb,
             {"--interactive-budget", "TIME",
              "a picture within that time (33ms): as many whole passes of a sample as fit, of restir-di frames of one "
              "chain, which continues over --frames; at least one"},
             into(render.budget, parse_time));
  verb.get_option("--interactive-budget")->excludes("--spp")->excludes("--time");
  add_option(
      verb,
      {"--seed", "S", "number of the realisation; the same seed gives the same bits; default: the scene's, else 0"},
      into(render.seed, [](const std::string& t) { return parse_whole(t, 0, 0x7fffffff); }));
  add_option(verb, {"--threads", "T", "threads; default: one for each processor"},
             into(render.threads, [](const std::string& t) { return parse_whole(t, 1, 4096); }));
  add_option(verb, {"--crop", "x0,y0,x1,y1", "only these pixels (x1 and y1 are just outside)"},
             into(render.crop, parse_crop));
}

// By what algorithm.
void add_algorithm_options(CLI::App& verb, RenderOptions& render) {
  auto choice = [](const std::vector<std::string>& names) {
    return [names](const std::string& text) { return parse_choice(text, names); };
  };
  const auto integrators = names_of(integrator_names()), samplers = names_of(sampler_names());
  add_option(verb,
             {"--integrator", alternatives(integrators),
              "algorithm, with settings if need be, as direct:strategy=ris,candidates=32; default: the scene's"},
             [&render](const std::string& text) -> Status {
               render.integrator = text;
               return check_integrator_text(text);
             });
  const auto presets = names_of(preset_names());
  add_option(verb, {"--preset", alternatives(presets), "integrator and samples of a published comparison"},
             into(render.preset, choice(presets)));
  verb.get_option("--preset")->excludes("--integrator");
  add_option(verb, {"--sampler", alternatives(samplers), "point set; default: the scene's"},
             into(render.sampler, choice(samplers)));
  add_option(
      verb,
      {"--layers", "bounces[:N],light-groups,errors,motion",
       "layers in the .exr: of light, bounce0 ... bounceN and bounce_rest (N = 4 if not stated); Combined_GROUP for "
       "each \"string group\" of the scene's lights; with errors NAME_stderr, too; motion: the way in pixels from here "
       "to "
       "where the same point was in the frame before"},
      into(render.layers, parse_layers));
  add_option(verb, {"--set", "key=value", "a setting of the integrator, as maxdepth=8; may be repeated", true},
             [&render](const std::string& text) -> Status {
               auto setting = parse_setting(text);
               if (!setting) return setting.failure();
               render.settings.push_back(*setting);
               return Done{};
             });
}

}  // namespace

void add_render(CLI::App& app, Action& chosen) {
  auto arguments = std::make_shared<RenderArguments>();
  CLI::App& verb = *app.add_subcommand("render", "Render a scene, with error bars");
  verb.footer(examples);
  add_option(
      verb,
      {"-o,--output", "FILE",
       "picture (.exr .hdr .pfm .png .jpg); may be repeated; default: as the scene's film names it, else SCENE.exr",
       true},
      [arguments](const std::string& file) -> Status {
        arguments->files.push_back(file);
        return Done{};
      });
  add_scene_options(verb, arguments->scene, arguments->load);
  add_sampling_options(verb, arguments->render);
  add_frame_options(verb, *arguments);
  add_algorithm_options(verb, arguments->render);
  add_display_options(verb, arguments->display);
  verb.add_flag(
      "--half", arguments->half,
      "light, albedo and normals of an .exr as 16-bit floats, which halves the file; errors and places stay 32-bit");
  verb.add_flag("--json", arguments->json, "results as one JSON object (a line for each frame)");
  verb.add_flag("--quiet", arguments->quiet, "no progress, notes or warnings");
  verb.add_flag("--no-progress", arguments->no_progress, "no progress");
  verb.callback([arguments, &chosen] { chosen = [arguments] { return run_render(*arguments); }; });
}

}  // namespace montelux::cli
