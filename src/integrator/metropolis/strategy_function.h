// From the numbers of a pair of subpaths to the light that one strategy of bidirectional path tracing finds with them:
// multiplexed Metropolis light transport (Hachisuka, Kaplanyan and Dachsbacher 2014).
#pragma once
#include "integrator/bidirectional/eye_subpaths.h"
#include "integrator/metropolis/given_paths.h"
#include "integrator/metropolis/markov_chains.h"
#include "integrator/metropolis/strategy_paths.h"
#include "transport/dimensions.h"

namespace montelux {

// The splats of a pack of subpaths: the last one of each lane with its origin, and the brightness of all.
template <class F>
struct SplatRecord {
  const SplatPlane& plane;
  Vec2<F> raster{F(0.0f), F(0.0f)};
  Spectrum<F> contribution = gray(F(0.0f));
  Mask<F> on = Mask<F>(false);
  F brightness = F(0.0f);
  LightOrigin<F> from{Uint<F>(0u), Uint<F>(0u), Technique::light_sampling};

  Mask<F> reaches(const Vec2<F>& place) const { return plane.reaches(place); }
  void record(const Vec2<F>& place, const Spectrum<F>& value, Mask<F> splatted, const LightOrigin<F>& origin) {
    raster = select<F>(splatted, place, raster), contribution = select(splatted, value, contribution),
    on = on | splatted;
    from.bounces = select(splatted, origin.bounces, from.bounces),
    from.light = select(splatted, origin.light, from.light);
    from.light_vertices = select(splatted, origin.light_vertices, from.light_vertices);
    from.weight = select(splatted, origin.weight, from.weight);
    for_each_lane(splatted,
                  [&](int k) { set_lane(brightness, k, lane(brightness, k) + brightness_of(to_rgb(lane(value, k)))); });
  }
};

// The numbers of a path from a light in each lane.
template <class F>
struct GivenLightNumbers {
  const RecordedNumbers<F>& numbers;
  friend const RecordedNumbers<F>& numbers_of(const GivenLightNumbers& points, const PathSite<F>&) {
    return points.numbers;
  }
};

// One pair of subpaths in each lane.
template <class F, class Rays>
struct PairFrame : BidirectionalFrame<Rays, StrategyWeights, SplatRecord<F>> {
  using U = Uint<F>;
  using M = Mask<F>;
  using Tally = PartsTally;

  const RecordedNumbers<F>& eye;
  const RecordedNumbers<F>& light;
  F& broken;  // not a number where the light of the path from the light is none

  const RecordedNumbers<F>& eye_numbers(const PathState<F>&) const { return eye; }
  GivenLightNumbers<F> light_points() const { return {light}; }
  void add_broken(const F& value, M on) const { broken = select(on, value, broken); }
  // The path from the light of each lane has the number of the lane.
  template <class>
  U light_of_pair(const PixelBounds&, const U& output) const {
    return gather(this->light_of_path, output);
  }
  template <class>
  F shutter_sample_of(const PathSite<F>&) const {
    return eye.get1(U(path_dimension::time));
  }
};

// The same, and the one strategy that is wanted of it.
template <class F, class Rays>
struct StrategyFrame : PairFrame<F, Rays> {
  using U = Uint<F>;
  using M = Mask<F>;

  static constexpr bool every_strategy = false;
  U light_vertices, eye_vertices;

  M wants(const U& s, const U& t) const { return (s == light_vertices) & (t == eye_vertices); }
  // At the vertex of that number, counted from the light or from the eye.
  M connects(const U& s) const { return (s == light_vertices) & (eye_vertices > U(1u)); }
  M continues_from_light(const U& s, M on) const { return on & (s < light_vertices); }
  M visits(const U& t) const { return (t < eye_vertices) | ((t == eye_vertices) & (light_vertices > U(0u))); }
  M continues_from_eye(const U& t, M on) const { return on & (t < eye_vertices); }
};

// The first numbers of a sample point are those of `path`, of which the first two are the place in the picture; then
// come those of the path from the light, the choice of the strategy and that of the number of scattering events, which
// only large steps draw again.
template <class F, class Rays, bool in_media>
class StrategyFunction {
 public:
  using U = Uint<F>;
  using M = Mask<F>;
  using Settings = StrategyPaths;
  // All must outlive this.
  StrategyFunction(const Scene& scene, const Rays& rays, const StrategyPaths& settings, const SeriesPass& pass,
                   const SplatPlane& plane)
      : scene_(scene),
        rays_(rays),
        settings_(settings),
        series_pass_(pass),
        pass_{pass.bounds, pass.points, pass.shutter, {}, {}, pass.grid},
        plane_(plane),
        values_(dimensions() * std::size_t(lanes_of<F>)),
        out_(std::size_t(lanes_of<F>)),
        light_of_path_(pass.layers ? out_.size() : 0) {
    if (pass.layers) tally_.emplace(*pass.layers, out_.size());
  }

  std::size_t dimensions() const { return eye_dimensions() + light_dimensions() + 2; }
  // Small steps keep the number of events. Every chain of the pack therefore mutates the numbers that the longest path
  // of the pack may need: these are the same for a step and for its reverse.
  void propose(SamplePoint<F>& to, const SamplePoint<F>& from, const StepOfNumbers<F>& step) const {
    to.values = from.values;
    const std::size_t lights = eye_dimensions(), strategy = strategy_dimension();
    const F events = step.drawn(from, strategy + 1);
    put_numbers(to, strategy + 1, events), put_numbers(to, strategy, step.moved(from, strategy));
    const auto vertices = std::size_t(std::min(settings_.choice->longest(events) + 1, this->vertices()));
    const std::size_t eye_end = path_dimension::first_vertex + vertices * path_dimension::per_vertex;
    const std::size_t light_end = lights + light_dimension::first_vertex + vertices * light_dimension::per_vertex;
    for (std::size_t d = 0; d < eye_end; ++d) put_numbers(to, d, step.moved(from, d));
    for (std::size_t d = lights; d < light_end; ++d) put_numbers(to, d, step.moved(from, d));
  }

  Contribution<F> operator()(const SamplePoint<F>& point, RayCounts& counts) {
    const std::size_t at = strategy_dimension();
    const ChosenStrategy<F> chosen =
        settings_.choice->template choose<F>(numbers_at(point, at + 1), numbers_at(point, at));
    return evaluate(point, chosen, counts);
  }

  // What all strategies find together with the pair of subpaths of an independent point, whichever it chooses. It has
  // no place in the picture.
  Contribution<F> independent(const SamplePoint<F>& point, RayCounts& counts) {
    const Pair pair(*this, point);
    Contribution<F> c = pair.place;
    const LightVertices vertices = follow_light(pair.frame, M(true), counts);
    follow_eye(pair.frame, vertices, {c, M(true), M(true)}, counts, no_tally);
    std::array<Rgb, lanes_of<F>> found;
    for (int k = 0; k < lanes_of<F>; ++k)
      found[std::size_t(k)] = gray_rgb(brightness_of(out_[std::size_t(k)].radiance) + lane(pair.splats.brightness, k) +
                                       lane(pair.broken, k));
    put_light<F>(c, found);
    return c;
  }

  // Chooses one of the strategies that find light with the pair of subpaths of `point`, in proportion to brightness,
  // and sets the point's choice to it. `brightness`: of all of them; u: a number in [0, 1) for the choice.
  Contribution<F> start(SamplePoint<F>& point, const F& brightness, const F& u, RayCounts& counts) {
    ChosenStrategy<F> chosen{U(0u), U(2u), F(1.0f)};
    const F wanted = brightness * u * (1 - 1e-5f);  // the sum has other rounding errors
    F sum(0.0f);
    M found = !(brightness > F(0.0f));
    const int longest = std::min(settings_.paths.max_depth.value_or(max_start_events), max_start_events);
    for (int events = 0; events <= longest && !all(found); ++events)
      for (int s = 0; s < StrategyChoice::count(events) && !all(found); ++s) {
        const ChosenStrategy<F> tried{U(std::uint32_t(s)), U(std::uint32_t(events + 2 - s)), F(1.0f)};
        const F more = evaluate(point, tried, counts).brightness;
        const M takes = (more > F(0.0f)) & !found;
        chosen.light_vertices = select(takes, tried.light_vertices, chosen.light_vertices);
        chosen.eye_vertices = select(takes, tried.eye_vertices, chosen.eye_vertices);
        sum += more;
        found = found | (takes & (sum > wanted));
      }
    const RandomStream<F> within = point.beyond.fork(U(chain_stream::start));
    const auto [u_events, u_strategy] = settings_.choice->template numbers_for<F>(
        chosen.light_vertices, chosen.eye_vertices, within.at(U(0u)), within.at(U(1u)));
    put_numbers(point, strategy_dimension(), u_strategy), put_numbers(point, strategy_dimension() + 1, u_events);
    return (*this)(point, counts);
  }

  // The light that the strategy finds, over its probability.
  Contribution<F> evaluate(const SamplePoint<F>& point, const ChosenStrategy<F>& chosen, RayCounts& counts) {
    const Pair pair(*this, point);
    const StrategyFrame<F, Rays> frame{pair.frame, chosen.light_vertices, chosen.eye_vertices};
    Contribution<F> c = pair.place;
    const LightVertices vertices = follow_light(frame, frame.light_vertices > U(1u), counts);
    const EyeStart start{c, frame.eye_vertices > U(1u), frame.wants(U(0u), U(2u))};
    if (tally_)
      follow_eye(frame, vertices, start, counts, *tally_);
    else
      follow_eye(frame, vertices, start, counts, no_tally);

    const SplatRecord<F>& splats = pair.splats;
    std::array<Rgb, lanes_of<F>> found;
    for (int k = 0; k < lanes_of<F>; ++k) {
      Rgb& sum = found[std::size_t(k)];
      sum = out_[std::size_t(k)].radiance;
      const Rgb splatted = to_rgb(lane(splats.contribution, k));
      for (int i = 0; i < rgb_size; ++i)
        sum.c[i] = (sum.c[i] + splatted.c[i] + lane(pair.broken, k)) / lane(chosen.probability, k);
    }
    c.splatted = splats.on, c.raster = splats.raster;
    place_splats(c);
    put_light<F>(c, found);
    if (tally_) put_parts(c, splats, chosen.probability);
    return c;
  }

 private:
  // Numbers that are varied one by one: of the first vertices, which decide most.
  static constexpr int deepest = 10;
  static constexpr int max_start_events = 256;  // reached where rounding errors are large, if ever

  // The pair of subpaths of a sample point.
  struct Pair {
    Pair(StrategyFunction& f, const SamplePoint<F>& point)
        : place(f.take_place(point)),
          eye(std::span(f.values_).first(f.eye_dimensions() * lanes_of<F>), point.beyond),
          light(std::span(f.values_).subspan(f.eye_dimensions() * lanes_of<F>, f.light_dimensions() * lanes_of<F>),
                point.beyond.fork(U(chain_stream::light_path))),
          splats{f.plane_},
          frame{{f.scene_,
                 f.rays_,
                 f.settings_.by_power,
                 f.series_pass_,
                 0u,
                 {},
                 f.settings_.paths,
                 StrategyWeights(f.settings_.paths.mis == BidirectionalMis::power),
                 f.settings_.one_sided,
                 splats,
                 std::uint32_t(f.series_pass_.bounds.area()),
                 f.settings_.light_media,
                 nullptr,
                 PhotonKernel::epanechnikov,
                 f.light_of_path_.empty() ? nullptr : f.light_of_path_.data(),
                 f.settings_.compensated},
                eye,
                light,
                broken} {}
    Pair(const Pair&) = delete;

    Contribution<F> place;
    RecordedNumbers<F> eye, light;
    mutable SplatRecord<F> splats;
    mutable F broken = F(0.0f);
    PairFrame<F, Rays> frame;
  };
  // The pixel of the path from the eye; its numbers become those within the pixel.
  Contribution<F> take_place(const SamplePoint<F>& point) {
    std::copy(point.values.begin(), point.values.end(), values_.begin());
    const std::span<float> film(values_.data() + path_dimension::film * lanes_of<F>, 2 * lanes_of<F>);
    const PixelBounds& bounds = series_pass_.bounds;
    Contribution<F> c;
    c.x = take_pixel<F>(film.first(lanes_of<F>), bounds.x0, bounds.width());
    c.y = take_pixel<F>(film.last(lanes_of<F>), bounds.y0, bounds.height());
    return c;
  }
  int vertices() const { return 1 + std::min(settings_.paths.max_depth.value_or(deepest), deepest); }
  std::size_t eye_dimensions() const {
    return path_dimension::first_vertex + std::size_t(vertices()) * path_dimension::per_vertex;
  }
  std::size_t strategy_dimension() const { return eye_dimensions() + light_dimensions(); }
  std::size_t light_dimensions() const {
    return light_dimension::first_vertex + std::size_t(vertices()) * light_dimension::per_vertex;
  }

  // Of the lanes `starts`.
  template <class Frame>
  LightVertices follow_light(const Frame& frame, M starts, RayCounts& counts) {
    LightVertices vertices(lanes_of<F>);
    if (!any(starts)) return vertices;
    const auto store = [&](const auto& view, M on) {
      const auto& v = view.vertex;
      const LightVertex<F> vertex{stored(v.at), v.path.flux, view.weights, v.path.depth, U(0u)};
      for_each_lane(on, [&](int k) {
        LightVertex<float> one;
        get_lane_words(vertex, k, one);
        vertices.add(std::uint32_t(k), one);
      });
    };
    walk_from_lights<F, AdjointCorrection, in_media>(frame, Splatting::on, counts, store, [&](auto& walk) {
      walk.run_pack(PathSite<F>{U(0u), U(0u), lane_index<F>()}, starts);
    });
    return vertices;
  }
  // Where paths from the eye start, the lanes that are wanted, and those whose sky is.
  struct EyeStart {
    const Contribution<F>& place;
    M on, wants_sky;
  };
  template <class Frame, class Tally>
  void follow_eye(const Frame& frame, const LightVertices& vertices, const EyeStart& start, RayCounts& counts,
                  Tally& tally) {
    std::ranges::fill(out_, PixelSample{});
    if (!any(start.on)) return;
    const auto [x, y] = pixels_of<F>(pass_.grid, pass_.points, start.place.x, start.place.y, U(0u));
    GivenPaths<F, Rays, Tally> paths(
        scene_, rays_, {pass_, {x, y, U(0u)}, frame.eye, start.on, start.on & start.wants_sky}, out_, tally);
    counts.camera += std::uint64_t(count(start.on));
    typename Frame::Tally* layers = nullptr;
    if constexpr (Tally::records) layers = &tally;
    counts += EyeSubpaths<F, Frame, AdjointCorrection, in_media>(frame, vertices, layers).run(paths, out_);
  }
  // What was found by this probability, by its origins.
  void put_parts(Contribution<F>& c, const SplatRecord<F>& splats, const F& probability) {
    for (int k = 0; k < lanes_of<F>; ++k) {
      std::vector<LightPart>& parts = c.parts.emplace_back(tally_->take(std::size_t(k)));
      if (lane(splats.on, k))
        add_part(parts, distinguished(*series_pass_.layers, lane_of(splats.from, k)), lane(splats.contribution, k));
      for (LightPart& part : parts) part.contribution = part.contribution * (1 / lane(probability, k));
    }
  }
  // The cells where splats arrive, or the nearest in the picture.
  void place_splats(Contribution<F>& c) const {
    const PixelGrid& grid = plane_.grid();
    const PixelBounds& b = grid.bounds;
    for_each_lane(c.splatted, [&](int k) {
      const int x = std::clamp(int(std::floor(lane(c.raster.x, k))), b.x0, b.x1 - 1),
                y = std::clamp(int(std::floor(lane(c.raster.y, k))), b.y0, b.y1 - 1);
      const PixelBounds& cells = series_pass_.bounds;
      set_lane(c.x, k, std::uint32_t(std::clamp(grid.cell_x(x), cells.x0, cells.x1 - 1)));
      set_lane(c.y, k, std::uint32_t(std::clamp(grid.cell_y(y), cells.y0, cells.y1 - 1)));
    });
  }

  const Scene& scene_;
  const Rays& rays_;
  const StrategyPaths& settings_;
  const SeriesPass& series_pass_;
  const TilePass pass_;
  const SplatPlane& plane_;
  std::vector<float> values_;
  std::vector<PixelSample> out_;
  // Of a pass with layers: the lights of the paths, and where their light comes from.
  std::vector<std::uint32_t> light_of_path_;
  std::optional<PartsTally> tally_;
};

}  // namespace montelux
