// The plan of the numbers of a path: which coordinate of its sample point decides what, so that no two decisions share
// one. Streams have the numbers of coordinates, but are independent of them, except that a recorded point chooses among
// several streams by the coordinate (numbers.h). One plan is for paths from the camera, one for paths from a light.
#pragma once
#include <cstdint>

namespace montelux {

namespace path_dimension {

inline constexpr std::uint32_t film = 0;  // 2
inline constexpr std::uint32_t lens = 2;  // 2
inline constexpr std::uint32_t time = 4;  // 1
inline constexpr std::uint32_t first_vertex = 6;

// Offsets within the numbers of one vertex.
inline constexpr std::uint32_t light_point = 0;   // 2
inline constexpr std::uint32_t direction = 2;     // 2
inline constexpr std::uint32_t light_choice = 4;  // 1
inline constexpr std::uint32_t lobe = 5;          // 1
inline constexpr std::uint32_t roulette = 6;      // 1
inline constexpr std::uint32_t own = 7;           // a stream, for mixtures, models that walk, and segments in media
inline constexpr std::uint32_t distance = 8;      // 2: along the segment that leads to the vertex, in a medium
inline constexpr std::uint32_t per_vertex = 10;
// Interfaces are no vertices, but each segment between them has a distance and a stream of its own.
inline constexpr std::uint32_t per_crossing = 1u << 20;

// A fork of the stream of a vertex, for what a shadow ray meets: unlike the forks of materials, whose numbers are
// small.
inline constexpr std::uint32_t shadow_stream = 0x1b873593u;

// Reuse between pixels: the direction of the first rough vertex, and the streams of a pixel. Crossings have no numbers
// before the first vertex, so that these are free.
inline constexpr std::uint32_t rough_direction = 1u << 29;  // 2
inline constexpr std::uint32_t reuse = 1u << 30;            // a stream

}  // namespace path_dimension

namespace light_dimension {

inline constexpr std::uint32_t point = 0;      // 2: on the light
inline constexpr std::uint32_t direction = 2;  // 2: from there
inline constexpr std::uint32_t lens = 4;       // 2, and a stream: for the connection of the light itself
inline constexpr std::uint32_t choice = 6;     // 1: of the light
inline constexpr std::uint32_t time = 7;       // 1
inline constexpr std::uint32_t first_vertex = 8;

// Offsets within the numbers of one vertex.
inline constexpr std::uint32_t vertex_lens = 0;       // 2, and a stream
inline constexpr std::uint32_t vertex_direction = 2;  // 2
inline constexpr std::uint32_t lobe = 4;              // 1
inline constexpr std::uint32_t roulette = 5;          // 1
inline constexpr std::uint32_t own = 6;               // a stream, for mixtures and models that walk
inline constexpr std::uint32_t per_vertex = 8;
// 2: along the segment that leads to the vertex, in a medium; those of crossings follow as they do in paths from the
// camera.
inline constexpr std::uint32_t distance = path_dimension::per_crossing;

}  // namespace light_dimension

// Of a ray that leaves an element of a radiosity mesh.
namespace element_dimension {

inline constexpr std::uint32_t place = 0;         // 2: on the element
inline constexpr std::uint32_t direction = 2;     // 2
inline constexpr std::uint32_t light_choice = 4;  // 1
inline constexpr std::uint32_t light_point = 5;   // 2
inline constexpr std::uint32_t own = 8;           // a stream

}  // namespace element_dimension

}  // namespace montelux
