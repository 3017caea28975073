// The strings of a document, without knowing what they are for.
#include <cstring>
#include <nlohmann/json.hpp>

#include "io/gltf.h"

namespace montelux {

namespace {

// Collects the strings of a JSON text, at any depth.
struct Strings : nlohmann::json::json_sax_t {
  std::string all;
  bool keep(const std::string& text) {
    all += text + "\n";
    return true;
  }
  bool string(string_t& text) override { return keep(text); }
  bool key(string_t& text) override { return keep(text); }
  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(number_integer_t) override { return true; }
  bool number_unsigned(number_unsigned_t) override { return true; }
  bool number_float(number_float_t, const string_t&) override { return true; }
  bool binary(binary_t&) override { return true; }
  bool start_object(std::size_t) override { return true; }
  bool end_object() override { return true; }
  bool start_array(std::size_t) override { return true; }
  bool end_array() override { return true; }
  bool parse_error(std::size_t, const std::string&, const nlohmann::json::exception&) override { return false; }
};

}  // namespace

std::string gltf_strings(const std::string& content) {
  // The JSON of a .glb is its first chunk.
  std::string text = content;
  if (content.starts_with("glTF") && content.size() >= 20) {
    std::uint32_t length = 0;
    std::memcpy(&length, &content[12], 4);
    text = content.substr(20, length);
  }
  Strings strings;
  return nlohmann::json::sax_parse(text, &strings) ? strings.all : content;
}

}  // namespace montelux
