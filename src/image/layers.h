// Parts of a picture's light that sum to it: by bounce, by group of lights, by technique.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "color/spectrum.h"
#include "math/exact_sum.h"

namespace montelux {

// By what a path's light was found: emission that the camera sees, a light sample, a scattered ray that met a lamp, a
// scattered ray that left the scene.
enum class Technique : std::uint32_t { emission, light_sampling, bsdf_sampling, environment };
inline constexpr std::array<std::string_view, 4> technique_names{"emission", "light-sampling", "bsdf-sampling",
                                                                 "environment"};

// The families of layers of one render. Each family by itself parts all light: every contribution of a path goes to
// one layer of each family.
struct LayerPlan {
  // Bounces 0 (emission seen directly) to this one have a layer each, and one holds the rest.
  std::optional<int> bounces;
  bool light_groups = false;
  bool techniques = false;
  // Keep the spread over passes, for standard errors and for what each layer adds to the picture's variance.
  bool spread = false;
  std::vector<std::uint32_t> group_of_light;  // by the light's number
  std::vector<std::string> group_names;

  int bounce_count() const { return bounces ? *bounces + 2 : 0; }
  int group_count() const { return light_groups ? int(group_names.size()) : 0; }
  int count() const { return bounce_count() + group_count() + (techniques ? int(technique_names.size()) : 0); }
};

// "bounce0" ... "bounce_rest"; "Combined_key" of the group "key" (as Blender's render passes are called); "technique_"
// and a name of technique_names. In the layers' order.
std::vector<std::string> layer_names(const LayerPlan& plan);

// Which layers make up one family, by the name of the family: their numbers from `first`.
struct LayerFamily {
  std::string name;  // "bounces", "light groups", "techniques"
  int first = 0, count = 0;
};
std::vector<LayerFamily> layer_families(const LayerPlan& plan);

// Light of one layer, in each channel.
struct ExactRgb {
  ExactSum c[spectrum_size];
  ExactRgb& operator+=(const ExactRgb& other) {
    for (int i = 0; i < spectrum_size; ++i) c[i] += other.c[i];
    return *this;
  }
  bool operator==(const ExactRgb&) const = default;
};

}  // namespace montelux
