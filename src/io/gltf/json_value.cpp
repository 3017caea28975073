#include "io/gltf/json_value.h"

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <optional>

namespace montelux::gltf {

namespace {

using Json = nlohmann::json;

// A position in the text that advances as the parser reads.
struct Place {
  std::size_t read = 0;
  int line = 1, column = 0;
};

// Iterates over the characters of a text and records the position in `place`.
class CountingIterator {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  CountingIterator(const char* at, Place* place) : at_(at), place_(place) {}
  reference operator*() const { return *at_; }
  CountingIterator& operator++() {
    ++place_->read, ++place_->column;
    if (*at_ == '\n') ++place_->line, place_->column = 0;
    ++at_;
    return *this;
  }
  CountingIterator operator++(int) {
    CountingIterator before = *this;
    ++*this;
    return before;
  }
  bool operator==(const CountingIterator& other) const { return at_ == other.at_; }
  bool operator!=(const CountingIterator& other) const { return at_ != other.at_; }

 private:
  const char* at_;
  Place* place_;
};

// Builds the tree from the parser's events.
class TreeBuilder {
 public:
  explicit TreeBuilder(const Place& place) : place_(place) {}

  bool null() { return put({}); }
  bool boolean(bool value) {
    JsonValue v = of(JsonValue::Kind::boolean);
    v.boolean = value;
    return put(std::move(v));
  }
  bool number_integer(Json::number_integer_t value) { return put_number(double(value)); }
  bool number_unsigned(Json::number_unsigned_t value) { return put_number(double(value)); }
  bool number_float(Json::number_float_t value, const std::string&) { return put_number(value); }
  bool string(std::string& value) {
    JsonValue v = of(JsonValue::Kind::text);
    v.text = std::move(value);
    return put(std::move(v));
  }
  bool binary(Json::binary_t&) { return false; }
  bool start_object(std::size_t) { return open(JsonValue::Kind::object); }
  bool start_array(std::size_t) { return open(JsonValue::Kind::list); }
  bool key(std::string& name) {
    open_.back()->members.push_back({std::move(name), {}});
    return true;
  }
  bool end_object() { return close(); }
  bool end_array() { return close(); }
  bool parse_error(std::size_t, const std::string&, const Json::exception& error) {
    // "[json.exception.parse_error.101] parse error at line 1, column 2: what is wrong"
    std::string message = error.what();
    if (const std::size_t colon = message.find(": "); colon != std::string::npos) message.erase(0, colon + 2);
    problem_ = JsonProblem{std::move(message), place_.line, std::max(place_.column, 1)};
    return false;
  }

  JsonValue root;
  std::optional<JsonProblem> problem_;

 private:
  static constexpr std::size_t deepest = 200;

  JsonValue of(JsonValue::Kind kind) const {
    JsonValue v;
    v.kind = kind, v.line = place_.line, v.column = std::max(place_.column, 1);
    return v;
  }
  bool put_number(double value) {
    JsonValue v = of(JsonValue::Kind::number);
    v.number = value;
    return put(std::move(v));
  }
  // The slot of the next value.
  JsonValue& slot() {
    if (open_.empty()) return root;
    JsonValue& parent = *open_.back();
    if (parent.kind == JsonValue::Kind::object) return parent.members.back().value;
    return parent.items.emplace_back();
  }
  bool put(JsonValue value) {
    slot() = std::move(value);
    return true;
  }
  bool open(JsonValue::Kind kind) {
    if (open_.size() == deepest) {
      problem_ = JsonProblem{"values are nested more than 200 deep", place_.line, std::max(place_.column, 1)};
      return false;
    }
    JsonValue& value = slot();
    value = of(kind);
    // The value does not move while it is open: only the innermost list grows.
    open_.push_back(&value);
    return true;
  }
  bool close() {
    open_.pop_back();
    return true;
  }

  const Place& place_;
  std::vector<JsonValue*> open_;
};

}  // namespace

const JsonValue* JsonValue::find(std::string_view name) const {
  for (const auto& [key, value] : members)
    if (key == name) return &value;
  return nullptr;
}

std::variant<JsonValue, JsonProblem> parse_json(std::string_view text) {
  Place place;
  TreeBuilder tree(place);
  const bool good = Json::sax_parse(CountingIterator(text.data(), &place),
                                    CountingIterator(text.data() + text.size(), &place), &tree);
  if (tree.problem_) return *std::move(tree.problem_);
  if (!good) return JsonProblem{"this is not JSON", place.line, std::max(place.column, 1)};
  return std::move(tree.root);
}

}  // namespace montelux::gltf
