// Scenes in glTF 2.0, as text with separate files (.gltf) or in one file (.glb).
#pragma once
#include <string>

#include "io/read_result.h"

namespace montelux {

// Reads a file with the buffers that it names; for images it only checks that they exist. The world is glTF's own:
// right-handed, y up, metres; the camera mirrors it into the image. Photometric units are used unchanged: a candela is
// an intensity of 1, a lux an irradiance of 1, a nit a radiance of 1. One run collects all errors, at most 50, each
// with the JSON pointer of what is wrong (and line and column in a .gltf).
ReadResult read_gltf(const std::string& path, const ReadOptions& options = {});

// All strings of the JSON of a file with this content, without escapes, a line each: among them are the names of other
// files. Content that is no JSON is returned as it is.
std::string gltf_strings(const std::string& content);

}  // namespace montelux
