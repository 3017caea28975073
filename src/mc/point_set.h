// Point sets: the numbers in [0, 1) of a pass. Every number is a pure function of the seed, the pass,
// the site, the index of the point and the dimension. Passes are independent randomisations of the same construction,
// so their spread is a valid error bar whatever the correlation within a pass.
#pragma once
#include <array>
#include <optional>
#include <string_view>

#include "mc/cube_points.h"
#include "mc/random.h"

namespace montelux {

enum class PointSetKind : std::uint8_t {
  independent,
  stratified,
  halton,
  sobol,
  padded_sobol,
  blue_noise,
  pmj02,
  lattice,
  uniform_grid
};

struct NamedPointSet {
  std::string_view name;
  PointSetKind kind;
  std::string_view description;
};

inline constexpr std::array<NamedPointSet, 8> point_set_names{{
    {"independent", PointSetKind::independent, "independent random numbers"},
    {"stratified", PointSetKind::stratified, "jittered strata of equal size, shuffled in each dimension"},
    {"halton", PointSetKind::halton, "radical inverses in prime bases with nested random digits"},
    {"sobol", PointSetKind::sobol, "one Sobol' sequence over all dimensions, Owen-scrambled"},
    {"padded-sobol", PointSetKind::padded_sobol,
     "(0,2)-sequences, Owen-scrambled and shuffled in each pair of dimensions"},
    {"blue-noise", PointSetKind::blue_noise,
     "one (0,2)-sequence along a shuffled Z curve: the error is blue over the grid"},
    {"pmj02", PointSetKind::pmj02, "progressive multi-jittered (0,2)-sequences, one for each pair of dimensions"},
    {"lattice", PointSetKind::lattice, "a rank-1 lattice sequence, shifted at random"},
}};

// Patterns for comparison only: the same points in every pass, so they are biased and their spread is no error bar.
inline constexpr std::array<NamedPointSet, 1> fixed_point_set_names{{
    {"uniform-grid", PointSetKind::uniform_grid,
     "the centres of the strata; a single point is the centre of the square"},
}};
// Higher dimensions are random numbers, the same everywhere: roulette with a constant 1/2 would never end a path.
inline constexpr std::uint32_t grid_dimensions = 256;

// Columns of the cells into which n points divide the square (stratified, uniform_grid): the rounded root of n.
std::uint32_t grid_columns(std::uint32_t n);

std::string_view name_of(PointSetKind kind);

// How a set of points fills blocks of the unit cube for integrals.
struct CubeFill {
  void (*fill)(CubeKey, CubeBlock);
  bool by_powers_of_two;  // the first 2^m points are best, for every m
};
// None: the set has no points for integrals.
std::optional<CubeFill> cube_fill(PointSetKind kind);

// Whether the points are the same in every pass, which biases every estimate.
bool is_fixed(PointSetKind kind);
std::optional<PointSetKind> point_set_named(std::string_view name);

// The points of one pass over a grid of sites: the pixels of an image, or the only site (0, 0) of a single integral.
struct PointSet {
  PointSetKind kind = PointSetKind::padded_sobol;
  std::uint32_t seed = 0;
  std::uint32_t pass = 0;
  std::uint32_t samples_per_pass = 1;  // points per site in this pass; >= 1
};

// The coordinates of one point in every lane. Lanes may differ in site, index (below samples_per_pass) and dimension.
// A two-dimensional request at d uses d and d + 1; every dimension number is valid, and no two give the same numbers.
template <class F>
class Sampler {
 public:
  Sampler(const PointSet& set, Uint<F> x, Uint<F> y, Uint<F> index);

  // The coordinate in [0, 1).
  F get1(Uint<F> dimension) const;
  // The coordinates d and d + 1, well spread as a pair.
  Vec2<F> get2(Uint<F> dimension) const;
  // Independent numbers for this point and dimension alone, for walks of unknown length.
  RandomStream<F> stream(Uint<F> dimension) const { return own_.fork(dimension); }
  // What all these streams are forked from.
  const RandomStream<F>& own() const { return own_; }

 private:
  PointSet set_;
  RandomStream<F> shared_;  // the randomisation that all points of a set share
  RandomStream<F> own_;     // of this point alone
  Uint<F> index_;           // the point's number in its set
  int index_bits_;          // bits of index_ that are used (pmj02)
};

extern template class Sampler<float>;
extern template class Sampler<NativeFloats>;

}  // namespace montelux
