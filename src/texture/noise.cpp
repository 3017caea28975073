#include "texture/noise.h"

#include <cmath>

namespace montelux {

namespace {

// Perlin's published permutation of 0...255.
constexpr std::array<std::uint8_t, 256> permutation{
    151, 160, 137, 91,  90,  15,  131, 13,  201, 95,  96,  53,  194, 233, 7,   225, 140, 36,  103, 30,  69,  142,
    8,   99,  37,  240, 21,  10,  23,  190, 6,   148, 247, 120, 234, 75,  0,   26,  197, 62,  94,  252, 219, 203,
    117, 35,  11,  32,  57,  177, 33,  88,  237, 149, 56,  87,  174, 20,  125, 136, 171, 168, 68,  175, 74,  165,
    71,  134, 139, 48,  27,  166, 77,  146, 158, 231, 83,  111, 229, 122, 60,  211, 133, 230, 220, 105, 92,  41,
    55,  46,  245, 40,  244, 102, 143, 54,  65,  25,  63,  161, 1,   216, 80,  73,  209, 76,  132, 187, 208, 89,
    18,  169, 200, 196, 135, 130, 116, 188, 159, 86,  164, 100, 109, 198, 173, 186, 3,   64,  52,  217, 226, 250,
    124, 123, 5,   202, 38,  147, 118, 126, 255, 82,  85,  212, 207, 206, 59,  227, 47,  16,  58,  17,  182, 189,
    28,  42,  223, 183, 170, 213, 119, 248, 152, 2,   44,  154, 163, 70,  221, 153, 101, 155, 167, 43,  172, 9,
    129, 22,  39,  253, 19,  98,  108, 110, 79,  113, 224, 232, 178, 185, 112, 104, 218, 246, 97,  228, 251, 34,
    242, 193, 238, 210, 144, 12,  191, 179, 162, 241, 81,  51,  145, 235, 249, 14,  239, 107, 49,  192, 214, 31,
    181, 199, 106, 157, 184, 84,  204, 176, 115, 121, 50,  45,  127, 4,   150, 254, 138, 236, 205, 93,  222, 114,
    67,  29,  24,  72,  243, 141, 128, 195, 78,  66,  215, 61,  156, 180};

// The twelve edges of a cube; four of them are repeated to make sixteen.
constexpr std::array<Vec3f, 16> gradients{{{1, 1, 0},
                                           {-1, 1, 0},
                                           {1, -1, 0},
                                           {-1, -1, 0},
                                           {1, 0, 1},
                                           {-1, 0, 1},
                                           {1, 0, -1},
                                           {-1, 0, -1},
                                           {0, 1, 1},
                                           {0, -1, 1},
                                           {0, 1, -1},
                                           {0, -1, -1},
                                           {1, 1, 0},
                                           {-1, 1, 0},
                                           {0, 1, -1},
                                           {0, -1, -1}}};

// A coordinate as its cell number (modulo 256) and the position within the cell.
struct Cell {
  std::uint32_t index;
  float place;
  float weight;  // of the next lattice point: quintic, with vanishing first and second derivatives at both ends
};

Cell cell_of(float x) {
  float bounded = is_finite(x) ? std::fmod(x, 0x1p30f) : 0.0f;
  float low = std::floor(bounded), t = bounded - low;
  return {std::uint32_t(std::int32_t(low)) & 255u, t, t * t * t * (t * (t * 6 - 15) + 10)};
}

// The dot product of the gradient of a lattice point and the offset from that point.
float pull(std::uint32_t x, std::uint32_t y, std::uint32_t z, Vec3f way) {
  std::uint32_t h = permutation[(permutation[(permutation[x & 255u] + y) & 255u] + z) & 255u];
  return dot(gradients[h & 15u], way);
}

}  // namespace

float gradient_noise(Vec3f p) {
  Cell x = cell_of(p.x), y = cell_of(p.y), z = cell_of(p.z);
  auto along_x = [&](std::uint32_t j, std::uint32_t k) {
    Vec3f way{x.place, y.place - float(j), z.place - float(k)};
    float a = pull(x.index, y.index + j, z.index + k, way);
    float b = pull(x.index + 1, y.index + j, z.index + k, {way.x - 1, way.y, way.z});
    return lerp(x.weight, a, b);
  };
  return lerp(z.weight, lerp(y.weight, along_x(0, 0), along_x(1, 0)), lerp(y.weight, along_x(0, 1), along_x(1, 1)));
}

float fractional_brownian_motion(Vec3f p, float roughness, int octaves) {
  float sum = 0, frequency = 1, amplitude = 1;
  for (int i = 0; i < octaves; ++i) {
    sum += amplitude * gradient_noise(p * frequency);
    frequency *= 1.99f;
    amplitude *= roughness;
  }
  return sum;
}

float turbulence(Vec3f p, float roughness, int octaves) {
  float sum = 0, frequency = 1, amplitude = 1;
  for (int i = 0; i < octaves; ++i) {
    sum += amplitude * std::abs(gradient_noise(p * frequency));
    frequency *= 1.99f;
    amplitude *= roughness;
  }
  return sum;
}

}  // namespace montelux
