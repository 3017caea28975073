// Parts of an image's light that sum to it: by bounce, by light group, by technique.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "color/rgb.h"
#include "math/exact_sum.h"

namespace montelux {

// How the light of a path was found: emission that the camera sees directly, a light sample, a scattered ray that hit a
// lamp, a scattered ray that left the scene.
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
  // Keep the spread over passes, for standard errors and for the share of each layer in the variance of the image.
  bool spread = false;
  std::vector<std::uint32_t> group_of_light;  // by the light's number
  std::vector<std::string> group_names;

  int bounce_count() const { return bounces ? *bounces + 2 : 0; }
  int group_count() const { return light_groups ? int(group_names.size()) : 0; }
  int count() const { return bounce_count() + group_count() + (techniques ? int(technique_names.size()) : 0); }
};

// "bounce0" ... "bounce_rest"; "Combined_key" for the group "key" (Blender's name for the pass); "technique_"
// and a name of technique_names. In the order of the layers.
std::vector<std::string> layer_names(const LayerPlan& plan);

// The layers of one family, by the name of the family: their numbers from `first`.
struct LayerFamily {
  std::string name;  // "bounces", "light groups", "techniques"
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
