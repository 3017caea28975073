// Settings of a struct, each stated once: name, type, range and meaning of the parameter, and where its value is
// stored. The default is the value that the struct has; help, documentation, reader and writer follow from the row.
#pragma once
#include <algorithm>
#include <array>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "math/result.h"
#include "parameter/input.h"
#include "parameter/setting_text.h"
#include "parameter/spec.h"

namespace montelux {

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
    return with_default_value<int>({name, {ParameterType::integer}, std::move(meaning), low, high}, place,
                                   &first_of<int>);
  }
  Fields& number(std::string_view name, Place<float> place, std::string meaning, double low, double high) {
    return with_default_value<float>({name, {ParameterType::number}, std::move(meaning), low, high}, place,
                                     &first_of<float>);
  }
  Fields& boolean(std::string_view name, Place<bool> place, std::string meaning) {
    return with_default_value<bool>({name, {ParameterType::boolean}, std::move(meaning)}, place, &truth_of);
  }
  // The same where a file states "true" and "false".
  Fields& flag(std::string_view name, Place<bool> place, std::string meaning) {
    boolean(name, place, std::move(meaning));
    rows_.back().shown = [place](const S& s) {
      S copy = s;
      return std::string(place(copy) ? "true" : "false");
    };
    return *this;
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
    const auto write = [name, place, shown](S& s, S& defaults, ParameterList& list) {
      if (place(s) != place(defaults)) list.add(parameter_of(name, shown(s)));
    };
    rows_.push_back({std::move(row), shown,
                     [name, place, names](const ParameterList& list, S& s) -> Status {
                       const std::string stated = list.string(name, "");
                       for (const auto& [word, value] : names)
                         if (word == stated) place(s) = value;
                       return Done{};
                     },
                     write});
    return *this;
  }
  // The same without a default value; the meaning states what is used instead.
  template <class E>
  Fields& optional_choice(std::string_view name, Place<std::optional<E>> place, std::string meaning,
                          NamedValues<E> names) {
    ParameterSpec row{name, {ParameterType::string}, std::move(meaning), 0, 0};
    for (const auto& [word, value] : names) row.choices.push_back(word);
    const auto write = [name, place, names](S& s, S& defaults, ParameterList& list) {
      if (!place(s) || place(s) == place(defaults)) return;
      for (const auto& [word, value] : names)
        if (value == *place(s)) list.add(parameter_of(name, std::string(word)));
    };
    const auto read = [name, place, names](const ParameterList& list, S& s) -> Status {
      const std::string stated = list.string(name, "");
      for (const auto& [word, value] : names)
        if (word == stated) place(s) = value;
      return Done{};
    };
    rows_.push_back({std::move(row), {}, read, write});
    return *this;
  }
  // Numbers, integers and text that have no default value; the meaning states what is used instead.
  Fields& optional(std::string_view name, Place<std::optional<float>> place, std::string meaning, double low,
                   double high) {
    return without_default_value<float>({name, {ParameterType::number}, std::move(meaning), low, high}, place,
                                        &first_of<float>);
  }
  Fields& optional(std::string_view name, Place<std::optional<int>> place, std::string meaning, double low,
                   double high) {
    return without_default_value<int>({name, {ParameterType::integer}, std::move(meaning), low, high}, place,
                                      &first_of<int>);
  }
  // A spectrum.
  Fields& spectrum(std::string_view name, Place<SpectrumValue> place, std::string meaning, double low, double high) {
    return with_default_value<SpectrumValue>({name, {ParameterType::spectrum}, std::move(meaning), low, high}, place,
                                             &first_of<SpectrumValue>);
  }
  Fields& optional(std::string_view name, Place<std::optional<SpectrumValue>> place, std::string meaning, double low,
                   double high) {
    return without_default_value<SpectrumValue>({name, {ParameterType::spectrum}, std::move(meaning), low, high}, place,
                                                &first_of<SpectrumValue>);
  }
  // A point or a vector; `type` states which.
  Fields& vector(std::string_view name, ParameterType type, Place<Vec3f> place, std::string meaning) {
    return with_default_value<Vec3f>({name, {type}, std::move(meaning)}, place, &first_of<Vec3f>);
  }
  // What may be stated in several ways (I: an Input).
  template <class I>
  Fields& input(std::string_view name, Place<I> place, std::string meaning, double low, double high) {
    return with_default_value<I>({name, InputConversion<I>::types(), std::move(meaning), low, high}, place,
                                 &InputConversion<I>::read);
  }
  // The same without a default value; the meaning states what is used instead.
  template <class I>
  Fields& optional_input(std::string_view name, Place<std::optional<I>> place, std::string meaning, double low,
                         double high) {
    return without_default_value<I>({name, InputConversion<I>::types(), std::move(meaning), low, high}, place,
                                    &InputConversion<I>::read);
  }
  // The last row has an effect only where `has_effect` is true of what was read; otherwise it counts as unused.
  Fields& only_if(std::function<bool(const S&)> has_effect) {
    rows_.back().has_effect = std::move(has_effect);
    return *this;
  }
  // The last row is known, but not applied yet: a reader warns of it.
  Fields& later() {
    rows_.back().spec.later = true;
    return *this;
  }
  // As many values as the array has. A list of another length, which the checks report, is ignored.
  template <std::size_t N>
  Fields& list(std::string_view name, Place<std::optional<std::array<float, N>>> place, std::string meaning, double low,
               double high) {
    return without_default_value<std::array<float, N>>(
        {name, {ParameterType::number}, std::move(meaning), low, high, {}, true}, place, &array_of<float, N>);
  }
  template <std::size_t N>
  Fields& list(std::string_view name, Place<std::optional<std::array<int, N>>> place, std::string meaning, double low,
               double high) {
    return without_default_value<std::array<int, N>>(
        {name, {ParameterType::integer}, std::move(meaning), low, high, {}, true}, place, &array_of<int, N>);
  }
  // The same with default values.
  template <std::size_t N>
  Fields& list(std::string_view name, Place<std::array<float, N>> place, std::string meaning, double low, double high) {
    return with_default_value<std::array<float, N>>(
        {name, {ParameterType::number}, std::move(meaning), low, high, {}, true}, place, &array_of<float, N>);
  }
  // A list of any length; by default it is empty. The type is that of the values or one like it: point3, normal.
  template <class T>
  Fields& list(std::string_view name, ParameterType type, Place<std::vector<T>> place, std::string meaning) {
    const auto write = [name, type, place](S& s, S& defaults, ParameterList& list) {
      if (!place(s).empty() && place(defaults).empty())
        list.add({std::string(name), type, Values(place(s)), SourceLocation{}});
    };
    ParameterSpec row{name, {type}, std::move(meaning), -1e30, 1e30, {}, true};
    rows_.push_back({std::move(row),
                     {},
                     [name, place](const ParameterList& list, S& s) -> Status {
                       if (list.find(name)) place(s) = list.array<T>(name);
                       return Done{};
                     },
                     write});
    return *this;
  }
  // Text without a default.
  Fields& words(std::string_view name, Place<std::string> place, std::string meaning) {
    const auto write = [name, place](S& s, S& defaults, ParameterList& list) {
      if (place(s) != place(defaults)) list.add(parameter_of(name, place(s)));
    };
    ParameterSpec row{name, {ParameterType::string}, std::move(meaning), 0, 0};
    rows_.push_back({std::move(row),
                     {},
                     [name, place](const ParameterList& list, S& s) -> Status {
                       place(s) = list.string(name, place(s));
                       return Done{};
                     },
                     write});
    return *this;
  }
  // A number that sets several others, each of which has a row of its own after it; the meaning states the default.
  Fields& common(ParameterSpec row, std::function<void(float, S&)> set) {
    const std::string_view name = row.name;
    rows_.push_back({std::move(row),
                     {},
                     [name, set](const ParameterList& list, S& s) -> Status {
                       if (list.find(name)) set(list.number(name, 0), s);
                       return Done{};
                     },
                     {}});
    return *this;
  }
  // Text, any or one of the choices, that `read` takes apart where it is stated; `shown` writes the default. `written`
  // states a value; an empty text: there is nothing to state.
  Fields& text(std::string_view name, std::string meaning, std::function<Status(const std::string&, S&)> read,
               std::function<std::string(const S&)> shown = {}, std::vector<std::string_view> choices = {},
               std::function<std::string(const S&)> written = {}) {
    const auto write = [name, written](S& s, S& defaults, ParameterList& list) {
      std::string text = written ? written(s) : std::string();
      if (!text.empty() && text != written(defaults)) list.add(parameter_of(name, std::move(text)));
    };
    ParameterSpec row{name, {ParameterType::string}, std::move(meaning), 0, 0, std::move(choices)};
    rows_.push_back({std::move(row), std::move(shown),
                     [name, read](const ParameterList& list, S& s) -> Status {
                       return list.find(name) ? read(list.string(name, ""), s) : Status(Done{});
                     },
                     write});
    return *this;
  }
  // The last row had this name before.
  Fields& formerly(std::string_view name) {
    rows_.back().spec.formerly = name;
    return *this;
  }
  // A row whose meaning states the default, since that is no value of its own, and that is read elsewhere.
  Fields& other(ParameterSpec row) {
    rows_.push_back({std::move(row), {}, [](const ParameterList&, S&) -> Status { return Done{}; }, {}});
    return *this;
  }
  // The rows of a part P of the struct after these. They have an effect only where `applies`.
  template <class P>
  Fields& part(std::type_identity_t<Place<P>> place, const Fields<P>& more,
               std::function<bool(const S&)> applies = {}) {
    for (const typename Fields<P>::Row& row : more.rows_) {
      Row own{row.spec, {}, [place, row](const ParameterList& list, S& s) { return row.read(list, place(s)); }, {}};
      if (row.shown)
        own.shown = [place, row](const S& s) {
          S copy = s;
          return row.shown(place(copy));
        };
      if (row.write)
        own.write = [place, row](S& s, S& defaults, ParameterList& list) {
          row.write(place(s), place(defaults), list);
        };
      if (row.has_effect || applies)
        own.has_effect = [place, row, applies](const S& s) {
          if (applies && !applies(s)) return false;
          if (!row.has_effect) return true;
          S copy = s;
          return row.has_effect(place(copy));
        };
      rows_.push_back(std::move(own));
    }
    return *this;
  }
  // The rows of another table after these.
  Fields& append(const Fields& more) {
    rows_.insert(rows_.end(), more.rows_.begin(), more.rows_.end());
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
    for (const Row& row : rows_)
      if (row.has_effect && !row.has_effect(s)) list.forget_use(row.spec.name);
    return Done{};
  }

  // The parameters that state `s` where they differ from `defaults`.
  ParameterList write(S s, S defaults) const {
    ParameterList list;
    for (const Row& row : rows_)
      if (row.write) row.write(s, defaults, list);
    return list;
  }

 private:
  template <class T>
  friend class Fields;
  struct Row {
    ParameterSpec spec;
    std::function<std::string(const S&)> shown;  // the default; empty: the meaning states it
    std::function<Status(const ParameterList&, S&)> read;
    std::function<void(S&, S& defaults, ParameterList&)> write;  // empty: other rows state it
    std::function<bool(const S&)> has_effect{};                  // empty: always
  };

  template <class T>
  static std::optional<T> first_of(const Parameter& stated) {
    const auto* values = std::get_if<std::vector<T>>(&stated.values);
    return values && !values->empty() ? std::optional<T>(values->front()) : std::nullopt;
  }
  static std::optional<bool> truth_of(const Parameter& stated) {
    const auto truth = first_of<std::uint8_t>(stated);
    return truth ? std::optional(*truth != 0) : std::nullopt;
  }
  template <class T, std::size_t N>
  static std::optional<std::array<T, N>> array_of(const Parameter& stated) {
    const auto* values = std::get_if<std::vector<T>>(&stated.values);
    if (!values || values->size() != N) return std::nullopt;
    std::array<T, N> result{};
    std::copy(values->begin(), values->end(), result.begin());
    return result;
  }
  template <class T>
  static bool equal(const T& a, const T& b) {
    if constexpr (std::is_same_v<T, Vec3f>)
      return a.x == b.x && a.y == b.y && a.z == b.z;
    else
      return a == b;
  }

  // The parameter that states a value; vectors have the type of their row.
  template <class T>
  static Parameter stated(const ParameterSpec& spec, const T& v) {
    if constexpr (std::is_same_v<T, Vec3f>)
      return {std::string(spec.name), spec.types.front(), std::vector<Vec3f>{v}, {}};
    else
      return parameter_of(spec.name, v);
  }

  // `taken`: the value of a parameter, if it has the right type.
  template <class T>
  Fields& with_default_value(ParameterSpec spec, Place<T> place, std::optional<T> (*taken)(const Parameter&)) {
    const auto shown = [place](const S& s) {
      S copy = s;
      return setting_text(place(copy));
    };
    const auto read = [name = spec.name, place, taken](const ParameterList& list, S& s) -> Status {
      const Parameter* p = list.find(name);
      if (std::optional<T> v = p ? taken(*p) : std::nullopt) place(s) = *std::move(v);
      return Done{};
    };
    const auto write = [spec, place](S& s, S& defaults, ParameterList& list) {
      if (!equal(place(s), place(defaults))) list.add(stated(spec, place(s)));
    };
    rows_.push_back({std::move(spec), shown, read, write});
    return *this;
  }
  template <class T>
  Fields& without_default_value(ParameterSpec spec, Place<std::optional<T>> place,
                                std::optional<T> (*taken)(const Parameter&)) {
    const auto read = [name = spec.name, place, taken](const ParameterList& list, S& s) -> Status {
      const Parameter* p = list.find(name);
      if (std::optional<T> v = p ? taken(*p) : std::nullopt) place(s) = std::move(v);
      return Done{};
    };
    const auto write = [spec, place](S& s, S& defaults, ParameterList& list) {
      if (place(s) && place(s) != place(defaults)) list.add(stated(spec, *place(s)));
    };
    rows_.push_back({std::move(spec), {}, read, write});
    return *this;
  }

  std::vector<Row> rows_;
};

}  // namespace montelux
