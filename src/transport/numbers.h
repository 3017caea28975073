// Where the random numbers of a path come from: a point set (`Sampler`), or a vector that was recorded or is mutated.
#pragma once
#include <concepts>
#include <span>

#include "mc/point_set.h"
#include "transport/dimensions.h"

namespace montelux {

// A source of the numbers of one path in each lane: single coordinates, pairs, and streams for walks of unknown length.
// All are pure functions of the dimension.
template <class Source, class F>
concept NumberSource = requires(const Source& source, Uint<F> dimension) {
  { source.get1(dimension) } -> std::convertible_to<F>;
  { source.get2(dimension) } -> std::convertible_to<Vec2<F>>;
  { source.stream(dimension) } -> std::convertible_to<RandomStream<F>>;
};
static_assert(NumberSource<Sampler<float>, float>);

// Which point of which pixel a path belongs to, in every lane.
template <class F>
struct PathSite {
  Uint<F> x, y, index;
};
// The numbers of a path by a set of points.
template <class F>
MONTELUX_INLINE Sampler<F> numbers_of(const PointSet& points, const PathSite<F>& site) {
  return Sampler<F>(points, site.x, site.y, site.index);
}

// A point of primary sample space (Kelemen et al. 2002): the first coordinates of the sample point are given, the
// others belong to `beyond`. So do the streams, of which each dimension has several: its coordinate decides which. So
// points that are close together share most of their streams, and a chain on the coordinates walks from stream to
// stream.
template <class F>
class RecordedNumbers {
 public:
  using U = Uint<F>;
  // `values`: lanes_of<F> consecutive numbers for each dimension, which must outlive this.
  RecordedNumbers(std::span<const float> values, const RandomStream<F>& beyond)
      : values_(values), dimensions_(std::uint32_t(values.size() / lanes_of<F>)), beyond_(beyond) {}

  F get1(U dimension) const {
    const Mask<F> known = dimension < U(dimensions_);
    if (!any(known)) return beyond_.at(dimension);
    const F value =
        gather(values_.data(), select(known, dimension * U(std::uint32_t(lanes_of<F>)) + lane_index<F>(), U(0u)));
    return select(known, value, beyond_.at(dimension));
  }
  Vec2<F> get2(U dimension) const { return {get1(dimension), get1(dimension + U(1u))}; }
  RandomStream<F> stream(U dimension) const {
    const U cell = to_uint(get1(dimension) * F(float(cells)));
    return beyond_.fork(dimension + cell * U(0x9e3779b9u));  // the first is that of the dimension alone
  }
  // Streams of a dimension, each for as much of its coordinate.
  static constexpr int cells = 16;

 private:
  std::span<const float> values_;
  std::uint32_t dimensions_;
  RandomStream<F> beyond_;
};
static_assert(NumberSource<RecordedNumbers<float>, float>);

}  // namespace montelux
