// Rendering the reference.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "lab/compare/measure.h"
#include "lab/compare/passes.h"
#include "lab/compare/pilot.h"
#include "lab/compare/work.h"
#include "mc/random.h"

namespace montelux::lab {

namespace {

constexpr int samples_per_pass = 16, max_passes = 1 << 16, min_more = 16;

Reference reference_of(const Film& film, int passes) {
  const ImageEstimate image = film.image();
  std::array<double, 3> variance_of_image{};
  for (std::size_t c = 0; c < 3; ++c) variance_of_image[c] = image.standard_error[c] * image.standard_error[c];
  return {mean_of(film), variance_of(film), double(passes - 1), variance_of_image, {}};
}

// The number of further passes if these passes have `excess` times the variance of the goal: the expected number,
// but at most as many as there are, because a variance from few passes may be far too small or too large.
int more_passes(int passes, double excess) {
  const double needed = 1.05 * passes * excess;
  const int max_more = std::min(passes, max_passes - passes);
  return std::clamp(int(std::min(needed - passes, 1e9)), std::min(min_more, max_more), max_more);
}

}  // namespace

Reference make_reference(const std::vector<ComparedMethod>& compared_methods, const ReferenceGoal& goal,
                         const ComparisonSettings& settings, const ComparisonWatch& watch) {
  const ComparedMethod& method = compared_methods[goal.method];
  RenderSettings s = settings_for(method, settings);
  s.image.seed = mix_bits(settings.render.image.seed ^ 0x5bd1e995u);
  const PieceProgress piece(watch, {"reference by " + method.shown_name(), goal.seconds});
  const double expected = std::clamp(goal.samples / samples_per_pass, double(min_more), double(max_passes));
  Film film(s.image.bounds);
  Reference reference;
  int passes = 0;
  for (int more = std::max(min_more, int(0.6 * expected)); more > 0 && !watch.stopped();) {
    s.plan = {samples_per_pass, more, reference_pass + passes};
    const double whole = std::max(expected, double(passes + more));
    PartOfPiece part(piece, passes / whole, std::min(0.99, (passes + more) / whole));
    film.merge(render(method.integrator, s, part).film);
    passes += more;
    reference = reference_of(film, passes);
    double excess = 0;
    for (ErrorMeasure by : {ErrorMeasure::relative_mse, ErrorMeasure::mse})
      excess = std::max(excess, variance_by(by, reference) / goal.variance[by]);
    more = excess > 1 ? more_passes(passes, excess) : 0;
  }
  reference.origin = fmt::format("{}, {} samples per pixel; the most efficient method of the pilots by {}",
                                 method.shown_name(), passes * samples_per_pass, title_of(settings.measure));
  return reference;
}

}  // namespace montelux::lab
