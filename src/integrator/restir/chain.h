// A chain of frames whose pixels share what they know of light.
#pragma once
#include "integrator/restir/first_stage.h"
#include "integrator/restir/light_point_shift.h"
#include "integrator/restir/neighbours.h"
#include "integrator/restir/reservoirs.h"

namespace montelux {

template <class F, class Rays>
class ReuseChain final : public Chain {
 public:
  using U = Uint<F>;
  using M = Mask<F>;
  // What `shared` refers to must outlive the chain.
  ReuseChain(const RestirScene<Rays>& shared, const ChainPass& pass)
      : shared_(shared), pass_(pass), before_(std::dynamic_pointer_cast<const ReuseMemory>(pass.before)) {
    const auto pixels = std::size_t(pass.bounds.area());
    if (before_ && !(before_->bounds == pass.bounds)) before_.reset();
    if (before_) earlier_.resize(pixels);
    for (auto& vertices : vertices_) vertices.resize(pixels);
    lights_.resize(pixels);
    if (reuses_paths()) paths_.resize(pixels);
    frame_.resize(pixels);
  }

  // Stage 0 looks for light at every pixel and in the frame before; every further one learns from neighbours, and the
  // last one of these makes the picture.
  RayCounts run(const ChainStep& step, const PixelBounds& tile, std::span<PixelSample> out) override {
    if (step.stage > 0) return share(step, tile, out);
    RayCounts counts = find(step.frame, tile);
    if (step.frame == 0 ? before_ != nullptr : settings().temporal) counts += recall(step.frame, tile);
    return counts;
  }

  std::unique_ptr<ChainMemory> remember(int frames) override {
    if (!settings().carry) return nullptr;
    auto memory = std::make_unique<ReuseMemory>();
    memory->bounds = pass_.bounds, memory->shutter = shutter();
    memory->vertices = std::move(vertices(frames - 1));
    memory->lights = std::move(lights_.after(step_number(frames - 1, settings().rounds)));
    if (reuses_paths()) memory->paths = std::move(paths_.after(step_number(frames - 1, settings().rounds)));
    return memory;
  }

  static int stages(const RestirSettings& settings) { return 1 + std::max(settings.rounds, 1); }

 private:
  const RestirSettings& settings() const { return shared_.settings; }
  bool reuses_paths() const { return settings().indirect.on; }
  Shutter shutter() const { return pass_.shutter.value_or(shared_.scene.shutter); }

  // The number of a round of a frame among all that write reservoirs; round 0 is that of stage 0.
  int step_number(int frame, int round) const { return frame * (settings().rounds + 1) + round; }
  std::vector<ReuseVertex<float>>& vertices(int frame) { return vertices_[std::size_t(frame) & 1]; }

  RandomStream<F> stream(int frame, const LanePixels<F>& at, std::uint32_t purpose) const {
    return at.stream(pass_.points, frame, restir_stream::dimension, purpose);
  }
  LanePixels<F> gather(int frame, const PixelBounds& tile, std::uint32_t& next) {
    return gather_pixels<F>(pass_.bounds, tile, next,
                            [&](std::size_t pixel) { return vertices(frame)[pixel].exists != 0; });
  }

  // What FirstStage tells.
  struct Finds {
    ReuseChain& chain;
    int frame;
    PixelBounds tile;

    void lights(const ReuseVertex<F>& vertex, const VertexOrigin<F>& origin, const LightReservoir<F>& reservoir,
                const U& slot, M on) {
      const int step = chain.step_number(frame, 0);
      if (chain.before_ && frame == 0) chain.trace_back({tile, slot, U(0u), on}, vertex, origin);
      for_each_pixel(slot, on, [&](int k, std::size_t pixel) {
        get_lane_words(vertex, k, chain.vertices(frame)[pixel]);
        get(reservoir, k, chain.lights_.after(step)[pixel]);
        if (chain.reuses_paths()) chain.paths_.after(step)[pixel] = {{}, 0.0f, 1.0f, 0.0f};
      });
    }
    void paths(const PathReservoir<F>& reservoir, const U& slot, M on) {
      for_each_pixel(slot, on, [&](int k, std::size_t pixel) {
        get(reservoir, k, chain.paths_.after(chain.step_number(frame, 0))[pixel]);
      });
    }

   private:
    template <class Function>
    void for_each_pixel(const U& slot, M on, Function f) const {
      const LanePixels<F> at{tile, slot, U(0u), on};
      for_each_lane(on, [&](int k) { f(k, pixel_number(chain.pass_.bounds, at.x(k), at.y(k))); });
    }
  };

  // Every pixel by itself.
  RayCounts find(int frame, const PixelBounds& tile) {
    std::vector<PixelSample> out(std::size_t(tile.area()));
    const TilePass request{tile, pass_.points, pass_.shutter, std::uint32_t(frame)};
    for_each_row(pass_.bounds, tile, [&](std::size_t pixel, std::size_t, std::size_t n) {
      for (std::size_t i = 0; i < n; ++i) vertices(frame)[pixel + i].exists = 0;
    });
    Finds finds{*this, frame, tile};
    FirstStage<F, Rays, Finds> stage(shared_, request, out, finds);
    const RayCounts counts = stage.run();
    for_each_row(pass_.bounds, tile, [&](std::size_t pixel, std::size_t first, std::size_t n) {
      std::copy_n(out.begin() + std::ptrdiff_t(first), n, frame_.begin() + std::ptrdiff_t(pixel));
    });
    return counts;
  }

  // Which pixels of the picture before showed the points of the vertices. Behind mirrors and glass it is sought at the
  // pixel itself.
  void trace_back(const LanePixels<F>& at, const ReuseVertex<F>& vertex, const VertexOrigin<F>& origin) {
    F moment = vertex.time;
    for_each_lane(
        at.on, [&](int k) { set_lane(moment, k, earlier_moment(lane(vertex.time, k), shutter(), before_->shutter)); });
    const M straight = at.on & origin.straight;
    const EarlierPlace<F> then = earlier_place<F>(shared_.scene, origin, moment, straight);
    for_each_lane(at.on, [&](int k) {
      std::optional<std::size_t> pixel;
      const std::uint32_t object = lane(vertex.object, k);
      if (!lane(straight, k))
        pixel = earlier_pixel(*before_, {float(at.x(k)) + 0.5f, float(at.y(k)) + 0.5f},
                              {object, lane(vertex.ng, k), lane(vertex.depth, k)});
      else if (lane(then.place.seen, k))
        pixel = earlier_pixel(*before_, lane(then.place.raster, k),
                              {object, lane(then.ng, k), lane(then.place.distance, k)});
      earlier_[pixel_number(pass_.bounds, at.x(k), at.y(k))] = pixel;
    });
  }

  // The pixels that a pixel learns from: their vertices and reservoirs, its own first.
  struct Inputs {
    std::vector<ReuseVertex<F>> vertices;
    std::vector<LightReservoir<F>> lights;
    std::vector<PathReservoir<F>> paths;

    Inputs(std::size_t count, bool with_paths) : vertices(count), lights(count), paths(with_paths ? count : 0) {}
    // Input i is there in no lane.
    void clear(std::size_t i) {
      vertices[i] = vertices[0], lights[i] = lights[0];
      lights[i].confidence = F(0.0f);
      if (!paths.empty()) paths[i] = paths[0], paths[i].confidence = F(0.0f);
    }
    void cap(std::size_t i, F most) {
      lights[i].confidence = min(lights[i].confidence, most);
      if (!paths.empty()) paths[i].confidence = min(paths[i].confidence, most);
    }
  };
  // What a pixel holds: it becomes lane k of input i.
  struct Holdings {
    const ReuseVertex<float>& vertex;
    const LightReservoir<float>& light;
    const PathReservoir<float>* path;  // null: paths are not reused
  };
  static void put_pixel(Inputs& inputs, std::size_t i, int k, const Holdings& pixel) {
    set_lane_words(inputs.vertices[i], k, pixel.vertex);
    put(inputs.lights[i], k, pixel.light);
    if (pixel.path != nullptr) put(inputs.paths[i], k, *pixel.path);
  }
  Holdings after(int frame, int step, std::size_t pixel) {
    return {vertices(frame)[pixel], lights_.after(step)[pixel], reuses_paths() ? &paths_.after(step)[pixel] : nullptr};
  }
  Holdings before(int frame, int step, std::size_t pixel) {
    return {vertices(frame)[pixel], lights_.before(step)[pixel],
            reuses_paths() ? &paths_.before(step)[pixel] : nullptr};
  }
  // What a pixel held at the end of the frame before: the same pixel within a picture.
  std::optional<Holdings> past(int frame, std::size_t pixel) {
    if (frame == 0) {
      const std::optional<std::size_t> earlier = earlier_[pixel];
      if (!earlier) return std::nullopt;
      return Holdings{before_->vertices[*earlier], before_->lights[*earlier],
                      reuses_paths() ? &before_->paths[*earlier] : nullptr};
    }
    if (vertices(frame - 1)[pixel].exists == 0) return std::nullopt;
    return before(frame - 1, step_number(frame, 0), pixel);
  }

  // Every pixel learns from itself in the frame before, or from where its surface was in the picture before.
  RayCounts recall(int frame, const PixelBounds& tile) {
    RayCounts counts;
    const int step = step_number(frame, 0);
    Inputs inputs(2, reuses_paths());
    for (std::uint32_t next = 0; next < std::uint32_t(tile.area());) {
      const LanePixels<F> at = gather(frame, tile, next);
      if (!any(at.on)) break;
      for_each_lane(at.on, [&](int k) { put_pixel(inputs, 0, k, after(frame, step, lane(at.pixel, k))); });
      inputs.clear(1);
      for_each_lane(at.on, [&](int k) {
        if (const auto known = past(frame, lane(at.pixel, k))) put_pixel(inputs, 1, k, *known);
      });
      inputs.cap(1, F(settings().m_cap));
      combine_all(inputs, stream(frame, at, restir_stream::temporal), at, {}, counts);
      leave(inputs, at, step);
    }
    return counts;
  }

  // The light of all that a vertex and its neighbours hold.
  struct LightOfAll {
    Spectrum<F> own_light;
    Spectrum<F> sum = gray(F(0.0f));
    void own(const F& weight, M on) { sum += select(on, own_light * weight, gray(F(0.0f))); }
    void other(const ShiftedLight<F>& image, const F& weight, M on) { add(image.light, weight, on); }
    void other(const Shifted<PathSample<F>, F>& image, const F& weight, M on) { add(image.value.brings, weight, on); }

   private:
    void add(const Spectrum<F>& light, const F& weight, M on) { sum += select(on, light * weight, gray(F(0.0f))); }
  };
  // Where targets know what is in the way, all reservoirs of the last round can be shown, and not the chosen one alone.
  struct Shown {
    bool lights = false, paths = false;
  };
  Shown shows_all() const {
    const bool all = settings().rounds > 0 && shares_sum_to_one(settings().weights);
    return {all && settings().direct && settings().visibility_reuse, all && reuses_paths()};
  }

  // Combines, into the first input. Gives the light of all samples of those kinds that `sums` names.
  Spectrum<F> combine_all(Inputs& inputs, const RandomStream<F>& numbers, const LanePixels<F>& at, const Shown& sums,
                          RayCounts& counts) const {
    Spectrum<F> light = gray(F(0.0f));
    const LightSet& lights = shared_.lights.by_hierarchy;
    if (settings().direct) {
      const LightPointDomains<F, Rays> domains{lights, shared_.rays, inputs.vertices, settings().visibility_reuse,
                                               counts};
      const auto own = [&] { return connect(lights, inputs.vertices[0], inputs.lights[0].value, at.on).value; };
      light += merge(inputs.lights, domains, numbers, at.on, sums.lights, own);
    }
    if (reuses_paths()) {
      const PathScene<Rays> scene = shared_.paths();
      const PathDomains<F, Rays> domains{scene, inputs.vertices, counts};
      const auto own = [&] { return inputs.paths[0].value.brings; };
      light += merge(inputs.paths, domains, numbers.fork(U(restir_stream::path)), at.on, sums.paths, own);
    }
    return light;
  }
  // own_light() is that of the first input's sample, before the others come.
  template <class T, class Domains, class OwnLight>
  Spectrum<F> merge(std::vector<Reservoir<T, F>>& inputs, const Domains& domains, RandomStream<F> numbers, M on,
                    bool sums, OwnLight own_light) const {
    const std::span<const Reservoir<T, F>> all_inputs(inputs);
    if (!sums) {
      inputs[0] = combine<T, F>(settings().weights, all_inputs, domains, numbers, on);
      return gray(F(0.0f));
    }
    LightOfAll all{own_light()};
    inputs[0] = combine<T, F>(settings().weights, all_inputs, domains, numbers, on, all);
    return all.sum;
  }
  // Leaves what the first input holds after `step`.
  void leave(const Inputs& inputs, const LanePixels<F>& at, int step) {
    for_each_lane(at.on, [&](int k) { get(inputs.lights[0], k, lights_.after(step)[lane(at.pixel, k)]); });
    if (!reuses_paths()) return;
    for_each_lane(at.on, [&](int k) { get(inputs.paths[0], k, paths_.after(step)[lane(at.pixel, k)]); });
  }

  // One round of spatial reuse, and after the last the picture.
  RayCounts share(const ChainStep& step, const PixelBounds& tile, std::span<PixelSample> out) {
    RayCounts counts;
    for_each_row(pass_.bounds, tile, [&](std::size_t pixel, std::size_t first, std::size_t n) {
      std::copy_n(frame_.begin() + std::ptrdiff_t(pixel), n, out.begin() + std::ptrdiff_t(first));
    });
    const bool shows = step.stage + 1 == stages(settings()), reuses = settings().rounds > 0;
    const Shown sums = shows ? shows_all() : Shown{};
    const std::size_t others = reuses ? std::size_t(settings().neighbours) : 0;
    const int writes = step_number(step.frame, reuses ? step.stage : 1);
    Inputs inputs(1 + others, reuses_paths());
    for (std::uint32_t next = 0; next < std::uint32_t(tile.area());) {
      const LanePixels<F> at = gather(step.frame, tile, next);
      if (!any(at.on)) break;
      for_each_lane(at.on, [&](int k) { put_pixel(inputs, 0, k, before(step.frame, writes, lane(at.pixel, k))); });
      if (reuses) {
        RandomStream<F> numbers = stream(step.frame, at, restir_stream::spatial + std::uint32_t(step.stage));
        meet_neighbours(step.frame, writes, at, numbers, inputs);
        const Spectrum<F> light = combine_all(inputs, numbers, at, sums, counts);
        if (shows) add_light(inputs.vertices[0].throughput * light, at, at.on, out);
        leave(inputs, at, writes);
      }
      if (!shows) continue;
      if (!sums.lights) show(inputs.vertices[0], inputs.lights[0], at, out, counts);
      if (reuses_paths() && !sums.paths) show(inputs.vertices[0], inputs.paths[0], at, out);
    }
    return counts;
  }

  void meet_neighbours(int frame, int writes, const LanePixels<F>& at, RandomStream<F>& numbers, Inputs& inputs) {
    for (std::size_t i = 1; i < inputs.vertices.size(); ++i) {
      const Vec2<F> u = numbers.next2();
      inputs.clear(i);
      for_each_lane(at.on, [&](int k) {
        const auto pixel =
            neighbour(settings(), pass_.bounds, vertices(frame), at.x(k), at.y(k), {lane(u.x, k), lane(u.y, k)});
        if (pixel) put_pixel(inputs, i, k, before(frame, writes, *pixel));
      });
    }
  }

  void show(const ReuseVertex<F>& vertex, const LightReservoir<F>& reservoir, const LanePixels<F>& at,
            std::span<PixelSample> out, RayCounts& counts) const {
    const M lit = at.on & (reservoir.weight > F(0.0f));
    if (!any(lit)) return;
    const Connection<F> way = connect(shared_.lights.by_hierarchy, vertex, reservoir.value, lit);
    const Spectrum<F> light = vertex.throughput * way.value * reservoir.weight;
    // Where targets know what is in the way, the pixel sees whatever it holds.
    const M asks = lit & (way.target > F(0.0f));
    const M open = settings().visibility_reuse ? asks : is_open<F>(shared_.rays, vertex, way, asks, counts);
    add_light(light, at, open, out);
  }
  void add_light(const Spectrum<F>& light, const LanePixels<F>& at, M on, std::span<PixelSample> out) const {
    for_each_lane(on, [&](int k) { out[lane(at.slot, k)].radiance += lane(light, k); });
  }

  // Targets of paths know what is in the way.
  void show(const ReuseVertex<F>& vertex, const PathReservoir<F>& reservoir, const LanePixels<F>& at,
            std::span<PixelSample> out) const {
    const Spectrum<F> light = vertex.throughput * reservoir.value.brings * reservoir.weight;
    add_light(light, at, at.on & (reservoir.weight > F(0.0f)), out);
  }

  const RestirScene<Rays> shared_;
  const ChainPass pass_;
  std::shared_ptr<const ReuseMemory> before_;        // of the picture before, if there is one
  std::vector<std::optional<std::size_t>> earlier_;  // pixels of it that showed what the pixels show
  std::vector<ReuseVertex<float>> vertices_[2];      // of this frame and the one before
  ReservoirPlanes<LightPoint> lights_;
  ReservoirPlanes<PathSample> paths_;  // of no size where paths are not reused
  std::vector<PixelSample> frame_;     // without the reused light
};

}  // namespace montelux
