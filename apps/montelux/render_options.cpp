#include "render_options.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "api/images.h"
#include "api/target_text.h"

namespace montelux::cli {

namespace {

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
  montelux render room.pbrt --spp 4096 --passes 0:3 --checkpoint a.film
  montelux render room.pbrt --spp 4096 --passes 4:7 --checkpoint b.film
  montelux merge a.film b.film -o room.film -o room.exr

Ctrl-C (or SIGTERM, SIGHUP) ends the render early and writes what is finished; a second one exits at once.
)";

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
       "end when the error is below this with the probability --confidence: 2% (root of the mean squared relative "
       "error), pixels:5%@95% (95 % of the pixels within 5 %), mean:0.1% (of the mean of the image) or denoised:2% "
       "(as 2%, of the image after its noise is removed: with --denoise); --time or --spp limit the render"},
      into(arguments.target, parse_target));
  add_option(verb, {"--confidence", "P", "probability that the true error is below the requested one (default 0.95)"},
             into(arguments.confidence, [](const std::string& t) { return parse_number(t, 0.5, 0.9999); }));
  verb.add_flag(
      "--unbiased", arguments.unbiased,
      "two stages: a pilot decides the number of samples, the image takes new ones, so that its mean is unbiased");
  add_option(verb,
             {"--adaptive", "on|off",
              "more passes for tiles where they lower the requested error most (default: the error of the pixels), as "
              "estimated from the first passes of the surrounding tiles; default: off"},
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

}  // namespace

void add_pass_options(CLI::App& verb, RenderOptions& render) {
  add_option(verb,
             {"--passes", "A:B",
              "only the passes A to B, counted from 0 and including B, of those that --spp defines; montelux "
              "merge combines such films"},
             into(render.passes, parse_passes));
  add_option(verb,
             {"--samples-per-pass", "K",
              "samples per pixel in each pass; default: by the number of samples, or that of the saved film"},
             into(render.samples_per_pass, [](const std::string& t) { return parse_whole(t, 1, 1 << 16); }));
}

namespace {

// Films in files.
void add_saving_options(CLI::App& verb, RenderArguments& arguments) {
  add_option(verb, {"--checkpoint", "FILE", "save the film at intervals and at the end, to be resumed or merged"},
             text_into(arguments.checkpoint));
  add_option(verb, {"--checkpoint-every", "TIME", "how often (30s, 5m, 1h; default 5m)"},
             into(arguments.every, parse_time));
  add_option(
      verb,
      {"--resume", "FILE",
       "continue a saved film, to --spp samples per pixel in total or for another --time; default: its remaining "
       "passes. Scene and settings are read from it"},
      text_into(arguments.resume));
  add_pass_options(verb, arguments.render);
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
  add_filter_samples_option(verb, render);
  add_option(
      verb,
      {"--layers", "bounces[:N],light-groups,strategies[:N],alone,errors,motion,halves,intervals",
       "layers in the .exr: of light, bounce0 ... bounceN and bounce_rest (N = 4 if not stated); Combined_GROUP for "
       "each \"string group\" of the scene's lights; strategies: those of light, bdpt, vcm and "
       "metropolis:strategies=bdpt, strategy_sS_tT with S "
       "vertices from the light and T from the eye, merging_sS_tT where they are merged, and strategy_rest beyond N "
       "bounces (3 if not stated); alone: each strategy also without its weight, as alone_sS_tT; errors: also "
       "NAME_stderr; motion: offset in pixels from here to where the same point was in the previous frame; halves: "
       "colours, albedo, normals and layers of light of both halves of the "
       "passes, which montelux denoise needs; intervals: low and high, which contain the true value of a pixel with 95 "
       "%"},
      into(render.layers, parse_layers));
  verb.add_flag(
      "--measure-bias", render.measure_bias,
      "measure by how much maxdepth, maxcomponent, radii and other biased settings change the mean of the image: an "
      "eighth of the samples is taken without bias as well");
  add_option(verb, {"--set", "key=value", "a setting of the integrator, such as maxdepth=8; may be repeated", true},
             [&render](const std::string& text) -> Status {
               auto setting = parse_setting(text);
               if (!setting) return setting.failure();
               render.settings.push_back(*setting);
               return Done{};
             });
}

}  // namespace

void add_filter_samples_option(CLI::App& verb, RenderOptions& render) {
  add_option(verb,
             {"--filter-samples", "shared|own",
              "shared: each sample counts for all pixels whose filters contain it, which lowers their errors; own: for "
              "its own pixel alone, so that pixels have independent noise; default: shared, unless layers of light, "
              "--denoise or halves are requested, or the integrator traces all pixels together"},
             [&render](const std::string& text) -> Status {
               const Result<std::string> choice = parse_choice(text, {"shared", "own"});
               if (!choice) return choice.failure();
               render.shared_filters = *choice == "shared";
               return Done{};
             });
}

void add_render_options(CLI::App& verb, RenderArguments& arguments) {
  verb.footer(examples);
  add_option(
      verb,
      {"-o,--output", "FILE",
       "image file (.exr .hdr .pfm .png .jpg); may be repeated; default: as named by the scene, else SCENE.exr", true},
      [&arguments](const std::string& file) -> Status {
        arguments.files.push_back(file);
        return Done{};
      });
  add_scene_options(verb, arguments.scene, arguments.load);
  verb.get_option("SCENE")->required(false);
  add_sampling_options(verb, arguments.render);
  add_frame_options(verb, arguments);
  add_saving_options(verb, arguments);
  add_algorithm_options(verb, arguments.render);
  add_target_options(verb, arguments);
  add_display_options(verb, arguments.display);
  verb.add_flag(
          "--denoise", arguments.render.denoise,
          "remove noise: adds the layers denoised and denoised_error (what is left, bias included) to an .exr, with "
          "those of both halves; other files show the denoised colours")
      ->excludes("--interactive-budget");
  add_denoiser_option(verb, arguments.render.denoiser, "; implies --denoise");
  verb.get_option("--denoiser")->excludes("--interactive-budget");
  verb.add_flag(
      "--half", arguments.half,
      "light, albedo and normals of an .exr as 16-bit floats, which halves the file; other layers stay 32-bit");
  verb.add_flag("--json", arguments.json, "results as one JSON object (one line per frame)");
  verb.add_flag("--quiet", arguments.quiet, "no progress, notes or warnings");
  verb.add_flag("--no-progress", arguments.no_progress, "no progress");
}

}  // namespace montelux::cli
