// A chain of frames whose pixels share what they know of direct light.
#pragma once
#include "integrator/restir/first_stage.h"
#include "integrator/restir/light_point_shift.h"

namespace montelux {

template <class F, class Rays>
class DirectChain final : public Chain {
 public:
  using U = Uint<F>;
  using M = Mask<F>;
  // What `shared` refers to must outlive the chain.
  DirectChain(const RestirScene<Rays>& shared, const ChainPass& pass) : shared_(shared), pass_(pass) {
    const auto pixels = std::size_t(pass.bounds.area());
    for (auto& vertices : vertices_) vertices.resize(pixels);
    for (auto& reservoirs : reservoirs_) reservoirs.resize(pixels);
    frame_.resize(pixels);
  }

  // Stage 0 looks for light at every pixel and in the frame before; every further one learns from neighbours, and the
  // last one of these makes the picture.
  RayCounts run(const ChainStep& step, const PixelBounds& tile, std::span<PixelSample> out) override {
    if (step.stage == 0) return find(step.frame, tile);
    return share(step, tile, out);
  }

  static int stages(const RestirSettings& settings) { return 1 + std::max(settings.rounds, 1); }

 private:
  using Sample = LightPoint<F>;
  const RestirSettings& settings() const { return shared_.settings; }

  std::size_t pixel_number(int x, int y) const {
    const PixelBounds& b = pass_.bounds;
    return std::size_t(y - b.y0) * std::size_t(b.width()) + std::size_t(x - b.x0);
  }
  // The pixels of a row of the tile are together in the picture, too.
  template <class Function>
  void for_each_row(const PixelBounds& tile, Function f) const {
    for (int y = tile.y0; y < tile.y1; ++y)
      f(pixel_number(tile.x0, y), std::size_t(y - tile.y0) * std::size_t(tile.width()), std::size_t(tile.width()));
  }

  // Reservoirs before and after round `round`: the frame before has left its own where a frame begins.
  std::vector<LightReservoir<float>>& reservoirs(int frame, int round) {
    return reservoirs_[std::size_t(frame * settings().rounds + round) & 1];
  }
  std::vector<ReuseVertex<float>>& vertices(int frame) { return vertices_[std::size_t(frame) & 1]; }

  template <template <class> class S>
  static void put(S<F>& lanes, int k, const S<float>& one) {
    set_lane_words(lanes, k, one);
  }
  static void put(LightReservoir<F>& lanes, int k, const LightReservoir<float>& one) {
    set_lane_words(lanes.value, k, one.value);
    set_lane(lanes.weight, k, one.weight), set_lane(lanes.confidence, k, one.confidence);
    set_lane(lanes.target, k, one.target);
  }
  static LightReservoir<float> get(const LightReservoir<F>& lanes, int k) {
    LightReservoir<float> one;
    get_lane_words(lanes.value, k, one.value);
    one.weight = lane(lanes.weight, k), one.confidence = lane(lanes.confidence, k), one.target = lane(lanes.target, k);
    return one;
  }

  RayCounts find(int frame, const PixelBounds& tile) {
    std::vector<PixelSample> out(std::size_t(tile.area()));
    const TilePass request{tile, pass_.points, pass_.shutter, std::uint32_t(frame)};
    for_each_row(tile, [&](std::size_t pixel, std::size_t, std::size_t n) {
      for (std::size_t i = 0; i < n; ++i) vertices(frame)[pixel + i].exists = 0;
    });
    RayCounts counts;
    auto keep = [&](const ReuseVertex<F>& vertex, LightReservoir<F> reservoir, const U& slot, M on) {
      U pixel = U(0u);
      for_each_lane(on, [&](int k) {
        const int at = int(lane(slot, k));
        set_lane(pixel, k, std::uint32_t(pixel_number(tile.x0 + at % tile.width(), tile.y0 + at / tile.width())));
      });
      if (settings().temporal && frame > 0)
        reservoir = with_last_frame(frame, {tile, slot, pixel, on}, vertex, reservoir, counts);
      for_each_lane(on, [&](int k) {
        get_lane_words(vertex, k, vertices(frame)[lane(pixel, k)]);
        reservoirs(frame, 0)[lane(pixel, k)] = get(reservoir, k);
      });
    };
    FirstStage<F, Rays, decltype(keep)> stage(shared_, request, out, keep);
    counts += stage.run();
    for_each_row(tile, [&](std::size_t pixel, std::size_t first, std::size_t n) {
      std::copy_n(out.begin() + std::ptrdiff_t(first), n, frame_.begin() + std::ptrdiff_t(pixel));
    });
    return counts;
  }

  // Which pixels the lanes are.
  struct LanePixels {
    PixelBounds tile;
    U slot, pixel;
    M on;
    U x() const {
      return coordinate([&](std::uint32_t s) { return tile.x0 + int(s) % tile.width(); });
    }
    U y() const {
      return coordinate([&](std::uint32_t s) { return tile.y0 + int(s) / tile.width(); });
    }

   private:
    template <class Function>
    U coordinate(Function f) const {
      U r = U(0u);
      for_each_lane(on, [&](int k) { set_lane(r, k, std::uint32_t(f(lane(slot, k)))); });
      return r;
    }
  };

  LightReservoir<F> with_last_frame(int frame, const LanePixels& at, const ReuseVertex<F>& vertex,
                                    const LightReservoir<F>& own, RayCounts& counts) {
    ReuseVertex<F> domains[2] = {vertex, vertex};
    LightReservoir<F> inputs[2] = {own, own};
    inputs[1].confidence = F(0.0f);
    for_each_lane(at.on, [&](int k) {
      const std::size_t pixel = lane(at.pixel, k);
      if (vertices(frame - 1)[pixel].exists == 0) return;
      put(domains[1], k, vertices(frame - 1)[pixel]);
      put(inputs[1], k, reservoirs(frame, 0)[pixel]);
    });
    inputs[1].confidence = min(inputs[1].confidence, F(settings().m_cap));
    return combined(inputs, domains, stream(frame, at, restir_stream::temporal), at.on, counts);
  }

  RandomStream<F> stream(int frame, const LanePixels& at, std::uint32_t purpose) const {
    return Sampler<F>(pass_.points, at.x(), at.y(), U(std::uint32_t(frame)))
        .stream(U(restir_stream::dimension))
        .fork(U(purpose));
  }

  LightReservoir<F> combined(std::span<const LightReservoir<F>> inputs, std::span<const ReuseVertex<F>> domains,
                             RandomStream<F> numbers, M on, RayCounts& counts) const {
    const LightPointDomains<F, Rays> points{shared_.lights.by_hierarchy, shared_.rays, domains,
                                            settings().visibility_reuse, counts};
    return combine<Sample, F>(settings().weights, inputs, points, numbers, on);
  }

  // One round of spatial reuse, and after the last the picture.
  RayCounts share(const ChainStep& step, const PixelBounds& tile, std::span<PixelSample> out) {
    RayCounts counts;
    for_each_row(tile, [&](std::size_t pixel, std::size_t first, std::size_t n) {
      std::copy_n(frame_.begin() + std::ptrdiff_t(pixel), n, out.begin() + std::ptrdiff_t(first));
    });
    const bool shows = step.stage + 1 == stages(settings());
    const std::size_t others = settings().rounds > 0 ? std::size_t(settings().neighbours) : 0;
    std::vector<ReuseVertex<F>> domains(1 + others);
    std::vector<LightReservoir<F>> inputs(1 + others);
    std::uint32_t next = 0;
    for (const auto slots = std::uint32_t(tile.area()); next < slots;) {
      LanePixels at{tile, U(0u), U(0u), M(false)};
      gather(step.frame, tile, next, at);
      if (!any(at.on)) break;
      for_each_lane(at.on, [&](int k) {
        put(domains[0], k, vertices(step.frame)[lane(at.pixel, k)]);
        put(inputs[0], k, reservoirs(step.frame, step.stage - 1)[lane(at.pixel, k)]);
      });
      if (settings().rounds > 0) {
        RandomStream<F> numbers = stream(step.frame, at, restir_stream::spatial + std::uint32_t(step.stage));
        choose_neighbours(step, at, numbers, domains, inputs);
        inputs[0] = combined(inputs, domains, numbers, at.on, counts);
        for_each_lane(at.on, [&](int k) { reservoirs(step.frame, step.stage)[lane(at.pixel, k)] = get(inputs[0], k); });
      }
      if (shows) show(domains[0], inputs[0], at, out, counts);
    }
    return counts;
  }

  // The next pixels of the tile that have a vertex, from slot `next` on.
  void gather(int frame, const PixelBounds& tile, std::uint32_t& next, LanePixels& at) {
    std::uint32_t lanes = 0;
    for (int k = 0; k < lanes_of<F> && next < std::uint32_t(tile.area()); ++next) {
      const std::size_t pixel = pixel_number(tile.x0 + int(next) % tile.width(), tile.y0 + int(next) / tile.width());
      if (vertices(frame)[pixel].exists == 0) continue;
      set_lane(at.slot, k, next), set_lane(at.pixel, k, std::uint32_t(pixel));
      lanes |= 1u << k++;
    }
    at.on = mask_of_bits<F>(lanes);
  }

  // Pixels drawn uniformly from a disk. The choice looks at surfaces alone, never at what was found there: the shares
  // of a combination would not add up to one otherwise.
  void choose_neighbours(const ChainStep& step, const LanePixels& at, RandomStream<F>& numbers,
                         std::span<ReuseVertex<F>> domains, std::span<LightReservoir<F>> inputs) {
    const PixelBounds& b = pass_.bounds;
    for (std::size_t i = 1; i < inputs.size(); ++i) {
      const Vec2<F> u = numbers.next2();
      domains[i] = domains[0], inputs[i] = inputs[0];
      inputs[i].confidence = F(0.0f);
      for_each_lane(at.on, [&](int k) {
        const float r = settings().radius * std::sqrt(lane(u.x, k)), angle = 2 * pi * lane(u.y, k);
        const int dx = int(std::lround(r * std::cos(angle))), dy = int(std::lround(r * std::sin(angle)));
        const int slot = int(lane(at.slot, k));
        const int x = at.tile.x0 + slot % at.tile.width() + dx, y = at.tile.y0 + slot / at.tile.width() + dy;
        if ((dx == 0 && dy == 0) || x < b.x0 || x >= b.x1 || y < b.y0 || y >= b.y1) return;
        const std::size_t pixel = pixel_number(x, y);
        const ReuseVertex<float>& other = vertices(step.frame)[pixel];
        if (other.exists == 0) return;
        if (settings().similar && !are_similar(vertices(step.frame)[lane(at.pixel, k)], other)) return;
        put(domains[i], k, other);
        put(inputs[i], k, reservoirs(step.frame, step.stage - 1)[pixel]);
      });
    }
  }

  // Normals within 25 degrees, depths within a tenth (Bitterli et al. 2020, sec. 5).
  static bool are_similar(const ReuseVertex<float>& a, const ReuseVertex<float>& b) {
    const float side = (a.wo.z < 0) == (b.wo.z < 0) ? 1.0f : -1.0f;
    return side * dot(a.frame.n, b.frame.n) > 0.906f && std::abs(a.depth - b.depth) < 0.1f * a.depth;
  }

  void show(const ReuseVertex<F>& vertex, const LightReservoir<F>& reservoir, const LanePixels& at,
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
  // Pixels in row-major order: this frame and the one before; before and after a round; without the reused light.
  std::vector<ReuseVertex<float>> vertices_[2];
  std::vector<LightReservoir<float>> reservoirs_[2];
  std::vector<PixelSample> frame_;
};

}  // namespace montelux
