// Markov chains on the numbers of paths, one a lane.
#pragma once
#include <array>
#include <cmath>
#include <cstring>
#include <utility>
#include <vector>

#include "image/pixel_sample.h"
#include "integrator/integrator.h"
#include "integrator/light_parts.h"
#include "math/lanes.h"
#include "mc/metropolis.h"
#include "mc/random.h"
#include "transport/dimensions.h"

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
  std::array<Rgb, lanes_of<F>> values{};
  F brightness = F(0.0f);             // by brightness_of(); 0 where broken
  Uint<F> x, y;                       // pixel, or cell of the grid of the pass
  Mask<F> splatted = Mask<F>(false);  // light that was not drawn by the filter of the pixel: it arrives at `raster`
  Vec2<F> raster{F(0.0f), F(0.0f)};
  Mask<F> broken = Mask<F>(false);              // the light is not a number
  std::vector<std::vector<LightPart>> parts{};  // of the light, by lane; empty in a pass without layers
};

// Turns the number of a place in the picture along one axis, from `first` on, into that of the place within its pixel,
// and returns the pixel. `u`: one for each lane.
template <class F>
Uint<F> take_pixel(std::span<float> u, int first, int size) {
  Uint<F> pixel(0u);
  for (int k = 0; k < lanes_of<F>; ++k) {
    float& number = u[std::size_t(k)];
    const float at = number * float(size);
    const int cell = std::min(int(at), size - 1);
    number = std::clamp(at - float(cell), 0.0f, 1.0f - 0x1p-24f);
    set_lane(pixel, k, std::uint32_t(first + cell));
  }
  return pixel;
}

// What chains sample by: the mean of the components' absolute values.
inline float brightness_of(const Rgb& contribution) {
  float sum = 0;
  for (float channel : contribution.c) sum += std::abs(channel);
  return sum * (1.0f / rgb_size);
}

// Light that was found, one colour a lane.
template <class F>
void put_light(Contribution<F>& c, const std::array<Rgb, lanes_of<F>>& values) {
  c.values = values;
  for (int k = 0; k < lanes_of<F>; ++k) set_lane(c.brightness, k, brightness_of(values[std::size_t(k)]));
  c.broken = !is_finite(c.brightness);
  c.brightness = select(c.broken, F(0.0f), c.brightness);
}

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
  const F number = min(max(u, F(0.0f)), F(1.0f - 0x1p-24f));
  std::memcpy(&point.values[dimension * lanes_of<F>], &number, sizeof number);
}
template <class F>
F numbers_at(const SamplePoint<F>& point, std::size_t dimension) {
  F u;
  std::memcpy(&u, &point.values[dimension * lanes_of<F>], sizeof u);
  return u;
}

// The numbers of one dimension after a step.
template <class F>
struct StepOfNumbers {
  const RandomStream<F>& numbers;
  Mask<F> large;
  const MutationSizes& sizes;

  F moved(const SamplePoint<F>& from, std::size_t dimension) const {
    const F u = numbers.at(Uint<F>(std::uint32_t(dimension)));
    return select(large, u, montelux::moved<F>(numbers_at(from, dimension), u, sizes.smallest, sizes.largest));
  }
  // The same where only large steps change them.
  F drawn(const SamplePoint<F>& from, std::size_t dimension) const {
    return select(large, numbers.at(Uint<F>(std::uint32_t(dimension))), numbers_at(from, dimension));
  }
};

// One step of every chain of the pack. evaluate.propose(proposal, point, step) moves the numbers;
// `deposit(contribution, share)` receives both ends of the step: what is expected of the chain there (Veach and Guibas
// 1997, sec. 4.4), in lanes. Returns how the proposals were made, and with which probability they were accepted.
template <class F>
struct StepsMade {
  Mask<F> large;
  F accepted;
};
template <class F, class Function, class Deposit>
StepsMade<F> step_chains(MarkovChains<F>& chains, SamplePoint<F>& proposal, const MutationSizes& sizes,
                         const RandomStream<F>& numbers, Function& evaluate, RayCounts& counts, Deposit deposit) {
  using U = Uint<F>;
  const RandomStream<F> decisions = numbers.fork(U(chain_stream::decisions));
  const Mask<F> large = decisions.at(U(0u)) < F(sizes.large_step);
  evaluate.propose(proposal, chains.point, StepOfNumbers<F>{numbers, large, sizes});
  proposal.beyond = select_words(large, numbers, chains.point.beyond);

  Contribution<F> there = evaluate(proposal, counts);
  const F accepted = metropolis_acceptance(chains.value.brightness, there.brightness);
  deposit(there, accepted);
  deposit(chains.value, F(1.0f) - accepted);
  const Mask<F> moves = decisions.at(U(1u)) < accepted;
  for_each_lane(moves, [&](int k) {
    const auto i = std::size_t(k);
    chains.value.values[i] = there.values[i];
    if (!there.parts.empty()) chains.value.parts[i] = std::move(there.parts[i]);
  });
  for (std::size_t d = 0; d * lanes_of<F> < proposal.values.size(); ++d)
    put_numbers(chains.point, d, select(moves, numbers_at(proposal, d), numbers_at(chains.point, d)));
  chains.point.beyond = select_words(moves, proposal.beyond, chains.point.beyond);
  chains.value.brightness = select(moves, there.brightness, chains.value.brightness);
  chains.value.x = select(moves, there.x, chains.value.x), chains.value.y = select(moves, there.y, chains.value.y);
  chains.value.splatted = (moves & there.splatted) | (chains.value.splatted & !moves);
  chains.value.raster.x = select(moves, there.raster.x, chains.value.raster.x);
  chains.value.raster.y = select(moves, there.raster.y, chains.value.raster.y);
  return {large, accepted};
}

}  // namespace montelux
