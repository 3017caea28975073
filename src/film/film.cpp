#include "film/film.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <stdexcept>

#include "film/limits.h"

namespace montelux {

namespace {

bool is_before(const FilmPass& a, const FilmPass& b) { return a.pass < b.pass; }

// The numbers of all passes that any tile has.
std::vector<int> all_numbers(const FilmTiles& tiles) {
  std::vector<int> all;
  for (const auto& [index, tile] : tiles) {
    const auto same = [](int pass, const FilmPass& own) { return pass == own.pass; };
    if (std::equal(all.begin(), all.end(), tile.passes.begin(), tile.passes.end(), same)) continue;
    std::vector<int> own, both;
    for (const FilmPass& pass : tile.passes) own.push_back(pass.pass);
    std::ranges::set_union(all, own, std::back_inserter(both));
    all = std::move(both);
  }
  return all;
}

// The mean of one tile over its passes.
struct TileMean {
  double mean[rgb_size] = {};
  double pixels = 0;  // pixels with a finite sample, in the mean over passes
  int passes = 0;     // passes with such pixels
  explicit TileMean(const FilmTile& tile) {
    for (const FilmPass& pass : tile.passes) {
      if (pass.pixels == 0) continue;
      ++passes, pixels += pass.pixels;
      for (int c = 0; c < rgb_size; ++c) mean[c] += pass.sum[c] / pass.pixels;
    }
    for (double& m : mean) m /= std::max(passes, 1);
    pixels /= std::max(passes, 1);
  }
};

}  // namespace

std::vector<PixelBounds> tiles_of(const PixelBounds& b, int side) {
  std::vector<PixelBounds> tiles;
  for (int y = b.y0; y < b.y1; y += side)
    for (int x = b.x0; x < b.x1; x += side) tiles.push_back({x, y, std::min(x + side, b.x1), std::min(y + side, b.y1)});
  return tiles;
}

void PixelFeatures::add(const Features& f) {
  const auto finite = [](float x) { return std::isfinite(x) ? x : 0; };
  for (float channel : f.emission.c) emission += finite(channel / rgb_size);
  samples += 1, emission_rays += f.emission_rays;
  if (f.coverage <= 0) return;
  hits += 1;
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    ((sums[I] += finite(feature_rows[feature_channels[I].row].value(f, feature_channels[I].channel))), ...);
  }
  (std::make_index_sequence<feature_channel_count>());
  if (object == 0) object = f.object;
}

void PixelPass::add(const PixelSample& sample) {
  features.add(sample.features);
  if (!is_kept(sample.radiance)) {
    ++non_finite;
    return;
  }
  ++finite;
  for (int i = 0; i < rgb_size; ++i)
    sum[i] += sample.radiance.c[i], emission[i] += within(sample.features.emission.c[i], ExactSum::largest);
}

void PixelSums::add(int pass, const PixelPass& added) {
  const PixelFeatures& f = added.features;
  samples += std::uint32_t(f.samples), hits.add(f.hits), non_finite += std::uint32_t(added.non_finite);
  emission_rays += std::uint64_t(f.emission_rays);
  if (f.hits == 0 && f.emission == 0) return;
  const double sampled = std::max(f.hits, 1.0);
  for_each_feature(*this, f, [&](auto& sum, double of_pass, double limit) {
    sum.add(within(of_pass, std::min(limit * sampled, double(ExactSum::largest))));
  });
  if (f.object != 0 && (object == 0 || pass < object_pass)) object = f.object, object_pass = pass;
}

void PixelSums::add_mean(int pass, const double (&mean)[rgb_size]) {
  ++passes;
  for (int c = 0; c < rgb_size; ++c) radiance[c].add(mean[c]);
  if (pass % 2 != 0) return;
  ++half_passes;
  for (double channel : mean) half.add(channel / rgb_size);
}

void PixelSums::merge(const PixelSums& other) {
  for (int c = 0; c < rgb_size; ++c) radiance[c].merge(other.radiance[c]);
  for_each_feature(*this, other, [](auto& sum, const auto& more, double) { sum += more; });
  half += other.half;
  passes += other.passes, half_passes += other.half_passes, non_finite += other.non_finite;
  hits += other.hits, samples += other.samples, emission_rays += other.emission_rays;
  if (other.object != 0 && (object == 0 || other.object_pass < object_pass))
    object = other.object, object_pass = other.object_pass;
}

PixelEstimate PixelSums::estimate() const {
  PixelEstimate e;
  for (int c = 0; c < rgb_size; ++c) e.mean[c] = radiance[c].mean(passes), e.m2[c] = radiance[c].m2(passes);
  e.half_sum = half.value(), e.half_passes = half_passes;
  e.passes = passes, e.non_finite = non_finite;
  return e;
}

std::array<double, rgb_size> PixelSums::mean() const {
  std::array<double, rgb_size> mean{};
  for (int c = 0; c < rgb_size; ++c) mean[std::size_t(c)] = radiance[c].mean(passes);
  return mean;
}

PixelFeatures PixelSums::features() const {
  PixelFeatures f;
  for_each_feature(f, *this, [](double& to, const auto& sum, double) { to = sum.value(); });
  f.hits = hits.value(), f.samples = samples, f.emission_rays = double(emission_rays), f.object = object;
  return f;
}

void PixelEstimate::merge(const PixelEstimate& other) {
  for (int c = 0; c < rgb_size; ++c) {
    Moments both{passes, 0, mean[c], m2[c]};
    both.merge({other.passes, 0, other.mean[c], other.m2[c]});
    mean[c] = both.mean, m2[c] = both.m2;
  }
  half_sum += other.half_sum, half_passes += other.half_passes;
  passes += other.passes, non_finite += other.non_finite;
}

double PixelEstimate::variance_of_mean(int channel) const {
  if (passes < 2) return std::numeric_limits<double>::infinity();
  return Moments{passes, 0, mean[channel], m2[channel]}.variance() / passes;
}

bool FilmTile::has(int pass) const { return std::ranges::binary_search(passes, pass, {}, &FilmPass::pass); }

Film::Film(PixelBounds bounds, const std::optional<LayerPlan>& layers, int stride, bool halves)
    : grid_{bounds, stride}, cells_(grid_.cells()), pixels_(std::size_t(cells_.area())) {
  if (layers) layers_.emplace(cells_, layers->count(), layers->spread, halves);
  if (halves) halves_.resize(pixels_.size());
}

FilmTile& Film::name_tile(const PixelBounds& cells) {
  const std::size_t index = index_of_cell(cells.x0, cells.y0);
  auto found = tiles_.find(index);
  if (found == tiles_.end()) found = tiles_.emplace(index, FilmTile{cells, {}}).first;
  if (!(found->second.cells == cells)) throw std::invalid_argument("the tiles of the film are other ones");
  return found->second;
}

int Film::passes(const PixelBounds& tile) const {
  const auto found = tiles_.find(index_of_cell(tile.x0, tile.y0));
  return found == tiles_.end() ? 0 : int(found->second.passes.size());
}

std::vector<int> Film::pass_numbers(const PixelBounds& tile) const {
  std::vector<int> numbers;
  const auto found = tiles_.find(index_of_cell(tile.x0, tile.y0));
  if (found == tiles_.end()) return numbers;
  for (const FilmPass& pass : found->second.passes) numbers.push_back(pass.pass);
  return numbers;
}

bool Film::has(const PixelBounds& tile, int pass) const {
  const auto found = tiles_.find(index_of_cell(tile.x0, tile.y0));
  return found != tiles_.end() && found->second.has(pass);
}

void Film::add_pass(const PixelBounds& tile, int pass, int samples_per_pixel, std::span<const PixelSample> samples,
                    std::span<const ExactRgb> sums) {
  FilmPass& whole = new_pass(tile, pass);
  const PixelSample* sample = samples.data();
  for (std::size_t i = 0; i < std::size_t(tile.area()); ++i) {
    PixelPass of_pixel;
    for (int s = 0; s < samples_per_pixel; ++s, ++sample) of_pixel.add(*sample);
    add_pixel(tile, i, of_pixel, sums, whole);
  }
}

void Film::add_pass(const PixelBounds& tile, int pass, std::span<const PixelPass> pixels,
                    std::span<const ExactRgb> sums) {
  FilmPass& whole = new_pass(tile, pass);
  for (std::size_t i = 0; i < std::size_t(tile.area()); ++i) add_pixel(tile, i, pixels[i], sums, whole);
}

FilmPass& Film::new_pass(const PixelBounds& tile, int pass) {
  std::vector<FilmPass>& passes = name_tile(tile).passes;
  const auto at = std::ranges::lower_bound(passes, pass, {}, &FilmPass::pass);
  if (at != passes.end() && at->pass == pass) throw std::invalid_argument("the film has this pass");
  return *passes.insert(at, {pass, 0, {}});
}

void Film::add_pixel(const PixelBounds& tile, std::size_t i, PixelPass of_pixel, std::span<const ExactRgb> sums,
                     FilmPass& whole) {
  const int width = tile.width(), x = tile.x0 + int(i) % width, y = tile.y0 + int(i) / width;
  const bool in_first_half = whole.pass % 2 == 0;
  if (layers_ && of_pixel.finite > 0) {
    const std::size_t stride = std::size_t(layers_->count()) + 1;
    const auto own = sums.subspan(i * stride, stride);
    layers_->add(x, y, of_pixel.finite, own, in_first_half);
    for (int c = 0; c < rgb_size; ++c) of_pixel.sum[c] = own.front().c[c].value();
  }
  const std::size_t index = index_of_cell(x, y);
  PixelSums& pixel = pixels_[index];
  if (has_halves()) halves_[index].add(of_pixel, in_first_half);
  pixel.add(whole.pass, of_pixel);
  if (of_pixel.finite == 0) return;
  double mean[rgb_size] = {};
  for (int c = 0; c < rgb_size; ++c) whole.sum[c] += mean[c] = of_pixel.sum[c] / of_pixel.finite;
  ++whole.pixels;
  pixel.add_mean(whole.pass, mean);
}

void Film::merge(const Film& other) {
  if (!(grid_ == other.grid_)) throw std::invalid_argument("films of different bounds or strides cannot be merged");
  if (layers_.has_value() != other.layers_.has_value())
    throw std::invalid_argument("films of different layers cannot be merged");
  if (has_halves() != other.has_halves()) throw std::invalid_argument("films with and without halves cannot be merged");
  int cells = 0;
  for (const auto& [index, theirs] : other.tiles_)
    for (const FilmPass& pass : theirs.passes)
      if (has(theirs.cells, pass.pass)) throw std::invalid_argument("both films have the same pass");
  for (const auto& [index, theirs] : other.tiles_) {
    std::vector<FilmPass>& ours = name_tile(theirs.cells).passes;
    ours.insert(ours.end(), theirs.passes.begin(), theirs.passes.end());
    std::ranges::sort(ours, is_before);
  }
  for (const auto& [index, tile] : tiles_) cells += tile.cells.area();
  if (cells > cells_.area()) throw std::invalid_argument("films of different tiles cannot be merged");
  if (layers_) layers_->merge(*other.layers_);
  for (std::size_t i = 0; i < pixels_.size(); ++i) pixels_[i].merge(other.pixels_[i]);
  for (std::size_t i = 0; i < halves_.size(); ++i) halves_[i].merge(other.halves_[i]);
}

std::uint64_t Film::non_finite() const {
  std::uint64_t n = 0;
  for (const PixelSums& p : pixels_) n += p.non_finite;
  return n;
}

// With the mean m_t of tile t over its n_t passes and its share w_t of the pixels the mean is the sum of w_t m_t.
// Passes are independent of each other, while in a pass the tiles y_tp may depend on each other; so the variance is
// estimated by the sum over passes of the square of the sum over tiles of w_t (y_tp - m_t) / sqrt(n_t (n_t - 1)): for
// tiles of the same passes that is the variance of the image means of these over their number.
ImageEstimate image_of(const FilmTiles& tiles, int cells) {
  ImageEstimate image;
  int covered = 0, fewest = std::numeric_limits<int>::max();
  double pixels = 0;
  std::vector<TileMean> means;
  for (const auto& [index, tile] : tiles) {
    covered += tile.passes.empty() ? 0 : tile.cells.area();
    const TileMean& own = means.emplace_back(tile);
    if (own.passes > 0) pixels += own.pixels, fewest = std::min(fewest, own.passes);
  }
  if (covered < cells || pixels == 0) return image;
  image.passes = fewest;
  const std::vector<int> numbers = all_numbers(tiles);
  std::vector<std::array<double, rgb_size>> deviations(numbers.size());
  auto own = means.begin();
  for (auto tile = tiles.begin(); tile != tiles.end(); ++tile, ++own) {
    if (own->passes == 0) continue;
    const double n = own->passes, share = own->pixels / pixels, weight = share / std::sqrt(n * std::max(n - 1, 1.0));
    for (int c = 0; c < rgb_size; ++c) image.mean[c] += share * own->mean[c];
    std::size_t at = 0;
    for (const FilmPass& pass : tile->second.passes) {
      while (numbers[at] != pass.pass) ++at;
      for (int c = 0; c < rgb_size && pass.pixels > 0; ++c)
        deviations[at][std::size_t(c)] += weight * (pass.sum[c] / pass.pixels - own->mean[c]);
    }
  }
  for (int c = 0; c < rgb_size; ++c) {
    double variance = 0;
    for (const auto& deviation : deviations) variance += deviation[std::size_t(c)] * deviation[std::size_t(c)];
    image.standard_error[c] = fewest < 2 ? std::numeric_limits<double>::infinity() : std::sqrt(variance);
  }
  return image;
}

ErrorEstimate Film::error() const {
  if (grid_.stride > 1) return {};
  if (std::none_of(pixels_.begin(), pixels_.end(), [](const PixelSums& p) { return p.passes > 1; })) return {};
  FilmPlanes planes(bounds());
  planes.copy(*this, bounds());
  return estimate_error(planes);
}

double Film::mse() const {
  double sum = 0, pixels = 0;
  for (const PixelSums& sums : pixels_) {
    if (sums.passes < 2) continue;
    const PixelEstimate pixel = sums.estimate();
    for (int c = 0; c < rgb_size; ++c) sum += pixel.variance_of_mean(c) / rgb_size;
    pixels += 1;
  }
  return pixels > 0 ? sum / pixels : 0;
}

}  // namespace montelux
