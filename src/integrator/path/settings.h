// Settings of the path integrator.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>

#include "integrator/path/lamp_pixels.h"
#include "light/light.h"
#include "parameter/choice.h"
#include "parameter/fields.h"

namespace montelux {

template <std::uint32_t side>
class DirectionField;
using GuideField = DirectionField<16>;
class ManifoldLight;
class SurvivalMap;
struct LearnedLights;

// How many paths run side by side: `one` is the same loop over single floats, for tests and comparisons.
enum class Lanes { one, native };
NamedValues<Lanes> lanes_names();
// The row of the maximum depth, which the catalogue reads, since a scene may state it too.
ParameterSpec max_depth_spec();
inline constexpr int max_lamp_rays = 128;
inline constexpr char lamp_rays_meaning[] =
    "camera rays of each sample that show lamps in view, in pixels where lamps may be seen in part; 0: the sample's "
    "own";

// How next-event estimation and BSDF sampling share the light that both can find; `off`: it is all next-event
// estimation's where the surface is not a mirror; `automatic`: by the power heuristic, except that light from infinity
// is shared by the balance heuristic where its images are compensated (LightSet::compensated).
enum class PathMis { off, balance, power, automatic };

// What decides whether a path survives. `throughput`: the square root of the product of its weights; `proportional`:
// that product itself, so that survivors weigh alike; `fixed`: always the same probability; `efficiency`: the one that
// a pilot found to make variance times cost least.
enum class PathRoulette { off, throughput, proportional, fixed, efficiency };

struct LightWeights {
  bool nee;
  PathMis mis;
};

struct PathSettings {
  // Scattering events at most; none: paths end by roulette alone, without bias.
  std::optional<int> max_depth;
  // Next-event estimation; without it a path waits to hit a light (those that no ray can hit are still sampled).
  bool nee = true;
  PathMis mis = PathMis::automatic;
  PathRoulette roulette = PathRoulette::throughput;
  float fixed_survival = 0.5f;  // of PathRoulette::fixed
  // Of PathRoulette::efficiency: the size of the picture, for the pilot, and what that found; made where there is none.
  int width = 0, height = 0;
  std::shared_ptr<const SurvivalMap> survival;
  // How lights are chosen; none: as the scene says.
  std::optional<LightSelection> light_selection;
  // By the hierarchy, with what so many paths before the render have found of which lights are hidden.
  bool learned_selection = false;
  int light_paths = 1 << 15;
  // Next-event estimation by one out of so many candidates, chosen by their contributions; 0: by a single one.
  int candidates = 0;
  // Specular events at most between a rough surface and a delta light whose light is looked for by walks on manifolds;
  // 0: none. What looks for it, made where there is none.
  int manifold = 0;
  // GGX alpha of the surfaces that count as specular there, at most; 0: smooth ones alone.
  float manifold_roughness = 0.01f;
  std::shared_ptr<const ManifoldLight> manifold_light;
  // Directions by a field that is learned before the render from so many paths; the field, made where there is none.
  bool guiding = false;
  int guiding_paths = 1 << 20;
  std::shared_ptr<const GuideField> guide;
  // Next-event estimation toward the brightest light from infinity from where so many paths before the render have
  // found that it is visible.
  bool sky_learning = false;
  int sky_paths = 1 << 16;
  // What learned_selection and sky_learning have learned, made where there is none.
  std::shared_ptr<const LearnedLights> learned;
  // Rays for each sample of a pixel in which lamps may be in view, which show their light; 0: the sample's own ray
  // shows it. Where they may be, made where there is none.
  int lamp_rays = 4;
  std::shared_ptr<const LampPixels> lamp_pixels;
  // Scattering events before roulette begins.
  int roulette_depth = 2;
  Lanes lanes = Lanes::native;

  LightWeights light_weights() const { return {nee, mis}; }
  LampRays lamps() const { return {lamp_pixels.get(), std::uint32_t(lamp_rays)}; }
};

EntitySpec path_spec();
// The same without next-event estimation, under a name of its own.
EntitySpec naive_spec();
// max_depth is that of the request, since a scene may state it too. Fails where paths would never end: no roulette and
// no greatest depth.
Result<PathSettings> path_settings(const ParameterList& list, std::optional<int> max_depth);

}  // namespace montelux
