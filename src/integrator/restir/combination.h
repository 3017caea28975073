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
Spectrum<F> light_of(const Shifted<PathSample<F>, F>& image) {
  return image.value.contribution;
}

template <class F, class Rays>
class ReuseCombination {
 public:
  using M = Mask<F>;
  // `shared`, `inputs` and `counts` must outlive it.
  ReuseCombination(const RestirScene<Rays>& shared, ReuseInputs<F>& inputs, RayCounts& counts)
      : settings_(shared.settings),
        inputs_(inputs),
        lights_{shared.lights.bvh, shared.rays, inputs.vertices, settings_.visibility_reuse, counts},
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

  // Every input becomes the combination of all in its own place. Gives the light of each, likewise.
  std::vector<Spectrum<F>> into_each(const RandomStream<F>& numbers, M on, const ImageSums& sums) {
    std::vector<Spectrum<F>> light(inputs_.vertices.size(), gray(F(0.0f)));
    if (settings_.direct) into_each(inputs_.lights, lights_, numbers, on, sums.lights, light);
    if (settings_.indirect.on) into_each(inputs_.paths, paths_, of_paths(numbers), on, sums.paths, light);
    return light;
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
  template <class T, class Domains>
  void into_each(std::vector<Reservoir<T, F>>& inputs, const Domains& domains, const RandomStream<F>& numbers, M on,
                 bool sums, std::vector<Spectrum<F>>& light) const {
    const auto add = [&](std::size_t k, const auto& image, const F& weight, M adds) {
      if (sums) light[k] += select(adds, light_of(image) * weight, gray(F(0.0f)));
    };
    combine_group<T, F>(inputs, domains, numbers, on, add);
  }

  const RestirSettings& settings_;
  ReuseInputs<F>& inputs_;
  const LightPointDomains<F, Rays> lights_;
  const PathScene<Rays> scene_;
  const PathDomains<F, Rays> paths_;
};

}  // namespace montelux
