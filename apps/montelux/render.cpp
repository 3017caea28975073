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
#include "picture_output.h"
#include "progress.h"
#include "render_options.h"
#include "signals.h"
#include "status.h"
#include "verbs.h"

namespace montelux::cli {

namespace {

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
  return arguments.checkpoint ? check_film_file(*arguments.checkpoint) : Status(Done{});
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

}  // namespace

void add_render(CLI::App& app, Action& chosen) {
  auto arguments = std::make_shared<RenderArguments>();
  CLI::App& verb = *app.add_subcommand("render", "Render a scene, with error bars");
  add_render_options(verb, *arguments);
  verb.callback([arguments, &chosen] { chosen = [arguments] { return run_render(*arguments); }; });
}

}  // namespace montelux::cli
