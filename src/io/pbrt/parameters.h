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

// What the values of a list are read against.
struct ParameterContext {
  Lexer& lexer;
  Reporter& report;
  const std::string& folder;       // of the scene
  const std::string& color_space;  // in force
};

// Whether a word starts a directive, so that a value list that meets it has lost its bracket.
bool is_directive(std::string_view word);

// All parameters up to the next token that is no quoted string. Malformed ones are reported and left out; their types
// are not yet compared with any table.
ParameterList read_parameters(const ParameterContext& context);

// How a file spells a type: "float" for a number, "rgb, spectrum or blackbody" for a spectrum.
std::string_view spelling(ParameterType type);

}  // namespace montelux::pbrt
