// The outcome of work that can fail in a way its caller should explain to a person.
#pragma once
#include <string>
#include <utility>
#include <variant>

namespace montelux {

// Why something failed, in one sentence that names what was being read or done.
struct Failure {
  std::string message;
};

// A value of type T, or the message of what went wrong. value() may be called only if the result holds one, error()
// only if it does not. T itself must not be Failure.
template <class T>
class [[nodiscard]] Result {
 public:
  Result(T value) : outcome_(std::in_place_index<0>, std::move(value)) {}
  Result(Failure failure) : outcome_(std::in_place_index<1>, std::move(failure)) {}

  bool has_value() const { return outcome_.index() == 0; }
  explicit operator bool() const { return has_value(); }

  T& value() & { return std::get<0>(outcome_); }
  const T& value() const& { return std::get<0>(outcome_); }
  T&& value() && { return std::get<0>(std::move(outcome_)); }
  T& operator*() & { return value(); }
  const T& operator*() const& { return value(); }
  T&& operator*() && { return std::move(*this).value(); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }

  const std::string& error() const { return std::get<1>(outcome_).message; }
  Failure failure() const { return std::get<1>(outcome_); }

 private:
  std::variant<T, Failure> outcome_;
};

// Success without a value.
struct Done {};
using Status = Result<Done>;

}  // namespace montelux
