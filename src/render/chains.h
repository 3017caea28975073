// Renders with chains of frames, for integrators whose pixels share information.
#pragma once
#include "render/render.h"

namespace montelux {

// Implements render() for coupled integrators. Threads share the tiles of each step of a chain, and wait for each other
// between steps. A render that is stopped ends between frames. Its last chain counts as a pass with fewer frames: it
// has the right mean, and passes are independent, so that their spread is still a valid error bar.
RenderResult render_chains(const CoupledIntegrator& integrator, const RenderSettings& settings,
                           RenderObserver& observer);

// The passes of a pixel integrator as chains of one frame: at every moment all pixels have equally many passes, and no
// part of the image lacks samples when time ends.
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
      return integrator_.trace({tile, pass_.points, pass_.shutter, {}, {}, pass_.grid}, out);
    }

   private:
    const PixelIntegrator& integrator_;
    ChainPass pass_;
  };
  const PixelIntegrator& integrator_;
};

}  // namespace montelux
