// Any integrator with its brightest samples cut: less noise, and a bias.
#pragma once
#include <memory>

#include "integrator/integrator.h"

namespace montelux {

// Samples with a component above `limit` are scaled down to it.
inline void clamp_samples(std::span<PixelSample> samples, float limit) {
  for (PixelSample& sample : samples) {
    const float brightest = max_component(sample.light());
    if (!(brightest > limit)) continue;
    for (Rgb* light : {&sample.radiance, &sample.emission, &sample.lamps}) *light = *light * (limit / brightest);
  }
}

class ClampedIntegrator final : public PixelIntegrator {
 public:
  ClampedIntegrator(std::unique_ptr<PixelIntegrator> inner, float limit) : inner_(std::move(inner)), limit_(limit) {}

  RayCounts trace(const TilePass& pass, std::span<PixelSample> out) const override {
    const RayCounts counts = inner_->trace(pass, out);
    clamp_samples(out, limit_);
    return counts;
  }
  std::optional<TracedPath> trace_path(const TilePass& pass) const override {
    std::optional<TracedPath> path = inner_->trace_path(pass);
    if (!path) return path;
    PixelSample sample;
    sample.radiance = path->radiance;
    clamp_samples({&sample, 1}, limit_);
    path->radiance = sample.radiance;
    return path;
  }

 private:
  std::unique_ptr<PixelIntegrator> inner_;
  float limit_;
};

class ClampedCoupledIntegrator final : public CoupledIntegrator {
 public:
  ClampedCoupledIntegrator(std::unique_ptr<CoupledIntegrator> inner, float limit)
      : inner_(std::move(inner)), limit_(limit) {}

  int frames() const override { return inner_->frames(); }
  int warm_up() const override { return inner_->warm_up(); }
  int stages() const override { return inner_->stages(); }
  std::unique_ptr<FrameSeries> begin(const SeriesPass& pass) const override {
    return std::make_unique<ClampedSeries>(inner_->begin(pass), inner_->stages() - 1, limit_);
  }

 private:
  class ClampedSeries final : public FrameSeries {
   public:
    ClampedSeries(std::unique_ptr<FrameSeries> inner, int last_stage, float limit)
        : inner_(std::move(inner)), last_stage_(last_stage), limit_(limit) {}
    std::optional<std::size_t> units(const SeriesStep& step) const override { return inner_->units(step); }
    RayCounts run_unit(const SeriesStep& step, std::size_t unit) override { return inner_->run_unit(step, unit); }
    RayCounts run(const SeriesStep& step, const PixelBounds& tile, std::span<PixelSample> out) override {
      const RayCounts counts = inner_->run(step, tile, out);
      if (step.stage == last_stage_) clamp_samples(out, limit_);
      return counts;
    }
    std::unique_ptr<SeriesMemory> remember(int frames) override { return inner_->remember(frames); }
    // Not measured_bias(), which is that of samples that are not scaled down.
    std::optional<MixingFigures> mixing() const override { return inner_->mixing(); }

   private:
    std::unique_ptr<FrameSeries> inner_;
    int last_stage_;
    float limit_;
  };

  std::unique_ptr<CoupledIntegrator> inner_;
  float limit_;
};

}  // namespace montelux
