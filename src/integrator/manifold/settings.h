// Limits of manifold next-event estimation.
#pragma once
#include <cstdint>

namespace montelux {

// Specular events of a chain at most.
inline constexpr std::uint32_t max_chain_length = 4;

}  // namespace montelux
