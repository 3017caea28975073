// Meshes in Stanford's PLY format: text, binary of either byte order, also compressed by gzip.
#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "geometry/mesh.h"
#include "parameter/diagnostic.h"

namespace montelux {

// The mesh of a file. Vertices: x y z, with nx ny nz and one of (u v, s t, texture_u texture_v, texture_s texture_t)
// if given. Faces: vertex_indices or vertex_index; three make a triangle, four a bilinear patch, more a fan (with a
// note). Other elements and properties are skipped. Faces without area are dropped with a warning. No value if
// the file is missing or damaged, with an error at `used_at`, the position that names the file.
std::optional<Mesh> read_ply(const std::string& path, const SourceLocation& used_at, Diagnostics& diagnostics);

// The same for bytes in memory (not compressed); messages use `name` for the file.
std::optional<Mesh> read_ply_bytes(std::string_view bytes, const std::string& name, const SourceLocation& used_at,
                                   Diagnostics& diagnostics);

}  // namespace montelux
