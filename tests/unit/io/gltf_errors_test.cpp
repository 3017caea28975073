// What is wrong with a glTF document is said with its place, and does no harm.
#include <gtest/gtest.h>

#include <random>

#include "gltf_files.h"

namespace montelux {
namespace {

using namespace test;

struct Fault {
  const char* name;
  std::string json;
  const char* pointer;  // that the message begins with
  const char* words;
};

std::string with(const std::string& from, const std::string& to, std::string text = triangle_json()) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

std::vector<Fault> faults() {
  const std::string triangle = R"("attributes": {"POSITION": 0}, "indices": 1)";
  return {
      {"version", with("\"2.0\"", "\"1.0\""), "/asset/version", "only version 2 is supported"},
      {"no version", with(R"("version": "2.0")", ""), "/asset", "\"version\" is missing"},
      {"mesh", with(R"([{"mesh": 0}])", R"([{"mesh": 7}])"), "/nodes/0/mesh", "7 is not the number of a mesh"},
      {"kind", with(R"([{"mesh": 0}])", R"([{"mesh": "a"}])"), "/nodes/0/mesh", "must be a whole number"},
      {"negative", with(R"([{"mesh": 0}])", R"([{"mesh": -1}])"), "/nodes/0/mesh", "not negative"},
      {"fraction", with(R"([{"mesh": 0}])", R"([{"mesh": 0.5}])"), "/nodes/0/mesh", "whole number"},
      {"root", with(R"("nodes": [0])", R"("nodes": [3])"), "/scenes/0/nodes/0", "not the number of a node"},
      {"ring", triangle_json(triangle, R"("mesh": 0}, {"children": [2]}, {"children": [1])"), "/nodes/1/children",
       "its own descendant"},
      {"two parents", triangle_json(triangle, R"("children": [1, 2]}, {"mesh": 0}, {"children": [1])"),
       "/nodes/2/children", "another parent"},
      {"root that is a child",
       with(R"("nodes": [0])", R"("nodes": [1])", triangle_json(triangle, R"("children": [1]}, {"mesh": 0)")),
       "/scenes/0/nodes/0", "not a root"},
      {"matrix", triangle_json(triangle, R"("mesh": 0, "matrix": [1, 2, 3])"), "/nodes/0/matrix", "16 numbers"},
      {"projective", triangle_json(triangle, R"("mesh": 0, "matrix": [1,0,0,1, 0,1,0,0, 0,0,1,0, 0,0,0,1])"),
       "/nodes/0/matrix", "last row"},
      {"zero quaternion", triangle_json(triangle, R"("mesh": 0, "rotation": [0, 0, 0, 0])"), "/nodes/0/rotation",
       "must not be zero"},
      {"huge number", triangle_json(triangle, R"("mesh": 0, "translation": [1e300, 0, 0])"), "/nodes/0/translation/0",
       "too large"},
      {"accessor", triangle_json(R"("attributes": {"POSITION": 9})"), "/meshes/0/primitives/0/attributes/POSITION",
       "9 is not the number of an accessor"},
      {"accessor type", triangle_json(R"("attributes": {"POSITION": 1})"), "/meshes/0/primitives/0/attributes/POSITION",
       "VEC3 is needed"},
      {"no attributes", triangle_json(R"("indices": 1)"), "/meshes/0/primitives/0", "\"attributes\" is missing"},
      {"indices of reals", triangle_json(R"("attributes": {"POSITION": 0}, "indices": 0)"),
       "/meshes/0/primitives/0/indices", "SCALAR is needed"},
      {"count",
       with("\"count\": 3,\n\"type\": \"VEC3\"", "\"count\": 4,\n\"type\": \"VEC3\"",
            with(R"("byteLength": 36)", R"("byteLength": 40)")),
       "/accessors/0", "beyond the end of buffer view 0"},
      {"huge count", with("\"count\": 3,\n\"type\"", "\"count\": 9007199254740991,\n\"type\""), "/accessors/0",
       "beyond the end"},
      {"component", with("5126", "5127"), "/accessors/0/componentType", "not a component type"},
      {"type", with("\"VEC3\"", "\"VECT3\""), "/accessors/0/type", "did you mean \"VEC3\""},
      {"view", with(R"("byteLength": 36)", R"("byteLength": 3600)"), "/bufferViews/0", "beyond the end of buffer 0"},
      {"view offset", with(R"("byteOffset": 36)", R"("byteOffset": 9007199254740991)"), "/bufferViews/1",
       "beyond the end"},
      {"view's buffer", with(R"({"buffer": 0, "byteLength")", R"({"buffer": 1, "byteLength")"), "/bufferViews/0/buffer",
       "not the number of a buffer"},
      {"stride", with(R"("byteLength": 36)", R"("byteLength": 36, "byteStride": 5)"), "/bufferViews/0/byteStride",
       "multiple of 4"},
      {"short stride", with(R"("byteLength": 36)", R"("byteLength": 36, "byteStride": 8)"), "/accessors/0",
       "do not fit"},
      {"buffer length", with(R"({"byteLength": 44)", R"({"byteLength": 4400)"), "/buffers/0", "only 44 bytes"},
      {"base64", with("base64,", "base64,*"), "/buffers/0/uri", "not in base64"},
      {"data", with(";base64", ""), "/buffers/0/uri", "data:...;base64"},
      {"missing file",
       triangle_json(triangle, R"("mesh": 0)", "", R"("buffers": [{"byteLength": 44, "uri": "no.bin"}])"),
       "/buffers/0/uri", "there is no file"},
      {"no data", triangle_json(triangle, R"("mesh": 0)", "", R"("buffers": [{"byteLength": 44}])"), "/buffers/0",
       "no \"uri\""},
      {"far away",
       triangle_json(triangle, R"("mesh": 0)", "",
                     R"("buffers": [{"byteLength": 44, "uri": "http://example.org/a.bin"}])"),
       "/buffers/0/uri", "only local files"},
      {"index",
       triangle_json(triangle, R"("mesh": 0)", "",
                     buffers_of(Bytes().put<float>({0, 0, 0, 2, 0, 0, 0, 3, 0}).put<std::uint16_t>({0, 1, 3}).pad())),
       "/meshes/0/primitives/0/indices", "index 3 is beyond the 3 vertices"},
      {"not finite",
       triangle_json(triangle, R"("mesh": 0)", "",
                     buffers_of(Bytes().put<float>({0, 0, 0, NAN, 0, 0, 0, 3, 0}).put<std::uint16_t>({0, 1, 2}).pad())),
       "/accessors/0", "not finite"},
      {"required extension",
       triangle_json(triangle, R"("mesh": 0)", R"(, "extensionsRequired": ["KHR_materials_spectral"])"),
       "/extensionsRequired/0", "KHR_materials_spectral"},
      {"material", triangle_json(triangle + R"(, "material": 0)"), "/meshes/0/primitives/0/material",
       "the file has none"},
      {"alpha mode",
       triangle_json(triangle + R"(, "material": 0)", R"("mesh": 0)", R"(, "materials": [{"alphaMode": "MASKED"}])"),
       "/materials/0/alphaMode", "did you mean \"MASK\""},
      {"colour",
       triangle_json(triangle + R"(, "material": 0)", R"("mesh": 0)",
                     R"(, "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [1, 2, 0, 1]}}])"),
       "/materials/0/pbrMetallicRoughness/baseColorFactor", "from 0 to 1"},
      {"texture",
       triangle_json(triangle + R"(, "material": 0)", R"("mesh": 0)",
                     R"(, "materials": [{"emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": 0}}])"),
       "/materials/0/emissiveTexture/index", "not the number of a texture"},
      {"image",
       triangle_json(triangle + R"(, "material": 0)", R"("mesh": 0)",
                     R"(, "images": [{"uri": "no.png"}], "textures": [{"source": 0}],
                                 "materials": [{"emissiveTexture": {"index": 0}}])"),
       "/images/0/uri", "there is no file"},
      {"camera", triangle_json(triangle, R"("mesh": 0, "camera": 0)", R"(, "cameras": [{"type": "perspective",
                                "perspective": {"yfov": 4}}])"),
       "/cameras/0/perspective/yfov", "must be from"},
      {"camera type", triangle_json(triangle, R"("mesh": 0, "camera": 0)", R"(, "cameras": [{"type": "perspektive"}])"),
       "/cameras/0/type", "did you mean \"perspective\""},
      {"light", triangle_json(triangle, R"("mesh": 0, "extensions": {"KHR_lights_punctual": {"light": 2}})"),
       "/nodes/0/extensions/KHR_lights_punctual/light", "the file has none"},
      {"keys", triangle_json(triangle, R"("mesh": 0)", R"(, "animations": [{"samplers": [{"input": 1, "output": 0}],
                                "channels": [{"sampler": 0, "target": {"node": 0, "path": "position"}}]}])"),
       "/animations/0/channels/0/target/path", "valid: translation, rotation"},
      {"key times",
       triangle_json(triangle, R"("mesh": 0)", R"(, "animations": [{"samplers": [{"input": 0, "output": 0}],
                                "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}]}])"),
       "/animations/0/samplers/0/input", "SCALAR is needed"},
  };
}

TEST(GltfErrors, name_what_is_wrong_and_where) {
  for (const Fault& fault : faults()) {
    const ReadResult result = read_text(fault.json);
    EXPECT_FALSE(result.scene) << fault.name;
    bool found = false;
    for (const Diagnostic& d : result.diagnostics.all())
      found = found || (d.severity == Severity::error && d.message.starts_with(std::string(fault.pointer) + ":") &&
                        (d.message + " " + d.hint).find(fault.words) != std::string::npos);
    EXPECT_TRUE(found) << fault.name << "\n" << render(result.diagnostics);
  }
}

TEST(GltfErrors, come_all_at_once_with_lines_and_columns) {
  const ReadResult result =
      read_text("{\"asset\": {\"version\": \"2.0\"},\n\"nodes\": [{\"mesh\": 3},\n {\"camera\": true}]}");
  const std::string text = render(result.diagnostics);
  EXPECT_NE(text.find("scene.gltf:2:21: error: /nodes/0/mesh: 3 is not"), std::string::npos) << text;
  EXPECT_NE(text.find("scene.gltf:3:"), std::string::npos) << text;
  EXPECT_EQ(result.diagnostics.errors(), 2) << text;
}

TEST(GltfErrors, of_the_text_itself_have_a_place) {
  const std::string text = render(read_text("{\"asset\":\n {,}}").diagnostics);
  EXPECT_NE(text.find("scene.gltf:2:"), std::string::npos) << text;
  EXPECT_FALSE(read_text("").scene);
  EXPECT_FALSE(read_text("[]").scene);
  EXPECT_FALSE(read_text(std::string(100000, '[')).scene);
  EXPECT_FALSE(read_gltf("/nonexistent/scene.gltf").scene);
}

TEST(GltfErrors, that_lenient_reading_lets_pass_are_warnings) {
  const std::string json = triangle_json(R"("attributes": {"POSITION": 0})", R"("mesh": 0)",
                                         R"(, "extensionsRequired": ["KHR_materials_spectral"])");
  ReadOptions options;
  options.lenient = true;
  const ReadResult result = read_text(json, options);
  EXPECT_TRUE(result.scene) << render(result.diagnostics);
  EXPECT_NE(render(result.diagnostics).find("warning"), std::string::npos);
}

TEST(GltfErrors, of_a_shining_texture_that_is_repeated_are_warnings) {
  const auto warns = [](const std::string& wrap) {
    std::string json =
        triangle_json(R"("attributes": {"POSITION": 0, "TEXCOORD_0": 2}, "indices": 1, "material": 0)", R"("mesh": 0)",
                      R"(, "images": [{"uri": "data:image/png;base64,AAAA"}], "samplers": [{"wrapS": )" + wrap +
                          R"(, "wrapT": )" + wrap + R"(}], "textures": [{"source": 0, "sampler": 0}],
            "materials": [{"emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": 0}}])");
    // Texture coordinates up to 2: the first six numbers of the positions.
    const std::string last = R"("type": "SCALAR"}])";
    json.replace(json.find(last), last.size(), R"("type": "SCALAR"},
        {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC2"}])");
    const ReadResult result = read_text(json);
    EXPECT_TRUE(result.scene) << render(result.diagnostics);
    return render(result.diagnostics).find("are outside [0, 1]") != std::string::npos;
  };
  EXPECT_TRUE(warns("10497"));
  EXPECT_TRUE(warns("33648"));
  EXPECT_FALSE(warns("33071"));
}

TEST(GltfErrors, of_a_binary_file_are_found_before_its_parts_are_read) {
  TemporaryFolder folder;
  const std::string good = binary_file(
      triangle_json(R"("attributes": {"POSITION": 0})", R"("mesh": 0)", "", R"("buffers": [{"byteLength": 44}])"),
      triangle_bytes().text());
  EXPECT_TRUE(read_gltf(folder.write("good.glb", good)).scene);
  const auto text_of = [&](std::string bytes) { return render(read_gltf(folder.write("x.glb", bytes)).diagnostics); };
  EXPECT_NE(text_of(good.substr(0, 15)).find("ends within its header"), std::string::npos);
  EXPECT_NE(text_of(good.substr(0, good.size() - 8)).find("truncated"), std::string::npos);
  std::string other = good;
  other[4] = 1;
  EXPECT_NE(text_of(other).find("version 1"), std::string::npos);
  other = good, other[15] = 0x7f;
  EXPECT_NE(text_of(other).find("reaches beyond its end"), std::string::npos);
  other = good, other[16] = 'X';
  EXPECT_NE(text_of(other).find("first chunk"), std::string::npos);
}

// A document with a bit of everything.
std::string rich_json(const std::string& buffers) {
  return triangle_json(
      R"("attributes": {"POSITION": 0, "NORMAL": 0, "JOINTS_0": 3, "WEIGHTS_0": 4}, "indices": 1, "material": 0,
         "targets": [{"POSITION": 0}])",
      R"("mesh": 0, "skin": 0, "children": [1, 2], "rotation": [0, 0, 0, 1]}, {"camera": 0, "translation": [0, 0, 5]},
         {"mesh": 0, "extensions": {"KHR_lights_punctual": {"light": 0}})",
      R"(, "materials": [{"pbrMetallicRoughness": {"metallicFactor": 0.5}, "emissiveFactor": [1, 1, 1]}],
         "cameras": [{"type": "perspective", "perspective": {"yfov": 1}}], "skins": [{"joints": [1, 2]}],
         "extensions": {"KHR_lights_punctual": {"lights": [{"type": "spot", "spot": {}}]}},
         "animations": [{"samplers": [{"input": 2, "output": 0}], "channels": [{"sampler": 0,
         "target": {"node": 1, "path": "translation"}}]}])",
      R"("ignored": 0, )" + buffers);
}

// Damaged files must be read to their end, and without a crash.
TEST(GltfRobustness, damaged_files_do_no_harm) {
  std::mt19937 random(7);
  TemporaryFolder folder;
  Bytes bytes = triangle_bytes();
  bytes.put<float>({0, 1, 2})
      .put<std::uint8_t>({0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0})
      .put<float>({1, 0, 0, 0, 0.5f, 0.5f, 0, 0, 1, 0, 0, 0});
  std::string json = rich_json(R"("buffers": [{"byteLength": )" + std::to_string(bytes.size()) + "}]");
  json = with(R"("bufferViews": [)", R"("bufferViews": [)", json);
  json = with(R"("byteOffset": 36, "byteLength": 6})",
              R"("byteOffset": 36, "byteLength": 6}, {"buffer": 0, "byteOffset": 44, "byteLength": 12},
                 {"buffer": 0, "byteOffset": 56, "byteLength": 12}, {"buffer": 0, "byteOffset": 68, "byteLength": 48})",
              json);
  json = with(R"("type": "SCALAR"}], )",
              R"("type": "SCALAR"}, {"bufferView": 2, "componentType": 5126, "count": 3, "type": "SCALAR"},
                 {"bufferView": 3, "componentType": 5121, "count": 3, "type": "VEC4"},
                 {"bufferView": 4, "componentType": 5126, "count": 3, "type": "VEC4"}], )",
              json);
  const std::string whole = binary_file(json, bytes.text());
  const ReadResult good = read_gltf(folder.write("good.glb", whole), {});
  ASSERT_TRUE(good.scene) << render(good.diagnostics);
  ReadOptions moving;
  moving.lenient = true;
  moving.window = [](const AnimationTime&) { return AnimationWindow{0, 2, 4, true}; };
  const std::vector<std::string> words{"-1",   "1e999", "9007199254740991", "null", "{}", "[]", "\"\"", "0.5",
                                       "true", "1"};
  int read = 0;
  for (int i = 0; i < 4000; ++i) {
    std::string text = i % 2 == 0 ? whole : json;
    const std::size_t at = random() % text.size();
    switch (random() % 4) {
      case 0:
        text.resize(at);
        break;
      case 1:
        text[at] = char(random() % 256);
        break;
      case 2:
        // Another value in the place of a number.
        for (std::size_t k = at; k < text.size() && k < json.size(); ++k)
          if (text[k] >= '0' && text[k] <= '9') {
            const std::string& word = words[random() % words.size()];
            text.replace(k, 1, word);
            break;
          }
        break;
      default:
        text[at] = char(text[at] ^ (1 << random() % 8));
        text.erase(random() % text.size(), 1 + random() % 3);
    }
    read += read_gltf(folder.write(i % 2 == 0 ? "x.glb" : "x.gltf", text), i % 3 == 0 ? moving : ReadOptions{})
                .scene.has_value();
  }
  EXPECT_GT(read, 0);
}

}  // namespace
}  // namespace montelux
