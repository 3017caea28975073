// Lamps of few pixels that the camera sees: what is so bright, and ends so sharply, that no filter may spread it.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "denoise/denoise.h"

namespace montelux {

// Of an image, or of one of its layers: the light of small lamps, which stays as it was rendered.
struct KeptLight {
  std::array<ColorPlanes, 2> halves;
  // Of the mean of both halves, and the covariance of that mean with the mean of the rest. Both are unbiased, and
  // unknown (empty) where the variance of the image or layer is.
  ColorPlanes variance, covariance;
};

// An image without the light of its small lamps, and that light; the two sum to the image and its layers. The rest does
// not know the whole.
struct SplitImage {
  NoisyImage rest;
  KeptLight kept;
  std::vector<KeptLight> kept_layers;
  std::vector<std::uint8_t> is_lamp;  // 1: the pixel is at a small lamp, whose light is kept if a sample finds it
};

// Nothing if the image shows no small lamp. Emission counts as such where, within two pixels, it is brighter than 300
// times the image around without its emission. A few samples that find such a lamp look like noise of all pixels
// around it, and a filter that averages over these makes them brighter by many times what they show; emission that the
// camera sees directly is never that noise. Of each layer the same part is kept, by pixel and channel, so that layers
// that sum to the image still do.
std::optional<SplitImage> split_small_lamps(const NoisyImage& image);

}  // namespace montelux
