// montelux merge: several saved films become one, and several saved integrals.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "api/images.h"
#include "api/integrate.h"
#include "api/saved_film.h"
#include "integral_output.h"
#include "options.h"
#include "picture_output.h"
#include "status.h"
#include "verbs.h"

namespace montelux::cli {

namespace {

struct MergeArguments {
  std::vector<std::string> files, outputs;
  IntegralOutput output;
};

constexpr const char* examples = R"(Examples:
  montelux integrate '4*x^3' --over x=0:1 --seed 1 --save a.json
  montelux integrate '4*x^3' --over x=0:1 --seed 2 --save b.json
  montelux merge a.json b.json -o both.json

  montelux render room.pbrt --spp 4096 --passes 0:7 --checkpoint a.film
  montelux render room.pbrt --spp 4096 --passes 8:15 --checkpoint b.film
  montelux merge a.film b.film -o room.film -o room.exr

Integrals are merged from runs of different seeds; films from different passes of one render, and the merged film is the
same bits as if that render had been one.
)";

bool is_picture(const std::string& file) {
  constexpr std::string_view endings[] = {".exr", ".hdr", ".pfm", ".png", ".jpg", ".jpeg"};
  return std::ranges::find(endings, extension_of(file)) != std::end(endings);
}

// Status of an output that cannot be written.
int complain_of_output(const Status& written) {
  complain(written.error());
  return failed;
}

template <class Saved, class Load>
Result<std::vector<Saved>> load_all(const std::vector<std::string>& files, Load load,
                                    std::vector<std::string>& mistakes) {
  std::vector<Saved> parts;
  for (const std::string& file : files)
    if (Result<Saved> part = load(file))
      parts.push_back(*std::move(part));
    else
      mistakes.push_back(part.error());
  return parts;
}

int merge_saved_integrals(const MergeArguments& arguments) {
  std::vector<std::string> mistakes;
  const auto parts = load_all<SavedIntegral>(arguments.files, load_integral, mistakes);
  if (!mistakes.empty()) return complain_of_all(mistakes);
  const Result<SavedIntegral> total = merge_integrals(*parts);
  if (!total) return complain(total.error());
  for (const std::string& file : arguments.outputs)
    if (Status written = save_integral(file, *total); !written) return complain_of_output(written);
  return print_integrals(arguments.output, total->options, runs_of(*total));
}

int merge_saved_films(const MergeArguments& arguments) {
  if (arguments.output.csv || arguments.output.strict)
    return complain("--csv and --strict are for integrals; the result of merged films is text or --json");
  std::vector<std::string> mistakes;
  auto parts = load_all<SavedFilm>(arguments.files, load_film, mistakes);
  if (!mistakes.empty()) return complain_of_all(mistakes);
  Result<SavedFilm> total = merge_films(*std::move(parts), arguments.files);
  if (!total) return complain(total.error());
  PictureReport report{total->scene.string(), {}, {}, total->settings.seed, {}, {}, {}};
  for (const std::string& file : arguments.outputs) {
    if (is_picture(file)) {
      report.files.push_back(file);
      continue;
    }
    if (Status written = save_film(file, *total); !written) return complain_of_output(written);
    report.film = file;
  }
  const Rendering rendering = rendering_of(*std::move(total));
  std::optional<ChosenDisplay> display;
  if (std::ranges::any_of(report.files, is_display_file)) {
    display = choose_display(rendering, {});
    report.display = &*display;
  }
  for (const std::string& file : report.files)
    if (Status written = write_rendering(file, rendering, display ? display->transform : DisplayTransform{}); !written)
      return complain_of_output(written);
  if (arguments.output.json)
    print_picture_json(report, rendering);
  else
    print_picture_text(report, rendering);
  return done;
}

int run_merge(const MergeArguments& arguments) {
  for (const std::string& file : arguments.outputs)
    if (Status good = check_output_file(file); !good) return complain(good.error());
  const auto films = std::ranges::count_if(arguments.files, is_saved_film);
  if (films == 0) {
    for (const std::string& file : arguments.outputs)
      if (is_picture(file)) return complain(fmt::format("{}: a picture is of films, and these are integrals", file));
    return merge_saved_integrals(arguments);
  }
  if (films == std::ssize(arguments.files)) return merge_saved_films(arguments);
  const auto film = std::ranges::find_if(arguments.files, is_saved_film);
  const auto other = std::ranges::find_if_not(arguments.files, is_saved_film);
  return complain(fmt::format("{} is a saved film, and {} is not", *film, *other));
}

}  // namespace

void add_merge(CLI::App& app, Action& chosen) {
  auto arguments = std::make_shared<MergeArguments>();
  CLI::App& verb =
      *app.add_subcommand("merge", "Merge saved films of one render, or saved integrals from runs of different seeds");
  verb.footer(examples);
  verb.add_option("FILES", arguments->files, "what montelux render --checkpoint or montelux integrate --save wrote")
      ->required()
      ->type_name("FILE");
  add_option(verb,
             {"-o,--output", "FILE",
              "keep the merged film or integral; of films also a picture (.exr .hdr .pfm .png "
              ".jpg); may be repeated",
              true},
             append_to(arguments->outputs));
  add_output_options(verb, arguments->output);
  verb.callback([arguments, &chosen] { chosen = [arguments] { return run_merge(*arguments); }; });
}

}  // namespace montelux::cli
