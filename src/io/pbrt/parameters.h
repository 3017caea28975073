// Parameter lists: "type name" [ values ].
#pragma once
#include <functional>
#include <optional>
#include <string>

#include "io/pbrt/lexer.h"
#include "io/reporter.h"
#include "parameter/spec.h"
#include "parameter/value.h"

namespace montelux::pbrt {

// The context in which the values of a list are read.
struct ParameterContext {
  Lexer& lexer;
  Reporter& report;
  const std::string& folder;       // of the scene
  const std::string& color_space;  // in force
};

// Whether a word begins a directive, so that a value list that reaches it lacks its bracket.
bool is_directive(std::string_view word);

// All parameters up to the next token that is not a quoted string. Malformed ones are reported and omitted; their types
// are not yet checked against a table.
ParameterList read_parameters(const ParameterContext& context);

// The notation of a type in a file: "float" for a number, "rgb, spectrum or blackbody" for a spectrum.
std::string_view spelling(ParameterType type);

}  // namespace montelux::pbrt
