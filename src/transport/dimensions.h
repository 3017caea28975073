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

// Reuse between pixels: the direction of the first rough vertex, and the streams of a pixel. Crossings have no numbers
// before the first vertex, so that these are free.
inline constexpr std::uint32_t rough_direction = 1u << 29;  // 2
inline constexpr std::uint32_t reuse = 1u << 30;            // a stream

}  // namespace path_dimension

// The forks of the stream of a vertex, by what they decide. The forks of materials have small numbers; "+ i": one for
// each i.
namespace vertex_stream {

inline constexpr std::uint32_t shadow = 0x1b873593u;         // what a shadow ray meets
inline constexpr std::uint32_t connection = 0x3c6ef372u;     // + i: with the vertex i of a path from a light
inline constexpr std::uint32_t resampling = 0x9d2c5680u;     // the candidates on lights
inline constexpr std::uint32_t segment_light = 0x5bd1e995u;  // the second event of a segment in a medium
inline constexpr std::uint32_t manifold = 0x9b1f6d2bu;       // the chains of mirrors and glass to a light
inline constexpr std::uint32_t photon = 0x6a09e667u;         // + i: how the photon i is scattered
inline constexpr std::uint32_t gather_ray = 0x9b05688cu;     // + i: the gather ray i

}  // namespace vertex_stream

// The forks of the stream of a pixel in one frame, where samples are reused. "+ i": in the stage i.
namespace restir_stream {

inline constexpr std::uint32_t bsdf = 1;               // of the vertex in view
inline constexpr std::uint32_t lights = 2;             // its candidates on lights
inline constexpr std::uint32_t met = 3;                // the light that its direction meets
inline constexpr std::uint32_t temporal = 4;           // the combination with the last frame
inline constexpr std::uint32_t path = 5;               // the candidate for its indirect light
inline constexpr std::uint32_t spatial = 16;           // + i: the choice of neighbours
inline constexpr std::uint32_t groups = 32;            // + i: the combination of groups of pixels
inline constexpr std::uint32_t interfaces = 1u << 31;  // a fork of `met`

}  // namespace restir_stream

// The forks of the stream of one scattering event of a path that other pixels replay.
namespace event_stream {

inline constexpr std::uint32_t model = 1;    // of the model that is sampled
inline constexpr std::uint32_t light = 2;    // next-event estimation where the event is
inline constexpr std::uint32_t surface = 3;  // the surfaces that it meets

}  // namespace event_stream

// The forks of the stream of a Markov chain's sample point, for what its vector of numbers does not have.
namespace chain_stream {

inline constexpr std::uint32_t light_path = 0x51ed270bu;
inline constexpr std::uint32_t start = 0x2545f491u;
inline constexpr std::uint32_t decisions = 0x9e37u;  // of a step: its size, and whether it is accepted

}  // namespace chain_stream

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
