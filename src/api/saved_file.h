// What saved work of every kind has in common: JSON that bears the name and the version of its format. Inside the
// facade only. `Json` is the JSON library's value in all of it.
#pragma once
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>

#include "api/checksum.h"
#include "image/replace_file.h"
#include "math/result.h"

namespace montelux {

struct SavedFormat {
  std::string_view name;    // as it stands in the file
  int version;              // that is written, and the only one that is read
  std::string_view writer;  // the command that writes it
  std::string_view what;    // for messages: "comparison"
};

// Nothing where the file cannot be read.
inline std::optional<std::string> content_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  if (!in || !(text << in.rdbuf())) return std::nullopt;
  return text.str();
}

// Throws std::invalid_argument on a file of another kind or version.
template <class Json>
void check_format(const Json& json, const SavedFormat& format) {
  const bool named = json.is_object() && json.contains("format") && json.at("format") == format.name;
  if (!named) throw std::invalid_argument("it is not a file that " + std::string(format.writer) + " wrote");
  if (json.at("version") != format.version)
    throw std::invalid_argument("its format has version " + json.at("version").dump() +
                                ", this program reads version " + std::to_string(format.version));
}

template <class Json>
std::string checksum_of(const Json& json) {
  return std::to_string(checksum(json.dump()));
}

// Throws std::invalid_argument where anything in the file is not as it was written. Takes the checksum out.
template <class Json>
void check_whole(Json& json) {
  const Json stated = json.value("checksum", Json());
  json.erase("checksum");
  if (stated != checksum_of(json)) throw std::invalid_argument("it is damaged: its checksum is another");
}

// read(json) of a file of the format; what it throws becomes a failure that names the file.
template <class Json, class Read>
auto load_saved(const std::filesystem::path& file, const SavedFormat& format, Read read)
    -> Result<decltype(read(Json()))> {
  const auto text = content_of(file);
  if (!text) return Failure{file.string() + ": cannot be read"};
  try {
    Json json = Json::parse(*text, nullptr, false);  // without exceptions: what is no JSON is no object either
    check_format(json, format);
    check_whole(json);
    return read(json);
  } catch (const std::invalid_argument& error) {
    return Failure{file.string() + ": " + error.what()};
  } catch (const std::exception& error) {
    return Failure{file.string() + ": is no saved " + std::string(format.what) + " (" + error.what() + ")"};
  }
}

// Whole or not at all, with a checksum.
template <class Json>
Status save_json(const std::filesystem::path& file, Json json) {
  json["checksum"] = checksum_of(json);
  return replace_file(file, [&json](const std::string& temporary) -> Status {
    std::ofstream out(temporary);
    out << json.dump(1) << '\n';
    out.close();
    if (!out) return Failure{"it cannot be written"};
    return Done{};
  });
}

// Absence is null in the file.
template <class Json, class T>
Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json();
}
template <class T, class Json>
std::optional<T> optional_at(const Json& json, const char* key) {
  const Json& value = json.at(key);
  return value.is_null() ? std::nullopt : std::optional<T>(value.template get<T>());
}

}  // namespace montelux
