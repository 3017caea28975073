// Images to be filtered: of films, and of files.
#pragma once
#include <string>
#include <vector>

#include "denoise/denoise.h"
#include "image/pixel_buffer.h"
#include "math/result.h"

namespace montelux {

class Film;

// Rows of a film with halves. `layers`: the names of all of its layers of light; empty: without them.
NoisyImage noisy_image(const Film& film, const std::vector<std::string>& layers, const RowRange& rows);
// Whether any pixel has passes in both halves.
bool has_both_halves(const Film& film);

// The layers of light of an image that has both halves of them.
std::vector<std::string> layers_with_halves(const PixelBuffer& image);
// Of an image with the layers of both halves. `layers`: the names of those of light that are read. Fails, with the name
// of the first channel that is missing.
Result<NoisyImage> noisy_image(const PixelBuffer& image, const std::vector<std::string>& layers);
bool has_both_halves(const PixelBuffer& image);

}  // namespace montelux
