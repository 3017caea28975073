#include "texture/table.h"

namespace montelux {

namespace {

using enum ParameterType;
using List = std::vector<ParameterSpec>;

constexpr double most = 1e30;
const std::vector<ParameterType> value{number, spectrum, texture}, number_map{number, texture};

List join(const List& a, const List& b) {
  List all = a;
  all.insert(all.end(), b.begin(), b.end());
  return all;
}

// Textures over (u, v).
List mapping() {
  return {{"mapping",
           {string},
           "map from a point to (s, t); default uv",
           0,
           0,
           {"uv", "spherical", "cylindrical", "planar"}},
          {"uscale", {number}, "factor of u; default 1"},
          {"vscale", {number}, "factor of v; default 1"},
          {"udelta", {number}, "added to u; default 0"},
          {"vdelta", {number}, "added to v; default 0"},
          {"uvmatrix",
           {number},
           "a b c d e f: s = a u + b v + c, t = d u + e v + f, instead of the four (Montelux alone)",
           -most,
           most,
           {},
           true},
          {"v1", {vector3}, "s axis of the planar mapping; default 1 0 0"},
          {"v2", {vector3}, "t axis of the planar mapping; default 0 1 0"}};
}

List noise() {
  return {{"octaves", {integer}, "octaves of noise; default 8", 1, 64},
          {"roughness", {number}, "falloff of the octaves; default 0.5", 0, most}};
}

std::vector<EntitySpec> combining_textures() {
  return {
      {"constant", "one value everywhere", {{"value", value, "default 1"}}},
      {"scale",
       "the product of two textures",
       {{"tex", value, "default 1"}, {"scale", number_map, "factor; default 1"}}},
      {"mix",
       "interpolation between two textures",
       {{"tex1", value, "default 0"},
        {"tex2", value, "default 1"},
        {"amount", number_map, "share of tex2; default 0.5"}}},
      {"threshold",
       "1 where a texture is at least as large as a number, else 0 (numbers only; Montelux alone)",
       {{"tex", number_map, "default 1"}, {"edge", {number}, "default 0.5"}}},
      {"directionmix",
       "interpolation by the angle of the normal",
       {{"tex1", value, "along dir; default 0"},
        {"tex2", value, "across dir; default 1"},
        {"dir", {vector3}, "direction; default 0 1 0"}}},
  };
}

std::vector<EntitySpec> plane_textures() {
  return {
      {"imagemap", "an image",
       join({{"filename", {string}, "the image"},
             {"wrap",
              {string},
              "outside the image; default repeat",
              0,
              0,
              {"repeat", "black", "clamp", "octahedralsphere"}},
             {"uwrap", {string}, "only along u; default as wrap (Montelux alone)", 0, 0, {"repeat", "clamp", "mirror"}},
             {"vwrap", {string}, "only along v; default as wrap (Montelux alone)", 0, 0, {"repeat", "clamp", "mirror"}},
             {"channel",
              {string},
              "for numbers; default alpha, or the mean if there is none (Montelux alone)",
              0,
              0,
              {"r", "g", "b", "a"}},
             {"tint", {spectrum}, "factor of spectra; default 1 (Montelux alone)", 0, most},
             {"scale", {number}, "factor of the values; default 1"},
             {"invert", {boolean}, "1 - value; default false"},
             {"filter", {string}, "interpolation; default bilinear", 0, 0, {"point", "bilinear", "trilinear", "ewa"}},
             {"maxanisotropy", {number}, "for ewa; default 8", 0, most, {}, false, true},
             {"encoding", {string}, "sRGB, linear or 'gamma x'; default sRGB for 8 bits, else linear"}},
            mapping())},
      {"checkerboard", "checks of size 1",
       join({{"dimension", {integer}, "2 or 3; default 2", 2, 3},
             {"tex1", value, "default 1"},
             {"tex2", value, "default 0"}},
            mapping())},
      {"bilerp", "bilinear interpolation of four corner values",
       join({{"v00", {number, spectrum}, "default 0"},
             {"v01", {number, spectrum}, "default 1"},
             {"v10", {number, spectrum}, "default 0"},
             {"v11", {number, spectrum}, "default 1"}},
            mapping())},
      {"dots", "discs at random positions",
       join({{"inside", value, "default 1"}, {"outside", value, "default 0"}}, mapping())},
      {"ptex",
       "a per-face texture",
       {{"filename", {string}, "the file"},
        {"encoding", {string}, "default gamma 2.2"},
        {"scale", {number}, "default 1"}},
       true,
       "constant"},
  };
}

std::vector<EntitySpec> noise_textures() {
  return {
      {"fbm", "fractional Brownian motion", noise()},
      {"wrinkled", "sums of absolute values of noise", noise()},
      {"windy", "waves of varying height", {}},
      {"marble", "veins of marble (spectra only)",
       join(noise(), {{"scale", {number}, "factor of space; default 1"},
                      {"variation", {number}, "strength of the veins; default 0.2"}})},
  };
}

}  // namespace

std::span<const EntitySpec> texture_table() {
  static const std::vector<EntitySpec> table = [] {
    std::vector<EntitySpec> all = combining_textures();
    for (auto more : {plane_textures(), noise_textures()}) all.insert(all.end(), more.begin(), more.end());
    return all;
  }();
  return table;
}

}  // namespace montelux
