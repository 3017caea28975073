// What a render measures: the random variable whose passes are collected by the film.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>

#include "camera/shutter.h"
#include "filter/sample_sharing.h"
#include "image/layers.h"
#include "image/pixel_sample.h"
#include "mc/point_set.h"

namespace montelux {

struct ImageSettings {
  PixelBounds bounds;         // of the image, or of the crop; within width x height
  int width = 0, height = 0;  // of the full image
  PointSetKind sampler = PointSetKind::blue_noise;
  std::uint32_t seed = 0;
  std::optional<Shutter> shutter;   // instead of the scene's
  std::optional<LayerPlan> layers;  // only for integrators that have layers
  bool halves = false;              // the film stores both halves of the passes
  Rgb max_chance_radiance{};        // as Film has it
  // Pixels share the samples of integrators of pixels; null: each sample is drawn from the filter of its own pixel.
  std::shared_ptr<const SampleSharing> sharing;

  PointSet points(int pass, int samples_per_pass) const {
    return {sampler, seed, std::uint32_t(pass), std::uint32_t(samples_per_pass)};
  }
};

}  // namespace montelux
