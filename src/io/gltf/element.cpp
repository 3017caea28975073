#include "io/gltf/element.h"

#include <cmath>

#include "io/numbers.h"
#include "io/text_file.h"

namespace montelux::gltf {

namespace {

using Kind = JsonValue::Kind;

std::string_view name_of(Kind kind) {
  switch (kind) {
    case Kind::null:
      return "null";
    case Kind::boolean:
      return "true or false";
    case Kind::number:
      return "a number";
    case Kind::text:
      return "a string";
    case Kind::list:
      return "a list";
    case Kind::object:
      break;
  }
  return "an object";
}

// "~" and "/" are escaped in a pointer.
std::string step(std::string_view name) {
  std::string text = "/";
  for (char c : name.substr(0, 60)) {
    if (c == '~')
      text += "~0";
    else if (c == '/')
      text += "~1";
    else
      text += c;
  }
  return without_control(text, '?');
}

}  // namespace

SourceLocation Element::where() const {
  if (!source_->has_lines || !value_) return {source_->file, 0, 0};
  return {source_->file, value_->line, value_->column};
}

std::string Element::once(std::string_view message) const {
  std::string text = (pointer_.empty() ? std::string("the document") : pointer_) + ": " + std::string(message);
  return source_->reported.insert(text).second ? text : std::string();
}

void Element::error(std::string_view message, std::string hint) const {
  if (std::string text = once(message); !text.empty()) source_->report.error(where(), std::move(text), std::move(hint));
}
void Element::warning(std::string_view message, std::string hint) const {
  if (std::string text = once(message); !text.empty())
    source_->report.warning(where(), std::move(text), std::move(hint));
}
void Element::tolerable(std::string_view message, std::string hint) const {
  if (std::string text = once(message); !text.empty())
    source_->report.tolerable(where(), std::move(text), std::move(hint));
}

void Element::report_kind(std::string_view wanted) const {
  error("must be " + std::string(wanted) + ", not " + std::string(name_of(value_->kind)));
}

Element Element::operator[](std::string_view name) const {
  Element absent{nullptr, pointer_ + step(name), *source_};
  if (!value_) return absent;
  if (value_->kind != Kind::object) {
    report_kind("an object");
    return absent;
  }
  absent.value_ = value_->find(name);
  return absent;
}

Element Element::operator[](std::size_t i) const {
  Element absent{nullptr, pointer_ + "/" + std::to_string(i), *source_};
  if (i < size()) absent.value_ = &value_->items[i];
  return absent;
}

Element Element::required(std::string_view name) const {
  Element member = (*this)[name];
  if (value_ && value_->kind == Kind::object && !member) error("\"" + std::string(name) + "\" is missing");
  return member;
}

std::size_t Element::size() const {
  if (!value_) return 0;
  if (value_->kind == Kind::list) return value_->items.size();
  report_kind("a list");
  return 0;
}

std::vector<std::string_view> Element::names() const {
  std::vector<std::string_view> names;
  if (!value_) return names;
  if (value_->kind != Kind::object) report_kind("an object");
  for (const auto& [name, member] : value_->members) names.push_back(name);
  return names;
}

std::optional<double> Element::number() const {
  if (!value_) return std::nullopt;
  if (value_->kind != Kind::number) {
    report_kind("a number");
    return std::nullopt;
  }
  // All numbers become single precision eventually.
  if (!(std::abs(value_->number) <= 3e38)) {
    error("is too large a number");
    return std::nullopt;
  }
  return value_->number;
}

std::optional<double> Element::number(double low, double high) const {
  const std::optional<double> x = number();
  if (!x || (*x >= low && *x <= high)) return x;
  const std::string found = "; found " + shortest(*x);
  if (high >= 1e30)
    error("must be at least " + shortest(low) + found);
  else
    error("must be from " + shortest(low) + " to " + shortest(high) + found);
  return std::nullopt;
}

std::optional<std::uint64_t> Element::whole(std::uint64_t highest) const {
  if (!value_) return std::nullopt;
  if (value_->kind != Kind::number || value_->number != std::floor(value_->number) || !(value_->number >= 0) ||
      !(value_->number <= largest_whole)) {
    error("must be a whole number that is not negative");
    return std::nullopt;
  }
  const auto n = std::uint64_t(value_->number);
  if (n <= highest) return n;
  error("must be at most " + std::to_string(highest) + "; found " + std::to_string(n));
  return std::nullopt;
}

std::optional<bool> Element::boolean() const {
  if (!value_) return std::nullopt;
  if (value_->kind == Kind::boolean) return value_->boolean;
  report_kind("true or false");
  return std::nullopt;
}

std::optional<std::string> Element::text() const {
  if (!value_) return std::nullopt;
  if (value_->kind == Kind::text) return value_->text;
  report_kind("a string");
  return std::nullopt;
}

std::optional<std::vector<double>> Element::numbers(std::size_t count) const {
  if (!value_) return std::nullopt;
  if (value_->kind != Kind::list || value_->items.size() != count) {
    error("must be a list of " + std::to_string(count) + " numbers");
    return std::nullopt;
  }
  std::vector<double> list;
  for (std::size_t i = 0; i < count; ++i) {
    const std::optional<double> x = (*this)[i].number();
    if (!x) return std::nullopt;
    list.push_back(*x);
  }
  return list;
}

std::optional<std::string> Element::choice(const std::vector<std::string_view>& choices) const {
  const std::optional<std::string> found = text();
  if (!found) return std::nullopt;
  std::string valid;
  for (std::string_view choice : choices) {
    if (choice == *found) return found;
    (valid += valid.empty() ? "" : ", ") += choice;
  }
  const std::string_view nearest = nearest_name(*found, choices);
  error("\"" + printable(*found) + "\" is not valid here; valid: " + valid,
        nearest.empty() ? std::string() : "did you mean \"" + std::string(nearest) + "\"?");
  return std::nullopt;
}

std::optional<std::size_t> Element::index_of(const Element& list, std::string_view kind) const {
  const std::optional<std::uint64_t> i = whole();
  if (!i) return std::nullopt;
  const std::size_t count = list.size();
  if (*i < count) return std::size_t(*i);
  error(std::to_string(*i) + " is not the number of " + std::string(kind) + ": the file has " +
        (count == 0 ? std::string("none") : std::to_string(count) + ", counted from 0"));
  return std::nullopt;
}

}  // namespace montelux::gltf
