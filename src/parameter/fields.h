// Settings of a struct, each stated once: name, type, range and meaning of the parameter, and where its value is
// stored. The default is the value that the struct has; help, documentation and reader follow from the row.
#pragma once
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "math/result.h"
#include "parameter/spec.h"

namespace montelux {

// Values as a person types them: "on", "0.001".
std::string setting_text(bool value);
std::string setting_text(int value);
std::string setting_text(float value);

// The row with its default at the end of the meaning.
ParameterSpec with_default(ParameterSpec row, const std::string& value);

// A name for each value of an enumeration.
template <class E>
using NamedValues = std::vector<std::pair<std::string_view, E>>;

// The rows of a struct S. Where a value is stored is a pointer to a member, or a function from S& to a reference.
template <class S>
class Fields {
 public:
  template <class T>
  using Place = std::function<T&(S&)>;

  Fields& integer(std::string_view name, Place<int> place, std::string meaning, double low, double high) {
    return value<int>({name, {ParameterType::integer}, std::move(meaning), low, high}, place, &ParameterList::integer);
  }
  Fields& number(std::string_view name, Place<float> place, std::string meaning, double low, double high) {
    return value<float>({name, {ParameterType::number}, std::move(meaning), low, high}, place, &ParameterList::number);
  }
  Fields& boolean(std::string_view name, Place<bool> place, std::string meaning) {
    return value<bool>({name, {ParameterType::boolean}, std::move(meaning)}, place, &ParameterList::boolean);
  }
  // One of the names.
  template <class E>
  Fields& choice(std::string_view name, Place<E> place, std::string meaning, NamedValues<E> names) {
    ParameterSpec row{name, {ParameterType::string}, std::move(meaning), 0, 0};
    for (const auto& [word, value] : names) row.choices.push_back(word);
    const auto shown = [place, names](const S& s) {
      S copy = s;
      for (const auto& [word, value] : names)
        if (value == place(copy)) return std::string(word);
      return std::string();
    };
    rows_.push_back({std::move(row), shown, [name, place, names](const ParameterList& list, S& s) -> Status {
                       const std::string stated = list.string(name, "");
                       for (const auto& [word, value] : names)
                         if (word == stated) place(s) = value;
                       return Done{};
                     }});
    return *this;
  }
  // Text, any or one of the choices, that `read` takes apart where it is stated; `shown` writes the default.
  Fields& text(std::string_view name, std::string meaning, std::function<Status(const std::string&, S&)> read,
               std::function<std::string(const S&)> shown = {}, std::vector<std::string_view> choices = {}) {
    rows_.push_back({{name, {ParameterType::string}, std::move(meaning), 0, 0, std::move(choices)},
                     std::move(shown),
                     [name, read](const ParameterList& list, S& s) -> Status {
                       return list.find(name) ? read(list.string(name, ""), s) : Status(Done{});
                     }});
    return *this;
  }
  // A row whose meaning states the default, since that is no value of its own, and that is read elsewhere.
  Fields& other(ParameterSpec row) {
    rows_.push_back({std::move(row), {}, [](const ParameterList&, S&) -> Status { return Done{}; }});
    return *this;
  }

  // The rows of the table, with the defaults that the struct has.
  std::vector<ParameterSpec> specs(const S& defaults) const { return specs(defaults, defaults, ""); }
  // The same where other defaults hold in a case: "default 15, without groups 5".
  std::vector<ParameterSpec> specs(const S& defaults, const S& otherwise, const std::string& in_which_case) const {
    std::vector<ParameterSpec> all;
    for (const Row& row : rows_) {
      all.push_back(row.spec);
      if (!row.shown) continue;
      std::string text = row.shown(defaults);
      if (const std::string other = row.shown(otherwise); other != text)
        text.append(", ").append(in_which_case).append(" ").append(other);
      all.back() = with_default(std::move(all.back()), text);
    }
    return all;
  }

  // Stores what the list states. Fails where a text cannot be read.
  Status read(const ParameterList& list, S& s) const {
    for (const Row& row : rows_)
      if (Status read = row.read(list, s); !read) return read;
    return Done{};
  }

 private:
  struct Row {
    ParameterSpec spec;
    std::function<std::string(const S&)> shown;  // the default; empty: the meaning states it
    std::function<Status(const ParameterList&, S&)> read;
  };

  template <class T>
  Fields& value(ParameterSpec spec, Place<T> place, T (ParameterList::*get)(std::string_view, T) const) {
    const std::string_view name = spec.name;
    const auto shown = [place](const S& s) {
      S copy = s;
      return setting_text(place(copy));
    };
    rows_.push_back({std::move(spec), shown, [name, place, get](const ParameterList& list, S& s) -> Status {
                       place(s) = (list.*get)(name, place(s));
                       return Done{};
                     }});
    return *this;
  }

  std::vector<Row> rows_;
};

}  // namespace montelux
