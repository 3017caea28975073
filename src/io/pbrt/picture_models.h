// What a pbrt file may state about the picture and how to compute it, in the words of pbrt.
#pragma once
#include "parameter/models.h"
#include "scene/description.h"

namespace montelux::pbrt {

// What a Sampler directive states.
struct StatedSampler {
  PointSetKind points = PointSetKind::blue_noise;
  int samples = 16;                // per pixel
  int x_strata = 4, y_strata = 4;  // of a jittered grid, instead of `samples`
  bool jitter = true;
  std::string randomization{};
  std::optional<int> seed{};
};

enum class StatedLightSampler { uniform, power, bvh, exhaustive };

// What an Integrator directive states.
struct StatedIntegrator {
  std::string name = "path";  // ours
  std::optional<int> max_depth{};
  StatedLightSampler light_sampler = StatedLightSampler::bvh;
  bool sample_lights = true;
  bool cosine_directions = true;        // of ambient occlusion
  std::optional<float> max_distance{};  // of occluders
  int photons = -1;                     // in each frame; not positive: one per pixel
  std::optional<float> radius{};        // of photon mapping
  std::optional<float> large_step{};    // probability
  std::optional<int> mutations{};       // per pixel: the number of samples
  std::optional<int> seed{};
};

// What the Option directives state.
struct StatedOptions {
  std::optional<int> seed{};
  bool pixel_centres = false;
};

const Models<FilmDesc>& film_models();
// `instead` of a sampler is the name of the point set that replaces it.
const Models<StatedSampler>& sampler_models();
const Models<StatedIntegrator>& integrator_models();
// One name, whose parameters are the options.
const Models<StatedOptions>& option_models();
// Accepted for compatibility with files that name one; the ray-tracing kernel builds its own.
const Models<Done>& accelerator_models();

}  // namespace montelux::pbrt
