#include "image/image_codec.h"

#include <dlfcn.h>

#include <array>
#include <filesystem>

namespace montelux {

namespace {

constexpr const char* module_file = "montelux_codec.so";

// Next to the program in a build folder; in an installation; on the program's search path for libraries (the empty
// name), which the package of the installed library extends; where it was built.
std::array<std::filesystem::path, 4> module_folders() {
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error).parent_path();
  return {program, program / ".." / "lib" / "montelux", "", MONTELUX_CODEC_FOLDER};
}

Result<const ImageCodec*> load() {
  std::string missing("the module of image formats is missing; looked for");
  for (const std::filesystem::path& folder : module_folders()) {
    const std::filesystem::path file = folder / module_file;
    std::error_code error;
    const bool is_searched = folder.empty();
    if (!is_searched && !std::filesystem::exists(file, error)) {
      missing.append(" '").append(file.string()).append("'");
      continue;
    }
    void* module = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!module && is_searched) continue;
    if (!module) return Failure{std::string("the module of image formats cannot be loaded: ").append(dlerror())};
    if (const void* codec = dlsym(module, "montelux_image_codec")) return static_cast<const ImageCodec*>(codec);
    return Failure{std::string("this is not the module of image formats: ").append(file.string())};
  }
  return Failure{missing};
}

}  // namespace

Result<const ImageCodec*> image_codec() {
  static const Result<const ImageCodec*> codec = load();
  return codec;
}

}  // namespace montelux
