// The documentation of what a scene may state.
#pragma once
#include <string>

namespace montelux {

// Every family with all names and parameters of its table, in Markdown; docs/formats.md contains this text.
std::string pbrt_reference();

}  // namespace montelux
