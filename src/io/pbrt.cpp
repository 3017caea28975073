#include "io/pbrt.h"

#include <filesystem>

#include "io/pbrt/parser.h"

namespace montelux {

namespace {

// Reads with `parse` and returns a scene only if there was no error.
template <class Parse>
ReadResult read(const std::string& folder, const ReadOptions& options, Parse parse) {
  ReadResult result;
  pbrt::Parser parser(folder, result.diagnostics, options.lenient);
  parse(parser);
  SceneDesc scene = parser.finish();
  result.omissions = parser.omissions();
  if (!result.diagnostics.has_errors()) result.scene = std::move(scene);
  return result;
}

}  // namespace

ReadResult read_pbrt(const std::string& path, const ReadOptions& options) {
  std::string folder = std::filesystem::path(path).parent_path().string();
  return read(folder, options, [&](pbrt::Parser& parser) { parser.parse_file(path); });
}

ReadResult read_pbrt_text(std::string_view text, const std::string& folder, const ReadOptions& options) {
  return read(folder, options, [&](pbrt::Parser& parser) { parser.parse_text(text, "<text>"); });
}

}  // namespace montelux
