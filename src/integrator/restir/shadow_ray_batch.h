// Shadow rays in another order than that of the requests.
#pragma once
#include <array>
#include <span>
#include <vector>

#include "accel/accel.h"
#include "integrator/integrator.h"

namespace montelux {

// Turns off all lanes of open[i] in which something lies in the way of ways[i]. The rays of a lane, over all i, are
// traced side by side: faster where they lead from neighbouring places to one light, and those of a pack do not.
template <class F, class Rays>
void keep_open(const Rays& rays, std::span<const Ray<F>> ways, std::span<Mask<F>> open, RayCounts& counts) {
  struct Place {
    std::size_t i;
    int lane;
  };
  std::array<Place, lanes_of<F>> places;
  std::size_t filled = 0;
  Ray<F> pack = ways[0];
  std::vector<F> hidden(ways.size(), F(0.0f));
  const auto trace = [&] {
    const Mask<F> on = mask_of_bits<F>((1u << filled) - 1u);
    for_each_lane(rays.template occluded<F>(pack, on),
                  [&](int j) { set_lane(hidden[places[std::size_t(j)].i], places[std::size_t(j)].lane, 1.0f); });
    counts.shadow += filled;
    filled = 0;
  };
  for (int k = 0; k < int(lanes_of<F>); ++k)
    for (std::size_t i = 0; i < ways.size(); ++i) {
      if (!lane(open[i], k)) continue;
      const int j = int(filled);
      set_lane(pack.o, j, lane(ways[i].o, k)), set_lane(pack.d, j, lane(ways[i].d, k));
      set_lane(pack.t_max, j, lane(ways[i].t_max, k)), set_lane(pack.time, j, lane(ways[i].time, k));
      places[filled++] = {i, k};
      if (filled == places.size()) trace();
    }
  if (filled > 0) trace();
  for (std::size_t i = 0; i < ways.size(); ++i) open[i] = open[i] & !(hidden[i] > F(0.0f));
}

}  // namespace montelux
