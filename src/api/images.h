// Reading images: for display, and for differences between two of them.
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

// The names of tone curves with one-line descriptions; and the curve with a given name.
std::vector<std::pair<std::string, std::string>> tone_curves();
std::optional<ToneCurve> tone_curve_named(std::string_view name);

// The names of colour maps with one-line descriptions.
std::vector<std::pair<std::string, std::string>> color_maps();

// Why an image could not be written to this file: an unknown extension, or the result of check_output_file(). To be
// called before a render, so that the work is not lost.
Status check_picture_file(const std::filesystem::path& file);

// The extension of a file name with its dot, in lower case; it selects the format.
std::string extension_of(const std::filesystem::path& file);

// Whether the extension is that of a picture that can be written.
bool is_picture_name(const std::filesystem::path& file);

// Whether it is an 8-bit format for display: .png, .jpg.
bool is_display_file(const std::filesystem::path& file);

// Writes a linear image in the format of the extension, 8-bit formats through the display transform. Atomic.
Status write_picture(const std::filesystem::path& file, const PixelBuffer& picture, const DisplayTransform& display);

// One layer of an image, and what determines how it is shown.
struct PictureLayer {
  PixelBuffer pixels;
  Content content = Content::light;
  bool has_own_exposure = false;  // the scene states one, or the file is one for display
};

// Reads one layer of an image: the colours for the empty name, else the channels "name.X", or only the channel
// "name". A failure lists the existing layers.
Result<PictureLayer> read_layer(const std::filesystem::path& file, const std::string& name);

}  // namespace montelux
