// Values with their errors, as they are printed.
#pragma once
#include <string>

namespace montelux::lab {

// "0.99994(37)": the digits in brackets are one standard error in units of the last digits; "12.3(2.1)" from 1 on, and
// "1.234(56)e-09" where the value is very large or small. Without a finite error above 0: "0.25(?)", "0.25(0)".
std::string value_with_error(double value, double error);

// "540 ± 100", "0.1234 ± 0.0021", "(5.41 ± 0.10)e-05": the error with two digits, the value to the same place. Without
// a finite error: "541.1 (error not known)"; without a finite value: "not known".
std::string value_plus_minus(double value, double error);
// "2.31 (2.10 to 2.55)": to the place of the second digit of the nearer bound's distance. An infinite bound is a word.
std::string value_in_interval(double value, double low, double high);

}  // namespace montelux::lab
