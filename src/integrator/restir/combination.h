// Combines the reservoirs of several pixels to one, or to one for each of them, and computes their light.
#pragma once
#include "integrator/restir/first_stage.h"
#include "integrator/restir/inputs.h"
#include "integrator/restir/light_point_shift.h"
#include "mc/reuse_group.h"
#include "transport/dimensions.h"

namespace montelux {

// Which kinds of samples are shown as the sum over all that are combined, and not as the chosen one alone: those whose
// targets include visibility, where shares sum to one for each sample.
struct ImageSums {
  bool lights = false, paths = false;
};

template <class F>
Spectrum<F> light_of(const ShiftedLight<F>& image) {
  return image.scattered;
}
template <class F>
Spectrum<F> light_of(const LightPointImage<F>& image) {
  return image.scattered;
}
template <class F>
Spectrum<F> light_of(const Shifted<PathSample<F>, F>& image) {
  return image.value.contribution;
}
template <class F>
Spectrum<F> light_of(const PathImage<F>& image) {
  return image.contribution;
}

// What the pixels of a group have chosen, input by input, and their light of those kinds of samples that are shown as
// sums.
template <class F>
struct GroupResult {
  std::vector<GroupChoice<LightPointImage<F>, F>> lights;  // none where they are not reused
  std::vector<GroupChoice<PathImage<F>, F>> paths;
  std::vector<Spectrum<F>> light;
};

template <class F, class Rays>
class ReuseCombination {
 public:
  using M = Mask<F>;
  // `shared`, `inputs` and `counts` must outlive it.
  ReuseCombination(const RestirScene<Rays>& shared, ReuseInputs<F>& inputs, RayCounts& counts)
      : settings_(shared.settings),
        inputs_(inputs),
        lights_{shared.scene.media, shared.lights.bvh,          shared.rays,
                inputs.vertices,    settings_.visibility_reuse, counts},
        scene_(shared.paths()),
        paths_{scene_, inputs.vertices, counts} {}

  // The first input becomes the combination of all. Gives the light that its pixel has of those kinds that `sums`
  // names.
  Spectrum<F> into_first(const RandomStream<F>& numbers, M on, const ImageSums& sums) {
    Spectrum<F> radiance = gray(F(0.0f));
    if (settings_.direct) radiance += into_first(inputs_.lights, lights_, numbers, on, sums.lights);
    if (settings_.indirect.on) radiance += into_first(inputs_.paths, paths_, of_paths(numbers), on, sums.paths);
    return radiance;
  }

  // For every input the combination of all in its own place, and its light, likewise.
  GroupResult<F> group_result(const RandomStream<F>& numbers, M on, const ImageSums& sums) const {
    GroupResult<F> result;
    result.light.assign(inputs_.vertices.size(), gray(F(0.0f)));
    const auto combined = [&](const auto& inputs, const auto& domains, const RandomStream<F>& own, bool adds_all) {
      return combine_group(std::span(inputs), domains, own, on,
                           [&](std::size_t k, const auto& image, const F& weight, M adds) {
                             if (!adds_all) return;
                             result.light[k] += select(adds, light_of(image) * weight, gray(F(0.0f)));
                           });
    };
    if (settings_.direct) result.lights = combined(inputs_.lights, lights_, numbers, sums.lights);
    if (settings_.indirect.on) result.paths = combined(inputs_.paths, paths_, of_paths(numbers), sums.paths);
    return result;
  }

 private:
  static RandomStream<F> of_paths(const RandomStream<F>& numbers) { return numbers.fork(Uint<F>(restir_stream::path)); }

  // The light of all samples, as the first vertex has it.
  struct LightOfAll {
    Spectrum<F> own_light;
    Spectrum<F> sum = gray(F(0.0f));
    void own(const F& weight, M on) { add(own_light, weight, on); }
    template <class Image>
    void other(const Image& image, const F& weight, M on) {
      add(light_of(image), weight, on);
    }

   private:
    void add(const Spectrum<F>& radiance, const F& weight, M on) {
      sum += select(on, radiance * weight, gray(F(0.0f)));
    }
  };

  template <class T, class Domains>
  Spectrum<F> into_first(std::vector<Reservoir<T, F>>& inputs, const Domains& domains, RandomStream<F> numbers, M on,
                         bool sums) const {
    const std::span<const Reservoir<T, F>> all_inputs(inputs);
    if (!sums) {
      inputs[0] = combine<T, F>(settings_.weights, all_inputs, domains, numbers, on);
      return gray(F(0.0f));
    }
    LightOfAll all{light_of(domains.own(0, inputs[0].value, on))};
    inputs[0] = combine<T, F>(settings_.weights, all_inputs, domains, numbers, on, all);
    return all.sum;
  }

  const RestirSettings& settings_;
  ReuseInputs<F>& inputs_;
  const LightPointDomains<F, Rays> lights_;
  const PathScene<Rays> scene_;
  const PathDomains<F, Rays> paths_;
};

}  // namespace montelux
