// Whether a scene is unchanged.
#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <set>

#include "api/checksum.h"
#include "api/comparison.h"
#include "io/scene_file.h"
#include "io/text_file.h"

namespace montelux {

namespace fs = std::filesystem;

std::uint64_t scene_fingerprint(const fs::path& scene, const std::optional<EnvironmentOptions>& environment,
                                const std::vector<std::string>& written) {
  std::error_code ignored;
  std::vector<fs::path> around;
  for (const auto& entry : fs::recursive_directory_iterator(fs::absolute(scene, ignored).parent_path(),
                                                            fs::directory_options::skip_permission_denied, ignored)) {
    const bool is_written = std::ranges::find(written, entry.path().filename().string()) != written.end();
    if (!is_written && entry.is_regular_file(ignored)) around.push_back(entry.path());
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
    const SceneFormat* format = scene_format_of(open.front().string());
    if (!format) continue;
    const std::string naming = format->naming_text(*content), plain = without_escapes(naming);
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
