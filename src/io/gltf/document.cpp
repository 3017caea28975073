#include "io/gltf/document.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>

#include "io/text_file.h"

namespace montelux::gltf {

namespace {

std::uint32_t word_at(const std::string& bytes, std::size_t i) {
  const auto byte = [&](std::size_t k) { return std::uint32_t(static_cast<unsigned char>(bytes[i + k])); };
  return byte(0) | byte(1) << 8 | byte(2) << 16 | byte(3) << 24;
}

// Decodes RFC 4648; nothing if there is an invalid character.
std::optional<std::string> from_base64(std::string_view text) {
  while (!text.empty() && text.back() == '=') text.remove_suffix(1);
  if (text.size() % 4 == 1) return std::nullopt;
  std::string bytes;
  bytes.reserve(text.size() * 3 / 4);
  std::uint32_t bits = 0;
  int count = 0;
  for (char c : text) {
    std::uint32_t value = 0;
    if (c >= 'A' && c <= 'Z')
      value = std::uint32_t(c - 'A');
    else if (c >= 'a' && c <= 'z')
      value = std::uint32_t(c - 'a') + 26;
    else if (c >= '0' && c <= '9')
      value = std::uint32_t(c - '0') + 52;
    else if (c == '+' || c == '-')
      value = 62;
    else if (c == '/' || c == '_')
      value = 63;
    else
      return std::nullopt;
    bits = (bits << 6 | value) & 0xffffffu;
    count += 6;
    if (count >= 8) {
      count -= 8;
      bytes += char(bits >> count & 0xffu);
    }
  }
  return bytes;
}

// Extensions that the reader supports, partly or completely.
constexpr std::array<std::string_view, 11> known_extensions{
    "KHR_lights_punctual",  "KHR_materials_anisotropy", "KHR_materials_clearcoat",    "KHR_materials_emissive_strength",
    "KHR_materials_ior",    "KHR_materials_specular",   "KHR_materials_transmission", "KHR_materials_unlit",
    "KHR_materials_volume", "KHR_mesh_quantization",    "KHR_texture_transform"};

}  // namespace

Document::Document(std::string path, Reporter& report)
    : path_(std::move(path)),
      folder_(std::filesystem::path(path_).parent_path().string()),
      source_{report, std::make_shared<const std::string>(path_)} {}

bool Document::read() {
  const Result<std::string> bytes = read_whole_file(path_);
  if (!bytes) {
    report().error(whole(), bytes.error());
    return false;
  }
  std::string_view text = *bytes;
  if (bytes->starts_with("glTF")) {
    source_.has_lines = false;
    if (!read_binary(*bytes, text)) return false;
  } else {
    text = without_byte_order_mark(text);
  }
  std::variant<JsonValue, JsonProblem> parsed = parse_json(text);
  if (const auto* problem = std::get_if<JsonProblem>(&parsed)) {
    SourceLocation where = whole();
    if (source_.has_lines) where.line = problem->line, where.column = problem->column;
    report().error(where, printable(problem->message));
    return false;
  }
  json_ = std::get<JsonValue>(std::move(parsed));
  if (json_.kind == JsonValue::Kind::object) return true;
  report().error(whole(), "a glTF document is a JSON object");
  return false;
}

// Header and chunks (glTF 2.0, 4.4).
bool Document::read_binary(const std::string& bytes, std::string_view& text) {
  constexpr std::uint32_t json_chunk = 0x4e4f534a, binary_chunk = 0x004e4942;
  const auto fail = [&](std::string message) {
    report().error(whole(), std::move(message));
    return false;
  };
  if (bytes.size() < 20) return fail("the file ends within its header: it is not binary glTF");
  if (const std::uint32_t version = word_at(bytes, 4); version != 2)
    return fail("binary glTF of version " + std::to_string(version) + "; only version 2 is supported");
  const std::size_t length = word_at(bytes, 8);
  if (length > bytes.size())
    return fail("the file is truncated: " + std::to_string(bytes.size()) + " bytes of " + std::to_string(length));
  bool has_json = false;
  for (std::size_t at = 12; at + 8 <= length;) {
    const std::size_t size = word_at(bytes, at);
    const std::uint32_t kind = word_at(bytes, at + 4);
    if (size > length - at - 8) return fail("a chunk of the file reaches beyond its end");
    if (!has_json && kind != json_chunk) return fail("the first chunk of the file is not JSON");
    if (!has_json) {
      text = std::string_view(bytes).substr(at + 8, size);
      has_json = true;
    } else if (kind == binary_chunk && !chunk_) {
      chunk_ = bytes.substr(at + 8, size);
    }
    at += 8 + size;
    // Chunks begin at multiples of four.
    at = (at + 3) / 4 * 4;
  }
  return has_json || fail("the file has no JSON chunk");
}

void Document::check_asset() const {
  const Element asset = root().required("asset");
  if (const auto version = asset.required("version").text(); version && !version->starts_with("2."))
    asset["version"].error("glTF of version " + printable(*version) + "; only version 2 is supported");
  const std::vector<std::string_view> known(known_extensions.begin(), known_extensions.end());
  const auto is_known = [&](const std::string& name) {
    return std::find(known.begin(), known.end(), name) != known.end();
  };
  std::set<std::string> required;
  const Element needed = list("extensionsRequired");
  for (std::size_t i = 0; i < needed.size(); ++i) {
    const auto name = needed[i].text();
    if (!name) continue;
    required.insert(*name);
    if (is_known(*name)) continue;
    const std::string_view nearest = nearest_name(*name, known);
    needed[i].tolerable(
        "the file requires the extension \"" + printable(*name) + "\", which is not supported",
        nearest.empty() ? std::string() : "the closest supported one: \"" + std::string(nearest) + "\"");
  }
  const Element used = list("extensionsUsed");
  for (std::size_t i = 0; i < used.size(); ++i)
    if (const auto name = used[i].text(); name && !is_known(*name) && !required.count(*name))
      used[i].warning("the extension \"" + printable(*name) + "\" is not supported: the scene is shown without it");
}

std::optional<Document::Link> Document::link(const Element& uri) const {
  const auto text = uri.text();
  if (!text) return std::nullopt;
  if (text->starts_with("data:")) {
    const std::size_t comma = text->find(',');
    const std::string_view head = std::string_view(*text).substr(0, comma);
    if (comma == std::string::npos || !head.ends_with(";base64")) {
      uri.error("a data URI must have the form data:...;base64,...");
      return std::nullopt;
    }
    if (auto bytes = from_base64(std::string_view(*text).substr(comma + 1))) return Link{{}, std::move(bytes)};
    uri.error("is not in base64");
    return std::nullopt;
  }
  if (text->find("://") != std::string::npos) {
    uri.error("only local files are read, not \"" + printable(*text) + "\"");
    return std::nullopt;
  }
  const std::string file = without_escapes(*text);
  if (!file.empty() && file.find('\0') == std::string::npos) return Link{file, std::nullopt};
  uri.error("names no file");
  return std::nullopt;
}

std::optional<std::string> Document::load_buffer(const Element& buffer, std::size_t number) const {
  const auto length = buffer.required("byteLength").whole();
  if (!length) return std::nullopt;
  std::string bytes;
  if (const Element uri = buffer["uri"]) {
    std::optional<Link> found = link(uri);
    if (!found) return std::nullopt;
    if (found->data) {
      bytes = *std::move(found->data);
    } else {
      Result<std::string> file = read_whole_file(resolve_path(folder_, found->file));
      if (!file) {
        uri.error(file.error());
        return std::nullopt;
      }
      bytes = *std::move(file);
    }
  } else if (number == 0 && chunk_) {
    bytes = *chunk_;
  } else {
    buffer.error("the buffer has no \"uri\", and the file has no binary part for it");
    return std::nullopt;
  }
  if (bytes.size() < *length) {
    buffer.error("has a byteLength of " + std::to_string(*length) + ", but only " + std::to_string(bytes.size()) +
                 " bytes exist");
    return std::nullopt;
  }
  return bytes;
}

std::optional<Bytes> Document::buffer(std::size_t number) {
  auto [place, is_new] = buffers_.try_emplace(number);
  if (is_new) place->second = load_buffer(list("buffers")[number], number);
  if (!place->second) return std::nullopt;
  return Bytes(reinterpret_cast<const std::uint8_t*>(place->second->data()), place->second->size());
}

std::optional<BufferView> Document::view(std::size_t number) {
  const Element element = list("bufferViews")[number];
  const auto index = element.required("buffer").index_of(list("buffers"), "a buffer");
  const auto length = element.required("byteLength").whole();
  const std::uint64_t offset = element["byteOffset"].whole().value_or(0);
  const Element stride = element["byteStride"];
  const auto step = stride.whole(252);
  if (step && (*step < 4 || *step % 4 != 0)) stride.error("must be a multiple of 4 from 4 to 252");
  if (!index || !length || (stride && (!step || *step < 4 || *step % 4 != 0))) return std::nullopt;
  const std::optional<Bytes> bytes = buffer(*index);
  if (!bytes) return std::nullopt;
  if (offset > bytes->size() || *length > bytes->size() - offset) {
    element.error("bytes " + std::to_string(offset) + " to " + std::to_string(offset + *length) +
                  " are beyond the end of buffer " + std::to_string(*index) + ", which has " +
                  std::to_string(bytes->size()));
    return std::nullopt;
  }
  return BufferView{bytes->subspan(offset, *length), std::size_t(step.value_or(0))};
}

}  // namespace montelux::gltf
