// What saved work states of its scene: file, options of its reading, fingerprint. Inside the facade only. `Json` is the
// JSON library's value in all of it.
#pragma once
#include <charconv>
#include <limits>

#include "api/comparison.h"
#include "api/saved_file.h"
#include "lab/report/base64.h"

namespace montelux {

// A side of a picture, in pixels.
template <class Json>
int side_from(const Json& json) {
  return whole_from(json, 0, 1 << 16);
}

struct SavedScene {
  std::filesystem::path file;
  LoadOptions load;
  std::uint64_t fingerprint = 0;
};

inline std::string fingerprint_text(std::uint64_t fingerprint) {
  std::string text(16, '0');
  for (std::size_t i = 16; fingerprint != 0; fingerprint >>= 4) text[--i] = "0123456789abcdef"[fingerprint & 15];
  return text;
}
inline std::uint64_t fingerprint_from(const std::string& hexadecimal) {
  std::uint64_t value = 0;
  const char* const end = hexadecimal.data() + hexadecimal.size();
  if (std::from_chars(hexadecimal.data(), end, value, 16).ptr != end)
    throw std::invalid_argument("the fingerprint of its scene is damaged");
  return value;
}

// Adds its entries to the JSON of saved work.
template <class Json>
void add_scene(Json& json, const SavedScene& scene) {
  json["scene"] = scene.file.string();
  // The name of a file may be any bytes, and this one is to be found again.
  if (!is_utf8(scene.file.string())) json["scene_bytes"] = lab::base64(scene.file.string());
  json["scene_fingerprint"] = fingerprint_text(scene.fingerprint);
  const LoadOptions& load = scene.load;
  json["lenient"] = load.lenient;
  json["resolution"] = load.resolution ? Json{load.resolution->first, load.resolution->second} : Json();
  json["camera"] = or_null<Json>(load.camera);
  json["animation"] = or_null<Json>(load.animation);
  json["shutter"] = load.shutter ? Json{load.shutter->open, load.shutter->close} : Json();
  if (const auto& e = load.environment)
    json["environment"] = {
        {"file", std::filesystem::absolute(e->file).string()}, {"rotation", e->rotation}, {"scale", e->scale}};
}

template <class Json>
SavedScene scene_from(const Json& j) {
  SavedScene scene;
  scene.file = j.at("scene").template get<std::string>();
  if (j.contains("scene_bytes")) {
    const auto bytes = lab::bytes_of_base64(j.at("scene_bytes").template get_ref<const std::string&>());
    if (!bytes) throw std::invalid_argument("the name of its scene is damaged");
    scene.file = *bytes;
  }
  LoadOptions& load = scene.load;
  load.lenient = j.at("lenient");
  if (const Json& size = j.at("resolution"); !size.is_null())
    load.resolution = {{side_from(size.at(0)), side_from(size.at(1))}};
  load.camera = optional_at<std::string>(j, "camera");
  load.animation = optional_at<std::string>(j, "animation");
  if (const Json& times = j.at("shutter"); !times.is_null()) load.shutter = {times.at(0), times.at(1)};
  if (const auto e = j.find("environment"); e != j.end())
    load.environment = EnvironmentOptions{e->at("file"), e->at("rotation"), e->at("scale")};
  scene.fingerprint = fingerprint_from(j.at("scene_fingerprint").template get_ref<const std::string&>());
  return scene;
}

}  // namespace montelux
