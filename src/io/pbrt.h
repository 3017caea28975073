// Scenes in the text format of pbrt-v4.
#pragma once
#include <string>
#include <string_view>

#include "io/read_result.h"

namespace montelux {

// Reads a file (.pbrt, also compressed by gzip) with all its includes; reads meshes, but only checks that images exist.
// One run collects all errors, at most 50 per file.
ReadResult read_pbrt(const std::string& path, const ReadOptions& options = {});

// The same for text; file names are relative to `folder`.
ReadResult read_pbrt_text(std::string_view text, const std::string& folder, const ReadOptions& options = {});

}  // namespace montelux
