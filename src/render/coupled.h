// Renders by chains of frames, for integrators whose pixels learn from each other.
#pragma once
#include "render/render.h"

namespace montelux {

// As render(), of which it is a part. Threads share the tiles of a step of the chain and wait for each other between
// steps. A render that is stopped ends between frames, and its last chain counts as a pass of fewer frames: it has the
// right mean, and passes are independent, so their spread stays an honest error bar.
RenderResult render_chains(const CoupledIntegrator& integrator, const RenderSettings& settings,
                           RenderObserver& observer);

// The passes of a pixel integrator, a sample a pixel each, as chains of one frame: so that all of the picture is as far
// at every moment, and none of it is left behind where time ends.
class PassesAsChains final : public CoupledIntegrator {
 public:
  // The integrator must outlive this.
  explicit PassesAsChains(const PixelIntegrator& integrator) : integrator_(integrator) {}
  int frames() const override { return 1; }
  int warm_up() const override { return 0; }
  int stages() const override { return 1; }
  std::unique_ptr<Chain> begin(const ChainPass& pass) const override {
    return std::make_unique<OnePass>(integrator_, pass);
  }

 private:
  class OnePass final : public Chain {
   public:
    OnePass(const PixelIntegrator& integrator, const ChainPass& pass) : integrator_(integrator), pass_(pass) {}
    RayCounts run(const ChainStep&, const PixelBounds& tile, std::span<PixelSample> out) override {
      return integrator_.trace({tile, pass_.points, pass_.shutter}, out);
    }

   private:
    const PixelIntegrator& integrator_;
    ChainPass pass_;
  };
  const PixelIntegrator& integrator_;
};

}  // namespace montelux
