// The first scan of the text of an expression: names, brackets and characters; finds all errors at once.
#pragma once
#include "lab/expression/expression.h"

namespace montelux::lab {

std::vector<TextMistake> scan_mistakes(std::string_view text, const std::vector<std::string>& variables);

const NamedFunction* find_function(std::string_view name);
const NamedConstant* find_constant(std::string_view name);

}  // namespace montelux::lab
