// Diagnostics as text for the user.
#pragma once
#include <string>

#include "parameter/diagnostic.h"

namespace montelux {

struct ReportStyle {
  bool colour = false;   // ANSI colours
  bool excerpts = true;  // the line of the file with a caret below; the file is read again
};

// "file:line:column: error: message", the line, a caret and the hint; ends with a line feed.
std::string render(const Diagnostic& diagnostic, const ReportStyle& style = {});
// All of them, in order.
std::string render(const Diagnostics& diagnostics, const ReportStyle& style = {});

}  // namespace montelux
