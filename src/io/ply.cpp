#include "io/ply.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>

#include "io/mesh_check.h"
#include "io/ply_header.h"
#include "io/text_file.h"

namespace montelux {

namespace {

using namespace ply;

// A number of the given type at `at`, which need not be aligned.
template <bool Swap, class T>
MONTELUX_INLINE T load(const char* at) {
  std::array<char, sizeof(T)> bytes;
  std::memcpy(bytes.data(), at, sizeof(T));
  if constexpr (Swap) std::reverse(bytes.begin(), bytes.end());
  T value;
  std::memcpy(&value, bytes.data(), sizeof(T));
  return value;
}

template <bool Swap>
MONTELUX_INLINE double load_as(Type type, const char* at) {
  switch (type) {
    case Type::int8:
      return static_cast<double>(load<Swap, std::int8_t>(at));
    case Type::uint8:
      return static_cast<double>(load<Swap, std::uint8_t>(at));
    case Type::int16:
      return static_cast<double>(load<Swap, std::int16_t>(at));
    case Type::uint16:
      return static_cast<double>(load<Swap, std::uint16_t>(at));
    case Type::int32:
      return static_cast<double>(load<Swap, std::int32_t>(at));
    case Type::uint32:
      return static_cast<double>(load<Swap, std::uint32_t>(at));
    case Type::float32:
      return static_cast<double>(load<Swap, float>(at));
    case Type::float64:
      return load<Swap, double>(at);
  }
  return 0;
}

// Numbers of a binary body in sequence. After the end of the bytes ok() is false and all numbers are 0.
template <bool Swap>
class BinaryBody {
 public:
  explicit BinaryBody(std::string_view bytes) : at_(bytes.data()), end_(bytes.data() + bytes.size()) {}
  MONTELUX_INLINE double next(Type type) {
    std::size_t size = size_of(type);
    if (std::size_t(end_ - at_) < size) {
      ok_ = false;
      return 0;
    }
    double value = load_as<Swap>(type, at_);
    at_ += size;
    return value;
  }
  bool ok() const { return ok_; }
  static constexpr std::size_t min_size(Type type) { return size_of(type); }
  std::size_t left() const { return std::size_t(end_ - at_); }

 private:
  const char *at_, *end_;
  bool ok_ = true;
};

// The same for text.
class TextBody {
 public:
  explicit TextBody(std::string_view bytes) : at_(bytes.data()), end_(bytes.data() + bytes.size()) {}
  double next(Type) {
    while (at_ != end_ && static_cast<unsigned char>(*at_) <= ' ') ++at_;
    if (at_ != end_ && *at_ == '+') ++at_;
    double value = 0;
    auto result = std::from_chars(at_, end_, value);
    if (result.ec == std::errc::result_out_of_range) value = 0;
    if (result.ec == std::errc::invalid_argument) {
      ok_ = false;
      return 0;
    }
    at_ = result.ptr;
    return value;
  }
  bool ok() const { return ok_; }
  static constexpr std::size_t min_size(Type) { return 1; }
  std::size_t left() const { return std::size_t(end_ - at_); }

 private:
  const char *at_, *end_;
  bool ok_ = true;
};

struct Body {
  Mesh mesh;
  std::size_t polygons = 0;          // of more than four corners
  std::size_t points_and_edges = 0;  // faces of fewer than three corners
  std::string problem;
};

// Reads the elements of a file whose header is known.
template <class Source>
class BodyReader {
 public:
  BodyReader(Source source, const Header& header) : source_(source), header_(header) {}

  Body read() {
    for (const Element& element : header_.elements) {
      if (!fits(element)) break;
      if (element.name == "vertex")
        read_vertices(element);
      else if (element.name == "face")
        read_faces(element);
      else
        skip(element);
      if (!body_.problem.empty()) break;
    }
    return std::move(body_);
  }

 private:
  // A header must not state more than the bytes can contain.
  bool fits(const Element& element) {
    std::size_t element_bytes = 0;
    for (const Property& p : element.properties) element_bytes += Source::min_size(p.is_list ? p.count_type : p.type);
    if (element.count == 0 || (element_bytes > 0 && element.count <= source_.left() / element_bytes)) return true;
    body_.problem = "it states " + std::to_string(element.count) + " of element '" + printable(element.name) +
                    "', more than its bytes can contain";
    return false;
  }

  void cut_short(const Element& element, std::size_t done) {
    body_.problem = "it ends, or has an invalid number, in element '" + printable(element.name) + "' number " +
                    std::to_string(done) + " of " + std::to_string(element.count);
  }

  // The number of entries of a list; no value if the bytes cannot contain that many.
  std::optional<std::size_t> list_size(const Property& p) {
    double count = source_.next(p.count_type);
    if (!source_.ok() || !(count >= 0) || count != std::floor(count)) return std::nullopt;
    if (count > static_cast<double>(source_.left() / Source::min_size(p.type))) return std::nullopt;
    return static_cast<std::size_t>(count);
  }
  bool skip_list(const Property& p) {
    auto count = list_size(p);
    for (std::size_t i = 0; count && i < *count; ++i) source_.next(p.type);
    return count && source_.ok();
  }

  void skip(const Element& element) {
    for (std::size_t i = 0; i < element.count; ++i)
      for (const Property& p : element.properties) {
        if (!p.is_list) source_.next(p.type);
        if (p.is_list ? !skip_list(p) : !source_.ok()) return cut_short(element, i);
      }
  }

  void read_vertices(const Element& element) {
    Mesh& mesh = body_.mesh;
    std::vector<int> slots = vertex_slots(element);
    auto has = [&](int slot) { return std::find(slots.begin(), slots.end(), slot) != slots.end(); };
    if (!has(0) || !has(1) || !has(2)) {
      body_.problem = "its vertices have no x, y or z";
      return;
    }
    bool normals = has(3) && has(4) && has(5), uvs = has(6) && has(7);
    mesh.positions.reserve(element.count);
    if (normals) mesh.normals.reserve(element.count);
    if (uvs) mesh.uvs.reserve(element.count);
    bool finite_normals = true, finite_uvs = true;
    for (std::size_t i = 0; i < element.count; ++i) {
      // Slot 8 is for unused properties.
      std::array<float, 9> v{};
      for (std::size_t k = 0; k < slots.size(); ++k) {
        const Property& p = element.properties[k];
        if (p.is_list) {
          if (!skip_list(p)) return cut_short(element, i);
        } else {
          v[std::size_t(slots[k])] = static_cast<float>(source_.next(p.type));
        }
      }
      if (!source_.ok()) return cut_short(element, i);
      if (!std::isfinite(v[0]) || !std::isfinite(v[1]) || !std::isfinite(v[2])) {
        body_.problem = "the position of vertex " + std::to_string(i) + " is not finite";
        return;
      }
      mesh.positions.push_back({v[0], v[1], v[2]});
      if (normals) mesh.normals.push_back({v[3], v[4], v[5]});
      if (uvs) mesh.uvs.push_back({v[6], v[7]});
      finite_normals &= std::isfinite(v[3]) && std::isfinite(v[4]) && std::isfinite(v[5]);
      finite_uvs &= std::isfinite(v[6]) && std::isfinite(v[7]);
    }
    if (!finite_normals || !finite_uvs)
      body_.problem = std::string("some ") + (finite_normals ? "texture coordinates" : "normals") + " are not finite";
  }

  void read_faces(const Element& element) {
    auto is_indices = [](const Property& p) {
      return p.is_list && (p.name == "vertex_indices" || p.name == "vertex_index");
    };
    const auto& properties = element.properties;
    if (std::none_of(properties.begin(), properties.end(), is_indices)) {
      body_.problem = "its faces lack the list vertex_indices";
      return;
    }
    body_.mesh.triangles.reserve(element.count * 3);
    for (std::size_t i = 0; i < element.count; ++i)
      for (const Property& p : properties) {
        if (is_indices(p)) {
          if (!read_corners(p)) return cut_short(element, i);
          add_face();
        } else {
          if (!p.is_list) source_.next(p.type);
          if (p.is_list ? !skip_list(p) : !source_.ok()) return cut_short(element, i);
        }
      }
  }

  bool read_corners(const Property& p) {
    auto count = list_size(p);
    if (!count) return false;
    corners_.resize(*count);
    constexpr double none = 4294967295.0;
    for (std::uint32_t& corner : corners_) {
      double index = source_.next(p.type);
      // A value that is not an index becomes one that is out of range, and is reported as such.
      corner = static_cast<std::uint32_t>(index >= 0 && index < none ? index : none);
    }
    return source_.ok();
  }

  void add_face() {
    Mesh& mesh = body_.mesh;
    const auto& c = corners_;
    if (c.size() < 3) {
      ++body_.points_and_edges;
    } else if (c.size() == 4) {
      mesh.quads.insert(mesh.quads.end(), {c[0], c[1], c[3], c[2]});
    } else {
      for (std::size_t k = 1; k + 1 < c.size(); ++k)
        mesh.triangles.insert(mesh.triangles.end(), {c[0], c[k], c[k + 1]});
      body_.polygons += c.size() > 4;
    }
  }

  // 0..2 position, 3..5 normal, 6..7 texture coordinates, 8 anything else.
  static std::vector<int> vertex_slots(const Element& element) {
    struct Slot {
      std::string_view name;
      int slot;
    };
    static constexpr std::array<Slot, 14> known{{{"x", 0},
                                                 {"y", 1},
                                                 {"z", 2},
                                                 {"nx", 3},
                                                 {"ny", 4},
                                                 {"nz", 5},
                                                 {"u", 6},
                                                 {"v", 7},
                                                 {"s", 6},
                                                 {"t", 7},
                                                 {"texture_u", 6},
                                                 {"texture_v", 7},
                                                 {"texture_s", 6},
                                                 {"texture_t", 7}}};
    std::vector<int> slots;
    for (const Property& p : element.properties) {
      int slot = 8;
      for (const Slot& k : known)
        if (!p.is_list && k.name == p.name) slot = k.slot;
      bool taken = std::find(slots.begin(), slots.end(), slot) != slots.end();
      slots.push_back(taken ? 8 : slot);
    }
    return slots;
  }

  Source source_;
  const Header& header_;
  Body body_;
  std::vector<std::uint32_t> corners_;
};

Body read_body(std::string_view bytes, const Header& header) {
  if (header.format == Format::text) return BodyReader(TextBody(bytes), header).read();
  if (header.format == Format::little_endian) return BodyReader(BinaryBody<false>(bytes), header).read();
  return BodyReader(BinaryBody<true>(bytes), header).read();
}

// The first index without a vertex.
std::string index_problem(const Mesh& mesh) {
  for (const auto* indices : {&mesh.triangles, &mesh.quads})
    for (std::uint32_t index : *indices)
      if (index >= mesh.positions.size())
        return "a face names vertex " + (index == 4294967295u ? "-1" : std::to_string(index)) + " of " +
               std::to_string(mesh.positions.size());
  return {};
}

}  // namespace

std::optional<Mesh> read_ply(const std::string& path, const SourceLocation& used_at, Diagnostics& diagnostics) {
  auto bytes = read_whole_file(path);
  if (bytes) return read_ply_bytes(*bytes, printable(path), used_at, diagnostics);
  diagnostics.error(used_at, bytes.error());
  return std::nullopt;
}

std::optional<Mesh> read_ply_bytes(std::string_view bytes, const std::string& name, const SourceLocation& used_at,
                                   Diagnostics& diagnostics) {
  bytes = without_byte_order_mark(bytes);
  auto header = read_header(bytes);
  if (!header) {
    diagnostics.error(used_at, "'" + name + "' is not a valid PLY file: " + header.error());
    return std::nullopt;
  }
  Body body = read_body(bytes.substr(header->size), *header);
  if (body.problem.empty()) body.problem = index_problem(body.mesh);
  if (!body.problem.empty()) {
    diagnostics.error(used_at, "'" + name + "' is damaged: " + body.problem);
    return std::nullopt;
  }
  if (body.polygons > 0)
    diagnostics.add({Severity::note,
                     used_at,
                     std::to_string(body.polygons) + " polygons of '" + name + "' were split into triangles",
                     {},
                     {"{n} meshes have polygons, {sum} in all, which were split into triangles", body.polygons}});
  std::size_t dropped = body.points_and_edges + drop_degenerate_faces(body.mesh).total();
  if (dropped > 0) diagnostics.add(dropped_faces_warning(dropped, name, used_at));
  return std::move(body.mesh);
}

}  // namespace montelux
