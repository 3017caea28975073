// How many passes the tiles of an image get, by what some samples show of them.
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "film/error_target.h"
#include "film/film.h"

namespace montelux {

// A tile as some samples show it.
struct TileFigures {
  double error = 0;  // the sum over its pixels of the squared error that passes lower
  double cost = 1;   // of one pass
  double pixels = 1;
};

// The tiles of an image from top to bottom and from left to right, and how many of them are in a row.
struct ImageFigures {
  std::vector<TileFigures> tiles;
  int columns = 1;
};

// What a film shows of tiles of this side, each by its own pixels alone. `rays`: of each tile of the film. `measure`:
// what is to be lowered. Pixels of fewer than two passes show no error.
ImageFigures figures_of(const Film& film, std::span<const std::uint64_t> rays, TargetMeasure measure, int tile_side);

// How many passes each tile gets where the average is one, so that the error at equal cost is the least: proportional
// to the root of error over cost (Neyman 1934). The share of a tile is decided by the 5 x 5 tiles around it without
// itself, weighted by distance: the tile's own samples may then be in the image. They reach its share only through
// means over all tiles (the part that is added, and the normalisation), one of many there; otherwise the mean of the
// image would be unbiased as long as its tiles are independent. A part of the mean of all is added, for what the
// samples have missed. The mean weighted by cost is 1, and none is below `min_share`. All are 1 where the samples show
// no error, or none that can be foreseen by the tiles around.
std::vector<double> pass_shares(const ImageFigures& image, double min_share);

// The factor by which the squared error at equal cost falls with these shares. Unbiased, since the error of a tile does
// not decide its share.
double expected_gain(const ImageFigures& image, const std::vector<double>& shares);

}  // namespace montelux
