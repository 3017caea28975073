// The program: reads the command line and runs its verb.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <sstream>
#include <system_error>

#include "api/render.h"
#include "signals.h"
#include "status.h"
#include "verbs.h"

namespace montelux::cli {

namespace {

constexpr const char* description = "Monte Carlo renderer and integrator that states how wrong its answer may be.";

constexpr const char* notes = R"(Examples:
  montelux render scene.pbrt -o room.exr --spp 256
  montelux denoise room.exr -o clean.exr
  montelux tonemap room.exr -o room.png
  montelux integrate '4*x^3' --over x=0:1
  montelux diff a.exr b.exr
  montelux render --help

Exit status: 0 done; 1 diff found a difference, with --strict an integral has warnings, the reference of compare is not
good enough, or a verdict of lab fails; 2 options, scene, images or integral are invalid;
3 a file or the results cannot be written, or an unexpected failure; 129, 130, 141 and 143 ended by
SIGHUP, SIGINT, SIGPIPE or SIGTERM, finished work is written.
)";

std::vector<std::string_view> verb_names(const CLI::App& app) {
  std::vector<std::string_view> names;
  for (const CLI::App* verb : app.get_subcommands({})) names.push_back(verb->get_name());
  return names;
}

// All names of a verb's options, as they are typed.
std::vector<std::string> option_names(const CLI::App& verb) {
  std::vector<std::string> names;
  for (const CLI::Option* option : verb.get_options()) {
    for (const std::string& name : option->get_snames()) names.push_back(fmt::format("-{}", name));
    for (const std::string& name : option->get_lnames()) names.push_back(fmt::format("--{}", name));
  }
  return names;
}

std::string did_you_mean(std::string_view name, const std::vector<std::string_view>& candidates) {
  std::string_view near = nearest_name(name, candidates);
  return near.empty() ? "" : fmt::format(" (did you mean \"{}\"?)", near);
}

// What is wrong with the command line, in one sentence. An unknown argument is reported before what is
// missing because of it.
std::string explain(const CLI::App& app, const CLI::ParseError& error) {
  const std::vector<CLI::App*> chosen = const_cast<CLI::App&>(app).get_subcommands();
  if (chosen.empty()) {
    const std::vector<std::string> extra = app.remaining();
    const std::vector<std::string_view> verbs = verb_names(app);
    if (extra.empty()) return fmt::format("a verb is missing; valid: {}", fmt::join(verbs, ", "));
    const bool option = extra.front().starts_with('-');
    return fmt::format("unknown {} \"{}\"; verbs: {}{}", option ? "option" : "verb", extra.front(),
                       fmt::join(verbs, ", "), did_you_mean(extra.front(), verbs));
  }
  const CLI::App& verb = *chosen.front();
  const std::vector<std::string> extra = verb.remaining();
  const std::string help = fmt::format("; see montelux {} --help", verb.get_name());
  for (const std::string& argument : extra)
    if (argument.starts_with('-') && argument != "--") {
      const std::vector<std::string> names = option_names(verb);
      return fmt::format("unknown option \"{}\" of {}; valid: {}{}", argument, verb.get_name(), fmt::join(names, ", "),
                         did_you_mean(argument.substr(0, argument.find('=')), {names.begin(), names.end()})) +
             (verb.get_name() == "integrate" ? "; write an expression that begins with - after --" : "");
    }
  if (dynamic_cast<const CLI::ExtrasError*>(&error) && !extra.empty())
    return fmt::format("unexpected argument \"{}\"{}", extra.front(), help);
  if (dynamic_cast<const CLI::ValidationError*>(&error)) return error.what();
  return error.what() + help;
}

int run(int argc, char** argv) {
  CLI::App app(description, "montelux");
  app.set_version_flag("--version", "montelux " + version(), "print the version");
  app.set_help_flag("-h,--help", "print this help");
  app.get_formatter()->column_width(32);
  app.get_formatter()->label("SUBCOMMAND", "VERB");
  app.footer(notes);
  app.require_subcommand(1);
  Action chosen;
  for (auto add : {add_render, add_integrate, add_merge, add_info, add_trace, add_diff, add_compare, add_denoise,
                   add_tonemap, add_list, add_lab, add_completion})
    add(app, chosen);
  for (CLI::App* verb : app.get_subcommands({})) verb->group("Verbs");
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& success) {
    // Help or version of something that does not exist.
    if (app.get_subcommands().empty() && !app.remaining().empty()) return complain(explain(app, success));
    std::ostringstream text, none;
    const int status = app.exit(success, text, none);
    fmt::print("{}", text.str());
    return status;
  } catch (const CLI::ParseError& error) {
    return complain(explain(app, error));
  }
  return chosen();
}

}  // namespace

}  // namespace montelux::cli

int main(int argc, char** argv) {
  using namespace montelux::cli;
  prepare_process();
  try {
    const int status = run(argc, argv);
    flush_results();
    return status;
  } catch (const std::system_error& e) {
    if (std::ferror(stdout)) return results_lost(e.code());
    complain(e.what());
  } catch (const std::bad_alloc&) {
    complain("there is not enough memory");
  } catch (const std::exception& e) {
    complain(e.what());
  }
  return failed;
}
