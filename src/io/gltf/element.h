// Values of a glTF document, read with checks: what is wrong is reported with its position and treated as absent.
#pragma once
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "io/gltf/json_value.h"
#include "io/reporter.h"

namespace montelux::gltf {

// Where messages go, and the names in them.
struct Source {
  Reporter& report;
  std::shared_ptr<const std::string> file;
  bool has_lines = true;                // false: the JSON is part of a binary file
  std::set<std::string> reported = {};  // messages so far, so that nothing is reported twice
};

// The largest integer that JSON represents exactly.
inline constexpr double largest_whole = 9007199254740991.0;

// A value, or its absence, with its JSON pointer (RFC 6901).
class Element {
 public:
  Element(const JsonValue* value, std::string pointer, Source& source)
      : value_(value), pointer_(std::move(pointer)), source_(&source) {}

  explicit operator bool() const { return value_ != nullptr; }
  bool is_object() const { return value_ && value_->kind == JsonValue::Kind::object; }
  bool is_text() const { return value_ && value_->kind == JsonValue::Kind::text; }
  const std::string& pointer() const { return pointer_; }
  SourceLocation where() const;

  // Each message begins with the pointer.
  void error(std::string_view message, std::string hint = {}) const;
  void warning(std::string_view message, std::string hint = {}) const;
  void tolerable(std::string_view message, std::string hint = {}) const;

  // A member of an object, an item of a list; absent if there is none. A value of another kind is reported.
  Element operator[](std::string_view name) const;
  Element operator[](const char* name) const { return (*this)[std::string_view(name)]; }
  Element operator[](std::size_t i) const;
  // The same; its absence is an error.
  Element required(std::string_view name) const;
  // The size of a list; 0 if absent.
  std::size_t size() const;
  // Names of an object's members.
  std::vector<std::string_view> names() const;

  // The value, if it exists and is valid.
  std::optional<double> number() const;
  std::optional<double> number(double low, double high) const;
  std::optional<std::uint64_t> whole(std::uint64_t highest = std::uint64_t(largest_whole)) const;
  std::optional<bool> boolean() const;
  std::optional<std::string> text() const;
  // A list of exactly that many numbers.
  std::optional<std::vector<double>> numbers(std::size_t count) const;
  // One of the choices; any other text is reported with the closest one.
  std::optional<std::string> choice(const std::vector<std::string_view>& choices) const;
  // The index of an item of `list`, which has list.size() items; `kind` names one ("a mesh").
  std::optional<std::size_t> index_of(const Element& list, std::string_view kind) const;

 private:
  void report_kind(std::string_view wanted) const;
  // The message with the pointer; empty if it has been reported before.
  std::string once(std::string_view message) const;

  const JsonValue* value_;
  std::string pointer_;
  Source* source_;
};

}  // namespace montelux::gltf
