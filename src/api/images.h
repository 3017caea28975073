// Reading pictures back: showing them on a display, and telling how two of them differ.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "image/display.h"
#include "image/image_file.h"
#include "image/output_file.h"
#include "math/result.h"

namespace montelux {

// Tone curves by name, with a line for each; and the curve of a name.
std::vector<std::pair<std::string, std::string>> tone_curves();
std::optional<ToneCurve> tone_curve_named(std::string_view name);

// Colour maps by name, with a line for each.
std::vector<std::pair<std::string, std::string>> color_maps();

// Why a picture could not be written to this file: an unknown extension, or what check_output_file() finds. To be
// called before a render, so that the work is not lost.
Status check_picture_file(const std::filesystem::path& file);

// The ending of a file's name with its dot, in lower case: what tells its format.
std::string extension_of(const std::filesystem::path& file);

// It is a format of 8 bits for display: .png, .jpg.
bool is_display_file(const std::filesystem::path& file);

// Writes a linear picture by the extension of the file, 8-bit formats through the display transform. One step.
Status write_picture(const std::filesystem::path& file, const PixelBuffer& picture, const DisplayTransform& display);

// One layer of a picture, and what tells how it is shown.
struct PictureLayer {
  PixelBuffer pixels;
  Content content = Content::light;
  bool has_own_exposure = false;  // the scene states one, or the file is one for display
};

// Reads one layer of a picture: the colours for the empty name, else the channels "name.X", or the channel "name"
// alone. A failure names the layers that there are.
Result<PictureLayer> read_layer(const std::filesystem::path& file, const std::string& name);

}  // namespace montelux
