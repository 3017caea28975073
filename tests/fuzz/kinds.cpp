#include "kinds.h"

#include <CLI/CLI.hpp>
#include <array>
#include <chrono>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "../../apps/montelux/verbs.h"
#include "api/comparison.h"
#include "api/diff.h"
#include "api/integrate.h"
#include "api/render.h"
#include "api/saved_file.h"
#include "api/saved_film.h"
#include "gltf_files.h"
#include "io/ply.h"
#include "material/measured_file.h"
#include "measured_files.h"

namespace montelux::fuzz {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using Examples = std::vector<std::string>;

constexpr std::pair<int, int> resolution{8, 6};
// The longest that a render of a few pixels may take before a stop is requested.
constexpr double max_seconds = 2;

void require(bool holds, const std::string& rule) {
  if (!holds) throw Finding(rule);
}

fs::path written(const fs::path& file, const std::string& bytes) {
  std::ofstream out(file, std::ios::binary);
  out << bytes;
  out.close();
  if (!out) throw std::runtime_error("the fuzzer cannot write " + file.string());
  return file;
}

std::string content(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream bytes;
  if (!in || !(bytes << in.rdbuf())) throw std::runtime_error("the fuzzer cannot read " + file.string());
  return bytes.str();
}

fs::path own_scenes() { return fs::path(MONTELUX_SOURCE_DIR) / "scenes"; }

class ImpatientObserver final : public RenderObserver {
 public:
  bool stop_requested() override {
    return std::chrono::steady_clock::now() - start_ > std::chrono::duration<double>(max_seconds);
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

// ---- scenes ---------------------------------------------------------------------------------------------------------

void check(const Diagnostics& diagnostics) {
  for (const Diagnostic& d : diagnostics.all()) {
    require(!d.message.empty(), "a diagnostic says nothing");
    require(d.severity != Severity::error || d.where.file != nullptr, "an error names no file: " + d.message);
    require(!to_text(d, false).empty(), "a diagnostic has no text");
  }
}

void run_scene(const fs::path& file) {
  LoadOptions load;
  load.resolution = resolution, load.threads = 1, load.lenient = true;
  const LoadResult loaded = load_scene(file, load);
  check(loaded.diagnostics);
  require(loaded.scene.has_value() || loaded.diagnostics.has_errors(), "there is no scene and no error");
  if (!loaded.scene) return;
  RenderOptions options;
  options.samples = 2, options.threads = 1;
  ImpatientObserver observer;
  const Result<Rendering> rendering = render_scene(*loaded.scene, options, observer);
  if (!rendering) {
    require(!rendering.error().empty(), "a render fails and does not say why");
    return;
  }
  const PixelBuffer layers = layers_of(*rendering);
  const std::array<int, 3> color = rgb_channels(layers);
  for (int y = 0; y < layers.height; ++y)
    for (int x = 0; x < layers.width; ++x)
      for (float value : rgb_at(layers, color, x, y).c) require(std::isfinite(value), "a pixel is not finite");
}

Examples pbrt_examples(const fs::path& folder) {
  fs::copy_file(own_scenes() / "analytic" / "right-half.png", folder / "right-half.png",
                fs::copy_options::overwrite_existing);
  Examples all;
  for (const char* sub : {"first-light", "glossy-indirect", "path-classes", "analytic"})
    for (const auto& entry : fs::directory_iterator(own_scenes() / sub))
      if (entry.path().extension() == ".pbrt") all.push_back(content(entry.path()));
  std::sort(all.begin(), all.end());
  return all;
}

Examples gltf_examples(const fs::path&) {
  return {content(own_scenes() / "clockwork" / "clockwork.gltf"), test::triangle_json(),
          test::triangle_json(R"("attributes": {"POSITION": 0}, "indices": 1, "material": 0)",
                              R"("mesh": 0, "scale": [1, 2, 3])",
                              R"(, "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0.2, 1],
"metallicFactor": 0.5, "roughnessFactor": 0.3}, "emissiveFactor": [1, 1, 1], "doubleSided": true}])")};
}

Examples glb_examples(const fs::path&) {
  const std::string bytes = test::triangle_bytes().text();
  return {test::binary_file(test::triangle_json(R"("attributes": {"POSITION": 0}, "indices": 1)", R"("mesh": 0)", "",
                                                R"("buffers": [{"byteLength": )" + std::to_string(bytes.size()) + "}]"),
                            bytes)};
}

// ---- meshes and pictures --------------------------------------------------------------------------------------------

Examples ply_examples(const fs::path&) {
  const std::string text =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty float "
      "nx\nproperty float ny\nproperty float nz\nelement extra 1\nproperty list uchar float stuff\nelement face 2\n"
      "property list uchar int vertex_indices\nend_header\n0 0 0 0 0 1\n1 0 0 0 0 1\n1 1 0 0 0 1\n0 1 0 0 0 1\n2 5 6\n"
      "3 0 1 2\n4 0 1 2 3\n";
  std::string binary =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  binary += test::Bytes().put<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}).put<char>({3}).put<int>({0, 1, 2}).text();
  return {text, binary};
}

void run_ply(const std::string& input, const fs::path&) {
  Diagnostics diagnostics;
  const auto file = std::make_shared<const std::string>("scene.pbrt");
  const std::optional<Mesh> mesh = read_ply_bytes(input, "mesh.ply", {file, 1, 1}, diagnostics);
  check(diagnostics);
  require(mesh.has_value() != diagnostics.has_errors(), "a mesh and an error, or neither");
  if (!mesh) return;
  for (std::uint32_t index : mesh->triangles) require(index < mesh->positions.size(), "an index beyond the vertices");
  for (std::uint32_t index : mesh->quads) require(index < mesh->positions.size(), "an index beyond the vertices");
}

Examples table_examples(const fs::path&) {
  const test::ClosedLobe lobe{0.3, 0.5, {0.2, 0.3, 0.4}, {0.5, 0.4, 0.3}};
  test::Tabulation spectral{.elevations = 2, .facets = 3, .values = 2};
  spectral.wavelengths = {400, 500, 700}, spectral.spectrum = [](double w) { return w / 1000; };
  return {test::measured_file(lobe, {.elevations = 2, .azimuths = 3, .facets = 3, .values = 2}),
          test::measured_file(lobe, spectral)};
}

void run_table(const std::string& input, const fs::path&) {
  Result<MeasuredData> data = read_measured_data(input);
  if (!data) return require(!data.error().empty(), "a table is refused and nothing says why");
  const MeasuredTable table(std::move(data).value());
  for (const Vec3f wo : {Vec3f{0, 0, 1}, Vec3f{0.6f, 0, 0.8f}, Vec3f{0, -1, 1e-6f}})
    for (const Vec2f u : {Vec2f{0, 0}, Vec2f{0.3f, 0.7f}, Vec2f{one_minus_epsilon, 0.5f}}) {
      const Vec3f wi = table.sample(wo, u).wi;
      require(std::abs(length(wi) - 1) < 1e-3f, "a direction is not unit");
      if (!(wi.z > 0)) continue;
      const BsdfValue<float> value = table.evaluate(wo, wi);
      require(is_finite(max_component(value.f_cos)) && is_finite(value.density.value), "a value is not finite");
    }
}

// The ending of the file is its first line, so that the same damage is read by every format.
Examples picture_examples(const fs::path& folder) {
  PixelBuffer picture = make_pixel_buffer(5, 4, {"R", "G", "B", "stderr.R", "stderr.G", "stderr.B", "Z"});
  for (std::size_t i = 0; i < picture.values.size(); ++i) picture.values[i] = 0.1f * float(i % 13);
  ExrOptions options;
  options.attributes = {{"montelux:passes", std::int32_t(8)}, {"montelux:integrator", std::string("path")}};
  Examples all;
  for (const char* ending : {".exr", ".hdr", ".pfm", ".png", ".jpg"}) {
    const fs::path file = folder / (std::string("example") + ending);
    if (!write_picture(file, picture, {})) throw std::runtime_error("the fuzzer cannot write " + file.string());
    if (ending == std::string(".exr") && !write_image(file, picture, options)) throw std::runtime_error("no .exr");
    all.push_back(std::string(ending) + "\n" + content(file));
  }
  return all;
}

void run_picture(const std::string& input, const fs::path& folder) {
  static constexpr std::array<const char*, 5> endings{".exr", ".hdr", ".pfm", ".png", ".jpg"};
  const std::size_t line = std::min(input.find('\n'), input.size());
  std::string ending = input.substr(0, line);
  if (std::find(endings.begin(), endings.end(), ending) == endings.end()) ending = ".exr";
  const fs::path file = written(folder / ("picture" + ending), line < input.size() ? input.substr(line + 1) : "");
  const Result<PictureEstimate> estimate = read_estimate({file, {}, {}});
  if (!estimate) {
    require(estimate.error().find(file.filename().string()) != std::string::npos, "no file in: " + estimate.error());
    return;
  }
  require(estimate->color.width > 0 && estimate->color.height > 0, "a picture without pixels");
  if (estimate->color.pixel_count() > 4096) return;
  const auto difference = compare_pictures(*estimate, *estimate, 0.01);
  require(difference.has_value() || !difference.error().empty(), "a comparison fails and does not say why");
}

// ---- saved work -----------------------------------------------------------------------------------------------------

// What is still JSON gets the checksum that it should have, so that the damage is not found by that alone.
std::string with_checksum(const std::string& input) {
  Json json = Json::parse(input, nullptr, false);
  if (!json.is_object() || !json.contains("checksum")) return input;
  json.erase("checksum");
  try {
    json["checksum"] = checksum_of(json);
    return json.dump(1);
  } catch (const Json::exception&) {  // text that is not UTF-8
    return input;
  }
}

Examples integral_examples(const fs::path& folder) {
  Examples all;
  for (const char* method : {"uniform", "qmc", "vegas"}) {
    IntegralOptions options;
    options.statement.integrand = "4*x^3*exp(-y)", options.statement.over = {"x=0:1", "y=0:2"};
    options.methods = {method}, options.budget.samples = 256;
    const IntegralPreparation prepared = prepare_integral(options);
    if (!prepared.integral) throw std::runtime_error("the example integral cannot be prepared");
    IntegralWatch watch;
    watch.threads = 1;
    const auto runs = run_integral(*prepared.integral, watch);
    const fs::path file = folder / "integral.json";
    if (!runs || !save_integral(file, saved_of(*prepared.integral, *runs)))
      throw std::runtime_error("the example integral cannot be run");
    all.push_back(content(file));
  }
  return all;
}

void run_integral_file(const std::string& input, const fs::path& folder) {
  const fs::path file = written(folder / "saved.json", with_checksum(input));
  const Result<SavedIntegral> saved = load_integral(file);
  if (!saved) {
    require(saved.error().find("saved.json") != std::string::npos, "no file in: " + saved.error());
    return;
  }
  for (const IntegralRun& run : runs_of(*saved)) require(!run.method.empty(), "a run without a method");
  rest_of_budget(*saved);
  const auto merged = merge_integrals({*saved, *saved});
  require(!merged || !saved->states.empty(), "two runs of one seed are merged");
}

// A formula, and below it its domain, a variable a line.
Examples formula_examples(const fs::path&) {
  return {"4*x^3\nx=0:1",  "exp(-x*y)\nx=0:1\ny=0:2", "sin(x)^2/(1+x^2)\nx=-inf:inf",
          "x*y*z\nsphere", "if(x<0.5,1,2*x)\nx=0:1",  "sqrt(abs(x-y))\nx=0:1\ny=0:1"};
}

void run_formula(const std::string& input, const fs::path&) {
  std::istringstream lines(input);
  IntegralOptions options;
  std::getline(lines, options.statement.integrand);
  for (std::string line; std::getline(lines, line);) options.statement.over.push_back(line);
  if (options.statement.over.size() > 8) return;
  options.methods = {"uniform"}, options.budget.samples = 64;
  const IntegralPreparation prepared = prepare_integral(options);
  require(prepared.integral.has_value() || !prepared.mistakes.empty(), "a formula is refused without a reason");
  for (const std::string& mistake : prepared.mistakes) require(!mistake.empty(), "a mistake says nothing");
  if (!prepared.integral) return;
  IntegralWatch watch;
  watch.threads = 1;
  const auto runs = run_integral(*prepared.integral, watch);
  require(runs.has_value() || !runs.error().empty(), "an integral fails and does not say why");
}

Examples comparison_examples(const fs::path& folder) {
  const fs::path scene = written(folder / "compared.pbrt", content(own_scenes() / "analytic" / "rectangle-light.pbrt"));
  LoadOptions load;
  load.resolution = resolution, load.threads = 1;
  const LoadResult loaded = load_scene(scene, load);
  if (!loaded.scene) throw std::runtime_error("the example comparison has no scene");
  ComparisonOptions options;
  options.methods = {"path", "direct"}, options.samples = 4, options.repeats = 2, options.cache = false;
  options.threads = 1, options.slopes = false;
  auto comparison = compare_methods(*loaded.scene, options, {});
  if (!comparison) throw std::runtime_error(comparison.error());
  comparison->saved.scene = scene, comparison->saved.load = load;
  comparison->saved.fingerprint = scene_fingerprint(scene);
  const fs::path file = folder / "comparison.json";
  if (!save_comparison(file, comparison->saved)) throw std::runtime_error("the example comparison cannot be saved");
  return {content(file)};
}

void run_comparison(const std::string& input, const fs::path& folder) {
  const fs::path file = written(folder / "saved.json", with_checksum(input));
  const Result<SavedComparison> saved = load_comparison(file);
  if (!saved) require(saved.error().find(".") != std::string::npos, "no file in: " + saved.error());
}

// A film with layers, half of whose passes another one has; in one line of JSON and bytes.
Examples film_examples(const fs::path& folder) {
  const fs::path scene = written(folder / "filmed.pbrt", content(own_scenes() / "analytic" / "rectangle-light.pbrt"));
  LoadOptions load;
  load.resolution = resolution, load.threads = 1;
  const LoadResult loaded = load_scene(scene, load);
  if (!loaded.scene) throw std::runtime_error("the example film has no scene");
  Examples all;
  for (const char* layers : {"", "bounces:1,errors"}) {
    RenderOptions options;
    options.samples = 4, options.samples_per_pass = 1, options.threads = 1;
    if (*layers) options.layers = *parse_layers(layers);
    options.checkpoint = FilmCheckpoint{folder / "example.film"};
    RenderObserver silent;
    if (!render_scene(*loaded.scene, options, silent)) throw std::runtime_error("the example film cannot be rendered");
    all.push_back(content(options.checkpoint->file));
  }
  return all;
}

// The checksum that the damaged film should have.
std::string with_film_checksum(const std::string& input) {
  const std::size_t line = std::min(input.find('\n'), input.size());
  Json json = Json::parse(input.substr(0, line), nullptr, false);
  if (!json.is_object() || !json.contains("checksum")) return input;
  json.erase("checksum");
  const std::string bytes = input.substr(std::min(line + 1, input.size()));
  try {
    json["bytes"] = bytes.size();
    json["checksum"] = checksum_of(json, bytes);
    return json.dump() + '\n' + bytes;
  } catch (const Json::exception&) {  // text that is not UTF-8
    return input;
  }
}

void run_film(const std::string& input, const fs::path& folder) {
  const fs::path file = written(folder / "saved.film", with_film_checksum(input));
  Result<SavedFilm> film = load_film(file);
  if (!film) {
    require(film.error().find("saved.film") != std::string::npos, "no file in: " + film.error());
    return;
  }
  require(bool(save_film(folder / "again.film", *film)), "a film that was read cannot be written");
  const Result<SavedFilm> again = load_film(folder / "again.film");
  require(again.has_value(), "a film that was written cannot be read");
  if (film->begun.film.image().passes > 0) {
    std::vector<SavedFilm> both{*film, *again};
    require(!merge_films(std::move(both), {"saved.film", "again.film"}), "a film is merged with itself");
  }
  const Rendering rendering = rendering_of(*std::move(film));
  require(!rendering.header.empty(), "a picture without a header");
}

// ---- options --------------------------------------------------------------------------------------------------------

// An argument a line.
Examples option_examples(const fs::path&) {
  return {
      "render\nroom.pbrt\n-o\nroom.exr\n--spp\n64\n--resolution\n80x60\n--crop\n0,0,8,8\n--time\n10m\n--seed\n7",
      "render\na.pbrt\n--integrator\ndirect:strategy=ris,candidates=32\n--set\nmaxdepth=4\n--sampler\nsobol\n--json",
      "render\na.gltf\n--frames\n0:11/24\n--fps\n24\n--shutter\n0:0.5\n--layers\nbounces:3,light-groups",
      "integrate\n4*x^3\n--over\nx=0:1\n--target-error\n1e-4\n--confidence\n0.95\n--method\nvegas",
      "diff\na.exr\nb.exr\n-o\nerror.png\n--metric\nflip\n--level\n0.01\n--dof\n63",
      "compare\na.pbrt\n-a\npath\n-b\nnaive\n--spp\n64\n--repeats\n8\n--save\nrun.json",
      "tonemap\na.exr\n-o\na.png\n--exposure\n1.5\n--tone\naces\n--layer\nalbedo",
      "merge\na.json\nb.json\n-o\nboth.json",
      "render\na.pbrt\n--passes\n4:7\n--samples-per-pass\n16\n--checkpoint\na.film\n--checkpoint-every\n30s",
      "render\n--resume\na.film\n--spp\n64",
      "list\nintegrators\npath",
      "info\nroom.pbrt\n--json"};
}

// Only what reading the options does; what the verb would do is left out.
void run_options(const std::string& input, const fs::path&) {
  CLI::App app("", "montelux");
  app.require_subcommand(1);
  cli::Action chosen;
  for (auto add : {cli::add_render, cli::add_integrate, cli::add_merge, cli::add_info, cli::add_diff, cli::add_compare,
                   cli::add_tonemap, cli::add_list, cli::add_lab, cli::add_completion})
    add(app, chosen);
  std::vector<std::string> arguments;
  std::istringstream lines(input);
  for (std::string line; std::getline(lines, line);) arguments.push_back(line);
  std::reverse(arguments.begin(), arguments.end());  // as this parser takes them
  try {
    app.parse(arguments);
  } catch (const CLI::Success&) {
    return;
  } catch (const CLI::ParseError& error) {
    require(std::string(error.what()).size() > 0, "options are refused without a reason");
    return;
  }
  require(bool(chosen), "options are taken, and no verb is chosen");
}

constexpr std::array<Kind, 11> all_kinds{{
    {"pbrt", "scenes in pbrt's format, loaded and rendered", pbrt_examples,
     [](const std::string& input, const fs::path& folder) { run_scene(written(folder / "scene.pbrt", input)); }},
    {"gltf", "glTF as text, loaded and rendered", gltf_examples,
     [](const std::string& input, const fs::path& folder) { run_scene(written(folder / "scene.gltf", input)); }},
    {"glb", "binary glTF, loaded and rendered", glb_examples,
     [](const std::string& input, const fs::path& folder) { run_scene(written(folder / "scene.glb", input)); }},
    {"ply", "meshes", ply_examples, run_ply},
    {"table", "tables of measured materials, looked up", table_examples, run_table},
    {"picture", "pictures of every format, read and compared", picture_examples, run_picture},
    {"integral", "saved integrals", integral_examples, run_integral_file},
    {"formula", "formulas and domains of integrals, integrated", formula_examples, run_formula},
    {"comparison", "saved comparisons", comparison_examples, run_comparison},
    {"film", "saved films", film_examples, run_film},
    {"options", "arguments of the command line", option_examples, run_options},
}};

}  // namespace

std::span<const Kind> kinds() { return all_kinds; }

const Kind* kind_named(std::string_view name) {
  for (const Kind& kind : all_kinds)
    if (kind.name == name) return &kind;
  return nullptr;
}

}  // namespace montelux::fuzz
