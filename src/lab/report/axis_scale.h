// Where values stand along an axis, and where its ticks are.
#pragma once
#include <string>
#include <vector>

#include "lab/report/report.h"

namespace montelux::lab {

struct Tick {
  double value;
  std::string label;  // empty for the small ticks between decades
};

// A range of values, mapped to [0, 1]. Logarithmic ranges are positive.
struct AxisScale {
  double low = 0, high = 1;
  bool logarithmic = false;
  std::vector<std::string> names{};  // of the places 1, 2, ..., instead of numbers

  // 0 at low, 1 at high; not a number where a logarithm has none.
  double place(double value) const;
  std::vector<Tick> ticks() const;
};

// The range that an axis shows of these values: its own bounds where it has them, else theirs and a little more. Bars
// reach down to zero.
AxisScale scale_of(const Axis& axis, const std::vector<double>& values, bool from_zero);

// Text with formulas in dollars as plain text: Greek letters and digits up and down as characters.
std::string plain_text(const std::string& text);

}  // namespace montelux::lab
