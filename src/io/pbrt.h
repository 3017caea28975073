// Scenes in the text format of pbrt-v4.
#pragma once
#include <string>
#include <string_view>

#include "io/read_result.h"

namespace montelux {

// Reads a file (.pbrt, also compressed by gzip) with all that it includes; meshes are read, images only looked for.
// All errors are collected in one run, at most 50 a file.
ReadResult read_pbrt(const std::string& path, const ReadOptions& options = {});

// The same for text; names of files start at `folder`.
ReadResult read_pbrt_text(std::string_view text, const std::string& folder, const ReadOptions& options = {});

}  // namespace montelux
