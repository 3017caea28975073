// How many samples a render takes, and in which passes.
#pragma once
#include "integrator/integrator.h"
#include "mc/point_set.h"

namespace montelux {

// No tile of a film is wider, in pixels.
inline constexpr int widest_tile = 64;

struct PassPlan {
  int samples_per_pass = 1;  // per pixel
  int passes = 1;
  int first_pass = 0;              // the passes are this one and the following ones
  int stride = 1;                  // only one pixel of each stride x stride is sampled
  int max_unit_samples = 1 << 16;  // of one unit of work, as far as a pass allows
  int max_tile_side = 32;          // a power of two, at most that of all plans, widest_tile
  bool synchronous = false;        // a pass begins when the one before is complete: all pixels have equally many

  int samples() const { return samples_per_pass * passes; }
  bool contains(int pass) const { return pass >= first_pass && pass - first_pass < passes; }
  // Side of a tile: large enough that packs stay full, small enough that a unit of work takes little time, so that
  // threads share the work evenly and stop soon after a request.
  int tile_side() const;
};

// The number of passes of a plan that only a stopping rule ends.
inline constexpr int endless_passes = 1 << 20;

// Fixed points are one pass, with at most this many samples.
inline constexpr int max_fixed_samples = 1 << 16;

// The plan for at least `samples` samples per pixel. Passes are replicates: more of them make the error bar more
// certain, fewer make each point set longer and the image better; docs/error-bars.md has the measurements.
PassPlan plan_passes(int samples, PointSetKind kind);
// The same for any integrator: a pass of a coupled one is a series of at most its number of frames.
PassPlan plan_passes(const AnyIntegrator& integrator, int samples, PointSetKind kind);

// Fewer series have no usable error bar.
inline constexpr int min_series = 4;

}  // namespace montelux
