#include "montelux/result.h"

#include <algorithm>

namespace montelux::api {

std::string to_text(const Message& message) {
  constexpr const char* words[] = {"note", "warning", "error"};
  std::string text = message.where;
  text.append(text.empty() ? "" : ": ").append(words[std::size_t(message.severity)]).append(": ").append(message.text);
  return message.hint.empty() ? text : text.append(" (").append(message.hint).append(")");
}

namespace {

std::string with_errors(std::string text, const std::vector<Message>& messages) {
  for (const Message& message : messages)
    if (message.severity == Severity::error) text.append("\n  ").append(to_text(message));
  return text;
}

}  // namespace

Error::Error(const std::string& text, std::vector<Message> messages)
    : std::runtime_error(with_errors(text, messages)), messages_(std::move(messages)) {}
Error::~Error() = default;

}  // namespace montelux::api
