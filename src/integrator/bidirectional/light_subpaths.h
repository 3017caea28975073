// Subpaths from the lights: stored to be connected, and splatted where the lens sees their vertices.
#pragma once
#include <algorithm>
#include <cstring>
#include <vector>

#include "integrator/bidirectional/light_end.h"
#include "integrator/bidirectional/settings.h"
#include "integrator/light_paths/lens.h"
#include "integrator/light_paths/walk.h"
#include "integrator/photons/tracing.h"
#include "math/row_gather.h"
#include "transport/stored_vertex.h"

namespace montelux {

// All that the paths of a frame share. `Rays` has the interface of Accel.
//
// Each pixel has a pair of subpaths, by the numbers of its points, and all strategies are wanted of all pairs. A frame
// with other pairs hides `every_strategy` and the members after it.
template <class Rays, class Weights = StrategyWeights, class Plane = SplatPlane>
struct BidirectionalFrame {
  const Scene& scene;
  const Rays& rays;
  const AliasTable* by_power;  // null: there is no light
  const SeriesPass& pass;
  std::uint32_t frame;
  // In [0, 1), of the exposure: of all paths; else each pair of subpaths has its own.
  std::optional<float> shutter_sample;
  BidirectionalPaths paths;
  Weights weights;
  bool one_sided;  // some surface is not there for camera rays that meet its back
  Plane& plane;
  std::uint32_t light_path_count;      // at least one for each pixel, or cell: the first ones belong to these
  const LightMedia* light_media;       // null: the scene has no media
  const PhotonMap* photons = nullptr;  // to be merged with the eye's vertices; null: none are
  PhotonKernel kernel = PhotonKernel::epanechnikov;
  // Of a pass with layers: by the number of a path from the lights the light where it starts; else null.
  std::uint32_t* light_of_path = nullptr;
  const LightSet* compensated = nullptr;  // from which paths from the eye sample light; null: from the scene's

  float light_paths() const { return float(light_path_count); }
  // As many as are connected with the lens: no light arrives where camera rays go through the centres of pixels alone.
  // For each path from the eye at a pixel: where cells show means, a pixel has only its share of the cell's.
  float splat_paths() const {
    if (scene.pixel_centres || !paths.connect) return 0;
    if (!pass.grid || !pass.grid->is_mean) return light_paths();
    return light_paths() * float(pass.grid->bounds.area()) / float(pass.grid->cells().area());
  }
  std::uint32_t path_number(int x, int y) const {
    return std::uint32_t(y - pass.bounds.y0) * std::uint32_t(pass.bounds.width()) + std::uint32_t(x - pass.bounds.x0);
  }
  PathLights path_lights() const { return {scene.lights, *by_power}; }
  const LightSet& sampled_lights() const { return compensated ? *compensated : scene.lights; }

  static constexpr bool every_strategy = true;
  using Tally = LayerTally;  // receives the layers of paths from the eye
  template <class F>
  Sampler<F> eye_numbers(const PathState<F>& path) const {
    return numbers_of(pass.points, path);
  }
  // Light of a path from a light that is not a number shows in the first pixel of the picture.
  template <class F>
  void add_broken(const F& value, Mask<F> on) const {
    for_each_lane(on, [&](int k) { plane.add_to_pixel(pass.bounds.x0, pass.bounds.y0, gray_rgb(lane(value, k))); });
  }
  // The light of the path from the lights that belongs to a path from the eye, by the output of that in a tile.
  template <class F>
  Uint<F> light_of_pair(const PixelBounds& tile, const Uint<F>& outputs) const {
    Uint<F> number(0u);
    const auto width = std::uint32_t(tile.width());
    for (int k = 0; k < lanes_of<F>; ++k) {
      const std::uint32_t output = lane(outputs, k);
      set_lane(number, k, path_number(tile.x0 + int(output % width), tile.y0 + int(output / width)));
    }
    return gather(light_of_path, number);
  }
  PointSet light_points() const { return photon_points(pass.points, int(frame), light_path_count); }
  // The time of a path from a light is that of the pixel's path from the eye.
  template <class F>
  F shutter_sample_of(const PathSite<F>& site) const {
    if (shutter_sample) return F(*shutter_sample);
    Uint<F> cell_x(0u), cell_y(0u);
    const PixelBounds& b = pass.bounds;
    for (int k = 0; k < lanes_of<F>; ++k) {
      const auto number = lane(site.index, k), width = std::uint32_t(b.width());
      set_lane(cell_x, k, std::uint32_t(b.x0) + number % width);
      set_lane(cell_y, k, std::uint32_t(b.y0) + number / width);
    }
    const auto [x, y] = pixels_of<F>(pass.grid, pass.points, cell_x, cell_y, Uint<F>(frame));
    return numbers_of<F>(pass.points, PathSite<F>{x, y, Uint<F>(frame)}).get1(Uint<F>(path_dimension::time));
  }
};

// A vertex of a subpath from a light.
template <class F>
struct LightVertex : StoredVertex<F> {
  Spectrum<F> flux;  // that arrives
  PartialWeights<F> weights;
  Uint<F> events;  // that have scattered it before
  Uint<F> before;  // of the same subpath: its number in the store, plus one; 0: there is none
};

// The vertices of the subpaths of a tile.
class LightVertices {
 public:
  explicit LightVertices(int paths) : last_(std::size_t(paths)) {}

  void add(std::uint32_t path, LightVertex<float> vertex) {
    vertex.before = last_[path];
    all_.push_back({vertex});
    last_[path] = std::uint32_t(all_.size());
  }
  // The last vertex of each path: its number, plus one; 0: it has none.
  template <class F>
  Uint<F> last_of(Uint<F> path, Mask<F> on) const {
    const Uint<F> number = gather(last_.data(), select(on, path, Uint<F>(0u)));
    return select(on, number, Uint<F>(0u));
  }
  // Lanes that are off have any vertex; there must be one.
  template <class F>
  LightVertex<F> get(Uint<F> number, Mask<F> on) const {
    using U = Uint<F>;
    constexpr std::size_t words = sizeof(LightVertex<float>) / 4, rows = sizeof(Record) / 4 / words_of_row;
    static_assert(sizeof(LightVertex<F>) == sizeof(LightVertex<float>) * lanes_of<F>);
    const U first = select(on, number, U(0u)) * U(std::uint32_t(rows));
    LightVertex<F> vertex;
    auto* to = reinterpret_cast<char*>(&vertex);
    const auto* from = reinterpret_cast<const float*>(all_.data());
    for (std::size_t row = 0; row < rows; ++row) {
      const auto values = gather_rows<F>(from, first + U(std::uint32_t(row)));
      const std::size_t begin = row * words_of_row, count = std::min(words - begin, std::size_t(words_of_row));
      std::memcpy(to + begin * sizeof(F), values.data(), count * sizeof(F));
    }
    return vertex;
  }

 private:
  // Whole rows of words.
  struct alignas(4 * words_of_row) Record {
    LightVertex<float> vertex;
  };
  std::vector<Record> all_;
  std::vector<std::uint32_t> last_;
};

// What the walk of subpaths from the lights shows: weighs it along the way, splats it, and hands it on to
//   store(LightVertexView, on)    where the surface is not a mirror or smooth glass
template <class F, class Numbers = Sampler<F>>
struct LightVertexView {
  const LightPathVertex<F, Numbers>& vertex;
  const PartialWeights<F>& weights;
};
template <class F, class Frame, class Correction, class Store, bool in_media>
class LightSubpathSink {
 public:
  using U = Uint<F>;
  using M = Mask<F>;
  using Numbers = decltype(numbers_of(std::declval<const Frame&>().light_points(), std::declval<PathSite<F>>()));
  using Vertex = LightPathVertex<F, Numbers>;
  // `first`: these subpaths are followed for the first time in the frame.
  LightSubpathSink(const Frame& frame, Store store, bool first, RayCounts& counts)
      : frame_(frame),
        store_(store),
        notes_lights_(first),
        splats_(first && frame.splat_paths() > 0),
        scale_(frame.scene.imaging_ratio / frame.light_paths()),
        lens_(frame.scene, frame.rays, frame.one_sided, frame.plane, counts) {}

  F shutter_sample(const PathSite<F>& site) const { return frame_.template shutter_sample_of<F>(site); }

  void leave(const LightPathStart<F, Numbers>& s, M on) {
    light_ = select(on, s.choice.index, light_);
    p_ = select<F>(on, s.emission.p, p_), n_ = select<F>(on, s.emission.n, n_);
    if (frame_.light_of_path && notes_lights_)
      for_each_lane(on, [&](int k) { frame_.light_of_path[lane(s.site.index, k)] = lane(s.choice.index, k); });
  }

  struct Query {
    LensConnection<F> lens;
    Vec3<F> toward;  // the lens, local
    M on;
  };
  Query query(const Vertex& v, M on) {
    arrive(v, on);
    const M rough = on & !v.at.bsdf.is_delta;
    M stored = rough, splatted = rough;
    if constexpr (!Frame::every_strategy) {
      const U vertices = v.path.depth + U(2u);
      stored = stored & frame_.connects(vertices), splatted = splatted & frame_.wants(vertices, U(1u));
    }
    if (any(stored)) store_(LightVertexView<F, Numbers>{v, weights_}, stored);
    if (!splats_ || !any(splatted)) return {{}, v.at.wo, M(false)};
    const LensConnection<F> lens =
        lens_.toward(v.at.x.point.p, v.numbers.get2(v.dimension + U(light_dimension::vertex_lens)), v.path.ray.time);
    return {lens, v.at.bsdf.frame.to_local(-lens.d), M(splatted & lens.seen)};
  }
  void visit(const Vertex& v, const Query& query, const BsdfValue<F>& value, M) {
    if (!any(query.on)) return;
    const NextVertex<F>& at = v.at;
    const LensConnection<F>& lens = query.lens;
    const F ng_out = dot(at.x.point.ng, lens.d);
    const F correction = adjoint_correction<F, Correction, in_media>(v, query.toward, ng_out);
    const Spectrum<F> contribution = v.path.flux * value.f_cos * (correction * lens.across.value * scale_);
    const M lit = query.on & !is_black(contribution);
    if (!any(lit)) return;
    const BothDensities<F> both{value.density, reverse_density(at, query.toward, lit), !at.in_medium};
    const F cos = area_cosine<F, in_media>(at, lens.d);
    lens_.connect({at.x.point.p, at.x.point.p_error, at.x.point.ng},
                  {at.media_toward(-lens.d), lens, v.path.ray.time,
                   v.numbers.stream(v.dimension + U(light_dimension::vertex_lens))},
                  contribution, lit, {v.path.depth + U(1u), light_, Technique::light_sampling, v.path.depth + U(2u)},
                  [&](const F& passing) {
                    return frame_.weights.lens(weights_, both, lens.across, cos, frame_.splat_paths(), passing);
                  });
  }
  void scatter(const Vertex& v, const BsdfSample<F>& next, M on) {
    const NextVertex<F>& at = v.at;
    const BothDensities<F> both{next.density, reverse_density(at, next.wi, on & !next.delta), !at.in_medium};
    const F cos = area_cosine<F, in_media>(at, at.bsdf.frame.to_world(next.wi));
    weights_ = select_weights(on, frame_.weights.scatter(weights_, both, cos, next.delta), weights_);
  }
  // Paths whose strategy has further vertices.
  M follows(const Vertex& v, const BsdfSample<F>&, M on) const {
    if constexpr (Frame::every_strategy)
      return on;
    else
      return frame_.continues_from_light(v.path.depth + U(2u), on);
  }
  void broken(F value, const PathSite<F>&, M on) { frame_.add_broken(value, on); }

 private:
  // Of the direction in which the path came, drawn from the local wi.
  Density<SolidAngle, F> reverse_density(const NextVertex<F>& at, const Vec3<F>& wi, M on) const {
    return evaluate_at<F, in_media>(frame_.scene, at, wi, at.wo, at.context, on).density;
  }
  void arrive(const Vertex& v, M on) {
    const NextVertex<F>& at = v.at;
    const F cos = area_cosine<F, in_media>(at, at.d);
    const M first = on & (v.path.depth == U(0u));
    weights_ =
        select_weights(on, frame_.weights.arrive(weights_, at.distance * at.distance, cos, at.passing), weights_);
    if (!any(first)) return;
    const LightSet& lights = frame_.sampled_lights();
    const Density<SolidAngle, F> sampled =
        lights.template sampling_density<F>(light_, at.x.point.p, at.bsdf.light_normal, p_, -at.d, first);
    const LightEnd<F> end =
        light_end<F>(frame_.path_lights(), {light_, p_, n_, first}, at.d, at.distance * at.distance, sampled);
    weights_ = select_weights(first, frame_.weights.first_from_light(end, cos, at.passing), weights_);
  }

  const Frame& frame_;
  Store store_;
  const bool notes_lights_, splats_;
  const float scale_;
  LensSplats<F, std::remove_cvref_t<decltype(std::declval<Frame>().rays)>, in_media,
             std::remove_cvref_t<decltype(std::declval<Frame>().plane)>>
      lens_;
  // Of the paths at hand: the light, where they left it, and the weights so far.
  U light_ = U(0u);
  Vec3<F> p_{}, n_{};
  PartialWeights<F> weights_{F(0.0f), F(0.0f), F(0.0f)};
};

// Which of their vertices are splatted: subpaths may be followed more than once in a frame.
enum class Splatting { on, off };

// Follows subpaths from the lights: run(walk) chooses which. store(LightVertexView, on) receives their vertices.
// `Correction` is AdjointCorrection, but in tests that plant a fault. `in_media`: the scene has participating media.
template <class F, class Correction, bool in_media, class Frame, class Store, class Run>
void walk_from_lights(const Frame& frame, Splatting splatting, RayCounts& counts, Store store, Run run) {
  if (!frame.by_power) return;
  using Rays = std::remove_cvref_t<decltype(frame.rays)>;
  using Points = decltype(frame.light_points());
  const LightWalkScene<Rays, Points> walk{frame.scene,
                                          frame.rays,
                                          *frame.by_power,
                                          frame.light_points(),
                                          frame.pass.shutter.value_or(frame.scene.shutter),
                                          {},
                                          frame.paths.max_depth,
                                          frame.paths.roulette_depth,
                                          Densities::for_weights,
                                          frame.light_media};
  using Sink = LightSubpathSink<F, Frame, Correction, Store, in_media>;
  Sink sink(frame, store, splatting == Splatting::on, counts);
  LightWalk<F, Rays, Sink, Correction, in_media, Points> all(walk, sink, counts);
  run(all);
}

// By their numbers number_of(i) for i below `count`.
template <class F, class Correction = AdjointCorrection, bool in_media = false, class Rays, class Weights,
          class NumberOf, class Store>
void follow_light_subpaths(const BidirectionalFrame<Rays, Weights>& frame, std::uint32_t count, NumberOf number_of,
                           Splatting splatting, RayCounts& counts, Store store) {
  walk_from_lights<F, Correction, in_media>(frame, splatting, counts, store, [&](auto& walk) {
    walk.run(count, [&](std::uint32_t i) { return PathSite<float>{0, 0, number_of(i)}; });
  });
}

// Keeps them, to be connected with the paths from the eye of the same tile.
template <class F, class Correction = AdjointCorrection, bool in_media = false, class Rays, class Weights>
LightVertices light_vertices(const BidirectionalFrame<Rays, Weights>& frame, const PixelBounds& tile,
                             Splatting splatting, RayCounts& counts) {
  LightVertices all(tile.area());
  const PixelBounds& b = frame.pass.bounds;
  const auto across = std::uint32_t(b.width());
  const auto width = std::uint32_t(tile.width());
  const auto number_of = [&](std::uint32_t i) {
    return frame.path_number(tile.x0 + int(i % width), tile.y0 + int(i / width));
  };
  const auto store = [&](const LightVertexView<F>& view, Mask<F> on) {
    const LightPathVertex<F>& v = view.vertex;
    const LightVertex<F> vertex{stored(v.at), v.path.flux, view.weights, v.path.depth, Uint<F>(0u)};
    for_each_lane(on, [&](int k) {
      const std::uint32_t number = lane(v.path.site.index, k);
      const int x = b.x0 + int(number % across) - tile.x0, y = b.y0 + int(number / across) - tile.y0;
      LightVertex<float> one;
      get_lane_words(vertex, k, one);
      all.add(std::uint32_t(y * tile.width() + x), one);
    });
  };
  follow_light_subpaths<F, Correction, in_media>(frame, std::uint32_t(tile.area()), number_of, splatting, counts,
                                                 store);
  return all;
}

}  // namespace montelux
