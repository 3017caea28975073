// Pilots of integrators on windows of an image.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "integrator/integrator.h"
#include "render/image_settings.h"

namespace montelux {

inline constexpr int passes_of_pilot = 2;

using PixelMean = std::array<double, rgb_size>;

// One candidate's pilot on one window.
struct WindowPilot {
  std::array<std::vector<PixelMean>, passes_of_pilot> passes;  // means of the samples, by pixel
  double cost = 0;                                             // of all its rays
};

// A candidate's pilot on some windows.
struct CandidatePilot {
  std::size_t candidate = 0;
  int samples_per_pass = 1;
  std::vector<WindowPilot> windows;
  double samples() const { return double(passes_of_pilot * samples_per_pass); }
};

// Squares of the image, in an order whose first ones are spread over it.
std::vector<PixelBounds> windows_of(const PixelBounds& bounds, std::uint32_t seed);

// A coarser image of about so many cells, at least one pixel each, that show the mean of their pixels.
PixelGrid coarse_image(const PixelBounds& bounds, double cells);

// The means of the pixels of a window in one pass, as those of an image of its own; with a grid, of its cells. Returns
// the rays.
RayCounts trace_window(const AnyIntegrator& integrator, const ImageSettings& image, const PixelBounds& window, int pass,
                       int samples, std::vector<PixelMean>& means, const std::optional<PixelGrid>& grid = {});

// The squares of `side` pixels of a window, as the pixels of a smaller one; and its pilot as one of these, each the
// mean of its pixels.
PixelBounds cells_of(const PixelBounds& window, int side);
void average_cells(WindowPilot& pilot, const PixelBounds& window, int side);

// A pilot of a whole image of cells as pilots of its squares of `side` cells, which are added to `windows`.
std::vector<WindowPilot> split_pilot(const WindowPilot& whole, const PixelBounds& cells, int side,
                                     std::vector<PixelBounds>& windows);

}  // namespace montelux
