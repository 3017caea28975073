#include "mc/confidence.h"

namespace montelux {

Interval confidence_interval(double mean, double standard_error, double count, double level) {
  const double reach = student_t_quantile(0.5 + 0.5 * level, count - 1) * standard_error;
  return {mean - reach, mean + reach};
}

}  // namespace montelux
