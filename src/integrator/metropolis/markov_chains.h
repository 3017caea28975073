// Markov chains on the numbers of paths, one a lane.
#pragma once
#include <array>
#include <cmath>
#include <vector>

#include "integrator/first_vertex.h"
#include "integrator/path/loop.h"
#include "mc/metropolis.h"

namespace montelux {

// A point of primary sample space: the first numbers of a path, and the stream that has all others.
template <class F>
struct SamplePoint {
  std::vector<float> values;  // lanes_of<F> for each dimension
  RandomStream<F> beyond;
};

// What the path of a sample point contributes, and where.
template <class F>
struct Contribution {
  std::array<Rgb, lanes_of<F>> light{};
  F brightness = F(0.0f);  // what the chains sample by: the mean of the components' absolute values; 0 where broken
  Uint<F> x, y;            // pixel, or cell of the grid of the pass
  Mask<F> broken = Mask<F>(false);  // the light is not a number
};

// One camera path a lane, which starts by given numbers.
template <class F, class Rays>
class GivenPaths {
 public:
  GivenPaths(const Scene& scene, const Rays& rays, const TilePass& pass, const PathSite<F>& site,
             const RecordedNumbers<F>& numbers, std::span<PixelSample> out)
      : scene_(scene), rays_(rays), pass_(pass), site_(site), numbers_(numbers), out_(out) {}

  Mask<F> refill(PathState<F>& path, Mask<F> on) {
    if (std::exchange(started_, true)) return on;
    PathStart<F> start = start_of_path<F>(scene_, pass_, site_, numbers_);
    start.slot = lane_index<F>();
    const auto [found, hit] =
        rays_.template trace<F>({start.o, start.d, F(ray_infinity), start.time}, Mask<F>(true), RayUse::camera);
    start.hit = hit;
    const Mask<F> starts = found | Mask<F>(scene_.camera_medium != empty_space);
    if (const Mask<F> left = !starts; any(left)) {
      const Spectrum<F> sky = scene_.lights.template escaped_radiance<F>(start.d, left) * start.weight;
      for_each_lane(left, [&](int k) { out_[std::size_t(k)].radiance = to_rgb(lane(sky, k)); });
    }
    begin_paths(path, start, media_of<F>(scene_.media, Uint<F>(scene_.camera_medium)), starts);
    return starts;
  }
  const RecordedNumbers<F>& numbers(const PathState<F>&) const { return numbers_; }

 private:
  const Scene& scene_;
  const Rays& rays_;
  const TilePass& pass_;
  const PathSite<F> site_;
  const RecordedNumbers<F>& numbers_;
  std::span<PixelSample> out_;
  bool started_ = false;
};

// The function that the chains sample: from a point of primary sample space to the light of its path. The first two
// numbers are the place in the picture.
template <class F, class Rays>
class PathFunction {
 public:
  using U = Uint<F>;
  // All must outlive this.
  PathFunction(const Scene& scene, const Rays& rays, const PathSettings& settings, const ChainPass& pass)
      : scene_(scene),
        rays_(rays),
        settings_(settings),
        bounds_(pass.bounds),
        pass_{pass.bounds, pass.points, pass.shutter, {}, {}, pass.grid},
        numbers_(dimensions_of(settings) * std::size_t(lanes_of<F>)) {}

  // Numbers that are varied one by one: of the first vertices, which decide most.
  static std::size_t dimensions_of(const PathSettings& settings) {
    constexpr int deepest = 12;
    const int vertices = 1 + std::min(settings.max_depth.value_or(deepest), deepest);
    return path_dimension::first_vertex + std::size_t(vertices) * path_dimension::per_vertex;
  }

  Contribution<F> operator()(const SamplePoint<F>& point, RayCounts& counts) {
    std::copy(point.values.begin(), point.values.end(), numbers_.begin());
    Contribution<F> c;
    c.x = place(0, bounds_.x0, bounds_.width()), c.y = place(1, bounds_.y0, bounds_.height());
    std::array<PixelSample, lanes_of<F>> out{};
    const RecordedNumbers<F> numbers(numbers_, point.beyond);
    const auto [x, y] = pixels_of<F>(pass_, c.x, c.y);
    GivenPaths<F, Rays> paths(scene_, rays_, pass_, {x, y, U(0u)}, numbers, out);
    counts.camera += lanes_of<F>;
    counts += scene_.media.empty()
                  ? run_paths<F>(scene_, scene_.lights, rays_, settings_, pass_, std::span(out), paths, no_tally)
                  : run_paths<F, true>(scene_, scene_.lights, rays_, settings_, pass_, std::span(out), paths, no_tally);
    for (int k = 0; k < lanes_of<F>; ++k) {
      const Rgb& light = out[std::size_t(k)].radiance;
      float sum = 0;
      for (float channel : light.c) sum += std::abs(channel);
      c.light[std::size_t(k)] = light;
      set_lane(c.brightness, k, sum * (1.0f / rgb_size));
    }
    c.broken = !is_finite(c.brightness);
    c.brightness = select(c.broken, F(0.0f), c.brightness);
    return c;
  }

 private:
  // The pixel along one axis; the number becomes that of the place within the pixel.
  U place(std::size_t dimension, int first, int size) {
    U pixel(0u);
    for (int k = 0; k < lanes_of<F>; ++k) {
      float& u = numbers_[dimension * lanes_of<F> + std::size_t(k)];
      const float at = u * float(size);
      const int cell = std::min(int(at), size - 1);
      u = std::clamp(at - float(cell), 0.0f, 1.0f - 0x1p-24f);
      set_lane(pixel, k, std::uint32_t(first + cell));
    }
    return pixel;
  }

  const Scene& scene_;
  const Rays& rays_;
  const PathSettings& settings_;
  const PixelBounds bounds_;
  const TilePass pass_;
  std::vector<float> numbers_;
};

// How a chain moves.
struct MutationSizes {
  float large_step;  // probability
  float smallest, largest;
};

// The states of a pack of chains.
template <class F>
struct MarkovChains {
  SamplePoint<F> point;
  Contribution<F> value;
};

template <class F>
void put_numbers(SamplePoint<F>& point, std::size_t dimension, const F& u) {
  for (int k = 0; k < lanes_of<F>; ++k)
    point.values[dimension * lanes_of<F> + std::size_t(k)] = std::clamp(lane(u, k), 0.0f, 1.0f - 0x1p-24f);
}
template <class F>
F numbers_at(const SamplePoint<F>& point, std::size_t dimension) {
  F u;
  for (int k = 0; k < lanes_of<F>; ++k) set_lane(u, k, point.values[dimension * lanes_of<F> + std::size_t(k)]);
  return u;
}

// One step of every chain of the pack. `deposit(contribution, share)` receives both ends of the step: what is expected
// of the chain there (Veach and Guibas 1997, sec. 4.4), in lanes. Returns how the proposals were made, and with which
// probability they were accepted.
template <class F>
struct StepsMade {
  Mask<F> large;
  F accepted;
};
template <class F, class Function, class Deposit>
StepsMade<F> step_chains(MarkovChains<F>& chains, SamplePoint<F>& proposal, const MutationSizes& sizes,
                         const RandomStream<F>& numbers, Function& evaluate, RayCounts& counts, Deposit deposit) {
  using U = Uint<F>;
  const RandomStream<F> decisions = numbers.fork(U(0x9e37u));
  const Mask<F> large = decisions.at(U(0u)) < F(sizes.large_step);
  for (std::size_t d = 0; d * lanes_of<F> < proposal.values.size(); ++d) {
    const F u = numbers.at(U(std::uint32_t(d)));
    const F small = moved<F>(numbers_at(chains.point, d), u, sizes.smallest, sizes.largest);
    put_numbers<F>(proposal, d, select(large, u, small));
  }
  proposal.beyond = select_words(large, numbers, chains.point.beyond);

  const Contribution<F> there = evaluate(proposal, counts);
  const F accepted = metropolis_acceptance(chains.value.brightness, there.brightness);
  deposit(there, accepted);
  deposit(chains.value, F(1.0f) - accepted);
  const Mask<F> moves = decisions.at(U(1u)) < accepted;
  for_each_lane(moves, [&](int k) {
    for (std::size_t i = std::size_t(k); i < proposal.values.size(); i += lanes_of<F>)
      chains.point.values[i] = proposal.values[i];
    chains.value.light[std::size_t(k)] = there.light[std::size_t(k)];
  });
  chains.point.beyond = select_words(moves, proposal.beyond, chains.point.beyond);
  chains.value.brightness = select(moves, there.brightness, chains.value.brightness);
  chains.value.x = select(moves, there.x, chains.value.x), chains.value.y = select(moves, there.y, chains.value.y);
  return {large, accepted};
}

}  // namespace montelux
