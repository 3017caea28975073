// How the library says that something failed.
#pragma once
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace montelux::api {

enum class Severity { note, warning, error };

// What was found in a scene.
struct Message {
  Severity severity = Severity::error;
  std::string where;  // the file with line and column, or the part of a scene in code: "material 2"
  std::string text;   // what was found and what is valid
  std::string hint;   // the nearest valid name, or what to do; may be empty
};

// "material 2: error: 'rougness' ... (did you mean 'roughness'?)".
std::string to_text(const Message& message);

// Why a call failed. The one exception type that the library throws itself, and only by Result::value(); besides it,
// std::bad_alloc may leave functions that return no Result.
class __attribute__((visibility("default"))) Error : public std::runtime_error {
 public:
  // what() is the text, and behind it a line for each message that is an error.
  explicit Error(const std::string& text, std::vector<Message> messages = {});
  ~Error() override;
  const std::vector<Message>& messages() const { return messages_; }

 private:
  std::vector<Message> messages_;
};

// A value, or the error that there is instead. Use either way:
//   if (!result) return report(result.error());     // no exceptions
//   Picture picture = scene.render().value();       // throws Error
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : outcome_(std::in_place_index<0>, std::move(value)) {}
  Result(Error error) : outcome_(std::in_place_index<1>, std::move(error)) {}

  bool has_value() const { return outcome_.index() == 0; }
  explicit operator bool() const { return has_value(); }

  // Throws Error where there is no value.
  T& value() & { return checked(), std::get<0>(outcome_); }
  const T& value() const& { return checked(), std::get<0>(outcome_); }
  T&& value() && { return checked(), std::get<0>(std::move(outcome_)); }
  // The same.
  T& operator*() & { return value(); }
  const T& operator*() const& { return value(); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }

  // Only where there is no value.
  const Error& error() const { return std::get<1>(outcome_); }

 private:
  void checked() const {
    if (!has_value()) throw error();
  }
  std::variant<T, Error> outcome_;
};

// The outcome of a call that returns nothing: value() only throws where it failed.
struct Done {};
using Status = Result<Done>;

}  // namespace montelux::api
