// montelux trace: one sample of a pixel, vertex by vertex.
#include "api/trace.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <memory>
#include <nlohmann/json.hpp>

#include "api/json_text.h"
#include "api/saved_film.h"
#include "options.h"
#include "render_options.h"
#include "status.h"
#include "verbs.h"

namespace montelux::cli {

namespace {

using Json = nlohmann::ordered_json;

struct TraceArguments {
  std::string scene;
  LoadOptions load;
  RenderOptions render;
  std::pair<int, int> pixel{};
  std::optional<int> sample;
  std::optional<std::string> film;
  bool json = false, quiet = false;
};

Result<std::pair<int, int>> parse_pixel(const std::string& text) {
  int x = 0, y = 0;
  const char *at = text.data(), *end = at + text.size();
  const auto [comma, first] = std::from_chars(at, end, x);
  const bool has_two = first == std::errc{} && comma != end && *comma == ',';
  const auto [rest, second] = has_two ? std::from_chars(comma + 1, end, y) : std::from_chars_result{end, first};
  if (!has_two || second != std::errc{} || rest != end)
    return Failure{fmt::format("takes two whole numbers, as 120,45; found \"{}\"", text)};
  return std::pair{x, y};
}

// A number, or the brightest.
Result<std::optional<int>> parse_sample(const std::string& text) {
  if (text == "brightest") return std::optional<int>();
  const Result<int> number = parse_whole(text, 0, (1 << 24) - 1);
  if (!number) return Failure{number.error() + ", or brightest"};
  return std::optional<int>(*number);
}

std::string text_of(const Rgb& c) { return fmt::format("{:.4g} {:.4g} {:.4g}", c.c[0], c.c[1], c.c[2]); }
std::string text_of(const Vec3f& v) { return fmt::format("{:.5g} {:.5g} {:.5g}", v.x, v.y, v.z); }
Json json_of(const Rgb& c) { return {c.c[0], c.c[1], c.c[2]}; }
Json json_of(const Vec3f& v) { return {v.x, v.y, v.z}; }

std::string_view kind_of(const PathVertex& v) {
  constexpr std::string_view names[] = {"surface", "interface", "medium"};
  return names[std::size_t(v.kind)];
}

std::string material_of(const SampleTrace& t, const PathVertex& v) {
  return v.kind != PathVertex::Kind::medium && v.material < t.materials.size() ? t.materials[v.material] : "";
}

std::string source_of(const SampleTrace& t, const PathContribution& c) {
  if (c.source >= t.light_names.size()) return "medium";
  return fmt::format("light {} ({})", c.source, t.light_names[c.source]);
}

void print_contributions(const SampleTrace& t, std::size_t vertex) {
  for (const PathContribution& c : t.path.contributions)
    if (c.vertex == vertex)
      fmt::print("     + {}  {} of {}, {} bounce{}\n", text_of(c.value), technique_names[std::size_t(c.technique)],
                 source_of(t, c), c.bounces, c.bounces == 1 ? "" : "s");
}

void print_text(const SampleTrace& t) {
  fmt::print("pixel     {},{}, sample {} of {} (pass {}, point {}; seed {}, sampler {}, integrator {})\n", t.x, t.y,
             t.sample, t.samples, t.pass, t.index, t.seed, t.sampler, t.integrator);
  fmt::print("radiance  {}; mean of the pixel {}\n", text_of(t.path.radiance), text_of(t.pixel_mean));
  fmt::print("camera    at {} toward {}\n", text_of(t.path.origin), text_of(t.path.direction));
  for (std::size_t i = 0; i < t.path.vertices.size(); ++i) {
    const PathVertex& v = t.path.vertices[i];
    fmt::print("{:4} {:9} at {}, after {:.4g}", i + 1, kind_of(v), text_of(v.p), v.distance);
    if (v.kind != PathVertex::Kind::medium) {
      const std::string material = material_of(t, v);
      fmt::print(", object {}, {}{}, normal {}", v.object, material.empty() ? "" : material + ": ", name(v.model),
                 text_of(v.normal));
    }
    fmt::print("\n     throughput {}\n", text_of(v.throughput));
    print_contributions(t, i);
    if (v.continues)
      fmt::print("     on toward {}, {}{}\n", text_of(v.direction),
                 v.delta ? std::string("straight or mirrored") : fmt::format("density {:.4g}", v.density),
                 v.survival < 1 ? fmt::format(", survives with probability {:.3g}", v.survival) : "");
    else
      fmt::print("     ends here{}\n",
                 v.survival < 1 ? fmt::format(": roulette, survival {:.3g}", v.survival) : std::string());
  }
  print_contributions(t, t.path.vertices.size());
}

void print_json(const SampleTrace& t) {
  Json json;
  json["pixel"] = {t.x, t.y}, json["sample"] = t.sample, json["samples"] = t.samples;
  json["pass"] = t.pass, json["index"] = t.index, json["seed"] = t.seed;
  json["sampler"] = t.sampler, json["integrator"] = t.integrator;
  json["radiance"] = json_of(t.path.radiance), json["pixel_mean"] = json_of(t.pixel_mean);
  json["origin"] = json_of(t.path.origin), json["direction"] = json_of(t.path.direction);
  json["vertices"] = Json::array();
  for (const PathVertex& v : t.path.vertices) {
    const bool has_surface = v.kind != PathVertex::Kind::medium;
    json["vertices"].push_back({{"kind", kind_of(v)},
                                {"position", json_of(v.p)},
                                {"normal", has_surface ? json_of(v.normal) : Json()},
                                {"distance", v.distance},
                                {"object", has_surface ? Json(v.object) : Json()},
                                {"material", has_surface ? Json(material_of(t, v)) : Json()},
                                {"model", has_surface ? Json(name(v.model)) : Json()},
                                {"throughput", json_of(v.throughput)},
                                {"direction", v.continues ? json_of(v.direction) : Json()},
                                {"density", v.continues && !v.delta ? Json(v.density) : Json()},
                                {"survival", v.survival},
                                {"continues", v.continues}});
  }
  json["contributions"] = Json::array();
  for (const PathContribution& c : t.path.contributions)
    json["contributions"].push_back({{"vertex", c.vertex},
                                     {"light", json_of(c.value)},
                                     {"bounces", c.bounces},
                                     {"source", source_of(t, c)},
                                     {"technique", technique_names[std::size_t(c.technique)]}});
  fmt::print("{}\n", json_text(std::move(json), 2));
}

int run_trace(TraceArguments& arguments) {
  if (arguments.scene.empty() && !arguments.film)
    return complain("SCENE is required, or --film FILE; see montelux trace --help");
  std::optional<SavedFilm> film;
  if (arguments.film) {
    Result<SavedFilm> saved = load_film(*arguments.film);
    if (!saved) return complain(saved.error());
    film = *std::move(saved);
    if (arguments.scene.empty()) arguments.scene = film->scene.string();
    take_options(*film, arguments.load, arguments.render);
    arguments.render.resume = &*film;
  }
  const LoadResult loaded = load_scene(arguments.scene, arguments.load);
  print_diagnostics(loaded.diagnostics, arguments.quiet);
  if (!loaded.scene) return bad_input;
  const Result<SampleTrace> traced =
      trace_sample(*loaded.scene, arguments.render, arguments.pixel.first, arguments.pixel.second, arguments.sample);
  if (!traced) return complain(traced.error());
  if (!arguments.quiet)
    for (const std::string& note : traced->notes) warn(note);
  if (arguments.json)
    print_json(*traced);
  else
    print_text(*traced);
  return done;
}

}  // namespace

void add_trace(CLI::App& app, Action& chosen) {
  auto arguments = std::make_shared<TraceArguments>();
  CLI::App& verb =
      *app.add_subcommand("trace", "Trace one sample of a pixel again, and print its path vertex by vertex");
  TraceArguments& a = *arguments;
  add_scene_options(verb, a.scene, a.load);
  verb.get_option("SCENE")->required(false);
  add_option(verb, {"--pixel", "X,Y", "the pixel, counted from the upper left corner from 0,0"},
             into(a.pixel, parse_pixel));
  verb.get_option("--pixel")->required();
  add_option(verb,
             {"--sample", "K", "number of the sample from 0, or brightest: that of the largest luminance (default)"},
             into(a.sample, parse_sample));
  add_option(verb,
             {"--film", "FILE",
              "trace samples of this film, which montelux render --checkpoint saved: its scene, settings and passes"},
             text_into(a.film));
  add_option(verb, {"--spp", "N", "samples per pixel of the render (default: of the scene)"},
             into(a.render.samples, [](const std::string& text) { return parse_whole(text, 1, 1 << 24); }));
  add_option(verb, {"--seed", "N", "seed of the render (default: of the scene)"},
             [&a](const std::string& text) -> Status {
               const auto seed = parse_large_whole(text, 0, 0xffffffffu);
               if (!seed) return seed.failure();
               a.render.seed = std::uint32_t(*seed);
               return Done{};
             });
  add_option(verb, {"--integrator", "NAME", "path or naive, with settings as render takes them"},
             into(a.render.integrator, [](const std::string& text) { return Result<std::string>(text); }));
  add_option(verb, {"--sampler", "NAME", "the point set (default: of the scene)"},
             into(a.render.sampler, [](const std::string& text) { return Result<std::string>(text); }));
  add_option(verb, {"--set", "KEY=VALUE", "a setting of the integrator, as maxdepth=5", true},
             [&a](const std::string& text) -> Status {
               auto setting = parse_setting(text);
               if (!setting) return setting.failure();
               a.render.settings.push_back(*std::move(setting));
               return Done{};
             });
  add_pass_options(verb, a.render);
  add_filter_samples_option(verb, a.render);
  for (const char* other :
       {"--spp", "--seed", "--integrator", "--sampler", "--set", "--passes", "--samples-per-pass", "--filter-samples"})
    verb.get_option("--film")->excludes(other);
  verb.add_flag("--json", a.json, "the path as one JSON object");
  verb.add_flag("--quiet", a.quiet, "no notes or warnings");
  verb.footer(
      "With the same --spp, --samples-per-pass, --passes, --seed, --sampler, --filter-samples and integrator a sample "
      "is "
      "the one that\nrender took. With --filter-samples own, which --denoise and layers of light imply, the mean of "
      "all is "
      "the pixel;\nelse those of its neighbours count as well. A render that ended by --time or --target-error, or is "
      "adaptive, is "
      "traced by its film\n(render --checkpoint).\n\nExamples:\n"
      "  montelux trace scene.pbrt --pixel 120,45\n"
      "  montelux trace scene.pbrt --pixel 120,45 --sample 17 --spp 64 --json\n"
      "  montelux trace --film room.film --pixel 120,45");
  verb.callback([arguments, &chosen] { chosen = [arguments] { return run_trace(*arguments); }; });
}

}  // namespace montelux::cli
