// glTF files made by tests: JSON with its buffer in a data URI, or as a binary file.
#pragma once
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "io/gltf.h"
#include "io/report.h"
#include "temporary_folder.h"

namespace montelux::test {

inline std::string base64(const std::string& bytes) {
  constexpr const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k)
      word = word << 8 | (i + k < bytes.size() ? std::uint32_t(static_cast<unsigned char>(bytes[i + k])) : 0u);
    for (std::size_t k = 0; k < 4; ++k) text += i + k <= bytes.size() ? digits[word >> (18 - 6 * k) & 63u] : '=';
  }
  return text;
}

// Bytes of numbers, one behind the other.
class Bytes {
 public:
  template <class T>
  Bytes& put(std::initializer_list<T> values) {
    for (T value : values) {
      char raw[sizeof(T)];
      std::memcpy(raw, &value, sizeof(T));
      text_.append(raw, sizeof(T));
    }
    return *this;
  }
  Bytes& pad() {
    while (text_.size() % 4 != 0) text_ += '\0';
    return *this;
  }
  std::size_t size() const { return text_.size(); }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

// The buffers member of a document with these bytes.
inline std::string buffers_of(const Bytes& bytes) {
  return R"("buffers": [{"byteLength": )" + std::to_string(bytes.size()) +
         R"(, "uri": "data:application/octet-stream;base64,)" + base64(bytes.text()) + "\"}]";
}

inline ReadResult read_text(const std::string& json, const ReadOptions& options = {}) {
  TemporaryFolder folder;
  return read_gltf(folder.write("scene.gltf", json), options);
}

// A binary file of this JSON, whose buffer has no URI.
inline std::string binary_file(std::string json, std::string bytes) {
  const auto word = [](std::size_t n) {
    std::string w;
    for (int k = 0; k < 4; ++k) w += char(n >> (8 * k) & 255u);
    return w;
  };
  while (json.size() % 4 != 0) json += ' ';
  while (bytes.size() % 4 != 0) bytes += '\0';
  return "glTF" + word(2) + word(12 + 8 + json.size() + 8 + bytes.size()) + word(json.size()) + "JSON" + json +
         word(bytes.size()) + std::string("BIN\0", 4) + bytes;
}

// A scene with a triangle: positions (view 0, accessor 0) and 16-bit indices (view 1, accessor 1).
inline Bytes triangle_bytes() {
  return Bytes().put<float>({0, 0, 0, 2, 0, 0, 0, 3, 0}).put<std::uint16_t>({0, 1, 2}).pad();
}
// `more` begins with a comma where it is not empty; it holds further members of the document.
inline std::string triangle_json(const std::string& primitive = R"("attributes": {"POSITION": 0}, "indices": 1)",
                                 const std::string& node = R"("mesh": 0)", const std::string& more = "",
                                 const std::string& buffers = buffers_of(triangle_bytes())) {
  return R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{)" + node +
         R"(}], "meshes": [{"primitives": [{)" + primitive + R"(}]}], "bufferViews": [{"buffer": 0, "byteLength": 36},
{"buffer": 0, "byteOffset": 36, "byteLength": 6}], "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3,
"type": "VEC3"}, {"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"}], )" +
         buffers + more + "}";
}

}  // namespace montelux::test
