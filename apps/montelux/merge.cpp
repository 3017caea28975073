// montelux merge: several saved films become one, and several saved integrals.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
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

  montelux render room.pbrt --spp 4096 --passes 0:3 --checkpoint a.film
  montelux render room.pbrt --spp 4096 --passes 4:7 --checkpoint b.film
  montelux merge a.film b.film -o room.film -o room.exr

Integrals are merged from runs of different seeds; films from different passes of one render, and the merged film is the
same bits as if that render had been one.
)";

// Whether the file is a film's by its name. Any other is more likely a slip than a film with an odd name.
Status check_film_name(const std::string& file, const std::vector<std::string>& films) {
  const std::string extension = extension_of(file);
  const auto has_extension = [&](const std::string& film) { return extension_of(film) == extension; };
  if (extension.empty() || extension == ".film" || std::ranges::any_of(films, has_extension)) return Done{};
  return Failure{
      fmt::format("cannot write '{}': -o takes a film (.film) or a picture (.exr .hdr .pfm .png .jpg)", file)};
}

Status check_output(const std::string& file, const MergeArguments& arguments, bool are_films) {
  if (!are_films) return check_integral_file(file);
  if (is_picture_name(file)) return check_picture_file(file);
  if (Status good = check_film_name(file, arguments.files); !good) return good;
  return check_film_file(file);
}

// Files that cannot be what is merged.
std::vector<std::string> unusable(const std::vector<std::string>& files) {
  std::vector<std::string> mistakes;
  std::error_code ignored;
  for (const std::string& file : files)
    if (!std::filesystem::exists(file, ignored))
      mistakes.push_back(fmt::format("there is no file {}", file));
    else if (is_picture_name(file))
      mistakes.push_back(fmt::format("{} is a picture; saved films and saved integrals can be merged", file));
  return mistakes;
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
    if (is_picture_name(file)) {
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
  const auto film = std::ranges::find_if(arguments.files, is_saved_film);
  const auto integral = std::ranges::find_if(arguments.files, is_saved_integral);
  const auto none = arguments.files.end();
  std::vector<std::string> mistakes = unusable(arguments.files);
  if (film != none && integral != none)
    mistakes.push_back(
        fmt::format("{} is a saved film, and {} is a saved integral: they cannot be merged", *film, *integral));
  for (const std::string& file : arguments.outputs)
    if (Status good = check_output(file, arguments, film != none); !good) mistakes.push_back(good.error());
  if (!mistakes.empty()) return complain_of_all(mistakes);
  return film != none ? merge_saved_films(arguments) : merge_saved_integrals(arguments);
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
              "write the merged film or integral, or an image of the merged film (.exr .hdr .pfm .png .jpg); may be "
              "repeated",
              true},
             append_to(arguments->outputs));
  add_output_options(verb, arguments->output);
  verb.callback([arguments, &chosen] { chosen = [arguments] { return run_merge(*arguments); }; });
}

}  // namespace montelux::cli
