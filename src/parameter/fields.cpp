#include "parameter/fields.h"

namespace montelux {

ParameterSpec with_default(ParameterSpec row, const std::string& value) {
  row.meaning += (row.meaning.empty() ? "default " : "; default ") + value;
  return row;
}

}  // namespace montelux
