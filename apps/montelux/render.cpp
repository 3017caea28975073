// montelux render: renders a scene to images.
#include "api/render.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <memory>

#include "api/images.h"
#include "api/saved_film.h"
#include "api/target_text.h"
#include "options.h"
#include "picture_output.h"
#include "progress.h"
#include "signals.h"
#include "status.h"
#include "verbs.h"

namespace montelux::cli {

namespace {

struct RenderArguments {
  std::string scene;
  std::vector<std::string> files;
  LoadOptions load;
  RenderOptions render;
  DisplayRequest display;
  // The display of the first image of a sequence, used for all.
  std::shared_ptr<std::optional<ChosenDisplay>> shown = std::make_shared<std::optional<ChosenDisplay>>();
  bool json = false, quiet = false, no_progress = false, half = false;
  std::optional<std::string> checkpoint, resume;
  std::optional<double> every;  // seconds between checkpoints
  std::optional<ErrorTarget> target;
  std::optional<double> confidence;
  bool unbiased = false;
  std::optional<FrameRange> frames;
  std::optional<double> fps;
  std::optional<int> frame;  // the current one
  // Whether an image took longer than its budget.
  bool is_late(const Rendering& rendering) const { return render.budget && rendering.result.seconds > *render.budget; }
};

bool has_display_file(const RenderArguments& arguments);
const ChosenDisplay& display_of(const RenderArguments& arguments, const Rendering& rendering);

constexpr const char* examples = R"(Examples:
  montelux render room.pbrt                                 writes room.exr
  montelux render room.pbrt -o room.exr -o room.png --tone aces --spp 256
  montelux render room.pbrt --time 10m --resolution 1920x1080
  montelux render room.pbrt --target-error 2% --time 10m    ends when the error is below 2 %
  montelux render room.pbrt --spp 64 --denoise -o room.exr -o room.png
  montelux render room.pbrt --crop 100,100,200,200 --seed 7 --json
  montelux render flight.pbrt --frames 0:23 -o flight.####.exr
  montelux render walk.glb --frames 0:47 --fps 24 --shutter 0:0.02 -o walk.####.exr
  montelux render flight.pbrt --frames 0:23 --interactive-budget 33ms --integrator restir-di
  montelux render room.pbrt --layers bounces:3,light-groups  layers that sum to the image
  montelux render room.pbrt --spp 4096 --checkpoint room.film --checkpoint-every 1m
  montelux render --resume room.film --checkpoint room.film  continues where that was interrupted
  montelux render --resume room.film --spp 8192 -o room.exr
  montelux render room.pbrt --spp 4096 --passes 0:7 --checkpoint a.film
  montelux render room.pbrt --spp 4096 --passes 8:15 --checkpoint b.film
  montelux merge a.film b.film -o room.film -o room.exr

Ctrl-C (or SIGTERM, SIGHUP) ends the render early and writes what is finished; a second one exits at once.
)";

// How 8-bit pictures show the rendering. All pictures of a sequence are shown like the first.
const ChosenDisplay& display_of(const RenderArguments& arguments, const Rendering& rendering) {
  if (!*arguments.shown) *arguments.shown = choose_display(rendering, arguments.display);
  return **arguments.shown;
}

bool has_display_file(const RenderArguments& arguments) {
  return std::ranges::any_of(arguments.files, is_display_file);
}

// Writes every file, even if one of them fails.
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

// Detects files that cannot be written before the render.
Status check_files(const RenderArguments& arguments) {
  for (const std::string& file : arguments.files)
    if (Status good = check_picture_file(file); !good) return good;
  const auto is_exr = [](const std::string& file) { return extension_of(file) == ".exr"; };
  if (arguments.render.layers && arguments.render.layers->motion && std::ranges::none_of(arguments.files, is_exr))
    return Failure{"the motion layer needs an .exr file: -o IMAGE.exr"};
  if (arguments.render.layers && !arguments.json && std::ranges::none_of(arguments.files, is_exr))
    return Failure{"layers need an .exr file: -o IMAGE.exr (or --json for their means)"};
  return Done{};
}

std::string interruption_text(const RenderArguments& arguments, const Outcome& outcome) {
  const std::string continues =
      arguments.checkpoint ? fmt::format("; montelux render --resume {} continues", *arguments.checkpoint) : "";
  if (outcome.image.passes == 0) return "interrupted in the first pass; parts of the image are missing" + continues;
  return fmt::format("interrupted after {} passes; the image contains the finished passes{}", outcome.image.passes,
                     continues);
}

// Writes one picture and reports it. A frame that is interrupted is not written.
int finish_picture(const RenderArguments& arguments, const Result<Rendering>& rendering, const StopSignals& signals) {
  if (!rendering) return complain(rendering.error());

  const int signal = signals.received();
  const Outcome outcome = outcome_of(*rendering);
  if (rendering->result.interrupted && arguments.frame) {
    if (!arguments.quiet)
      warn(fmt::format("interrupted in frame {}, which is not written; earlier frames are", *arguments.frame));
    return 128 + signal;
  }
  if (rendering->result.interrupted && outcome.samples == 0) {
    complain("interrupted before any sample was taken; nothing is written");
    return 128 + signal;
  }
  int status = write_files(arguments, *rendering);
  if (!rendering->saved) {
    complain(rendering->saved.error());
    status = failed;
  }
  if (rendering->result.interrupted && !arguments.quiet) warn(interruption_text(arguments, outcome));
  // Notes are the same for every frame.
  if (!arguments.quiet && (!arguments.frame || *arguments.frame == arguments.frames->first))
    for (const std::string& note : rendering->notes) warn(note);
  if (!arguments.quiet && has_display_file(arguments) &&
      (!arguments.frame || *arguments.frame == arguments.frames->first))
    if (const std::string text = choice_text(display_of(arguments, *rendering)); !text.empty()) warn(text);
  if (outcome.non_finite > 0 && !arguments.quiet)
    warn(fmt::format("{} samples were not finite; they are excluded from the mean", outcome.non_finite));
  if (status != done) return status;
  PictureReport report{
      arguments.scene,          arguments.files,        {}, arguments.render.seed.value_or(0), arguments.frame,
      arguments.render.shutter, arguments.render.budget};
  if (arguments.checkpoint) report.film = *arguments.checkpoint;
  if (has_display_file(arguments)) report.display = &display_of(arguments, *rendering);
  if (arguments.json)
    print_picture_json(report, *rendering);
  else
    print_picture_text(report, *rendering);
  flush_results();
  return rendering->result.interrupted ? 128 + signal : done;
}

// The arguments of one frame; fails if a file name has no valid placeholder for the number.
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

// The outcome of some frames of a sequence.
struct FramesOutcome {
  int status = done;
  int late = 0;
};

// Renders the frames from `first` to `last`, for which the scene contains motion.
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
      warn(fmt::format("histories are limited to {} in all: {} of {} series start the next frame without a history",
                       count_text(double(rendering->history_bytes), "B"), rendering->result.forgotten,
                       rendering->result.film.image().passes));
    late += one->is_late(*rendering);
    if (const int status = finish_picture(*one, rendering, signals); status != done) return {status, late};
    // A frame may be finished before signals are checked.
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
    warn("nothing moves in the scene: its frames differ only by their seeds");
  ProgressLine observer({!all.quiet && !all.no_progress, !all.quiet}, signals, all.frames->count());
  int late = 0;
  for (int first = all.frames->first; first <= all.frames->last;) {
    const int last = int(std::min<std::int64_t>(std::int64_t(first) + scene->info().frames_held - 1, all.frames->last));
    const FramesOutcome part = render_part(all, *scene, signals, observer, first, last);
    late += part.late;
    if (part.status != done) return part.status;
    first = last + 1;
    if (first > all.frames->last) break;
    // A scene contains a limited number of poses: the next part is loaded again, and histories restart.
    if (!all.quiet)
      warn(fmt::format("frames from {} on: the scene is reloaded for the next part of its animation", first));
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
    warn(fmt::format("{} of {} images took longer than the budget of {}", late, all.frames->count(),
                     time_text(*all.render.budget)));
  return done;
}

// room.exr for room.pbrt and room.pbrt.gz.
std::string default_picture(std::filesystem::path scene) {
  if (extension_of(scene) == ".gz") scene = scene.stem();
  return scene.stem().string() + ".exr";
}

// Checks the images of all frames: only their numbers differ.
Status check_output(const RenderArguments& arguments) {
  if (!arguments.frames) return check_files(arguments);
  const Result<RenderArguments> last = arguments_of_frame(arguments, {}, arguments.frames->last);
  if (!last) return last.failure();
  return check_files(*last);
}

// What the options about saved films say together.
Status check_saving(const RenderArguments& arguments) {
  const RenderOptions& render = arguments.render;
  if (arguments.scene.empty() && !arguments.resume) return Failure{"SCENE is required; see montelux render --help"};
  if (arguments.every && !arguments.checkpoint) return Failure{"--checkpoint-every needs --checkpoint FILE"};
  if (render.passes && !arguments.checkpoint && arguments.files.empty())
    return Failure{"--passes renders a part: --checkpoint FILE saves it, to be merged, or -o FILE is its picture"};
  return arguments.checkpoint ? check_output_file(*arguments.checkpoint) : Status(Done{});
}

// The film to be continued, with the scene and the options that it takes.
Result<SavedFilm> resumed(RenderArguments& arguments) {
  RenderOptions& render = arguments.render;
  Result<SavedFilm> film = load_film(*arguments.resume);
  if (!film) return film;
  if (!film->wanted && !film->options.target && !render.target && !render.samples && !render.seconds && !render.passes)
    return Failure{
        fmt::format("{} was rendered within a time; --time says how much more, or --spp how many samples per "
                    "pixel there shall be",
                    *arguments.resume)};
  if (arguments.scene.empty()) arguments.scene = film->scene.string();
  take_options(*film, arguments.load, render);
  return film;
}

// What the options about a requested error say together.
void set_target(RenderArguments& arguments) {
  if (!arguments.target) return;
  TargetRequest target{*arguments.target, arguments.unbiased};
  if (arguments.confidence) target.error.confidence = *arguments.confidence;
  arguments.render.target = target;
}

int run_render(RenderArguments& arguments) {
  if (Status good = check_saving(arguments); !good) return complain(good.error());
  set_target(arguments);
  if (arguments.fps && arguments.frames->of)
    return complain("--fps and the /N of --frames exclude each other: both set the duration of a frame");
  if (arguments.frames) arguments.frames->fps = arguments.fps;
  if (!arguments.frames && arguments.render.layers && arguments.render.layers->motion)
    return complain("motion vectors are between the images of a sequence: --layers motion needs --frames");
  if (!arguments.files.empty())
    if (Status good = check_output(arguments); !good) return complain(good.error());

  const bool is_part = arguments.render.passes.has_value();
  std::optional<SavedFilm> film;
  if (arguments.resume) {
    Result<SavedFilm> saved = resumed(arguments);
    if (!saved) return complain(saved.error());
    film = *std::move(saved);
    arguments.render.resume = &*film;
  }
  if (arguments.checkpoint)
    arguments.render.checkpoint =
        FilmCheckpoint{*arguments.checkpoint, arguments.every.value_or(FilmCheckpoint{}.every)};

  arguments.load.threads = arguments.render.threads;
  // To move 100 MB takes a quarter of a second, and saves up to 4 % of what follows.
  arguments.load.huge_pages = arguments.render.seconds.value_or(0) >= 20;
  arguments.load.frames = arguments.frames;
  LoadResult loaded = load_scene(arguments.scene, arguments.load);
  print_diagnostics(loaded.diagnostics, arguments.quiet);
  if (!loaded.scene) return bad_input;
  if (!arguments.render.seed) arguments.render.seed = loaded.scene->info().seed;
  if (arguments.files.empty() && !is_part) {
    const std::string& by_scene = loaded.scene->info().picture_file;
    arguments.files = {by_scene.empty() ? default_picture(arguments.scene) : by_scene};
    if (Status good = check_output(arguments); !good)
      return complain(by_scene.empty() ? good.error()
                                       : good.error() + "; the scene's film names this file, -o names another one");
  }

  arguments.render.files = {{arguments.files.begin(), arguments.files.end()}, arguments.half};
  StopSignals signals;
  if (arguments.frames) return render_frames(arguments, *std::move(loaded.scene), signals);
  ProgressLine observer({!arguments.quiet && !arguments.no_progress, !arguments.quiet}, signals);
  return finish_picture(arguments, render_scene(*loaded.scene, arguments.render, observer), signals);
}

// Options of a sequence of images.
void add_frame_options(CLI::App& verb, RenderArguments& arguments) {
  add_option(verb,
             {"--frames", "A[:B][/N]",
              "one image per frame (A for a single one); the time of the scene's transforms is divided into "
              "equal parts "
              "(A:B/N: N parts, counted from 0); the number replaces #### or %04d in -o, or precedes the extension"},
             into(arguments.frames, parse_frames));
  add_option(verb, {"--fps", "F", "frames per unit of the scene's time: frame f has the scene's shutter, f / F later"},
             into(arguments.fps, [](const std::string& t) { return parse_number(t, 1e-6, 1e6); }));
  verb.get_option("--fps")->needs("--frames");
}

// Options of the number and the seed of samples.
void add_sampling_options(CLI::App& verb, RenderOptions& render) {
  add_option(verb, {"--spp", "N", "samples per pixel; default: as stated by the scene"},
             into(render.samples, [](const std::string& t) { return parse_whole(t, 1, 1 << 24); }));
  add_option(verb,
             {"--time", "TIME",
              "finish this long after the scene is loaded, with as many samples as fit (500ms, 30s, 10m, 2h)"},
             into(render.seconds, parse_time));
  verb.get_option("--time")->excludes("--spp");
  add_option(
      verb,
      {"--interactive-budget", "TIME",
       "each image within this time (33ms): as many passes of one sample as fit, or with restir-di frames of one "
       "series, which continues over --frames; at least one"},
      into(render.budget, parse_time));
  verb.get_option("--interactive-budget")->excludes("--spp")->excludes("--time");
  add_option(
      verb,
      {"--seed", "S", "seed of all random numbers; the same seed gives the same bits; default: the scene's, else 0"},
      into(render.seed, [](const std::string& t) { return parse_whole(t, 0, 0x7fffffff); }));
  add_option(verb, {"--threads", "T", "threads; default: one for each processor"},
             into(render.threads, [](const std::string& t) { return parse_whole(t, 1, 4096); }));
  add_option(verb, {"--crop", "x0,y0,x1,y1", "only these pixels (x1 and y1 are excluded)"},
             into(render.crop, parse_crop));
}

// A requested error.
void add_target_options(CLI::App& verb, RenderArguments& arguments) {
  add_option(
      verb,
      {"--target-error", "ERROR",
       "end as soon as the error is below this, with certainty --confidence: 2% (root of the mean relative square "
       "over the pixels), pixels:5%@95% (95 % of the pixels within 5 %) or mean:0.1% (of the mean of the image); "
       "--time or --spp are the most"},
      into(arguments.target, parse_target));
  add_option(verb, {"--confidence", "P", "probability that the true error is below the requested one (default 0.95)"},
             into(arguments.confidence, [](const std::string& t) { return parse_number(t, 0.5, 0.9999); }));
  verb.add_flag(
      "--unbiased", arguments.unbiased,
      "two stages: samples of a pilot decide their number, the image is of others, so that its mean is unbiased");
  add_option(
      verb,
      {"--adaptive", "on|off",
       "more passes for the tiles where they lower the requested error most (without one, that of the pixels); a "
       "pilot of other samples decides; default: off"},
      [&arguments](const std::string& text) -> Status {
        const Result<std::string> choice = parse_choice(text, {"on", "off"});
        if (!choice) return choice.failure();
        arguments.render.adaptive = *choice == "on";
        return Done{};
      });
  for (const char* needs : {"--confidence", "--unbiased"}) verb.get_option(needs)->needs("--target-error");
  for (const char* other : {"--interactive-budget", "--preset", "--passes"})
    verb.get_option("--target-error")->excludes(other);
}

// "A" or "A:B".
Result<PassRange> parse_passes(const std::string& text) {
  const std::size_t colon = text.find(':');
  constexpr int max_number = (1 << 24) - 1;
  const Result<int> first = parse_whole(text.substr(0, colon), 0, max_number);
  const Result<int> last = colon == std::string::npos ? first : parse_whole(text.substr(colon + 1), 0, max_number);
  if (first && last && *first <= *last) return PassRange{*first, *last};
  return Failure{fmt::format("takes a range of passes A:B, from 0, with its last pass, as 0:3; found \"{}\"", text)};
}

// Films in files.
void add_saving_options(CLI::App& verb, RenderArguments& arguments) {
  add_option(verb, {"--checkpoint", "FILE", "save the film now and then and at the end, to be resumed or merged"},
             text_into(arguments.checkpoint));
  add_option(verb, {"--checkpoint-every", "TIME", "how often (30s, 5m, 1h; default 5m)"},
             into(arguments.every, parse_time));
  add_option(
      verb,
      {"--resume", "FILE",
       "continue a saved film, up to --spp samples per pixel in all or for --time more; default: what it lacks. Its "
       "scene and settings need not be given"},
      text_into(arguments.resume));
  add_option(verb,
             {"--passes", "A:B",
              "only these of the passes that --spp makes, from 0, with the last one; montelux merge makes one film of "
              "such parts"},
             into(arguments.render.passes, parse_passes));
  add_option(
      verb,
      {"--samples-per-pass", "K",
       "samples per pixel in each pass; default: so that there are from 8 to 32 passes, or as the saved film has it"},
      into(arguments.render.samples_per_pass, [](const std::string& t) { return parse_whole(t, 1, 1 << 16); }));
  verb.get_option("--passes")->excludes("--time");
  for (const char* saving : {"--checkpoint", "--resume", "--passes"})
    for (const char* other : {"--frames", "--interactive-budget"}) verb.get_option(saving)->excludes(other);
}

// By what algorithm.
void add_algorithm_options(CLI::App& verb, RenderOptions& render) {
  auto choice = [](const std::vector<std::string>& names) {
    return [names](const std::string& text) { return parse_choice(text, names); };
  };
  const auto integrators = names_of(integrator_names()), samplers = names_of(sampler_names());
  add_option(verb,
             {"--integrator", alternatives(integrators),
              "algorithm, optionally with settings: direct:strategy=ris,candidates=32; default: the scene's"},
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
      {"--layers", "bounces[:N],light-groups,strategies[:N],alone,errors,motion,halves,intervals",
       "layers in the .exr: of light, bounce0 ... bounceN and bounce_rest (N = 4 if not stated); Combined_GROUP for "
       "each \"string group\" of the scene's lights; strategies: those of light, bdpt, vcm and "
       "metropolis:strategies=bdpt, strategy_sS_tT with S "
       "vertices from the light and T from the eye, merging_sS_tT where they are merged, and strategy_rest beyond N "
       "bounces (3 if not stated); alone: each strategy also without its weight, as alone_sS_tT; errors: also "
       "NAME_stderr; motion: offset in pixels from here to where the same point was in the previous frame; halves: "
       "colours, albedo and normals of both halves of the "
       "passes, which montelux denoise needs; intervals: low and high, which contain the true value of a pixel with 95 "
       "%"},
      into(render.layers, parse_layers));
  verb.add_flag(
      "--measure-bias", render.measure_bias,
      "measure by how much maxdepth and maxcomponent bias the mean: an eighth of the samples is taken without "
      "them as well");
  add_option(verb, {"--set", "key=value", "a setting of the integrator, such as maxdepth=8; may be repeated", true},
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
       "image file (.exr .hdr .pfm .png .jpg); may be repeated; default: as named by the scene, else SCENE.exr", true},
      [arguments](const std::string& file) -> Status {
        arguments->files.push_back(file);
        return Done{};
      });
  add_scene_options(verb, arguments->scene, arguments->load);
  verb.get_option("SCENE")->required(false);
  add_sampling_options(verb, arguments->render);
  add_frame_options(verb, *arguments);
  add_saving_options(verb, *arguments);
  add_algorithm_options(verb, arguments->render);
  add_target_options(verb, *arguments);
  add_display_options(verb, arguments->display);
  verb.add_flag(
          "--denoise", arguments->render.denoise,
          "remove noise: adds the layers denoised and denoised_error (what is left, bias included) to an .exr, with "
          "those of both halves; other files show the denoised colours")
      ->excludes("--interactive-budget");
  verb.add_flag(
      "--half", arguments->half,
      "light, albedo and normals of an .exr as 16-bit floats, which halves the file; other layers stay 32-bit");
  verb.add_flag("--json", arguments->json, "results as one JSON object (one line per frame)");
  verb.add_flag("--quiet", arguments->quiet, "no progress, notes or warnings");
  verb.add_flag("--no-progress", arguments->no_progress, "no progress");
  verb.callback([arguments, &chosen] { chosen = [arguments] { return run_render(*arguments); }; });
}

}  // namespace montelux::cli
