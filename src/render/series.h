// Renders with series of frames, for integrators whose pixels share information.
#pragma once
#include "render/render.h"

namespace montelux {

// Implements render() for coupled integrators. Threads share the units of each step of a series, and wait for each
// other between steps. A render that is stopped ends between frames. Its last series counts as a pass with fewer
// frames: it has the right mean, and passes are independent, so that their spread is still a valid error bar.
RenderResult render_series(const CoupledIntegrator& integrator, const RenderSettings& settings,
                           RenderObserver& observer);

// The passes of a pixel integrator as series of one frame: at all times all pixels have equally many passes, and no
// part of the image lacks samples when time ends.
class PassesAsSeries final : public CoupledIntegrator {
 public:
  // The integrator must outlive this.
  explicit PassesAsSeries(const PixelIntegrator& integrator) : integrator_(integrator) {}
  int frames() const override { return 1; }
  int warm_up() const override { return 0; }
  int stages() const override { return 1; }
  std::unique_ptr<FrameSeries> begin(const SeriesPass& pass) const override {
    return std::make_unique<OnePass>(integrator_, pass);
  }

 private:
  class OnePass final : public FrameSeries {
   public:
    OnePass(const PixelIntegrator& integrator, const SeriesPass& pass) : integrator_(integrator), pass_(pass) {}
    RayCounts run(const SeriesStep&, const PixelBounds& tile, std::span<PixelSample> out) override {
      return integrator_.trace({tile, pass_.points, pass_.shutter, {}, {}, pass_.grid}, out);
    }

   private:
    const PixelIntegrator& integrator_;
    SeriesPass pass_;
  };
  const PixelIntegrator& integrator_;
};

}  // namespace montelux
