// What may stand in a scene, as documentation.
#pragma once
#include <string>

namespace montelux {

// Every family with every name and parameter of its table, in Markdown; docs/formats.md holds this text.
std::string pbrt_reference();

}  // namespace montelux
