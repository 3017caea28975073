// What tells whether a scene is the one that it was.
#include <fmt/format.h>

#include <cstring>
#include <deque>
#include <nlohmann/json.hpp>
#include <set>

#include "api/checksum.h"
#include "api/contest.h"
#include "io/text_file.h"

namespace montelux {

namespace {

namespace fs = std::filesystem;

bool names_files(const fs::path& scene) {
  const fs::path unpacked = scene.extension() == ".gz" ? scene.stem() : scene.filename();
  return unpacked.extension() == ".pbrt" || unpacked.extension() == ".gltf" || unpacked.extension() == ".glb";
}

// The strings of a JSON text, without its escapes, however deep they stand.
struct Strings : nlohmann::json::json_sax_t {
  std::string all;
  bool keep(const std::string& text) {
    all += text + "\n";
    return true;
  }
  bool string(string_t& text) override { return keep(text); }
  bool key(string_t& text) override { return keep(text); }
  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(number_integer_t) override { return true; }
  bool number_unsigned(number_unsigned_t) override { return true; }
  bool number_float(number_float_t, const string_t&) override { return true; }
  bool binary(binary_t&) override { return true; }
  bool start_object(std::size_t) override { return true; }
  bool end_object() override { return true; }
  bool start_array(std::size_t) override { return true; }
  bool end_array() override { return true; }
  bool parse_error(std::size_t, const std::string&, const nlohmann::json::exception&) override { return false; }
};

// The text in which a scene's file may name others: of a .glb its JSON, which its first chunk is; of JSON its strings.
std::string naming_text(const fs::path& file, const std::string& content) {
  std::string text = content;
  if (file.extension() == ".glb" && content.size() >= 20) {
    std::uint32_t length = 0;
    std::memcpy(&length, &content[12], 4);
    text = content.substr(20, length);
  }
  Strings strings;
  return nlohmann::json::sax_parse(text, &strings) ? strings.all : text;
}

}  // namespace

std::uint64_t scene_fingerprint(const fs::path& scene, const std::optional<EnvironmentOptions>& environment) {
  std::error_code ignored;
  std::vector<fs::path> around;
  for (const auto& entry : fs::recursive_directory_iterator(fs::absolute(scene, ignored).parent_path(),
                                                            fs::directory_options::skip_permission_denied, ignored)) {
    if (entry.is_regular_file(ignored)) around.push_back(entry.path());
    if (around.size() > 20000) break;
  }
  std::ranges::sort(around);
  // Of the files that are reached, in the order in which they are.
  std::uint64_t all = checksum("");
  std::set<fs::path> reached{fs::absolute(scene, ignored)};
  for (std::deque<fs::path> open{fs::absolute(scene, ignored)}; !open.empty(); open.pop_front()) {
    const auto content = read_whole_file(open.front().string());  // unpacked, if it is packed
    if (!content) continue;
    all = checksum(fmt::format("{} bytes\n", content->size()), checksum(*content, all));
    if (!names_files(open.front())) continue;
    const std::string naming = naming_text(open.front(), *content), plain = without_escapes(naming);
    for (const fs::path& file : around) {
      const std::string name = file.filename().string();
      if (!reached.contains(file) && (naming.find(name) != naming.npos || plain.find(name) != plain.npos))
        reached.insert(file), open.push_back(file);
    }
  }
  if (!environment) return all;
  if (const auto content = read_whole_file(environment->file)) all = checksum(*content, all);
  return all;
}

}  // namespace montelux
