// Any integrator with its brightest samples cut: less noise, and a bias.
#pragma once
#include <memory>

#include "integrator/integrator.h"

namespace montelux {

// Samples with a component above `most` are scaled down until it is `most`.
class ClampedIntegrator final : public PixelIntegrator {
 public:
  ClampedIntegrator(std::unique_ptr<PixelIntegrator> inner, float most) : inner_(std::move(inner)), most_(most) {}

  RayCounts trace(const TilePass& pass, std::span<PixelSample> out) const override {
    const RayCounts counts = inner_->trace(pass, out);
    for (PixelSample& sample : out) {
      const float brightest = max_component(sample.radiance);
      if (brightest > most_) sample.radiance *= gray(most_ / brightest);
    }
    return counts;
  }

 private:
  std::unique_ptr<PixelIntegrator> inner_;
  float most_;
};

}  // namespace montelux
