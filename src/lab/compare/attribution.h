// How the variance of an image splits over the layers of its light. For the light L of a pass, L = L_1 + ... + L_n, the
// share of layer i is Cov(L_i, L) / Var(L): the shares sum to one whatever the covariances between layers; a layer that
// reduces the noise of others has a negative share. All components are treated alike, and the share of one does not
// depend on how the remainder is split (Shorrocks 1982, "Inequality Decomposition by Factor Components").
#pragma once
#include <string>
#include <vector>

#include "film/film.h"
#include "image/pixel_buffer.h"
#include "lab/compare/statistics.h"

namespace montelux::lab {

// Variances of one pass, summed over pixels and channels; the unbiased estimates of one repeat.
struct AttributionRound {
  double all = 0;              // Var(L)
  std::vector<double> layers;  // Cov(L_i, L)
};

// The same for every pixel, summed over channels and repeats: first Var(L), then the layers; one value per pixel.
using PixelShares = std::vector<std::vector<double>>;

// From a film with layers and their spread, with at least two passes. Adds to `pixels`.
AttributionRound attribute(const Film& film, PixelShares& pixels);

struct LayerShare {
  std::string name;
  Measured share;
};
// All layers of one family; their shares sum to one.
struct FamilyShares {
  std::string name;
  std::vector<LayerShare> layers;
};
struct Attribution {
  std::vector<FamilyShares> families;
  // For every layer in the order of the families, the share by pixel, over the window of 3 x 3 pixels around it.
  std::vector<std::vector<float>> by_pixel;
};

struct AttributionFrame {
  int width, height;
  double confidence;
};
Attribution attribution_of(const LayerPlan& plan, const std::vector<AttributionRound>& rounds,
                           const PixelShares& pixels, const AttributionFrame& frame);

}  // namespace montelux::lab
