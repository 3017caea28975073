// Reading pictures back: showing them on a display, and telling how two of them differ.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "image/display.h"
#include "image/flip.h"
#include "image/image_file.h"
#include "image/metrics.h"
#include "image/welch.h"
#include "math/result.h"

namespace montelux {

// Tone curves by name, with a line for each; and the curve of a name.
std::vector<std::pair<std::string, std::string>> tone_curves();
std::optional<ToneCurve> tone_curve_named(std::string_view name);

// Why a picture could not be written to this file: an unknown extension, a folder that is not there or may not be
// written to. Asked before a render, so that the work is not lost.
Status check_picture_file(const std::filesystem::path& file);

// Writes a linear picture by the extension of the file, 8-bit formats through the display transform. One step.
Status write_picture(const std::filesystem::path& file, const PixelBuffer& picture, const DisplayTransform& display);

}  // namespace montelux
