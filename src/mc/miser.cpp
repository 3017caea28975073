#include "mc/miser.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mc/moments.h"

namespace montelux {
namespace {

struct Box {
  std::vector<double> low, high;
};

// Evaluates f at uniform points of a box in batches; calls use(points, values) on each, with points within the box.
template <class Use>
std::uint64_t sample_box(const CubeFunction& f, const Box& box, std::uint64_t samples, CubeKey key, Use use) {
  constexpr std::size_t batch = 256;
  const std::size_t dimension = box.low.size();
  std::vector<double> points(dimension * batch), values(batch);
  std::uint64_t non_finite = 0;
  for (std::uint64_t done = 0; done < samples;) {
    const std::size_t n = std::size_t(std::min<std::uint64_t>(batch, samples - done));
    fill_independent(key, {dimension, done, n, points.data()});
    for (std::size_t d = 0; d < dimension; ++d)
      for (std::size_t i = 0; i < n; ++i) {
        double& x = points[d * n + i];
        x = box.low[d] + (box.high[d] - box.low[d]) * x;
      }
    const std::span<double> v = std::span(values).first(n);
    f(std::span(points).first(dimension * n), v);
    for (double& x : v)
      if (!std::isfinite(x)) x = 0, ++non_finite;
    use(std::span<const double>(points).first(dimension * n), std::span<const double>(v));
    done += n;
  }
  return non_finite;
}

// Which axis to halve, and the share of the samples that the lower half gets.
struct Cut {
  std::size_t axis = 0;
  double lower_share = 0.5;
};

Cut choose_cut(const std::vector<Moments>& lower, const std::vector<Moments>& upper, double exponent) {
  Cut best;
  double smallest = std::numeric_limits<double>::infinity();
  const double power = 1 / (1 + exponent);
  for (std::size_t d = 0; d < lower.size(); ++d) {
    if (lower[d].count < 2 || upper[d].count < 2) continue;
    const double l = std::pow(lower[d].variance(), power), u = std::pow(upper[d].variance(), power);
    if (l + u < smallest) {
      smallest = l + u;
      best = {d, l + u > 0 ? std::clamp(l / (l + u), 0.05, 0.95) : 0.5};
    }
  }
  return best;
}

struct Miser {
  const CubeFunction& f;
  const MiserSettings& settings;
  CubeKey key;

  // `node` numbers the regions: the halves of region k are 2k and 2k + 1.
  RegionEstimate integrate(const Box& box, std::uint64_t samples, std::uint64_t node) const {
    const std::size_t dimension = box.low.size();
    const CubeKey own = key.fork(std::uint32_t(node)).fork(std::uint32_t(node >> 32));
    if (samples < settings.min_to_cut * dimension || node >> 62 != 0) return plain(box, samples, own);

    std::vector<Moments> lower(dimension), upper(dimension);
    const auto exploring =
        std::max(settings.min_explored * dimension, std::uint64_t(settings.explored * double(samples)));
    RegionEstimate result;
    result.non_finite =
        sample_box(f, box, exploring, own, [&](std::span<const double> points, std::span<const double> values) {
          for (std::size_t d = 0; d < dimension; ++d) {
            const double middle = 0.5 * (box.low[d] + box.high[d]);
            for (std::size_t i = 0; i < values.size(); ++i)
              (points[d * values.size() + i] < middle ? lower : upper)[d].add(values[i]);
          }
        });
    const Cut cut = choose_cut(lower, upper, settings.exponent);
    const std::uint64_t rest = samples - exploring;
    const auto low_samples = std::clamp<std::uint64_t>(std::uint64_t(cut.lower_share * double(rest)), 2, rest - 2);
    Box low = box, high = box;
    low.high[cut.axis] = high.low[cut.axis] = 0.5 * (box.low[cut.axis] + box.high[cut.axis]);
    const RegionEstimate a = integrate(low, low_samples, 2 * node);
    const RegionEstimate b = integrate(high, rest - low_samples, 2 * node + 1);
    result.mean = 0.5 * (a.mean + b.mean), result.variance = 0.25 * (a.variance + b.variance);
    result.samples = exploring + a.samples + b.samples, result.non_finite += a.non_finite + b.non_finite;
    return result;
  }

  RegionEstimate plain(const Box& box, std::uint64_t samples, CubeKey own) const {
    Moments moments;
    const std::uint64_t non_finite = sample_box(f, box, samples, own, [&](auto, std::span<const double> values) {
      for (double v : values) moments.add(v);
    });
    return {moments.mean, moments.variance() / double(samples), samples, non_finite};
  }
};

}  // namespace

RegionEstimate miser(const CubeFunction& f, std::size_t dimension, std::uint64_t samples, CubeKey key,
                     const MiserSettings& settings) {
  const Box cube{std::vector<double>(dimension, 0.0), std::vector<double>(dimension, 1.0)};
  return Miser{f, settings, key}.integrate(cube, samples, 1);
}

}  // namespace montelux
