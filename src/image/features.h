// What a camera path shows of the first surface, and the one table of the features that a film averages and a picture
// has as layers.
#pragma once
#include <array>
#include <cstdint>
#include <limits>
#include <string_view>

#include "color/rgb.h"
#include "math/vec.h"

namespace montelux {

// The first surface on a camera path; coverage 0: the path left the scene. Albedo and normal are those of the first
// surface that scatters, where the path comes to it by way of perfect mirrors and smooth glass alone.
struct Features {
  Rgb emission{};  // radiance that reaches the camera directly from an emitter, as part of the sample's
  Rgb albedo{};    // estimate of the directional albedo, multiplied by what mirrors and glass before it leave of light
  Vec3f normal{};  // shading normal, world space, facing the ray that met the surface
  Vec3f position{};  // world space
  float depth = 0;   // distance along the ray from the camera's origin
  float coverage = 0;
  std::uint32_t object = 0;  // number of the object, from 1; 0: none
  // Of which the emission is the mean: as many as have its variance if they are over all of the pixel's filter; at most
  // max_emission_rays.
  std::uint32_t emission_rays = 1;
};
inline constexpr std::uint32_t max_emission_rays = 1 << 16;

// A feature whose layer is the mean over the samples that hit a surface.
struct FeatureRow {
  std::string_view layer;     // its channels are "layer.X" or, without a name, "X"
  std::string_view channels;  // a letter for each
  float (*value)(const Features& sample, int channel);
  double limit;    // the largest absolute value of a sample; values beyond it count as it
  bool fits_half;  // 16-bit floats keep what it is for, unlike that of a position
};
inline constexpr double no_feature_limit = std::numeric_limits<double>::infinity();

constexpr float component(const Vec3f& v, int i) { return i == 0 ? v.x : i == 1 ? v.y : v.z; }

inline constexpr std::array<FeatureRow, 4> feature_rows{
    {{"", "Z", [](const Features& f, int) { return f.depth; }, no_feature_limit, false},
     {"P", "XYZ", [](const Features& f, int c) { return component(f.position, c); }, no_feature_limit, false},
     {"albedo", "RGB", [](const Features& f, int c) { return f.albedo.c[c]; }, 64, true},
     {"N", "XYZ", [](const Features& f, int c) { return component(f.normal, c); }, 1, true}}};

// A channel of the table: its row, and its number there.
struct FeatureChannel {
  std::size_t row;
  int channel;
};
inline constexpr std::size_t feature_channel_count = [] {
  std::size_t count = 0;
  for (const FeatureRow& row : feature_rows) count += row.channels.size();
  return count;
}();
// All of them, in their order.
inline constexpr auto feature_channels = [] {
  std::array<FeatureChannel, feature_channel_count> all{};
  std::size_t i = 0;
  for (std::size_t row = 0; row < feature_rows.size(); ++row)
    for (std::size_t c = 0; c < feature_rows[row].channels.size(); ++c) all[i++] = {row, int(c)};
  return all;
}();
constexpr double feature_limit(std::size_t channel) { return feature_rows[feature_channels[channel].row].limit; }
// The number of the first channel of a layer; of a layer without a name, by the name of its channel.
consteval std::size_t feature_channel(std::string_view name) {
  for (std::size_t i = 0; i < feature_channel_count; ++i) {
    const FeatureRow& row = feature_rows[feature_channels[i].row];
    if (row.layer == name || (row.layer.empty() && row.channels == name)) return i;
  }
  throw "no layer has this name";
}

}  // namespace montelux
