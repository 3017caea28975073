// Parts of an image's light that sum to it: by bounce, by light group, by technique.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "color/rgb.h"
#include "math/exact_sum.h"

namespace montelux {

// How the light of a path from the eye was found: emission that the camera sees directly, a light sample, a scattered
// ray that hit a lamp, a scattered ray that left the scene.
enum class Technique : std::uint32_t { emission, light_sampling, bsdf_sampling, environment };
inline constexpr std::array<std::string_view, 4> technique_names{"emission", "light-sampling", "bsdf-sampling",
                                                                 "environment"};

// The families of layers of one render. Each family is a partition of all light: every contribution of a path belongs
// to one layer of each family.
struct LayerPlan {
  // Bounces 0 (emission seen directly) to this one have one layer each; another layer holds the rest.
  std::optional<int> bounces;
  bool light_groups = false;
  bool techniques = false;
  // Of bidirectional integrators: one layer for each strategy, as below, for bounces 0 to this one.
  std::optional<int> strategies;
  bool mergings = false;  // strategies merge vertices, too
  // Each of these strategies also by itself, without the weight by which they share the light: every one of these
  // layers has the expectation of the light that the strategy can find. They are no partition.
  bool alone = false;
  // Keep the spread over passes, for standard errors and for the share of each layer in the variance of the image.
  bool spread = false;
  std::vector<std::uint32_t> group_of_light;  // by the light's number
  std::vector<std::string> group_names;

  int bounce_count() const { return bounces ? *bounces + 2 : 0; }
  int group_count() const { return light_groups ? int(group_names.size()) : 0; }
  int technique_count() const { return techniques ? int(technique_names.size()) : 0; }
  // Connections of every bounce, mergings, and one layer for the rest.
  int strategy_count() const { return strategies ? first_merging() + (mergings ? triangle(*strategies) : 0) + 1 : 0; }
  int alone_count() const { return strategies && alone ? strategy_count() - 1 : 0; }
  int count() const { return bounce_count() + group_count() + technique_count() + strategy_count() + alone_count(); }

  // The strategy with this many vertices drawn from the light, among those of this bounce; `merged`: its last vertex
  // from the light is merged with one from the eye, else the two are connected. The last number is that of the rest.
  int strategy_number(std::uint32_t bounce, std::uint32_t light_vertices, bool merged) const {
    if (bounce > std::uint32_t(*strategies)) return strategy_count() - 1;
    const int b = int(bounce), s = int(light_vertices);
    return merged ? first_merging() + triangle(b - 1) + s - 2 : connections_below(b) + s;
  }

 private:
  // A path of b bounces has b + 2 vertices: from 0 to b + 1 of them are drawn from the light.
  static int connections_below(int bounce) { return bounce * (bounce + 3) / 2; }
  // b of them may be merged.
  static int triangle(int bounce) { return bounce * (bounce + 1) / 2; }
  int first_merging() const { return connections_below(*strategies + 1); }
};

// "bounce0" ... "bounce_rest"; "Combined_key" for the group "key" (Blender's name for the pass); "technique_"
// and a name of technique_names; "strategy_s1_t2" for s vertices from the light that are connected with t from the eye
// (the one at the light and the one at the lens included; s = 0: the path from the eye meets the light),
// "merging_s2_t2" where the last ones are merged, and "strategy_rest"; "alone_s1_t2", "alone_merging_s2_t2". In the
// order of the layers.
std::vector<std::string> layer_names(const LayerPlan& plan);
// The family of a layer of light by its name in files: the name of a LayerFamily, or "" for a layer that belongs to no
// partition; nothing for layers that are not of light.
std::optional<std::string_view> layer_family(std::string_view layer_name);

// The layers of one family, by the name of the family: their numbers from `first`. Every family sums to all light.
struct LayerFamily {
  std::string name;  // "bounces", "light groups", "techniques", "strategies"
  int first = 0, count = 0;
};
std::vector<LayerFamily> layer_families(const LayerPlan& plan);

// The light of one layer, in each channel.
struct ExactRgb {
  ExactSum c[rgb_size];
  ExactRgb& operator+=(const ExactRgb& other) {
    for (int i = 0; i < rgb_size; ++i) c[i] += other.c[i];
    return *this;
  }
  bool operator==(const ExactRgb&) const = default;
};

}  // namespace montelux
