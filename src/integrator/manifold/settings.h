// Settings and limits of manifold next-event estimation.
#pragma once
#include <cstdint>

namespace montelux {

// Specular events of a chain at most.
inline constexpr std::uint32_t max_chain_length = 4;

// Which chains are looked for.
struct ChainLimits {
  int length = 0;           // events at most
  float max_roughness = 0;  // GGX alpha of the surfaces at most; 0: smooth ones alone
};

}  // namespace montelux
