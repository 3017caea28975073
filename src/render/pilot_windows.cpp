#include "render/pilot_windows.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "film/film.h"
#include "mc/random.h"
#include "render/float_mode.h"
#include "render/shared_samples.h"

namespace montelux {

namespace {

PixelMean mean_of(const PixelPass& pass) {
  PixelMean mean{};
  for (std::size_t c = 0; c < rgb_size; ++c) mean[c] = pass.finite > 0 ? pass.sum[c] / pass.finite : 0;
  return mean;
}

// The pixels around a small window are more than those around the tiles of a render.
RayCounts without_surroundings(RayCounts rays, int window, int traced) {
  for (std::uint64_t* count : {&rays.camera, &rays.scattered, &rays.shadow})
    *count = *count * std::uint64_t(window) / std::uint64_t(traced);
  return rays;
}

}  // namespace

std::vector<PixelBounds> windows_of(const PixelBounds& bounds, std::uint32_t seed) {
  // Large windows show pixels that share samples with their neighbours as the whole image does; small ones are more
  // numerous.
  constexpr int large = 32, small = 16;
  constexpr std::size_t enough = 64;
  std::vector<PixelBounds> tiles = tiles_of(bounds, large);
  if (tiles.size() < enough) tiles = tiles_of(bounds, small);
  const std::size_t count = tiles.size();
  std::size_t step = std::max<std::size_t>(std::size_t(std::lround(double(count) * 0.6180339887)), 1);
  while (std::gcd(step, count) != 1) ++step;
  std::vector<PixelBounds> windows;
  for (std::size_t i = 0, at = mix_bits(seed) % count; i < count; ++i, at = (at + step) % count)
    windows.push_back(tiles[at]);
  return windows;
}

PixelGrid coarse_image(const PixelBounds& bounds, double cells) {
  PixelGrid grid{bounds, 1, true};
  while (PixelGrid{bounds, grid.stride + 1, true}.cells().area() >= cells) ++grid.stride;
  return grid;
}

RayCounts trace_window(const AnyIntegrator& integrator, const ImageSettings& image, const PixelBounds& window, int pass,
                       int samples, std::vector<PixelMean>& means, const std::optional<PixelGrid>& grid) {
  const FlushDenormals flush;
  std::vector<PixelPass> sums(std::size_t(window.area()));
  RayCounts rays;
  if (const PixelIntegrator* pixels = integrator.pixel(); pixels && image.sharing && !grid) {
    const SharedSamples shared(*image.sharing, window, image.points(pass, samples));
    TilePass request{shared.around(), image.points(pass, samples), image.shutter};
    request.offsets = shared.offsets();
    std::vector<PixelSample> out(std::size_t(request.tile.area()) * std::size_t(samples));
    rays = without_surroundings(pixels->trace(request, out), window.area(), request.tile.area());
    shared.sum(out, sums);
  } else if (pixels) {
    std::vector<PixelSample> out(sums.size() * std::size_t(samples));
    rays = pixels->trace({window, image.points(pass, samples), image.shutter, {}, {}, grid}, out);
    for (std::size_t i = 0; i < out.size(); ++i) sums[i / std::size_t(samples)].add(out[i]);
  } else {
    const CoupledIntegrator& coupled = *integrator.coupled();
    const int frames = coupled.warm_up() + samples;
    const std::unique_ptr<FrameSeries> series =
        coupled.begin({window, image.points(pass, frames), image.shutter, {}, grid});
    std::vector<PixelSample> out(sums.size());
    for (int frame = 0; frame < frames; ++frame) {
      out.assign(out.size(), {});
      for (int stage = 0; stage < coupled.stages(); ++stage) rays += series->run_alone({frame, stage}, window, out);
      if (frame < coupled.warm_up()) continue;
      for (std::size_t i = 0; i < out.size(); ++i) sums[i].add(out[i]);
    }
  }
  means.reserve(sums.size());
  for (const PixelPass& sum : sums) means.push_back(mean_of(sum));
  return rays;
}

PixelBounds cells_of(const PixelBounds& window, int side) {
  return {0, 0, (window.width() + side - 1) / side, (window.height() + side - 1) / side};
}

void average_cells(WindowPilot& pilot, const PixelBounds& window, int side) {
  const PixelBounds cells = cells_of(window, side);
  const auto cell_of = [&](int x, int y) { return std::size_t(y / side * cells.width() + x / side); };
  for (std::vector<PixelMean>& pass : pilot.passes) {
    std::vector<PixelMean> means(std::size_t(cells.area()), PixelMean{});
    std::vector<int> counts(means.size());
    for (int y = 0; y < window.height(); ++y)
      for (int x = 0; x < window.width(); ++x) {
        ++counts[cell_of(x, y)];
        for (std::size_t c = 0; c < rgb_size; ++c)
          means[cell_of(x, y)][c] += pass[std::size_t(y * window.width() + x)][c];
      }
    for (std::size_t i = 0; i < means.size(); ++i)
      for (double& value : means[i]) value /= counts[i];
    pass = std::move(means);
  }
}

std::vector<WindowPilot> split_pilot(const WindowPilot& whole, const PixelBounds& cells, int side,
                                     std::vector<PixelBounds>& windows) {
  std::vector<WindowPilot> parts;
  for (const PixelBounds& window : tiles_of(cells, side)) {
    windows.push_back(window);
    WindowPilot& part = parts.emplace_back();
    part.cost = whole.cost * window.area() / cells.area();
    for (std::size_t pass = 0; pass < whole.passes.size(); ++pass)
      for (int y = window.y0; y < window.y1; ++y)
        for (int x = window.x0; x < window.x1; ++x)
          part.passes[pass].push_back(
              whole.passes[pass][std::size_t(y - cells.y0) * std::size_t(cells.width()) + std::size_t(x - cells.x0)]);
  }
  return parts;
}

}  // namespace montelux
