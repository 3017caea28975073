#include "film/film_bytes.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <type_traits>

#include "film/film.h"

namespace montelux {

namespace {

static_assert(std::endian::native == std::endian::little);

[[noreturn]] void damaged() { throw std::invalid_argument("it is damaged: its film cannot be read"); }

// A number in two's complement is cut into 16 units, of which a header says how many low ones are zero (high four bits)
// and how many follow, less one (low four bits). Those above have the sign of the last. No number has 15 zeros and 16
// that follow: that stands for zero.
constexpr std::size_t units = 16;
constexpr unsigned char zero_header = 0xff;

void write_words(std::string& out, std::span<const std::uint64_t> words) {
  std::array<char, 32> bytes{};
  const std::size_t size = 8 * words.size(), unit = size / units;
  std::memcpy(bytes.data(), words.data(), size);
  const char sign = bytes[size - 1] < 0 ? char(-1) : char(0);
  std::size_t low = 0, high = size;
  while (low < size && bytes[low] == 0) ++low;
  if (low == size) {
    out += char(zero_header);
    return;
  }
  while (high > low + 1 && bytes[high - 1] == sign && (bytes[high - 2] < 0) == (sign < 0)) --high;
  const std::size_t first = low / unit, end = (high + unit - 1) / unit;
  out += char(first << 4 | (end - first - 1));
  out.append(&bytes[first * unit], (end - first) * unit);
}

}  // namespace

void ByteWriter::count(std::uint64_t x) {
  for (; x >= 0x80; x >>= 7) out_ += char(x | 0x80);
  out_ += char(x);
}

// No film has so many samples of a pixel.
constexpr std::uint64_t first_of_parts = 2ull * max_film_samples;

void ByteWriter::samples(const SampleCount& x) { count(x.is_whole() ? x.whole() : first_of_parts + x.units()); }

void ByteWriter::real(double x) {
  char bytes[8];
  std::memcpy(bytes, &x, 8);
  out_.append(bytes, 8);
}

void ByteWriter::sum(const ExactSum& x) {
  const std::array<std::uint64_t, 2> words{std::uint64_t(x.units()), std::uint64_t(x.units() >> 64)};
  write_words(out_, words);
}
void ByteWriter::sum(const SmallExactSum& x) { sum(ExactSum::of_units(x.units())); }
void ByteWriter::sum(const ExactProducts& x) { write_words(out_, x.words()); }

unsigned char ByteReader::byte() {
  if (rest_.empty()) damaged();
  const auto byte = static_cast<unsigned char>(rest_.front());
  rest_.remove_prefix(1);
  return byte;
}

std::uint64_t ByteReader::count(std::uint64_t max) {
  std::uint64_t x = 0;
  for (unsigned shift = 0;; shift += 7) {
    const unsigned char next = byte();
    if (shift > 56) damaged();
    x |= std::uint64_t(next & 0x7f) << shift;
    if (next < 0x80) break;
  }
  if (x > max) damaged();
  return x;
}

SampleCount ByteReader::samples(std::uint64_t max) {
  const std::uint64_t most = SampleCount::of(max).units(), stated = count(first_of_parts + most);
  if (stated >= first_of_parts) return SampleCount::of_units(stated - first_of_parts);
  if (stated > max) damaged();
  return SampleCount::of(stated);
}

double ByteReader::real() {
  if (rest_.size() < 8) damaged();
  double x = 0;
  std::memcpy(&x, rest_.data(), 8);
  rest_.remove_prefix(8);
  if (!std::isfinite(x)) damaged();
  return x;
}

void ByteReader::words(std::span<std::uint64_t> words) {
  std::array<char, 32> bytes{};
  const unsigned char header = byte();
  const std::size_t size = 8 * words.size(), unit = size / units, first = std::size_t(header >> 4),
                    end = first + (header & 15u) + 1;
  if (header != zero_header) {
    if (end > units || rest_.size() < (end - first) * unit) damaged();
    std::memcpy(&bytes[first * unit], rest_.data(), (end - first) * unit);
    rest_.remove_prefix((end - first) * unit);
    if (bytes[end * unit - 1] < 0) std::memset(bytes.data() + end * unit, -1, size - end * unit);
  }
  std::memcpy(words.data(), bytes.data(), size);
}

ExactSum ByteReader::sum(std::uint64_t terms) {
  std::array<std::uint64_t, 2> parts{};
  words(parts);
  const auto sum = Int128(UInt128(parts[1]) << 64 | parts[0]);
  const Int128 bound = Int128(terms) << 102;
  if (sum > bound || sum < -bound) damaged();
  return ExactSum::of_units(sum);
}

SmallExactSum ByteReader::small_sum() {
  const Int128 sum = this->sum(1).units();
  if (sum > Int128(1) << 62 || sum < -(Int128(1) << 62)) damaged();
  return SmallExactSum::of_units(std::int64_t(sum));
}

ExactProducts ByteReader::products() {
  ExactProducts::Words parts{};
  words(parts);
  return ExactProducts::of_words(parts);
}

namespace {

void write(ByteWriter& out, const PixelSums& p) {
  for (std::uint32_t n : {p.passes, p.half_passes, p.non_finite, p.samples}) out.count(n);
  out.samples(p.hits), out.count(p.object);
  if (p.object != 0) out.count(std::uint64_t(p.object_pass));
  for (const ExactMoments& channel : p.radiance) out.sum(channel.sum()), out.sum(channel.squares());
  out.sum(p.half);
  // Samples that hit nothing have emission where other rays of theirs have met it.
  out.count(p.emission_rays);
  if (p.hits.is_zero() && p.emission_rays > p.samples) out.sum(p.emission);
  if (p.hits.is_zero()) return;
  for_each_feature(p, p, [&](const auto& sum, const auto&, double) { out.sum(sum); });
}

PixelSums read_pixel(ByteReader& in, std::uint64_t passes, bool has_emission_rays) {
  PixelSums p;
  p.passes = std::uint32_t(in.count(passes)), p.half_passes = std::uint32_t(in.count(p.passes));
  p.non_finite = std::uint32_t(in.count(max_film_samples)), p.samples = std::uint32_t(in.count(max_film_samples));
  p.hits = in.samples(p.samples), p.object = std::uint32_t(in.count(0xffffffffu));
  if (p.object != 0) p.object_pass = int(in.count(max_pass_number));
  for (ExactMoments& channel : p.radiance) {
    const ExactSum sum = in.sum(p.passes);
    channel = ExactMoments::of(sum, in.products());
  }
  p.half = in.sum(p.passes);
  p.emission_rays = has_emission_rays ? in.count(std::uint64_t(p.samples) * max_emission_rays) : p.samples;
  if (p.hits.is_zero() && p.emission_rays > p.samples) p.emission = in.sum(p.samples);
  if (p.hits.is_zero()) return p;
  for_each_feature(p, p, [&]<class Sum>(Sum& sum, const Sum&, double) {
    if constexpr (std::is_same_v<Sum, ExactSum>)
      sum = in.sum(p.samples);
    else
      sum = in.small_sum();
  });
  return p;
}

}  // namespace

void Film::write_tile(const PixelBounds& b, std::string& bytes) const {
  ByteWriter out(bytes);
  const FilmTile& tile = tiles_.at(index_of_cell(b.x0, b.y0));
  out.count(tile.passes.size());
  for (const FilmPass& pass : tile.passes) {
    out.count(std::uint64_t(pass.pass)), out.count(std::uint64_t(pass.pixels));
    for (double x : pass.sum) out.real(x);
  }
  if (tile.passes.empty()) return;
  for (int y = b.y0; y < b.y1; ++y)
    for (int x = b.x0; x < b.x1; ++x) {
      write(out, pixels_[index_of_cell(x, y)]);
      if (has_halves()) halves_[index_of_cell(x, y)].write(out);
      if (layers_) layers_->write_pixel(x, y, out);
    }
}

void Film::read_tile(const PixelBounds& b, ByteReader& in, bool has_emission_rays) {
  FilmTile& tile = name_tile(b);
  const std::uint64_t passes = in.count(max_film_samples);
  for (std::uint64_t i = 0; i < passes; ++i) {
    FilmPass pass;
    pass.pass = int(in.count(max_pass_number)), pass.pixels = int(in.count(std::uint64_t(b.area())));
    for (double& x : pass.sum) x = in.real();
    if (!tile.passes.empty() && tile.passes.back().pass >= pass.pass) damaged();
    tile.passes.push_back(pass);
  }
  if (tile.passes.empty()) return;
  for (int y = b.y0; y < b.y1; ++y)
    for (int x = b.x0; x < b.x1; ++x) {
      PixelSums& pixel = pixels_[index_of_cell(x, y)];
      pixel = read_pixel(in, passes, has_emission_rays);
      if (has_halves()) halves_[index_of_cell(x, y)].read(pixel, in);
      if (layers_) layers_->read_pixel(x, y, pixel, in);
    }
}

void LayerFilm::write_pixel(int x, int y, ByteWriter& out) const {
  const std::size_t first = first_sum(x, y), stride = std::size_t(count_) + 1;
  out.count(counts_[index(x, y)].samples);
  for (std::size_t i = first; i < first + stride; ++i)
    for (const ExactSum& channel : sums_[i].c) out.sum(channel);
  for (std::size_t i = first; has_spread() && i < first + stride; ++i)
    for (int c = 0; c < rgb_size; ++c) {
      out.sum(spreads_[i].own[c].sum()), out.sum(spreads_[i].own[c].squares());
      out.sum(spreads_[i].with_all[c]);
    }
  if (!has_halves()) return;
  out.count(half_samples_[index(x, y)]);
  for (std::size_t i = first_half_sum(x, y), end = i + std::size_t(count_); i < end; ++i)
    for (const ExactSum& channel : half_sums_[i].c) out.sum(channel);
}

void LayerFilm::read_pixel(int x, int y, const PixelSums& film, ByteReader& in) {
  const std::size_t first = first_sum(x, y), stride = std::size_t(count_) + 1;
  Counts& counts = counts_[index(x, y)];
  counts.samples = in.count(film.samples), counts.passes = int(film.passes);
  for (std::size_t i = first; i < first + stride; ++i)
    for (ExactSum& channel : sums_[i].c) channel = in.sum(counts.samples);
  for (std::size_t i = first; has_spread() && i < first + stride; ++i)
    for (int c = 0; c < rgb_size; ++c) {
      const ExactSum sum = in.sum(film.passes);
      spreads_[i].own[c] = ExactMoments::of(sum, in.products());
      spreads_[i].with_all[c] = in.products();
    }
  if (!has_halves()) return;
  const std::uint64_t samples = half_samples_[index(x, y)] = in.count(counts.samples);
  for (std::size_t i = first_half_sum(x, y), end = i + std::size_t(count_); i < end; ++i)
    for (ExactSum& channel : half_sums_[i].c) channel = in.sum(samples);
}

}  // namespace montelux
