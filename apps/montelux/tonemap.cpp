// montelux tonemap: converts a linear image for display.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "api/images.h"
#include "api/json_text.h"
#include "display_json.h"
#include "options.h"
#include "status.h"
#include "verbs.h"

namespace montelux::cli {

namespace {

struct TonemapArguments {
  std::string picture, output, layer;
  DisplayRequest display;
  bool json = false, quiet = false;
};

constexpr const char* examples = R"(Examples:
  montelux tonemap room.exr -o room.png
  montelux tonemap room.exr -o room.jpg --exposure -1 --tone aces
  montelux tonemap lamp.exr -o lamp.png --exposure auto
  montelux tonemap room.exr -o depth.png --layer Z                        false colours over the range of the image
  montelux tonemap room.exr -o error.png --layer stderr --range 0:0.1 --colormap magma
)";

int run_tonemap(const TonemapArguments& arguments) {
  if (Status good = check_picture_file(arguments.output); !good) return complain(good.error());
  if (!is_display_file(arguments.output))
    return complain(fmt::format("cannot write '{}': tonemap writes .png and .jpg", arguments.output));
  Result<PictureLayer> picture = read_layer(arguments.picture, arguments.layer);
  if (!picture) return complain(picture.error());
  const ChosenDisplay display =
      choose_display(picture->pixels, picture->content, arguments.display, picture->has_own_exposure);
  if (Status written = write_picture(arguments.output, picture->pixels, display.transform); !written) {
    complain(written.error());
    return failed;
  }
  if (const std::string text = choice_text(display); !text.empty() && !arguments.quiet) warn(text);
  if (arguments.json) {
    nlohmann::ordered_json json{{"picture", arguments.picture}, {"file", arguments.output}, {"layer", arguments.layer}};
    json["display"] = display_json<nlohmann::ordered_json>(display);
    fmt::print("{}\n", json_text(std::move(json), 2));
  }
  return done;
}

}  // namespace

void add_tonemap(CLI::App& app, Action& chosen) {
  auto arguments = std::make_shared<TonemapArguments>();
  CLI::App& verb = *app.add_subcommand("tonemap", "Convert a linear image for display");
  verb.footer(examples);
  verb.add_option("IN", arguments->picture, "image (.exr .hdr .pfm, or any other)")->required()->type_name("FILE");
  verb.add_option("-o,--output", arguments->output, "picture (.png .jpg)")->required()->type_name("FILE");
  verb.add_option("--layer", arguments->layer, "stderr, albedo, N, P, Z, ...; default: the colours")->type_name("NAME");
  add_display_options(verb, arguments->display);
  verb.add_flag("--json", arguments->json, "what was chosen, as one JSON object");
  verb.add_flag("--quiet", arguments->quiet, "no notes or warnings");
  verb.callback([arguments, &chosen] { chosen = [arguments] { return run_tonemap(*arguments); }; });
}

}  // namespace montelux::cli
