// Numbers as text.
#pragma once
#include <optional>
#include <string>
#include <string_view>

namespace montelux {

// The number that the whole text states; no value if it is not a number, not finite or too large for the type.
std::optional<float> to_float(std::string_view text);
std::optional<double> to_double(std::string_view text);
std::optional<int> to_integer(std::string_view text);

// The shortest text that is read back as the same number.
std::string shortest(float value);
std::string shortest(double value);

}  // namespace montelux
