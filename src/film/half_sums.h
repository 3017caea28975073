// The sums of a pixel over the passes with even numbers, the first half. These passes and the others are two
// independent halves of the image, so that a filter can be tested on data that it has not used.
#pragma once
#include <array>
#include <cstdint>

#include "color/rgb.h"
#include "film/sample_count.h"
#include "math/exact_sum.h"

namespace montelux {

class ByteReader;
class ByteWriter;
struct PixelPass;
struct PixelSums;

// The means over one half of the passes of a pixel. The features are means over the samples that hit a surface.
struct PixelHalf {
  double mean[rgb_size] = {};
  double emission[rgb_size] = {};  // the part of the mean that the camera sees directly of emitters
  double albedo[rgb_size] = {}, normal[3] = {};
  double share = 0;  // of the passes of the pixel
};

struct HalfSums {
  ExactSum radiance[rgb_size];                // of the pass means
  ExactSum emission[2][rgb_size];             // of the pass means, over the first half and over the second
  SmallExactSum albedo[rgb_size], normal[3];  // as PixelSums has them
  SampleCount hits;

  // A pass of either half.
  void add(const PixelPass& sums, bool in_first_half);
  void merge(const HalfSums& other);
  // Both halves, from these sums and those over all passes, `all`. Both are the whole where one of them has no pass.
  std::array<PixelHalf, 2> halves(const PixelSums& all) const;

  // As Film::write_tile() and Film::read_tile(), for one pixel.
  void write(ByteWriter& out) const;
  void read(const PixelSums& all, ByteReader& in);
};

}  // namespace montelux
