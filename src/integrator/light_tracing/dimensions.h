// Which coordinate of a light path's sample point decides what.
#pragma once
#include <cstdint>

namespace montelux::light_dimension {

inline constexpr std::uint32_t point = 0;      // 2: on the light
inline constexpr std::uint32_t direction = 2;  // 2: from there
inline constexpr std::uint32_t lens = 4;       // 2: for the connection of the light itself
inline constexpr std::uint32_t choice = 6;     // 1: of the light
inline constexpr std::uint32_t time = 7;       // 1
inline constexpr std::uint32_t first_vertex = 8;

// Offsets within the numbers of one vertex.
inline constexpr std::uint32_t vertex_lens = 0;       // 2
inline constexpr std::uint32_t vertex_direction = 2;  // 2
inline constexpr std::uint32_t lobe = 4;              // 1
inline constexpr std::uint32_t roulette = 5;          // 1
inline constexpr std::uint32_t own = 6;               // a stream, for mixtures and models that walk
inline constexpr std::uint32_t per_vertex = 8;

}  // namespace montelux::light_dimension
