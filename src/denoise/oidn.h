// Intel's Open Image Denoise, of which no part is linked: its library is loaded while the program runs.
#pragma once
#include <memory>
#include <string>

#include "denoise/color_filter.h"
#include "math/result.h"

namespace montelux {

// Its filter for ray tracing ("RT", high dynamic range, with albedo and normal), on the processor. Of versions 1 and
// 2, by the functions that their manuals document. `file`: of the library; empty: the system's, by its name. Fails,
// with what was tried, if there is none, or none that works here. The library stays loaded until the program ends.
Result<std::shared_ptr<const ColorFilter>> load_oidn(const std::string& file = {});

}  // namespace montelux
