#include "io/read_model.h"

namespace montelux {

void report_unused(const std::string& owner, const ParameterList& parameters, Reporter& report) {
  for (const Parameter* p : parameters.unused())
    if (report.is_first_at(p->where)) report.warning(p->where, "'" + p->name + "' of " + owner + " has no effect here");
}

}  // namespace montelux
