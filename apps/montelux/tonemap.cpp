// montelux tonemap: a linear picture for the eye.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "api/images.h"
#include "options.h"
#include "status.h"
#include "verbs.h"

namespace montelux::cli {

namespace {

struct TonemapArguments {
  std::string picture, output, layer;
  DisplayTransform display;
};

constexpr const char* examples = R"(Examples:
  montelux tonemap room.exr -o room.png
  montelux tonemap room.exr -o room.jpg --exposure -1 --tone aces
  montelux tonemap room.exr -o error.png --layer stderr --exposure 4
)";

int run_tonemap(const TonemapArguments& arguments) {
  if (Status good = check_picture_file(arguments.output); !good) return complain(good.error());
  if (!is_display_file(arguments.output))
    return complain(fmt::format("cannot write '{}': tonemap writes .png and .jpg", arguments.output));
  Result<PixelBuffer> picture = read_layer(arguments.picture, arguments.layer);
  if (!picture) return complain(picture.error());
  if (Status written = write_picture(arguments.output, *picture, arguments.display); !written) {
    complain(written.error());
    return failed;
  }
  return done;
}

}  // namespace

void add_tonemap(CLI::App& app, Action& chosen) {
  auto arguments = std::make_shared<TonemapArguments>();
  CLI::App& verb = *app.add_subcommand("tonemap", "Turn a linear picture into one for display");
  verb.footer(examples);
  verb.add_option("IN", arguments->picture, "picture (.exr .hdr .pfm, or any other image)")
      ->required()
      ->type_name("FILE");
  verb.add_option("-o,--output", arguments->output, "picture (.png .jpg)")->required()->type_name("FILE");
  verb.add_option("--layer", arguments->layer, "stderr, albedo, N, P, Z, ...; default: the colours")->type_name("NAME");
  add_display_options(verb, arguments->display);
  verb.callback([arguments, &chosen] { chosen = [arguments] { return run_tonemap(*arguments); }; });
}

}  // namespace montelux::cli
