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

// The text in which a scene's file may name others: of a .glb its JSON, which its first chunk is; of JSON its strings
// without the escapes of JSON.
std::string naming_text(const fs::path& file, const std::string& content) {
  std::string text = content;
  if (file.extension() == ".glb" && content.size() >= 20) {
    std::uint32_t length = 0;
    std::memcpy(&length, &content[12], 4);
    text = content.substr(20, length);
  }
  const auto json = nlohmann::json::parse(text, nullptr, false);
  return json.is_discarded() ? text : json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace

std::uint64_t scene_fingerprint(const fs::path& scene) {
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
  return all;
}

}  // namespace montelux
