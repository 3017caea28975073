// Requested errors as text.
#pragma once
#include <string>

#include "film/error_target.h"
#include "math/result.h"

namespace montelux {

struct TargetResult;

// "2%", "pixels:5%@95%" (95 % of the pixels within 5 %) or "mean:0.1%". A failure states what is valid.
Result<ErrorTarget> parse_target(const std::string& text);
// The same text, without the confidence.
std::string to_text(const ErrorTarget& target);

// Of a target that is not reached, in one clause.
std::string why_not_reached(const TargetResult& target);

}  // namespace montelux
