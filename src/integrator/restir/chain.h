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
    frame_.resize(pixels);
  }

  // Stage 0 looks for light at every pixel and in the frame before; every further one learns from neighbours, and the
  // last one of these makes the picture.
  RayCounts run(const ChainStep& step, const PixelBounds& tile, std::span<PixelSample> out) override {
    if (step.stage > 0) return share(step, tile, out);
    RayCounts counts = find(step.frame, tile);
    if (settings().temporal && (step.frame > 0 || before_)) counts += recall(step.frame, tile);
    return counts;
  }

  std::unique_ptr<ChainMemory> remember(int frames) override {
    if (!settings().temporal || !settings().carry) return nullptr;
    auto memory = std::make_unique<ReuseMemory>();
    memory->bounds = pass_.bounds, memory->shutter = shutter();
    memory->vertices = std::move(vertices(frames - 1));
    memory->lights = std::move(lights_.after(step_number(frames - 1, settings().rounds)));
    return memory;
  }

  static int stages(const RestirSettings& settings) { return 1 + std::max(settings.rounds, 1); }

 private:
  const RestirSettings& settings() const { return shared_.settings; }
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

  // Every pixel by itself.
  RayCounts find(int frame, const PixelBounds& tile) {
    std::vector<PixelSample> out(std::size_t(tile.area()));
    const TilePass request{tile, pass_.points, pass_.shutter, std::uint32_t(frame)};
    for_each_row(pass_.bounds, tile, [&](std::size_t pixel, std::size_t, std::size_t n) {
      for (std::size_t i = 0; i < n; ++i) vertices(frame)[pixel + i].exists = 0;
    });
    auto keep = [&](const ReuseVertex<F>& vertex, const VertexOrigin<F>& origin, const LightReservoir<F>& reservoir,
                    const U& slot, M on) {
      const LanePixels<F> at{tile, slot, U(0u), on};
      if (before_ && frame == 0) trace_back(at, vertex, origin);
      for_each_lane(on, [&](int k) {
        const std::size_t pixel = pixel_number(pass_.bounds, at.x(k), at.y(k));
        get_lane_words(vertex, k, vertices(frame)[pixel]);
        get(reservoir, k, lights_.after(step_number(frame, 0))[pixel]);
      });
    };
    FirstStage<F, Rays, decltype(keep)> stage(shared_, request, out, keep);
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

  // What a pixel held at the end of the frame before: the same pixel within a picture.
  struct Past {
    const ReuseVertex<float>& vertex;
    const LightReservoir<float>& light;
  };
  std::optional<Past> past(int frame, std::size_t pixel) {
    if (frame == 0) {
      const auto earlier = earlier_[pixel];
      return earlier ? std::optional<Past>({before_->vertices[*earlier], before_->lights[*earlier]}) : std::nullopt;
    }
    if (vertices(frame - 1)[pixel].exists == 0) return std::nullopt;
    return Past{vertices(frame - 1)[pixel], lights_.before(step_number(frame, 0))[pixel]};
  }

  // Every pixel learns from itself in the frame before, or from where its surface was in the picture before.
  RayCounts recall(int frame, const PixelBounds& tile) {
    RayCounts counts;
    const int step = step_number(frame, 0);
    for (std::uint32_t next = 0; next < std::uint32_t(tile.area());) {
      const LanePixels<F> at = gather(frame, tile, next);
      if (!any(at.on)) break;
      ReuseVertex<F> domains[2];
      LightReservoir<F> inputs[2];
      for_each_lane(at.on, [&](int k) {
        const std::size_t pixel = lane(at.pixel, k);
        set_lane_words(domains[0], k, vertices(frame)[pixel]);
        put(inputs[0], k, lights_.after(step)[pixel]);
      });
      domains[1] = domains[0], inputs[1] = inputs[0];
      inputs[1].confidence = F(0.0f);
      for_each_lane(at.on, [&](int k) {
        const std::optional<Past> known = past(frame, lane(at.pixel, k));
        if (!known) return;
        set_lane_words(domains[1], k, known->vertex);
        put(inputs[1], k, known->light);
      });
      inputs[1].confidence = min(inputs[1].confidence, F(settings().m_cap));
      const LightReservoir<F> result =
          combined(inputs, domains, stream(frame, at, restir_stream::temporal), at.on, counts);
      for_each_lane(at.on, [&](int k) { get(result, k, lights_.after(step)[lane(at.pixel, k)]); });
    }
    return counts;
  }

  LightReservoir<F> combined(std::span<const LightReservoir<F>> inputs, std::span<const ReuseVertex<F>> domains,
                             RandomStream<F> numbers, M on, RayCounts& counts) const {
    const LightPointDomains<F, Rays> points{shared_.lights.by_hierarchy, shared_.rays, domains,
                                            settings().visibility_reuse, counts};
    return combine<LightPoint<F>, F>(settings().weights, inputs, points, numbers, on);
  }

  // One round of spatial reuse, and after the last the picture.
  RayCounts share(const ChainStep& step, const PixelBounds& tile, std::span<PixelSample> out) {
    RayCounts counts;
    for_each_row(pass_.bounds, tile, [&](std::size_t pixel, std::size_t first, std::size_t n) {
      std::copy_n(frame_.begin() + std::ptrdiff_t(pixel), n, out.begin() + std::ptrdiff_t(first));
    });
    const bool shows = step.stage + 1 == stages(settings()), reuses = settings().rounds > 0;
    const std::size_t others = reuses ? std::size_t(settings().neighbours) : 0;
    const int writes = step_number(step.frame, reuses ? step.stage : 1);
    std::vector<ReuseVertex<F>> domains(1 + others);
    std::vector<LightReservoir<F>> inputs(1 + others);
    for (std::uint32_t next = 0; next < std::uint32_t(tile.area());) {
      const LanePixels<F> at = gather(step.frame, tile, next);
      if (!any(at.on)) break;
      for_each_lane(at.on, [&](int k) {
        set_lane_words(domains[0], k, vertices(step.frame)[lane(at.pixel, k)]);
        put(inputs[0], k, lights_.before(writes)[lane(at.pixel, k)]);
      });
      if (reuses) {
        RandomStream<F> numbers = stream(step.frame, at, restir_stream::spatial + std::uint32_t(step.stage));
        meet_neighbours(step.frame, writes, at, numbers, domains, inputs);
        inputs[0] = combined(inputs, domains, numbers, at.on, counts);
        for_each_lane(at.on, [&](int k) { get(inputs[0], k, lights_.after(writes)[lane(at.pixel, k)]); });
      }
      if (shows) show(domains[0], inputs[0], at, out, counts);
    }
    return counts;
  }

  void meet_neighbours(int frame, int writes, const LanePixels<F>& at, RandomStream<F>& numbers,
                       std::span<ReuseVertex<F>> domains, std::span<LightReservoir<F>> inputs) {
    for (std::size_t i = 1; i < inputs.size(); ++i) {
      const Vec2<F> u = numbers.next2();
      domains[i] = domains[0], inputs[i] = inputs[0];
      inputs[i].confidence = F(0.0f);
      for_each_lane(at.on, [&](int k) {
        const auto pixel =
            neighbour(settings(), pass_.bounds, vertices(frame), at.x(k), at.y(k), {lane(u.x, k), lane(u.y, k)});
        if (!pixel) return;
        set_lane_words(domains[i], k, vertices(frame)[*pixel]);
        put(inputs[i], k, lights_.before(writes)[*pixel]);
      });
    }
  }

  void show(const ReuseVertex<F>& vertex, const LightReservoir<F>& reservoir, const LanePixels<F>& at,
            std::span<PixelSample> out, RayCounts& counts) const {
    const M lit = at.on & (reservoir.weight > F(0.0f));
    if (!any(lit)) return;
    const Connection<F> way = connect(shared_.lights.by_hierarchy, vertex, reservoir.value, lit);
    const Spectrum<F> light = vertex.throughput * way.value * reservoir.weight;
    const M open = is_open<F>(shared_.rays, vertex, way, lit & (way.target > F(0.0f)), counts);
    for_each_lane(open, [&](int k) { out[lane(at.slot, k)].radiance += lane(light, k); });
  }

  const RestirScene<Rays> shared_;
  const ChainPass pass_;
  std::shared_ptr<const ReuseMemory> before_;        // of the picture before, if there is one
  std::vector<std::optional<std::size_t>> earlier_;  // pixels of it that showed what the pixels show
  std::vector<ReuseVertex<float>> vertices_[2];      // of this frame and the one before
  ReservoirPlanes<LightPoint> lights_;
  std::vector<PixelSample> frame_;  // without the reused light
};

}  // namespace montelux
