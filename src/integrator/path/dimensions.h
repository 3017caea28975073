// Which coordinate of a sample point decides what, so that two decisions never share one.
#pragma once
#include <cstdint>

namespace montelux::path_dimension {

inline constexpr std::uint32_t film = 0;  // 2
inline constexpr std::uint32_t lens = 2;  // 2
inline constexpr std::uint32_t first_vertex = 4;
// Of motion; the place of the first vertex's stream, of which no single number is taken otherwise.
inline constexpr std::uint32_t time = 11;  // 1

// Offsets within the numbers of one vertex.
inline constexpr std::uint32_t light_point = 0;   // 2
inline constexpr std::uint32_t direction = 2;     // 2
inline constexpr std::uint32_t light_choice = 4;  // 1
inline constexpr std::uint32_t lobe = 5;          // 1
inline constexpr std::uint32_t roulette = 6;      // 1
inline constexpr std::uint32_t own = 7;           // a stream, for mixtures and models that walk
inline constexpr std::uint32_t per_vertex = 8;
static_assert(time == first_vertex + own);
// Interfaces are no vertices, but each has a stream of its own.
inline constexpr std::uint32_t per_crossing = 1u << 20;

}  // namespace montelux::path_dimension
