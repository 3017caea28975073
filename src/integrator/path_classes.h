// Which paths from a lamp to the eye an integrator finds: the one table behind warnings, headers and documentation.
#pragma once
#include <array>
#include <optional>
#include <string_view>

namespace montelux {

// Heckbert's classes (1990): L a lamp, D a rough scattering event, S one by a perfect mirror or smooth glass, E the
// eye. Each has a scene with a closed form in scenes/path-classes. The last two are of lamps that no ray meets (point,
// spot, goniometric, projection and distant lights), the others of any lamp.
enum class PathClass { le, lde, lse, lsse, ldse, ldde, lsde, lsdse, lsde_delta, lsdse_delta };
inline constexpr std::array<std::string_view, 10> path_class_names{
    "LE", "LDE", "LSE", "LSSE", "LDSE", "LDD+E", "LSDE", "LSDSE", "LSDE of delta lights", "LSDSE of delta lights"};

// `by_chance`: without bias, where a path from the eye happens to meet the lamp. `refused`: scenes with such paths are
// not rendered at all. `short_chains`: where there are no more specular events between the lamp and the rough surface
// than a setting states.
enum class Finding { yes, by_chance, no, refused, short_chains };
inline constexpr std::array<std::string_view, 5> finding_names{"yes", "by chance", "no", "refused", "short chains"};

// How an integrator looks for light: by paths of any length from the eye, the same with connections to delta lights
// through specular chains, by one scattering event, between diffuse surfaces alone, by paths from the lights whose
// vertices it connects with the lens, by paths from both ends that are connected, by photons, or not at all, since its
// pictures show something else.
enum class LightSearch { any_length, with_chains, one_event, diffuse, from_lights, both_ends, photons, none };

// None where an integrator does not show light.
std::optional<Finding> finding(LightSearch search, PathClass path_class);

}  // namespace montelux
