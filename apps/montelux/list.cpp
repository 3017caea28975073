// montelux list: everything that Montelux knows by name.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "api/catalogue.h"
#include "api/json_text.h"
#include "options.h"
#include "status.h"
#include "verbs.h"

namespace montelux::cli {

namespace {

using Json = nlohmann::ordered_json;

struct ListArguments {
  std::string topic, name;
  bool json = false, quiet = false;
};

void print_lines(const std::vector<std::pair<std::string, std::string>>& lines) {
  std::size_t width = 0;
  for (const auto& [name, meaning] : lines) width = std::max(width, name.size());
  for (const auto& [name, meaning] : lines) fmt::print("{:{}}  {}\n", name, width, meaning);
}

// Appends the state of unsupported entries to their meaning.
std::string with_state(const CatalogueEntry& entry) {
  if (!entry.instead.empty() && entry.instead != entry.name)
    return fmt::format("{} (replaced by {})", entry.meaning, entry.instead);
  return entry.later ? entry.meaning + " (not yet)" : entry.meaning;
}

void print_entry(const CatalogueEntry& entry) {
  fmt::print("{}: {}\n", entry.name, with_state(entry));
  std::vector<std::pair<std::string, std::string>> lines;
  for (const CatalogueParameter& p : entry.parameters)
    lines.emplace_back(fmt::format("  {} {}", p.types, p.name), p.meaning + (p.later ? " (not yet)" : ""));
  print_lines(lines);
}

Json to_json(const CatalogueEntry& entry) {
  Json json{{"name", entry.name}, {"meaning", entry.meaning}, {"later", entry.later}};
  json["instead"] = entry.instead.empty() || entry.instead == entry.name ? Json() : Json(entry.instead);
  json["parameters"] = Json::array();
  for (const CatalogueParameter& p : entry.parameters)
    json["parameters"].push_back({{"name", p.name}, {"types", p.types}, {"meaning", p.meaning}, {"later", p.later}});
  return json;
}

// The entries of a topic, or the one with that name.
Json list_json(const std::vector<CatalogueEntry>& entries, const std::string& name) {
  Json list = Json::array();
  for (const CatalogueEntry& entry : entries) {
    if (entry.name == name) return to_json(entry);
    list.push_back(to_json(entry));
  }
  return list;
}

Json topics_json() {
  Json list = Json::array();
  for (const auto& [name, meaning] : catalogue_topics()) list.push_back({{"name", name}, {"meaning", meaning}});
  return list;
}

int run_list(const ListArguments& arguments) {
  if (arguments.topic.empty()) {
    if (arguments.json)
      fmt::print("{}\n", json_text(topics_json(), 2));
    else
      print_lines(catalogue_topics());
    return done;
  }
  const std::vector<CatalogueEntry> entries = catalogue(arguments.topic).value();
  std::vector<std::pair<std::string, std::string>> lines;
  for (const CatalogueEntry& entry : entries) lines.emplace_back(entry.name, with_state(entry));
  if (!arguments.name.empty())
    if (Result<std::string> name = parse_choice(arguments.name, names_of(lines)); !name)
      return complain(fmt::format("list {}: {}", arguments.topic, name.error()));
  if (arguments.json) {
    fmt::print("{}\n", json_text(list_json(entries, arguments.name), 2));
    return done;
  }
  if (arguments.name.empty()) {
    print_lines(lines);
    return done;
  }
  print_entry(*std::find_if(entries.begin(), entries.end(), [&](auto& e) { return e.name == arguments.name; }));
  return done;
}

}  // namespace

void add_list(CLI::App& app, Action& chosen) {
  auto arguments = std::make_shared<ListArguments>();
  CLI::App& verb = *app.add_subcommand("list", "List what Montelux knows by name: materials, lights, samplers, ...");
  verb.footer("Examples:\n  montelux list\n  montelux list materials\n  montelux list materials conductor\n");
  const std::vector<std::string> topics = names_of(catalogue_topics());
  add_option(verb, {"TOPIC", alternatives(topics), "what to list; default: these topics"},
             into(arguments->topic, [topics](const std::string& text) { return parse_choice(text, topics); }));
  verb.add_option("NAME", arguments->name, "one entry of the topic, with its parameters")->type_name("NAME");
  verb.add_flag("--json", arguments->json, "as JSON");
  verb.add_flag("--quiet", arguments->quiet, "no notes or warnings (there are none: results and errors stay)");
  verb.callback([arguments, &chosen] { chosen = [arguments] { return run_list(*arguments); }; });
}

}  // namespace montelux::cli
