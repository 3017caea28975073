#include "film/film.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace montelux {

namespace {

// Adds one value to a mean and a sum of squared deviations; n counts the new value.
void add_value(double x, double n, double& mean, double& m2) {
  double delta = x - mean;
  mean += delta / n;
  m2 += delta * (x - mean);
}

bool all_finite(const Rgb& c) {
  for (float x : c.c)
    if (!std::isfinite(x)) return false;
  return true;
}

}  // namespace

void PixelFeatures::add(const Features& f) {
  samples += 1;
  if (f.coverage <= 0) return;
  hits += 1;
  for (int i = 0; i < spectrum_size; ++i) {
    emission += std::isfinite(f.emission.c[i]) ? f.emission.c[i] / spectrum_size : 0;
    albedo[i] += std::isfinite(f.albedo.c[i]) ? f.albedo.c[i] : 0;
  }
  const float n[3] = {f.normal.x, f.normal.y, f.normal.z}, p[3] = {f.position.x, f.position.y, f.position.z};
  for (int i = 0; i < 3; ++i) normal[i] += n[i], position[i] += p[i];
  depth += f.depth;
  if (object == 0) object = f.object;
}

void PixelFeatures::merge(const PixelFeatures& other) {
  for (int c = 0; c < spectrum_size; ++c) albedo[c] += other.albedo[c];
  for (int c = 0; c < 3; ++c) normal[c] += other.normal[c], position[c] += other.position[c];
  emission += other.emission, depth += other.depth, hits += other.hits, samples += other.samples;
  if (object == 0) object = other.object;
}

void PixelPass::add(const PixelSample& sample) {
  features.add(sample.features);
  if (!all_finite(sample.radiance)) {
    ++non_finite;
    return;
  }
  ++finite;
  for (int i = 0; i < spectrum_size; ++i) sum[i] += sample.radiance.c[i];
}

void PixelEstimate::add(const double (&pass_mean)[spectrum_size]) {
  if (passes % 2 == 0) {
    for (double channel : pass_mean) half_sum += channel / spectrum_size;
    ++half_passes;
  }
  ++passes;
  for (int i = 0; i < spectrum_size; ++i) add_value(pass_mean[i], passes, mean[i], m2[i]);
}

void PixelEstimate::merge(const PixelEstimate& other) {
  non_finite += other.non_finite;
  if (other.passes == 0) return;
  // Chan, Golub and LeVeque 1979.
  double n = double(passes) + double(other.passes);
  for (int i = 0; i < spectrum_size; ++i) {
    double delta = other.mean[i] - mean[i];
    mean[i] += delta * (double(other.passes) / n);
    m2[i] += other.m2[i] + delta * delta * (double(passes) * double(other.passes) / n);
  }
  half_sum += other.half_sum, half_passes += other.half_passes;
  passes += other.passes;
}

double PixelEstimate::variance_of_mean(int channel) const {
  if (passes < 2) return std::numeric_limits<double>::infinity();
  return m2[channel] / (double(passes) - 1) / double(passes);
}

Film::Film(PixelBounds bounds, const std::optional<LayerPlan>& layers, int stride)
    : grid_{bounds, stride},
      cells_(grid_.cells()),
      pixels_(std::size_t(cells_.area())),
      features_(std::size_t(cells_.area())),
      tile_sums_(std::size_t(cells_.area())) {
  if (layers) layers_.emplace(cells_, layers->count(), layers->spread);
}

void Film::PassSum::add(const double (&mean)[spectrum_size]) {
  for (int i = 0; i < spectrum_size; ++i) sum[i] += mean[i];
  ++pixels;
}

void Film::keep_pass_sum(const PixelBounds& tile, int pass, PassSum sum) {
  sum.cells = tile.area();
  auto& sums = tile_sums_[index_of_cell(tile.x0, tile.y0)];
  if (sums.size() <= std::size_t(pass)) sums.resize(std::size_t(pass) + 1);
  sums[std::size_t(pass)] = sum;
}

void Film::add_pass(const PixelBounds& tile, int pass, int samples_per_pixel, std::span<const PixelSample> samples,
                    std::span<const ExactRgb> sums) {
  PassSum tile_sum;
  const PixelSample* sample = samples.data();
  for (int y = tile.y0; y < tile.y1; ++y)
    for (int x = tile.x0; x < tile.x1; ++x) {
      PixelEstimate& estimate = pixels_[index_of_cell(x, y)];
      PixelFeatures& features = features_[index_of_cell(x, y)];
      double mean[spectrum_size] = {};
      int finite = 0;
      for (int s = 0; s < samples_per_pixel; ++s, ++sample) {
        features.add(sample->features);
        if (!all_finite(sample->radiance)) continue;
        ++finite;
        for (int i = 0; i < spectrum_size; ++i) mean[i] += sample->radiance.c[i];
      }
      estimate.non_finite += std::uint32_t(samples_per_pixel - finite);
      if (finite == 0) continue;
      if (layers_) {
        const std::size_t stride = std::size_t(layers_->count()) + 1;
        const auto own = sums.subspan(
            std::size_t(y - tile.y0) * std::size_t(tile.width()) * stride + std::size_t(x - tile.x0) * stride, stride);
        layers_->add(x, y, finite, own);
        for (int i = 0; i < spectrum_size; ++i) mean[i] = own.front().c[i].value();
      }
      for (double& m : mean) m /= finite;
      estimate.add(mean);
      tile_sum.add(mean);
    }
  keep_pass_sum(tile, pass, tile_sum);
}

void Film::add_pass(const PixelBounds& tile, int pass, std::span<const PixelPass> pixels) {
  PassSum tile_sum;
  const PixelPass* of_pixel = pixels.data();
  for (int y = tile.y0; y < tile.y1; ++y)
    for (int x = tile.x0; x < tile.x1; ++x, ++of_pixel) {
      features_[index_of_cell(x, y)].merge(of_pixel->features);
      PixelEstimate& estimate = pixels_[index_of_cell(x, y)];
      estimate.non_finite += std::uint32_t(of_pixel->non_finite);
      if (of_pixel->finite == 0) continue;
      double mean[spectrum_size] = {};
      for (int i = 0; i < spectrum_size; ++i) mean[i] = of_pixel->sum[i] / of_pixel->finite;
      estimate.add(mean);
      tile_sum.add(mean);
    }
  keep_pass_sum(tile, pass, tile_sum);
}

void Film::merge(const Film& other) {
  if (!(grid_ == other.grid_)) throw std::invalid_argument("films of different bounds or strides cannot be merged");
  if (layers_.has_value() != other.layers_.has_value())
    throw std::invalid_argument("films of different layers cannot be merged");
  if (layers_) layers_->merge(*other.layers_);
  for (std::size_t i = 0; i < pixels_.size(); ++i) {
    pixels_[i].merge(other.pixels_[i]);
    features_[i].merge(other.features_[i]);
    tile_sums_[i].insert(tile_sums_[i].end(), other.tile_sums_[i].begin(), other.tile_sums_[i].end());
  }
}

std::uint64_t Film::non_finite() const {
  std::uint64_t n = 0;
  for (const PixelEstimate& p : pixels_) n += p.non_finite;
  return n;
}

ImageEstimate Film::image() const {
  ImageEstimate image;
  double m2[spectrum_size] = {};
  for (std::size_t pass = 0;; ++pass) {
    PassSum total;
    for (const auto& sums : tile_sums_) {
      if (pass >= sums.size()) continue;
      for (int i = 0; i < spectrum_size; ++i) total.sum[i] += sums[pass].sum[i];
      total.pixels += sums[pass].pixels, total.cells += sums[pass].cells;
    }
    if (total.cells < cells_.area()) break;
    if (total.pixels == 0) continue;
    ++image.passes;
    for (int i = 0; i < spectrum_size; ++i) add_value(total.sum[i] / total.pixels, image.passes, image.mean[i], m2[i]);
  }
  for (int i = 0; i < spectrum_size; ++i)
    image.standard_error[i] = image.passes < 2 ? std::numeric_limits<double>::infinity()
                                               : std::sqrt(m2[i] / (image.passes - 1.0) / image.passes);
  return image;
}

ErrorEstimate Film::error() const {
  if (grid_.stride > 1) return {};
  if (std::none_of(pixels_.begin(), pixels_.end(), [](const PixelEstimate& p) { return p.passes > 1; })) return {};
  FilmPlanes planes(bounds());
  planes.copy(*this, bounds());
  return estimate_error(planes);
}

double Film::mse() const {
  double sum = 0, pixels = 0;
  for (const PixelEstimate& pixel : pixels_) {
    if (pixel.passes < 2) continue;
    for (int c = 0; c < spectrum_size; ++c) sum += pixel.variance_of_mean(c) / spectrum_size;
    pixels += 1;
  }
  return pixels > 0 ? sum / pixels : 0;
}

}  // namespace montelux
