// What pixels contribute to a combination: their vertices and reservoirs, side by side in lanes.
#pragma once
#include <array>
#include <vector>

#include "integrator/restir/path_sample.h"
#include "integrator/restir/reservoirs.h"
#include "integrator/restir/vertex.h"

namespace montelux {

// What a pixel holds.
struct PixelState {
  const ReuseVertex<float>& vertex;
  const LightReservoir<float>& light;
  const PathReservoir<float>* path;  // null: paths are not reused
};

// What one pixel holds, for every lane.
template <class F>
struct PixelsInLanes {
  std::array<const ReuseVertex<float>*, lanes_of<F>> vertices;
  std::array<const LightReservoir<float>*, lanes_of<F>> lights;
  std::array<const PathReservoir<float>*, lanes_of<F>> paths;  // null where paths are not reused

  void put(std::size_t k, const PixelState& pixel) {
    vertices[k] = &pixel.vertex, lights[k] = &pixel.light, paths[k] = pixel.path;
  }
};

// Input i of a combination, in every lane.
template <class F>
struct ReuseInputs {
  std::vector<ReuseVertex<F>> vertices;
  std::vector<LightReservoir<F>> lights;
  std::vector<PathReservoir<F>> paths;  // none where paths are not reused

  ReuseInputs(std::size_t count, bool with_paths) : vertices(count), lights(count), paths(with_paths ? count : 0) {}

  // Input i exists in no lane; finite numbers replace it.
  void clear(std::size_t i) {
    vertices[i] = vertices[0], lights[i] = lights[0];
    if (!paths.empty()) paths[i] = paths[0];
    cap(i, F(0.0f));
  }
  void cap(std::size_t i, F limit) {
    lights[i].confidence = min(lights[i].confidence, limit);
    if (!paths.empty()) paths[i].confidence = min(paths[i].confidence, limit);
  }
  // A pixel becomes input i, in every lane.
  void put_pixels(std::size_t i, const PixelsInLanes<F>& pixels) {
    set_all_lane_words<ReuseVertex<F>, ReuseVertex<float>>(vertices[i], pixels.vertices);
    set_all_lane_words<LightReservoir<F>, LightReservoir<float>>(lights[i], pixels.lights);
    if (!paths.empty()) set_all_lane_words<PathReservoir<F>, PathReservoir<float>>(paths[i], pixels.paths);
  }
  // The pixel becomes lane k of input i.
  void put_pixel(std::size_t i, int k, const PixelState& pixel) {
    set_lane_words(vertices[i], k, pixel.vertex);
    put(lights[i], k, pixel.light);
    if (pixel.path != nullptr) put(paths[i], k, *pixel.path);
  }
};

}  // namespace montelux
