// montelux denoise: removes noise from a rendered image.
#include "api/denoise.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "api/denoisers.h"
#include "api/images.h"
#include "api/json_text.h"
#include "denoise_output.h"
#include "options.h"
#include "progress.h"
#include "status.h"
#include "verbs.h"

namespace montelux::cli {

namespace {

struct DenoiseArguments {
  std::string picture;
  std::vector<std::string> outputs, before;
  std::optional<std::string> denoiser;
  int threads = 0;
  bool json = false, quiet = false;
};

constexpr const char* examples = R"(Examples:
  montelux render room.pbrt --spp 64 --layers halves -o room.exr
  montelux denoise room.exr -o clean.exr -o clean.png
  montelux render room.pbrt --spp 64 --denoise                     in one step
  montelux render room.pbrt --spp 64 --layers light-groups --denoise     the light of each group, too
  montelux render walk.pbrt --frames 1:9 --layers halves,motion -o walk.####.exr
  montelux denoise walk.0002.exr --before walk.0001.exr -o clean.0002.exr
  montelux denoise room.exr --denoiser oidn -o clean.exr           by Open Image Denoise, if it is installed

The .exr keeps all layers of the image, and adds denoised.R, .G, .B and denoised_error.R, .G, .B: the root of the
estimated mean squared error that is left, bias included. R, G, B stay the unbiased estimate. Layers of light become
denoised_NAME, which sum to the denoised colours, and denoised_error_NAME if they were rendered with errors. Other
formats contain the denoised colours.
)";

Status write_output(const std::string& file, const DenoisedFile& denoised, int threads) {
  if (extension_of(file) == ".exr") return write_exr(file, denoised.rows(), {denoised.image.attributes, {}, threads});
  const PixelBuffer colors = *layer(denoised.layers, "denoised");
  return write_picture(file, colors, choose_display(colors, Content::light, {}, false).transform);
}

int run_denoise(const DenoiseArguments& arguments) {
  for (const std::string& file : arguments.outputs)
    if (Status good = check_picture_file(file); !good) return complain(good.error());
  const auto filter = parse_denoiser(arguments.denoiser.value_or("montelux"));
  if (!filter) return complain(filter.error());
  DenoiseOptions options{arguments.threads, {}, {arguments.before.begin(), arguments.before.end()}, {}, *filter};
  StatusLine line(!arguments.quiet);
  const auto seconds = [start = std::chrono::steady_clock::now()] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  double read = 0;  // when the files were
  options.progress = [&](double share) {
    const double elapsed = seconds();
    if (share == 0) read = elapsed;
    line.show(share, elapsed, [&] {
      const std::string left = share > 0 ? time_text((elapsed - read) * (1 - share) / share) : "-";
      return fmt::format("{}  left {}", time_text(elapsed), left);
    });
  };
  const Result<DenoisedFile> denoised = denoise_file(arguments.picture, options);
  line.finish();
  if (!denoised) return complain(denoised.error());
  int status = done;
  for (const std::string& file : arguments.outputs)
    if (Status written = write_output(file, *denoised, arguments.threads); !written) {
      complain(written.error());
      status = failed;
    }
  if (arguments.json) {
    nlohmann::ordered_json json{{"picture", arguments.picture}, {"files", arguments.outputs}};
    json["denoised"] = denoising_json<nlohmann::ordered_json>(denoised->estimate);
    fmt::print("{}\n", json_text(std::move(json), 2));
  } else {
    for (const std::string& file : arguments.outputs) fmt::print("image    {}\n", file);
    fmt::print("denoised {}\n", denoising_text(denoised->estimate));
  }
  return status;
}

}  // namespace

void add_denoise(CLI::App& app, Action& chosen) {
  auto arguments = std::make_shared<DenoiseArguments>();
  CLI::App& verb = *app.add_subcommand("denoise", "Remove noise from an image, and estimate the error that is left");
  verb.footer(examples);
  verb.add_option("IN", arguments->picture, "image that was rendered with --layers halves (.exr)")
      ->required()
      ->type_name("FILE");
  verb.add_option("-o,--output", arguments->outputs, "image (.exr .hdr .pfm .png .jpg); may be repeated")
      ->required()
      ->type_name("FILE")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  verb.add_option(
          "--before", arguments->before,
          "an earlier image of the sequence (.exr); may be repeated, the latest first. Requires the layer motion "
          "and frames with independent samples")
      ->type_name("FILE")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  add_denoiser_option(verb, arguments->denoiser, "");
  add_option(verb, {"--threads", "T", "threads; default: one for each processor"},
             into(arguments->threads, [](const std::string& t) { return parse_whole(t, 1, 4096); }));
  verb.add_flag("--json", arguments->json, "the estimated errors, as one JSON object");
  verb.add_flag("--quiet", arguments->quiet, "no progress, notes or warnings");
  verb.callback([arguments, &chosen] { chosen = [arguments] { return run_denoise(*arguments); }; });
}

}  // namespace montelux::cli
