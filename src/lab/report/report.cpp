#include "lab/report/report.h"

namespace montelux::lab {

bool Report::passed() const {
  for (const Section& section : sections)
    if (const auto* verdict = std::get_if<Verdict>(&section); verdict && !verdict->passed) return false;
  return true;
}

int color_of(const Figure& figure, std::size_t curve) {
  if (figure.curves[curve].color >= 0) return figure.curves[curve].color;
  int color = 0;
  for (std::size_t i = 0; i < curve; ++i)
    if (figure.curves[i].color < 0) ++color;
  return color;
}

}  // namespace montelux::lab
