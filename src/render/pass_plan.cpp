#include "render/pass_plan.h"

#include <algorithm>

namespace montelux {

int PassPlan::tile_side() const {
  int side = max_tile_side;
  while (side > 1 && side * side * samples_per_pass > max_unit_samples) side /= 2;
  return side;
}

PassPlan plan_passes(int samples, PointSetKind kind) {
  samples = std::max(samples, 1);
  // Independent samples lose nothing by short passes; the others need the longest sets that leave enough replicates.
  const int replicates = kind == PointSetKind::independent ? 64 : 8;
  // With longer passes a stop would have to wait too long for a unit of work.
  constexpr int longest_pass = 1024;
  // A second pass with the same points would add no information: one pass, and so no error bar.
  if (is_fixed(kind)) return {samples, 1};
  int k = 1;
  while (samples / (2 * k) >= replicates && k < longest_pass) k *= 2;
  return {k, (samples + k - 1) / k};
}

PassPlan plan_passes(const AnyIntegrator& integrator, int samples, PointSetKind kind) {
  if (!integrator.coupled()) return plan_passes(samples, kind);
  const int frames = std::min(integrator.coupled()->frames(), std::max(1, samples / min_series));
  return {frames, (std::max(samples, 1) + frames - 1) / frames};
}

}  // namespace montelux
