// montelux completion: shell scripts, generated from the description of the command line.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "options.h"
#include "status.h"
#include "verbs.h"

namespace montelux::cli {

namespace {

// The value of an option, or a positional argument.
struct Value {
  std::vector<std::string> choices;
  bool file = false;
};

struct OptionWords {
  std::vector<std::string> names;  // "-o", "--output"
  std::string help;
  std::optional<Value> value;  // none: a flag
  bool repeatable = false;
};

struct VerbWords {
  std::string name, help;
  std::vector<OptionWords> options;
  std::vector<Value> places;
};

Value value_of(const std::string& type) {
  Value value{{}, type == "FILE"};
  if (type.find('|') == std::string::npos) return value;
  for (std::size_t begin = 0; begin <= type.size();) {
    const std::size_t end = std::min(type.find('|', begin), type.size());
    const std::string word = type.substr(begin, end - begin);
    // NAME and N stand for values that cannot be listed here.
    if (std::ranges::any_of(word, [](char c) { return c < 'A' || c > 'Z'; })) value.choices.push_back(word);
    begin = end + 1;
  }
  return value;
}

VerbWords words_of(const CLI::App& verb) {
  VerbWords words{verb.get_name(), verb.get_description(), {}, {}};
  for (const CLI::Option* option : verb.get_options()) {
    if (option->get_positional()) {
      words.places.push_back(value_of(option->get_type_name()));
      continue;
    }
    OptionWords o{{}, option->get_description(), std::nullopt, option->get_items_expected_max() > 1};
    for (const std::string& name : option->get_snames()) o.names.push_back(fmt::format("-{}", name));
    for (const std::string& name : option->get_lnames()) o.names.push_back(fmt::format("--{}", name));
    if (option->get_items_expected_max() > 0) o.value = value_of(option->get_type_name());
    words.options.push_back(std::move(o));
  }
  return words;
}

std::vector<std::string> all_names(const VerbWords& verb) {
  std::vector<std::string> names;
  for (const OptionWords& option : verb.options) names.insert(names.end(), option.names.begin(), option.names.end());
  return names;
}

// The choices of an argument in shell syntax; none for arbitrary text.
std::string bash_reply(const Value& value) {
  if (value.file) return "_montelux_files";
  return fmt::format("_montelux_words \"{}\"", fmt::join(value.choices, " "));
}

std::string bash_script(const std::vector<VerbWords>& verbs) {
  std::string names, values, places;
  for (const VerbWords& verb : verbs) {
    names += fmt::format("{}{}", names.empty() ? "" : " ", verb.name);
    for (const OptionWords& option : verb.options)
      for (const std::string& name : option.names)
        if (option.value)
          values += fmt::format("    '{} {}') {}; return ;;\n", verb.name, name, bash_reply(*option.value));
    places += fmt::format("    {})\n      if [[ $current == -* ]]; then _montelux_words \"{}\"; return; fi\n",
                          verb.name, fmt::join(all_names(verb), " "));
    // A positional argument with choices comes before one with arbitrary text; files are valid everywhere.
    const bool any_file = std::any_of(verb.places.begin(), verb.places.end(), [](const Value& v) { return v.file; });
    if (any_file)
      places += "      _montelux_files ;;\n";
    else if (!verb.places.empty())
      places += fmt::format("      if [[ $previous == $verb ]]; then {}; fi ;;\n", bash_reply(verb.places.front()));
    else
      places += "      ;;\n";
  }
  return fmt::format(R"script(# Completion of montelux for bash: eval "$(montelux completion bash)"
_montelux_words() {{ mapfile -t COMPREPLY < <(compgen -W "$1" -- "${{COMP_WORDS[COMP_CWORD]}}"); }}
_montelux_files() {{
  compopt -o filenames 2>/dev/null
  mapfile -t COMPREPLY < <(compgen -f -- "${{COMP_WORDS[COMP_CWORD]}}")
}}
_montelux() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} previous=${{COMP_WORDS[COMP_CWORD-1]}} verb=${{COMP_WORDS[1]}}
  COMPREPLY=()
  if ((COMP_CWORD == 1)); then _montelux_words "{} --help --version"; return; fi
  case "$verb $previous" in
{}  esac
  case $verb in
{}  esac
}}
complete -F _montelux montelux
)script",
                     names, values, places);
}

// Text between single quotes, with the special characters of zsh's _arguments escaped.
std::string zsh_text(const std::string& text) {
  std::string out;
  for (char c : text) {
    if (c == '\'') {
      out += "'\\''";
      continue;
    }
    if (c == '[' || c == ']' || c == ':' || c == '\\') out += '\\';
    out += c;
  }
  return out;
}

std::string zsh_value(const Value& value) {
  if (value.file) return "file:_files";
  return value.choices.empty() ? "value: " : fmt::format("value:({})", fmt::join(value.choices, " "));
}

std::string zsh_script(const std::vector<VerbWords>& verbs) {
  std::string list, cases;
  for (const VerbWords& verb : verbs) {
    list += fmt::format("    '{}:{}'\n", verb.name, zsh_text(verb.help));
    cases += fmt::format("    {})\n      _arguments", verb.name);
    for (const OptionWords& option : verb.options)
      for (const std::string& name : option.names) {
        const std::string others = option.repeatable ? "*" : fmt::format("({})", fmt::join(option.names, " "));
        cases += fmt::format(" \\\n        '{}{}[{}]{}'", others, name, zsh_text(option.help),
                             option.value ? fmt::format(":{}", zsh_value(*option.value)) : "");
      }
    for (std::size_t i = 0; i < verb.places.size(); ++i)
      cases += fmt::format(" \\\n        '{}:{}'", i + 1, zsh_value(verb.places[i]));
    cases += " ;;\n";
  }
  return fmt::format(R"script(#compdef montelux
# Completion of montelux for zsh: eval "$(montelux completion zsh)", or as the file _montelux in a folder of $fpath.
_montelux() {{
  local -a verbs=(
{}  )
  local curcontext=$curcontext state line
  _arguments -C '(- *)--help[print help]' '(- *)--version[print the version]' '1: :->verb' '*:: :->arguments'
  if [[ $state == verb ]]; then _describe verb verbs; return; fi
  case $words[1] in
{}  esac
}}
if [[ $funcstack[1] == _montelux ]]; then _montelux "$@"; else compdef _montelux montelux; fi
)script",
                     list, cases);
}

std::string fish_text(const std::string& text) {
  std::string out;
  for (char c : text) {
    if (c == '\'' || c == '\\') out += '\\';
    out += c;
  }
  return out;
}

std::string fish_script(const std::vector<VerbWords>& verbs) {
  std::string out =
      "# Completion of montelux for fish: montelux completion fish | source\n"
      "complete -c montelux -f\n"
      "complete -c montelux -n __fish_use_subcommand -l help -d 'print help'\n"
      "complete -c montelux -n __fish_use_subcommand -l version -d 'print the version'\n";
  for (const VerbWords& verb : verbs) {
    const std::string seen = fmt::format("complete -c montelux -n '__fish_seen_subcommand_from {}'", verb.name);
    out +=
        fmt::format("complete -c montelux -n __fish_use_subcommand -a {} -d '{}'\n", verb.name, fish_text(verb.help));
    for (const OptionWords& option : verb.options) {
      out += seen;
      for (const std::string& name : option.names)
        out += name.starts_with("--") ? fmt::format(" -l {}", name.substr(2)) : fmt::format(" -s {}", name.substr(1));
      if (option.value && option.value->file) out += " -r -F";
      if (option.value && !option.value->file)
        out += option.value->choices.empty() ? std::string(" -x")
                                             : fmt::format(" -x -a '{}'", fmt::join(option.value->choices, " "));
      out += fmt::format(" -d '{}'\n", fish_text(option.help));
    }
    for (const Value& place : verb.places) {
      if (place.file) out += seen + " -F\n";
      if (!place.choices.empty()) out += fmt::format("{} -a '{}'\n", seen, fmt::join(place.choices, " "));
    }
  }
  return out;
}

int run_completion(const CLI::App& app, const std::string& shell) {
  std::vector<VerbWords> verbs;
  for (const CLI::App* verb : app.get_subcommands({})) verbs.push_back(words_of(*verb));
  if (shell == "bash") fmt::print("{}", bash_script(verbs));
  if (shell == "zsh") fmt::print("{}", zsh_script(verbs));
  if (shell == "fish") fmt::print("{}", fish_script(verbs));
  return done;
}

}  // namespace

void add_completion(CLI::App& app, Action& chosen) {
  auto shell = std::make_shared<std::string>();
  CLI::App& verb = *app.add_subcommand("completion", "Print a script that completes montelux in a shell");
  verb.footer(
      "Examples:\n  eval \"$(montelux completion bash)\"\n  eval \"$(montelux completion zsh)\"\n"
      "  montelux completion fish | source\n");
  const std::vector<std::string> shells{"bash", "zsh", "fish"};
  add_option(verb, {"SHELL", alternatives(shells), "the shell"},
             into(*shell, [shells](const std::string& text) { return parse_choice(text, shells); }));
  verb.get_option("SHELL")->required();
  verb.callback([shell, &app, &chosen] { chosen = [shell, &app] { return run_completion(app, *shell); }; });
}

}  // namespace montelux::cli
