// Passes whose samples pixels share.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include "film/film.h"
#include "filter/sample_sharing.h"
#include "integrator/integrator.h"
#include "render/image_settings.h"
#include "render/pass_plan.h"

namespace montelux {

// How pixels of images with this filter share samples; null where it would hardly lower their errors.
std::shared_ptr<const SampleSharing> sharing_for(const Filter& filter);

// Whether pixels of the image share the samples of integrators of pixels: not where these sum layers by themselves. And
// those of this integrator: not of a coupled one.
bool filters_share_samples(const ImageSettings& image);
bool filters_share_samples(const ImageSettings& image, const AnyIntegrator& integrator);

// Lets tiles be as wide as large images allow, so that fewer pixels are traced around them.
void widen_tiles(const PixelBounds& image, PassPlan& plan);

// One pass of a tile: which pixels are traced, at which offsets, and what all of their samples count for.
class SharedSamples {
 public:
  SharedSamples(const SampleSharing& sharing, const PixelBounds& tile, const PointSet& points);

  // The pixels whose samples count in the tile: also those around it, and around the image.
  PixelBounds around() const;
  // Of the samples of each pixel, in their order.
  std::span<const Vec2f> offsets() const { return offsets_; }
  // The sums of the tile's pixels in row-major order. `samples`: of the pixels around, in row-major order, those of one
  // pixel consecutive.
  void sum(std::span<const PixelSample> samples, std::vector<PixelPass>& pixels) const;

 private:
  PixelBounds tile_;
  int reach_x_, reach_y_;
  std::vector<SampleSharing::Weights> weights_;  // by sample
  std::vector<Vec2f> offsets_;
};

}  // namespace montelux
