#include "integrator/manifold/walk.h"

namespace montelux {

namespace {

constexpr int max_steps = 16;          // traced, those that are taken back included
constexpr double max_step = 0.5;       // of the first direction, as a tangent
constexpr double min_share = 1.0 / 8;  // of a step: below it the walk is lost

// The step of Newton's method; none where the Jacobian is singular.
std::optional<std::array<double, 2>> newton_step(const ChainMiss& m) {
  const double d = m.determinant();
  const auto& j = m.jacobian;
  const std::array<double, 2> step{-(j[1][1] * m.miss[0] - j[0][1] * m.miss[1]) / d,
                                   -(j[0][0] * m.miss[1] - j[1][0] * m.miss[0]) / d};
  const double length = std::hypot(step[0], step[1]);
  if (!(length < 1e30)) return std::nullopt;
  const double scale = length > max_step ? max_step / length : 1;
  return std::array<double, 2>{step[0] * scale, step[1] * scale};
}

Vec3f moved(const SpecularChain& c, double a, double b) {
  return to_float(unit(to_double(c.w) + to_double(c.s) * a + to_double(c.t) * b));
}

}  // namespace

double ChainMiss::min_stretch() const {
  const auto& j = jacobian;
  const double sum = j[0][0] * j[0][0] + j[0][1] * j[0][1] + j[1][0] * j[1][0] + j[1][1] * j[1][1];
  const double product = std::abs(determinant());
  // The singular values a >= b have a^2 + b^2 = sum and a b = product.
  const double larger = std::sqrt(0.5 * (sum + std::sqrt(std::max(sum * sum - 4 * product * product, 0.0))));
  return larger > 0 ? product / larger : 0;
}

ChainMiss miss_of(const SpecularChain& c, const DeltaLight& light) {
  const Vec3d way = light.place - c.p;
  const double distance = light.is_distant ? 1 : std::max(norm(way), 1e-30);
  const Vec3d l = light.is_distant ? light.place : way * (1 / distance);
  const Vec3d axis = abs_of(l).x < 0.6 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
  const Vec3d s = unit(cross(l, axis)), t = cross(l, s);
  // (2 s.d, 2 t.d) / (1 + d.l), twice the tangent of half the angle: its derivative, with axes that turn with l.
  const double cosine = dot(c.d, l), scale = 2 / std::max(1 + cosine, 1e-6);
  const std::array<double, 2> across{dot(s, c.d), dot(t, c.d)};
  ChainMiss m;
  m.miss = {scale * across[0], scale * across[1]};
  m.size = std::hypot(m.miss[0], m.miss[1]);
  for (std::size_t j = 0; j < 2; ++j) {
    const Vec3d dl = light.is_distant ? Vec3d{0, 0, 0} : (c.dp[j] - l * dot(l, c.dp[j])) * (-1 / distance);
    const double dcosine = dot(c.dd[j], l) + dot(c.d, dl), dscale = -0.5 * scale * scale * dcosine;
    m.jacobian[0][j] = scale * (dot(s, c.dd[j]) - cosine * dot(s, dl)) + dscale * across[0];
    m.jacobian[1][j] = scale * (dot(t, c.dd[j]) - cosine * dot(t, dl)) + dscale * across[1];
  }
  m.precision = 1e-6 + (light.is_distant ? 0 : 4e-7 * norm(c.p) / distance);
  return m;
}

bool ChainSolution::is_same(const ChainSolution& other) const {
  if (!(chain.at == other.chain.at)) return false;
  if ((miss.determinant() < 0) != (other.miss.determinant() < 0)) return false;
  const double allowed = 1e-5 + 4 * (miss.precision + other.miss.precision) /
                                    std::max(std::min(miss.min_stretch(), other.miss.min_stretch()), 1e-3);
  return norm(to_double(chain.w - other.chain.w)) < allowed;
}

std::optional<ChainSolution> walk_to_light(const ChainTracer& tracer, const StoredOrigin<float>& from,
                                           const Vec3f& start, const ChainKind& kind, const DeltaLight& light,
                                           const RandomStream<float>& random, std::uint64_t& rays) {
  ChainSolution here;
  if (!tracer.trace(from, start, kind, random, here.chain, rays)) return std::nullopt;
  here.miss = miss_of(here.chain, light);
  double share = 1;
  for (int i = 0; i < max_steps; ++i) {
    if (here.miss.size < here.miss.precision) return here;
    const auto step = newton_step(here.miss);
    if (!step) return std::nullopt;
    ChainSolution next;
    const Vec3f w = moved(here.chain, share * (*step)[0], share * (*step)[1]);
    const bool closer = tracer.trace(from, w, kind, random, next.chain, rays) &&
                        (next.miss = miss_of(next.chain, light)).size < here.miss.size;
    if (closer) {
      here = next, share = std::min(1.0, 2 * share);
      continue;
    }
    // At the limit of single precision steps no longer help.
    if (here.miss.size < 8 * here.miss.precision) return here;
    if ((share *= 0.5) < min_share) return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace montelux
