// What saved work of every kind has in common: JSON that bears the name and the version of its format. Inside the
// facade only. `Json` is the JSON library's value in all of it.
#pragma once
#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "api/checksum.h"
#include "image/output_file.h"
#include "io/json_text.h"
#include "math/result.h"

namespace montelux {

struct SavedFormat {
  std::string_view name;    // as written in the file
  int version;              // that is written
  std::string_view writer;  // the command that writes it
  std::string_view what;    // for messages: "comparison"
  int oldest = version;     // that is read, with all up to that which is written
};

// Whether a file begins as one of this format does. A pipe does not, and is not opened: one that nobody writes to would
// wait.
bool begins_as(const std::filesystem::path& file, const SavedFormat& format);

// Whether work can be saved to a file, for a check before the work. Its name must not be that of a picture or a scene,
// and a file that exists must be of the same format or empty, so that a slip never costs a scene or a picture.
Status check_saved_target(const std::filesystem::path& file, const SavedFormat& format);

// Throws std::invalid_argument on a file of another kind or version.
template <class Json>
void check_format(const Json& json, const SavedFormat& format) {
  const bool named = json.is_object() && json.contains("format") && json.at("format") == format.name;
  if (!named) throw std::invalid_argument("it is not a file that " + std::string(format.writer) + " wrote");
  const Json& version = json.at("version");
  if (version.is_number_integer() && version >= format.oldest && version <= format.version) return;
  const std::string oldest = format.oldest < format.version ? std::to_string(format.oldest) + " to " : "";
  throw std::invalid_argument("its format has version " + version.dump() + ", this program reads version " + oldest +
                              std::to_string(format.version));
}

template <class Json>
std::string checksum_of(const Json& json) {
  return std::to_string(checksum(json.dump()));
}

// Of a value and the bytes that follow it.
template <class Json>
std::string checksum_of(const Json& json, std::string_view bytes) {
  return std::to_string(checksum(bytes, checksum(json.dump())));
}

// Throws std::invalid_argument where anything in the file is not as it was written. Takes the checksum out.
template <class Json>
void check_whole(Json& json) {
  const Json stated = json.value("checksum", Json());
  json.erase("checksum");
  if (stated != checksum_of(json)) throw std::invalid_argument("it is damaged: its checksum is another");
}

// Where a byte of a text is: "line 3, column 7".
inline std::string place_in(std::string_view text, std::size_t byte) {
  text = text.substr(0, byte);
  const std::size_t line = text.rfind('\n');
  return "line " + std::to_string(std::count(text.begin(), text.end(), '\n') + 1) + ", column " +
         std::to_string(text.size() - (line == std::string_view::npos ? 0 : line + 1));
}

// The value that a text holds. Throws std::invalid_argument with the place where it is no JSON.
template <class Json>
Json parse_saved(const std::string& text, const SavedFormat& format) {
  try {
    return Json::parse(text);
  } catch (const typename Json::parse_error& error) {
    throw std::invalid_argument("it is not a file that " + std::string(format.writer) +
                                " wrote, or it is damaged: it is no JSON from " + place_in(text, error.byte) + " on");
  }
}

// What a reader missed in a file that is JSON, in our own words.
template <class Json>
std::string missing_entry(const typename Json::exception& error) {
  // "[json.exception.out_of_range.403] key 'seed' not found"
  const std::string_view text = error.what();
  const std::size_t begin = text.find('\''), end = text.rfind('\'');
  if (dynamic_cast<const typename Json::out_of_range*>(&error) && begin < end && end != std::string_view::npos)
    return "its entry \"" + std::string(text.substr(begin + 1, end - begin - 1)) + "\" is missing";
  return "an entry of it is missing or of another type";
}

// A whole number in these bounds. Throws std::invalid_argument where a file has something else in its place: a
// library's conversion of 1e300 to an integer is undefined.
template <class T, class Json>
T whole_from(const Json& value, T low, T high) {
  const bool good = value.is_number_unsigned()
                        ? std::in_range<T>(value.template get<std::uint64_t>())
                        : value.is_number_integer() && std::in_range<T>(value.template get<std::int64_t>());
  if (!good || value.template get<T>() < low || value.template get<T>() > high)
    throw std::invalid_argument("it has " + value.dump() + " instead of a whole number from " + std::to_string(low) +
                                " to " + std::to_string(high));
  return value.template get<T>();
}

// read(text) of a file of the format; what is wrong with it becomes a failure that names the file.
template <class Json, class Read>
auto read_saved(const std::filesystem::path& file, const SavedFormat& format, Read read)
    -> Result<decltype(read(std::string()))> {
  const std::string what = "the saved " + std::string(format.what) + " '" + file.string() + "' cannot be read: ";
  const auto text = read_whole_file(file.string());
  if (!text) return Failure{"the saved " + std::string(format.what) + " cannot be read: " + text.error()};
  try {
    return read(*text);
  } catch (const typename Json::exception& error) {
    return Failure{what + "it is damaged: " + missing_entry<Json>(error)};
  } catch (const std::bad_alloc&) {
    return Failure{what + "it does not fit in memory"};
  } catch (const std::invalid_argument& error) {
    return Failure{what + error.what()};
  } catch (const std::exception&) {
    return Failure{what + "it is damaged"};
  }
}

// Of a file that is JSON: read(json).
template <class Json, class Read>
auto load_saved(const std::filesystem::path& file, const SavedFormat& format, Read read)
    -> Result<decltype(read(Json()))> {
  return read_saved<Json>(file, format, [&](const std::string& text) {
    Json json = parse_saved<Json>(text, format);
    check_format(json, format);
    check_whole(json);
    return read(json);
  });
}

// Of a file whose first line is JSON, and bytes follow: read(json, bytes).
template <class Json, class Read>
auto load_saved_bytes(const std::filesystem::path& file, const SavedFormat& format, Read read)
    -> Result<decltype(read(Json(), std::string_view()))> {
  return read_saved<Json>(file, format, [&](const std::string& text) {
    const std::size_t line = std::min(text.find('\n'), text.size());
    Json json = parse_saved<Json>(text.substr(0, line), format);
    check_format(json, format);
    const std::string_view bytes = std::string_view(text).substr(std::min(line + 1, text.size()));
    const auto stated = whole_from<std::uint64_t>(json.at("bytes"), 0, std::uint64_t(1) << 62);
    if (bytes.size() < stated)
      throw std::invalid_argument("it is truncated: it has " + std::to_string(bytes.size()) + " bytes of " +
                                  std::to_string(stated));
    const Json sum = json.value("checksum", Json());
    json.erase("checksum");
    if (bytes.size() != stated || sum != checksum_of(json, bytes))
      throw std::invalid_argument("it is damaged: its checksum is another");
    return read(json, bytes);
  });
}

// Whole or not at all, with a checksum.
template <class Json>
Status save_json(const std::filesystem::path& file, Json json) {
  make_utf8(json);
  json["checksum"] = checksum_of(json);
  return write_file(file, json.dump(1) + '\n');
}

// The same of JSON in one line and bytes behind it.
template <class Json>
Status save_bytes(const std::filesystem::path& file, Json json, std::string_view bytes) {
  make_utf8(json);
  json["bytes"] = bytes.size();
  json["checksum"] = checksum_of(json, bytes);
  return write_file(file, json.dump() + '\n', bytes);
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
