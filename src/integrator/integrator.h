// The interface between the scheduler and integrators. Integrators know no threads, no film and no files.
#pragma once
#include <array>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>

#include "camera/shutter.h"
#include "image/layers.h"
#include "image/pixel_sample.h"
#include "integrator/traced_path.h"
#include "mc/mixing.h"
#include "mc/point_set.h"

namespace montelux {

// Whether the current work should stop. May be called from many threads at once.
class StopQuery {
 public:
  virtual ~StopQuery() = default;
  virtual bool stop_requested() const = 0;
};

// One pass over one tile: every pixel of the tile takes points.samples_per_pass samples. Frames of coupled
// integrators, traced paths and measurements of bias request a single sample.
struct TilePass {
  PixelBounds tile;
  PointSet points;
  std::optional<Shutter> shutter{};       // instead of the scene's
  std::optional<std::uint32_t> only{};    // this one of the samples alone
  std::optional<float> shutter_sample{};  // in [0, 1), of the exposure: of all samples; else each has its own
  std::optional<PixelGrid> grid{};        // the tile counts the cells of this grid; else pixels
  // Of the samples of every pixel, in their order, from its centre: pixels share samples, so that those of a tile may
  // lie outside the image. Empty: each sample is drawn from the filter of its own pixel.
  std::span<const Vec2f> offsets{};
  const StopQuery* stop = nullptr;  // once it wants a stop, the tile may be left unfinished: the caller drops it
  std::uint32_t samples() const { return only ? 1 : points.samples_per_pass; }
  bool stop_requested() const { return stop && stop->stop_requested(); }
};

// Rays that were traced, for statistics.
struct RayCounts {
  std::uint64_t camera = 0, scattered = 0, shadow = 0;
  // Camera rays, rays after one scattering event, after two, ...; the last holds all that are deeper. Only integrators
  // that branch fill it.
  std::array<std::uint64_t, 16> by_depth{};
  RayCounts& operator+=(const RayCounts& other) {
    camera += other.camera, scattered += other.scattered, shadow += other.shadow;
    for (std::size_t i = 0; i < by_depth.size(); ++i) by_depth[i] += other.by_depth[i];
    return *this;
  }
  std::uint64_t all() const { return camera + scattered + shadow; }
};

// Maps (pixel, point of the pass) to radiance. A pure function of the scene, the settings and the pass: it may be
// called from many threads at once.
class PixelIntegrator {
 public:
  virtual ~PixelIntegrator() = default;
  // Fills `out`: pixels of the tile in row-major order, the samples of one pixel consecutive.
  virtual RayCounts trace(const TilePass& pass, std::span<PixelSample> out) const = 0;

  // Whether trace_layers() is there.
  virtual bool has_layers() const { return false; }
  // The same, and adds the contributions of the samples to sums: for each pixel of the tile, plan.count() + 1
  // consecutive sums, all light and then the layers. Samples that are not finite are excluded from the sums.
  virtual RayCounts trace_layers(const TilePass&, const LayerPlan&, std::span<PixelSample>, std::span<ExactRgb>) const {
    throw std::logic_error("this integrator has no layers");
  }

  // The path of the sample `pass.only` of the first pixel of the tile; none: the integrator cannot show it.
  virtual std::optional<TracedPath> trace_path(const TilePass&) const { return std::nullopt; }
};

// ---- pixels that share samples
// ---------------------------------------------------------------------------------------

// State passed to the series of the same number in the next picture of a sequence. Opaque outside the integrator that
// wrote it.
class SeriesMemory {
 public:
  virtual ~SeriesMemory() = default;
  virtual std::size_t bytes() const = 0;
};

// One pass of a coupled integrator: the pixels of the picture or of its crop. Every pixel takes one sample in each of
// points.samples_per_pass frames. With a grid the pass is that of a smaller picture whose pixels are the cells: bounds
// and tiles count cells, and a cell shows what the pixel shows that represents it, or the mean of its pixels.
struct SeriesPass {
  PixelBounds bounds;
  PointSet points;
  std::optional<Shutter> shutter{};              // instead of the scene's
  std::shared_ptr<const SeriesMemory> before{};  // of a series of the picture before, on the same scene; null: none
  std::optional<PixelGrid> grid{};               // as TilePass has it; only one with a stride above 1
  const LayerPlan* layers = nullptr;             // must outlive the series; null: there are none
};

// Where a series is: frames follow one another, stages follow one another within a frame.
struct SeriesStep {
  int frame = 0, stage = 0;
};

// By colour.
using MeanDifference = std::array<double, rgb_size>;

// Consecutive frames over all pixels, each of which uses the state of the previous frames. A step may begin when
// all units of the step before it are done; the units of one step may be run by many threads at once. They are the
// tiles of the picture, or parts of what the step works on instead of pixels: light paths, cells of a hash grid,
// elements, Markov chains.
class FrameSeries {
 public:
  virtual ~FrameSeries() = default;
  // How many units the step has, for run_unit(); none: its units are the tiles, for run().
  virtual std::optional<std::size_t> units(const SeriesStep&) const { return std::nullopt; }
  virtual RayCounts run_unit(const SeriesStep&, [[maybe_unused]] std::size_t unit) {
    throw std::logic_error("the units of this step are tiles");
  }
  // The last stage of a frame fills `out`, one sample for each pixel of the tile in row-major order: an unbiased
  // estimate. The other stages leave it alone. The tiles must be the same in all steps.
  virtual RayCounts run(const SeriesStep& step, const PixelBounds& tile, std::span<PixelSample> out) = 0;
  // The same of a pass with layers, whose last stage adds to sums as PixelIntegrator::trace_layers() does.
  virtual RayCounts run_layers(const SeriesStep&, const PixelBounds&, std::span<PixelSample>, std::span<ExactRgb>) {
    throw std::logic_error("this integrator has no layers");
  }
  // Ends the series after `frames` complete frames and returns its state. Null if the integrator passes none on.
  virtual std::unique_ptr<SeriesMemory> remember([[maybe_unused]] int frames) { return nullptr; }
  // How much the picture of the frames so far differs in the mean from unbiased samples that were taken for comparison
  // at some of its samples. None where nothing was compared. Only while no step runs.
  virtual std::optional<MeanDifference> measured_bias() { return std::nullopt; }
  // A whole step over a picture of one tile, by this thread.
  RayCounts run_alone(const SeriesStep& step, const PixelBounds& picture, std::span<PixelSample> out) {
    const std::optional<std::size_t> count = units(step);
    if (!count) return run(step, picture, out);
    RayCounts rays;
    for (std::size_t unit = 0; unit < *count; ++unit) rays += run_unit(step, unit);
    return rays;
  }
  // How the Markov chains of the frames so far have mixed; none where there are none. Only while no step runs.
  virtual std::optional<MixingFigures> mixing() const { return std::nullopt; }
};

// Maps a pass to a series of frames over the whole picture, whose mean over frames is the pass's picture: series are
// independent, frames of one series are not. A pure function of the scene, the settings and the pass, whatever the
// tiles and threads.
class CoupledIntegrator {
 public:
  virtual ~CoupledIntegrator() = default;
  // Frames that a series should have; warm-up frames before those, which are not shown; stages of each frame.
  virtual int frames() const = 0;
  virtual int warm_up() const = 0;
  virtual int stages() const = 0;
  // Whether its series have layers.
  virtual bool has_layers() const { return false; }
  // Whether paths from the lights add light to any pixel, so that a part of the picture takes as many of them as all of
  // it.
  virtual bool splats() const { return false; }
  virtual std::unique_ptr<FrameSeries> begin(const SeriesPass& pass) const = 0;
};

// An integrator of either kind, which must outlive this.
class AnyIntegrator {
 public:
  AnyIntegrator() = default;
  AnyIntegrator(const PixelIntegrator& integrator) : pixel_(&integrator) {}
  AnyIntegrator(const CoupledIntegrator& integrator) : coupled_(&integrator) {}
  const PixelIntegrator* pixel() const { return pixel_; }        // null: it is the other kind
  const CoupledIntegrator* coupled() const { return coupled_; }  // likewise
  bool has_layers() const { return pixel_ ? pixel_->has_layers() : coupled_->has_layers(); }
  bool splats() const { return coupled_ && coupled_->splats(); }

 private:
  const PixelIntegrator* pixel_ = nullptr;
  const CoupledIntegrator* coupled_ = nullptr;
};

}  // namespace montelux
