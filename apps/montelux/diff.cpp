// montelux diff: how two images differ, and whether their noise explains it.
#include "api/diff.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "api/json_text.h"
#include "options.h"
#include "status.h"
#include "verbs.h"

namespace montelux::cli {

namespace {

using Json = nlohmann::ordered_json;

struct DiffArguments {
  PictureFiles a, b;
  std::optional<double> degrees_of_freedom;
  std::optional<std::string> output;
  std::string metric = "relative";
  double level = 0.01;
  bool json = false, quiet = false;
};

constexpr const char* examples = R"(Examples:
  montelux diff a.exr b.exr
  montelux diff a.exr b.exr -o error.png --metric flip
  montelux diff a.exr reference.exr --stderr-b reference.stderr.exr --dof 63 --json

With standard errors of both images (layer stderr, or --stderr-a, --stderr-b), Welch's t-test of the image mean, of
blocks of 8 x 8, 16 x 16, ... pixels and of pixels decides; otherwise the images must be identical.
Exit status: 0 equal, or the noise explains the difference; 1 different; 2 error.
)";

Json number_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json to_json(const WelchScale& scale) {
  Json json;
  json["tests"] = scale.tests, json["p"] = scale.smallest_p, json["t"] = number_or_null(scale.t);
  json["difference"] = number_or_null(scale.difference), json["detectable"] = number_or_null(scale.detectable);
  json["detectable_median"] = number_or_null(scale.detectable_median), json["side"] = scale.side;
  json["x"] = scale.x, json["y"] = scale.y, json["channel"] = std::string(1, "RGB"[scale.channel]);
  json["differs"] = scale.differs;
  return json;
}

void print_json(const DiffArguments& arguments, const PictureDifference& d) {
  Json json;
  json["a"] = arguments.a.picture.string(), json["b"] = arguments.b.picture.string();
  json["equal"] = d.equal, json["differs"] = d.differs();
  json["mse"] = d.measures.mse, json["relative_mse"] = d.measures.relative_mse;
  json["psnr"] = number_or_null(d.measures.psnr);
  json["flip"] = d.flip.mean, json["flip_kind"] = d.hdr_flip ? "hdr" : "ldr";
  json["mean_difference"] = d.measures.mean_difference;
  json["mean_a"] = d.mean_a, json["mean_b"] = d.mean_b;
  json["non_finite"] = d.measures.non_finite;
  json["welch"] = nullptr;
  if (d.welch)
    json["welch"] = {{"level", arguments.level},
                     {"image", to_json(d.welch->image)},
                     {"blocks", to_json(d.welch->blocks)},
                     {"pixels", to_json(d.welch->pixels)},
                     {"differs", d.welch->differs}};
  fmt::print("{}\n", json_text(std::move(json), 2));
}

void print_scale(std::string_view name, const WelchScale& scale, double level) {
  fmt::print("  {:7} {:>8} {:>10.3g} {:>10.3g}  {:>5} {:>5}, {:<5} {} {:>11.4g} {:>11.4g}  {}\n", name, scale.tests,
             scale.smallest_p, level / (3 * double(scale.tests)), scale.side > 0 ? std::to_string(scale.side) : "all",
             scale.x, scale.y, "RGB"[scale.channel], scale.difference, scale.detectable,
             scale.differs ? "differs" : "");
}

// The power of the tests, relative to the mean of B.
void print_power(const PictureDifference& d) {
  const double mean = d.mean_b[std::size_t(d.welch->image.channel)];
  if (!(mean > 0) || !(d.welch->image.detectable > 0)) return;
  fmt::print(
      "detected in half of the cases: {:.3g} % of the image mean, {:.3g} % of it in a block, {:.3g} % in a pixel\n",
      100 * d.welch->image.detectable / mean, 100 * d.welch->blocks.detectable_median / mean,
      100 * d.welch->pixels.detectable_median / mean);
}

void print_text(const DiffArguments& arguments, const PictureDifference& d) {
  fmt::print("MSE       {:.6g}\nrelMSE    {:.6g}\nPSNR      {:.4g} dB\n", d.measures.mse, d.measures.relative_mse,
             d.measures.psnr);
  fmt::print("{} {:.4g}\n", d.hdr_flip ? "HDR-FLIP " : "LDR-FLIP ", d.flip.mean);
  fmt::print("mean      ");
  for (std::size_t c = 0; c < 3; ++c)
    fmt::print("{} {:.6g} - {:.6g} = {:.3g}{}", "RGB"[c], d.mean_a[c], d.mean_b[c], d.mean_a[c] - d.mean_b[c],
               c < 2 ? ", " : "\n");
  if (d.measures.non_finite > 0) fmt::print("{} pixels are not finite and excluded above\n", d.measures.non_finite);
  if (d.welch) {
    fmt::print("Welch t-test, family-wise level {}; of each scale the most significant test:\n", arguments.level);
    fmt::print("  {:7} {:>8} {:>10} {:>10}  {:>5} {:>14} {:>11} {:>11}\n", "scale", "tests", "p", "below is", "side",
               "at pixel", "difference", "detectable");
    print_scale("image", d.welch->image, arguments.level);
    print_scale("blocks", d.welch->blocks, arguments.level);
    print_scale("pixels", d.welch->pixels, arguments.level);
    print_power(d);
  }
  if (d.equal)
    fmt::print("equal\n");
  else if (!d.welch)
    fmt::print("different (without error bars on both images, noise cannot be separated from error)\n");
  else
    fmt::print("{}\n", d.welch->differs ? "different: more than the noise explains"
                                        : "indistinguishable: the noise explains the difference");
}

int run_diff(DiffArguments& arguments) {
  if (arguments.output)
    if (Status good = check_picture_file(*arguments.output); !good) return complain(good.error());
  arguments.a.degrees_of_freedom = arguments.b.degrees_of_freedom = arguments.degrees_of_freedom;
  Result<PictureEstimate> a = read_estimate(arguments.a);
  if (!a) return complain(a.error());
  Result<PictureEstimate> b = read_estimate(arguments.b);
  if (!b) return complain(b.error());
  Result<PictureDifference> difference = compare_pictures(*a, *b, arguments.level);
  if (!difference) return complain(difference.error());
  if (arguments.output) {
    Result<PixelBuffer> map = difference_map(arguments.metric, *a, *b, *difference);
    if (!map) return complain(map.error());
    if (Status written = write_map(*arguments.output, *map); !written) return complain(written.error(), failed);
  }
  if (arguments.json)
    print_json(arguments, *difference);
  else
    print_text(arguments, *difference);
  return difference->differs() ? differs : done;
}

}  // namespace

void add_diff(CLI::App& app, Action& chosen) {
  auto arguments = std::make_shared<DiffArguments>();
  CLI::App& verb = *app.add_subcommand("diff", "Compare two images, using their error bars if they have any");
  verb.footer(examples);
  auto file = [&verb](const char* name, std::filesystem::path& target, const char* help) {
    verb.add_option_function<std::string>(
            name, [&target](const std::string& text) { target = text; }, help)
        ->required()
        ->type_name("FILE");
  };
  file("A", arguments->a.picture, "image to test");
  file("B", arguments->b.picture, "image to compare with, the reference of relMSE");
  auto optional_file = [](const std::string& text) -> Result<std::filesystem::path> { return {text}; };
  add_option(verb, {"-o,--output", "FILE", "map of the difference; .png in false colours, .exr .hdr .pfm as numbers"},
             into(arguments->output, [](const std::string& text) -> Result<std::string> { return text; }));
  const auto metrics = names_of(difference_maps());
  add_option(verb, {"--metric", alternatives(metrics), "what the map shows (default relative)"},
             into(arguments->metric, [metrics](const std::string& text) { return parse_choice(text, metrics); }));
  add_option(verb, {"--stderr-a", "FILE", "standard error of A, instead of its layer stderr"},
             into(arguments->a.standard_error, optional_file));
  add_option(verb, {"--stderr-b", "FILE", "standard error of B, instead of its layer stderr"},
             into(arguments->b.standard_error, optional_file));
  add_option(
      verb, {"--dof", "N", "degrees of freedom of standard errors whose image does not state them (default: infinite)"},
      into(arguments->degrees_of_freedom, [](const std::string& text) { return parse_number(text, 1, 1e9); }));
  add_option(verb, {"--level", "P", "family-wise level of the tests (default 0.01)"},
             into(arguments->level, [](const std::string& text) { return parse_number(text, 1e-12, 0.5); }));
  verb.add_flag("--json", arguments->json, "results as one JSON object");
  verb.add_flag("--quiet", arguments->quiet, "no notes or warnings (there are none: results and errors stay)");
  verb.callback([arguments, &chosen] { chosen = [arguments] { return run_diff(*arguments); }; });
}

}  // namespace montelux::cli
