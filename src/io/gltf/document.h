// A glTF file in memory: its JSON, and the bytes that it refers to.
#pragma once
#include <map>
#include <memory>
#include <span>

#include "io/gltf/element.h"
#include "scene/description.h"

namespace montelux::gltf {

using Bytes = std::span<const std::uint8_t>;

// A part of a buffer. A stride of 0 means that elements are packed.
struct BufferView {
  Bytes bytes;
  std::size_t stride = 0;
};

class Document {
 public:
  Document(std::string path, Reporter& report);

  // Reads the file and the JSON in it. False if there is no valid document, which has been reported.
  bool read();
  // Checks what must hold before anything else: the version, and the extensions.
  void check_asset() const;

  Element root() const { return {&json_, "", source_}; }
  // A list of the document, for example "meshes".
  Element list(std::string_view name) const { return root()[name]; }
  const std::string& folder() const { return folder_; }
  SourceLocation whole() const { return {source_.file, 0, 0}; }
  Reporter& report() const { return source_.report; }

  // The bytes of a buffer, or nothing if they cannot be read, which is reported once.
  std::optional<Bytes> buffer(std::size_t number);
  // Within its buffer's bounds.
  std::optional<BufferView> view(std::size_t number);
  // The file that an element's "uri" names, without escapes; a "data:" URI is decoded instead.
  struct Link {
    std::string file;                 // relative to the folder; or
    std::optional<std::string> data;  // the bytes themselves
  };
  std::optional<Link> link(const Element& uri) const;

 private:
  bool read_binary(const std::string& bytes, std::string_view& text);
  std::optional<std::string> load_buffer(const Element& buffer, std::size_t number) const;

  std::string path_, folder_;
  JsonValue json_;
  mutable Source source_;
  std::optional<std::string> chunk_;  // the binary part of a .glb
  std::map<std::size_t, std::optional<std::string>> buffers_;
};

}  // namespace montelux::gltf
