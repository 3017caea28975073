#include "mc/point_set.h"

#include "mc/digital.h"
#include "mc/halton.h"
#include "mc/lattice.h"
#include "mc/pmj02.h"
#include "mc/sobol.h"

namespace montelux {

std::string_view name_of(PointSetKind kind) {
  for (const NamedPointSet& entry : fixed_point_set_names)
    if (entry.kind == kind) return entry.name;
  return point_set_names[std::size_t(kind)].name;
}

std::uint32_t grid_columns(std::uint32_t n) { return std::max(1u, std::uint32_t(std::lround(std::sqrt(double(n))))); }

bool is_fixed(PointSetKind kind) {
  for (const NamedPointSet& entry : fixed_point_set_names)
    if (entry.kind == kind) return true;
  return false;
}

std::optional<PointSetKind> point_set_named(std::string_view name) {
  for (const NamedPointSet& entry : point_set_names)
    if (entry.name == name) return entry.kind;
  for (const NamedPointSet& entry : fixed_point_set_names)
    if (entry.name == name) return entry.kind;
  return std::nullopt;
}

std::optional<CubeFill> cube_fill(PointSetKind kind) {
  switch (kind) {
    case PointSetKind::halton:
      return CubeFill{fill_halton, false};
    case PointSetKind::sobol:
      return CubeFill{fill_sobol, true};
    case PointSetKind::pmj02:
      return CubeFill{fill_pmj02, true};
    case PointSetKind::lattice:
      return CubeFill{fill_lattice, true};
    default:
      return std::nullopt;
  }
}

namespace {

template <class F>
RandomStream<F> stream_of_site(const PointSet& set, Uint<F> x, Uint<F> y) {
  using U = Uint<F>;
  const std::uint32_t low = mix_bits(set.pass + mix_bits(set.seed + 0x2545f491u));
  const std::uint32_t high = mix_bits(set.pass + 0x9e3779b9u * mix_bits(set.seed ^ 0xb5297a4du));
  return RandomStream<F>(mix_bits(U(x + mix_bits(U(y + U(low))))), mix_bits(U(y ^ mix_bits(U(x ^ U(high))))));
}

// ---- jittered strata ------------------------------------------------------------------------------------------------

// i / n rounded down; exact for i < 2^24.
template <class F>
Uint<F> divide(Uint<F> i, F n) {
  return to_uint(floor(to_float(i) / n));
}

// Which of the n strata the point falls into, at random. Points beyond the first n start the next round of strata.
template <class F>
Uint<F> stratum(Uint<F> index, std::uint32_t n, Uint<F> key) {
  using U = Uint<F>;
  U round = divide<F>(index, F(float(n)));
  return permute(U(index - round * U(n)), n, mix_bits(U(key + round)));
}

template <class F>
F stratified1(Uint<F> index, std::uint32_t n, Uint<F> key, F jitter) {
  return min((to_float(stratum<F>(index, n, key)) + jitter) / F(float(n)), F(one_minus_epsilon));
}

// n cells of equal area for any n: as many columns as the root of n, the first of them with one cell more where n is
// not divisible; the width of a column is proportional to its number of cells.
template <class F>
Vec2<F> stratified2(Uint<F> index, std::uint32_t n, Uint<F> key, Vec2<F> jitter) {
  using U = Uint<F>;
  const std::uint32_t columns = grid_columns(n);
  const std::uint32_t base = n / columns, tall = n % columns, in_tall = tall * (base + 1u);
  U cell = stratum<F>(index, n, key);
  Mask<F> is_tall = cell < U(in_tall);
  F rows = select(is_tall, F(float(base + 1u)), F(float(base)));
  U first = select(is_tall, U(0u), U(in_tall));
  U column = divide<F>(U(cell - first), rows);
  U row = cell - first - column * to_uint(rows);
  F start = to_float(first) + to_float(column) * rows;
  F u = (start + jitter.x * rows) / F(float(n));
  F v = (to_float(row) + jitter.y) / rows;
  return {min(u, F(one_minus_epsilon)), min(v, F(one_minus_epsilon))};
}

// ---- (0,2)-sequences ------------------------------------------------------------------------------------------------

// The point of the scrambled (0,2)-sequence; d and d + 1 select the keys of its two coordinates.
template <class F>
Vec2<F> scrambled_02(Uint<F> index, const RandomStream<F>& keys, Uint<F> d) {
  using U = Uint<F>;
  U second = multiply_by_pascal(index);
  return {fraction_of_reversed<F>(scramble_upwards(index, keys.bits_at(d))),
          fraction_of_reversed<F>(scramble_upwards(second, keys.bits_at(U(d + U(1u)))))};
}

template <class F>
Uint<F> padded_index(Uint<F> index, const RandomStream<F>& keys, Uint<F> d) {
  return shuffle_index(index, keys.bits_at(Uint<F>(d ^ Uint<F>(0x80000000u))));
}

template <class F>
Vec2<F> multi_jittered(Uint<F> index, int bits, const RandomStream<F>& keys, Uint<F> d) {
  using U = Uint<F>;
  const U first = pmj02_order(index, keys.bits_at(U(d ^ U(0x80000000u))));
  const U second = multiply_by_pascal(first);
  return {fraction_of_reversed<F>(pmj02_digits(first, bits, keys.bits_at(d))),
          fraction_of_reversed<F>(pmj02_digits(second, bits, keys.bits_at(U(d + U(1u)))))};
}

// ---- lattices -------------------------------------------------------------------------------------------------------

// One lattice for all the dimensions of the generating vector; beyond them one planar lattice for each
// pair, each in a random order. `component`: 0 or 1 within the pair.
template <class F>
F shifted_lattice(Uint<F> index, const RandomStream<F>& keys, Uint<F> d, std::uint32_t component) {
  using U = Uint<F>;
  const U dimension = d + U(component);
  const Mask<F> inside = dimension < U(std::uint32_t(lattice_dimensions));
  U place = index;
  if (!all(inside)) place = select(inside, index, padded_index<F>(index, keys, d));
  const U z = gather(lattice_generator.data(), select(inside, dimension, U(component)));
  return unit_float<F>(lattice_word(place, z, keys.bits_at(dimension)));
}

// ---- Z curve --------------------------------------------------------------------------------------------------------

// A zero bit before each of the lower 16 bits.
template <class U>
U spread_bits(U x) {
  x = x & U(0xffffu);
  x = (x ^ (x << 8)) & U(0x00ff00ffu);
  x = (x ^ (x << 4)) & U(0x0f0f0f0fu);
  x = (x ^ (x << 2)) & U(0x33333333u);
  return (x ^ (x << 1)) & U(0x55555555u);
}

}  // namespace

template <class F>
Sampler<F>::Sampler(const PointSet& set, Uint<F> x, Uint<F> y, Uint<F> index)
    : set_(set), shared_(stream_of_site<F>(set, x, y)), index_(index), index_bits_(0) {
  using U = Uint<F>;
  own_ = shared_.fork(U(index + U(0x3c6ef372u)));
  // A fixed pattern uses the same order of strata, and the same numbers beyond, for all sites and passes.
  if (set.kind == PointSetKind::uniform_grid) {
    shared_ = RandomStream<F>(U(0x452821e6u), U(0x38d01377u));
    own_ = shared_.fork(U(index + U(0x3c6ef372u)));
  }
  if (set.kind == PointSetKind::pmj02) index_bits_ = int(std::bit_width(set.samples_per_pass - 1u));
  if (set.kind != PointSetKind::blue_noise) return;
  // One sequence for the grid: the bits of the site's position on the Z curve above those of the index, after Ahmed and
  // Wonka 2020, "Screen-Space Blue-Noise Diffusion". padded_index() shuffles all of it by nested binary digits, for
  // each pair of dimensions. The grid is divided into the largest squares that 32 bits can number, with separate
  // randomisations.
  const int sample_bits = int(std::bit_width(set.samples_per_pass - 1u));
  const int side_bits = std::min(16, (32 - sample_bits) / 2);
  const U low_bits = U((1u << side_bits) - 1u);
  const U place = spread_bits(U(x & low_bits)) | (spread_bits(U(y & low_bits)) << 1);
  shared_ = stream_of_site<F>(set, U(x >> side_bits), U(y >> side_bits));
  index_ = (place << sample_bits) | index;
}

template <class F>
F Sampler<F>::get1(Uint<F> dimension) const {
  using U = Uint<F>;
  const U d = dimension;
  const auto padded = [&] {
    return fraction_of_reversed<F>(scramble_upwards(padded_index<F>(index_, shared_, d), shared_.bits_at(d)));
  };
  switch (set_.kind) {
    case PointSetKind::independent:
      break;
    case PointSetKind::stratified:
      return stratified1<F>(index_, set_.samples_per_pass, shared_.bits_at(d), own_.at(d));
    case PointSetKind::uniform_grid:
      return select(d < U(grid_dimensions), stratified1<F>(index_, set_.samples_per_pass, shared_.bits_at(d), F(0.5f)),
                    own_.at(d));
    case PointSetKind::halton: {
      Mask<F> inside = d < U(halton_dimensions);
      F tabulated = halton<F>(index_, select(inside, d, U(0u)), set_.samples_per_pass, shared_.bits_at(d));
      return all(inside) ? tabulated : select(inside, tabulated, padded());
    }
    case PointSetKind::sobol: {
      Mask<F> inside = d < U(sobol_dimensions);
      U x = sobol_reversed(index_, select(inside, d, U(0u)));
      F tabulated = fraction_of_reversed<F>(scramble_upwards(x, shared_.bits_at(d)));
      return all(inside) ? tabulated : select(inside, tabulated, padded());
    }
    case PointSetKind::padded_sobol:
    case PointSetKind::blue_noise:
      return padded();
    case PointSetKind::pmj02: {
      U place = pmj02_order(index_, shared_.bits_at(U(d ^ U(0x80000000u))));
      return fraction_of_reversed<F>(pmj02_digits(place, index_bits_, shared_.bits_at(d)));
    }
    case PointSetKind::lattice:
      return shifted_lattice<F>(index_, shared_, d, 0);
  }
  return own_.at(d);
}

template <class F>
Vec2<F> Sampler<F>::get2(Uint<F> dimension) const {
  using U = Uint<F>;
  const U d = dimension, next = d + U(1u);
  switch (set_.kind) {
    case PointSetKind::stratified:
      return stratified2<F>(index_, set_.samples_per_pass, shared_.bits_at(d), {own_.at(d), own_.at(next)});
    case PointSetKind::uniform_grid:
      return select<F>(d < U(grid_dimensions),
                       stratified2<F>(index_, set_.samples_per_pass, shared_.bits_at(d), {F(0.5f), F(0.5f)}),
                       Vec2<F>{own_.at(d), own_.at(next)});
    case PointSetKind::halton:
    case PointSetKind::sobol: {
      const U size = set_.kind == PointSetKind::sobol ? sobol_dimensions : halton_dimensions;
      Mask<F> inside = next < size;
      if (!any(inside)) return scrambled_02<F>(padded_index<F>(index_, shared_, d), shared_, d);
      Vec2<F> tabulated{get1(select(inside, d, U(0u))), get1(select(inside, next, U(1u)))};
      if (all(inside)) return tabulated;
      return select(inside, tabulated, scrambled_02<F>(padded_index<F>(index_, shared_, d), shared_, d));
    }
    case PointSetKind::padded_sobol:
    case PointSetKind::blue_noise:
      return scrambled_02<F>(padded_index<F>(index_, shared_, d), shared_, d);
    case PointSetKind::pmj02:
      return multi_jittered<F>(index_, index_bits_, shared_, d);
    case PointSetKind::lattice:
      return {shifted_lattice<F>(index_, shared_, d, 0), shifted_lattice<F>(index_, shared_, d, 1)};
    case PointSetKind::independent:
      break;
  }
  return {own_.at(d), own_.at(next)};
}

template class Sampler<float>;
template class Sampler<NativeFloats>;

}  // namespace montelux
