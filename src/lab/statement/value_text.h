// Values with their errors, as they are printed.
#pragma once
#include <string>

namespace montelux::lab {

// "0.99994(37)": the digits in brackets are one standard error in units of the last digits; "12.3(2.1)" from 1 on, and
// "1.234(56)e-09" where the value is very large or small. Without a finite error above 0: "0.25(?)", "0.25(0)".
std::string value_with_error(double value, double error);

}  // namespace montelux::lab
