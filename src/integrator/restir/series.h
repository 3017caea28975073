// A series of frames whose pixels share what they know of light. With a grid its pixels are the cells: what they share
// is drawn by the numbers of the cells, while their paths have the numbers of the pixels that they stand for.
#pragma once
#include <limits>

#include "integrator/restir/combination.h"
#include "integrator/restir/groups.h"
#include "integrator/restir/neighbours.h"
#include "transport/dimensions.h"

namespace montelux {

template <class F, class Rays>
class ReuseSeries final : public FrameSeries {
 public:
  using U = Uint<F>;
  using M = Mask<F>;
  // What `shared` refers to must outlive the series.
  ReuseSeries(const RestirScene<Rays>& shared, const SeriesPass& pass)
      : shared_(shared), pass_(pass), before_(std::dynamic_pointer_cast<const ReuseMemory>(pass.before)) {
    const auto pixels = std::size_t(pass.bounds.area());
    if (before_ && (!shared.settings.temporal || pass.grid || !(before_->bounds == pass.bounds))) before_.reset();
    if (before_) earlier_.resize(pixels);
    for (auto& vertices : vertices_) vertices.resize(pixels);
    lights_.resize(pixels);
    if (reuses_paths()) paths_.resize(pixels);
    objects_.resize(pixels), frame_.resize(pixels);
  }

  // Stage 0 looks for light at every pixel and in the frame before; every further one reuses samples of neighbours,
  // and the last one of these makes the picture.
  RayCounts run(const SeriesStep& step, const PixelBounds& tile, std::span<PixelSample> out) override {
    if (step.stage > 0) {
      if (!in_groups()) return share(step, tile, out);
      return step.stage <= settings().rounds ? share_in_groups(step, tile) : show_frame(step, tile, out);
    }
    RayCounts counts = find(step.frame, tile);
    if (settings().temporal && (step.frame > 0 || before_)) counts += recall(step.frame, tile);
    return counts;
  }

  std::unique_ptr<SeriesMemory> remember(int frames) override {
    if (!settings().temporal || !settings().carry || pass_.grid) return nullptr;
    auto memory = std::make_unique<ReuseMemory>();
    memory->bounds = pass_.bounds, memory->shutter = shutter();
    memory->vertices = std::move(vertices(frames - 1));
    memory->lights = std::move(lights_.after(step_number(frames - 1, settings().rounds)));
    if (keeps_paths()) memory->paths = std::move(paths_.after(step_number(frames - 1, settings().rounds)));
    return memory;
  }

  // Groups reach over tiles, so that the picture is complete only after the last round.
  static int stages(const RestirSettings& settings) {
    return 1 + std::max(settings.rounds, 1) + (settings.groups && settings.rounds > 0 ? 1 : 0);
  }

 private:
  const RestirSettings& settings() const { return shared_.settings; }
  bool reuses_paths() const { return settings().indirect.on; }
  // For the next picture: of another time, where surfaces move.
  bool keeps_paths() const { return reuses_paths() && !shared_.scene.geometry.moves(); }
  bool in_groups() const { return settings().groups && settings().rounds > 0; }
  Shutter shutter() const { return pass_.shutter.value_or(shared_.scene.shutter); }

  // Paths that are shared have the same time: where surfaces move, all pixels of a frame have one. The times of the
  // frames are spread over the exposure as the samples of a pixel are.
  std::optional<float> shutter_sample(int frame) const {
    if (!reuses_paths() || !shared_.scene.geometry.moves()) return std::nullopt;
    return Sampler<float>(pass_.points, 0, 0, std::uint32_t(frame)).get1(path_dimension::time);
  }
  // The number of a round of a frame among all that write reservoirs; round 0 is that of stage 0.
  int step_number(int frame, int round) const { return frame * (settings().rounds + 1) + round; }
  std::vector<ReuseVertex<float>>& vertices(int frame) { return vertices_[std::size_t(frame) & 1]; }

  RandomStream<F> stream(int frame, const LanePixels<F>& at, std::uint32_t purpose) const {
    return at.stream(pass_.points, frame, path_dimension::reuse, purpose);
  }
  LanePixels<F> gather(int frame, const PixelBounds& tile, std::uint32_t& next) {
    return gather_pixels<F>(pass_.bounds, tile, next,
                            [&](std::size_t pixel) { return vertices(frame)[pixel].exists != 0; });
  }

  // Receives the results of FirstStage.
  struct FirstStageSink {
    ReuseSeries& series;
    int frame;
    PixelBounds tile;

    void lights(const ReuseVertex<F>& vertex, const VertexOrigin<F>& origin, const LightReservoir<F>& reservoir,
                const U& output, M on) {
      const int step = series.step_number(frame, 0);
      if (series.before_ && frame == 0) series.trace_back({tile, output, U(0u), on}, vertex, origin);
      for_each_pixel(output, on, [&](int k, std::size_t pixel) {
        get_lane_words(vertex, k, series.vertices(frame)[pixel]);
        series.objects_[pixel] = lane(vertex.object, k);
        get(reservoir, k, series.lights_.after(step)[pixel]);
        if (series.reuses_paths()) series.paths_.after(step)[pixel] = {{}, 0.0f, 1.0f, 0.0f};
      });
    }
    void paths(const PathReservoir<F>& reservoir, const U& output, M on) {
      for_each_pixel(output, on, [&](int k, std::size_t pixel) {
        get(reservoir, k, series.paths_.after(series.step_number(frame, 0))[pixel]);
      });
    }

   private:
    template <class Function>
    void for_each_pixel(const U& output, M on, Function f) const {
      const LanePixels<F> at{tile, output, U(0u), on};
      for_each_lane(on, [&](int k) { f(k, pixel_number(series.pass_.bounds, at.x(k), at.y(k))); });
    }
  };

  // Every pixel by itself.
  RayCounts find(int frame, const PixelBounds& tile) {
    std::vector<PixelSample> out(std::size_t(tile.area()));
    const TilePass request{tile, pass_.points, pass_.shutter, std::uint32_t(frame), shutter_sample(frame), pass_.grid};
    for_each_row(pass_.bounds, tile, [&](std::size_t pixel, std::size_t, std::size_t n) {
      for (std::size_t i = 0; i < n; ++i) vertices(frame)[pixel + i].exists = 0, objects_[pixel + i] = no_vertex;
    });
    FirstStageSink finds{*this, frame, tile};
    FirstStage<F, Rays, FirstStageSink> stage(shared_, request, out, finds);
    const RayCounts counts = stage.run();
    for_each_row(pass_.bounds, tile, [&](std::size_t pixel, std::size_t first, std::size_t n) {
      std::copy_n(out.begin() + std::ptrdiff_t(first), n, frame_.begin() + std::ptrdiff_t(pixel));
    });
    return counts;
  }

  // Which pixels of the picture before showed the points of the vertices. Behind mirrors and glass it is sought at the
  // pixel itself.
  void trace_back(const LanePixels<F>& at, const ReuseVertex<F>& vertex, const VertexOrigin<F>& origin) {
    F time = vertex.time;
    for_each_lane(at.on,
                  [&](int k) { set_lane(time, k, earlier_time(lane(vertex.time, k), shutter(), before_->shutter)); });
    const M straight = at.on & origin.straight;
    const EarlierPlace<F> then = earlier_place<F>(shared_.scene, origin, time, straight);
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

  PixelState after(int frame, int step, std::size_t pixel) {
    return {vertices(frame)[pixel], lights_.after(step)[pixel], reuses_paths() ? &paths_.after(step)[pixel] : nullptr};
  }
  PixelState before(int frame, int step, std::size_t pixel) {
    return {vertices(frame)[pixel], lights_.before(step)[pixel],
            reuses_paths() ? &paths_.before(step)[pixel] : nullptr};
  }
  // What a pixel held at the end of the frame before: the same pixel within a picture.
  std::optional<PixelState> past(int frame, std::size_t pixel) {
    if (frame == 0) {
      const std::optional<std::size_t> earlier = earlier_[pixel];
      if (!earlier) return std::nullopt;
      return PixelState{before_->vertices[*earlier], before_->lights[*earlier],
                        keeps_paths() ? &before_->paths[*earlier] : nullptr};
    }
    if (vertices(frame - 1)[pixel].exists == 0) return std::nullopt;
    return before(frame - 1, step_number(frame, 0), pixel);
  }

  // Every pixel reuses its own samples of the frame before, or those of where its surface was in the picture before.
  RayCounts recall(int frame, const PixelBounds& tile) {
    RayCounts counts;
    const int step = step_number(frame, 0);
    ReuseInputs<F> inputs(2, reuses_paths());
    for (std::uint32_t next = 0; next < std::uint32_t(tile.area());) {
      const LanePixels<F> at = gather(frame, tile, next);
      if (!any(at.on)) break;
      for_each_lane(at.on, [&](int k) { inputs.put_pixel(0, k, after(frame, step, lane(at.pixel, k))); });
      inputs.clear(1);
      for_each_lane(at.on, [&](int k) {
        if (const auto known = past(frame, lane(at.pixel, k))) inputs.put_pixel(1, k, *known);
      });
      inputs.cap(1, F(settings().m_cap));
      combination(inputs, counts).into_first(stream(frame, at, restir_stream::temporal), at.on, {});
      leave(inputs, at, step);
    }
    return counts;
  }

  // Where targets know what is in the way, all reservoirs of the last round can be shown, and not the chosen one alone.
  ImageSums shows_all() const {
    const bool all = settings().rounds > 0 && (settings().groups || shares_sum_to_one(settings().weights));
    return {all && settings().direct && settings().visibility_reuse, all && reuses_paths()};
  }

  ReuseCombination<F, Rays> combination(ReuseInputs<F>& inputs, RayCounts& counts) const {
    return {shared_, inputs, counts};
  }
  // Leaves what the first input holds after `step`.
  void leave(const ReuseInputs<F>& inputs, const LanePixels<F>& at, int step) {
    for_each_lane(at.on, [&](int k) { get(inputs.lights[0], k, lights_.after(step)[lane(at.pixel, k)]); });
    if (!reuses_paths()) return;
    for_each_lane(at.on, [&](int k) { get(inputs.paths[0], k, paths_.after(step)[lane(at.pixel, k)]); });
  }

  // One round of spatial reuse, and after the last the picture.
  RayCounts share(const SeriesStep& step, const PixelBounds& tile, std::span<PixelSample> out) {
    RayCounts counts;
    copy_frame(tile, out);
    const bool shows = step.stage + 1 == stages(settings()), reuses = settings().rounds > 0;
    const ImageSums sums = shows ? shows_all() : ImageSums{};
    const std::size_t others = reuses ? std::size_t(settings().neighbours) : 0;
    const int writes = step_number(step.frame, reuses ? step.stage : 1);
    ReuseInputs<F> inputs(1 + others, reuses_paths());
    for (std::uint32_t next = 0; next < std::uint32_t(tile.area());) {
      const LanePixels<F> at = gather(step.frame, tile, next);
      if (!any(at.on)) break;
      for_each_lane(at.on, [&](int k) { inputs.put_pixel(0, k, before(step.frame, writes, lane(at.pixel, k))); });
      if (reuses) {
        RandomStream<F> numbers = stream(step.frame, at, restir_stream::spatial + std::uint32_t(step.stage));
        meet_neighbours(step.frame, writes, at, numbers, inputs);
        const Spectrum<F> radiance = combination(inputs, counts).into_first(numbers, at.on, sums);
        if (shows) add_light(inputs.vertices[0].throughput * radiance, at, at.on, out);
        leave(inputs, at, writes);
      }
      if (!shows) continue;
      show_chosen(inputs, sums, at, out, counts);
    }
    return counts;
  }

  // What the pixels of the groups hold: lane k of input i is pixel i of the group first + k. Lanes without a pixel have
  // confidence 0.
  void meet_groups(int frame, int writes, const PixelGroups& groups, std::size_t first, ReuseInputs<F>& inputs) {
    for (std::size_t i = 0; i < inputs.vertices.size(); ++i) {
      PixelsInLanes<F> pixels;
      std::uint32_t present = 0;
      for (std::size_t k = 0; k < lanes_of<F>; ++k) {
        const std::span<const std::uint32_t> members = groups.group(std::min(first + k, groups.count() - 1));
        if (first + k < groups.count() && i < members.size()) present |= 1u << k;
        pixels.put(k, before(frame, writes, members[std::min(i, members.size() - 1)]));
      }
      inputs.put_pixels(i, pixels);
      inputs.cap(i, select(mask_of_bits<F>(present), F(std::numeric_limits<float>::infinity()), F(0.0f)));
    }
  }

  // What pixel i of a group holds after its step: what it has chosen, if anything.
  template <template <class> class Value, class Image, class Change>
  static void leave_choice(ReservoirPlanes<Value>& planes, int writes, std::span<const std::uint32_t> members,
                           std::size_t i, int k, const GroupChoice<Image, F>& choice, Change change) {
    auto& left = planes.after(writes)[members[i]];
    const float weight = lane(choice.weight, k);
    left.value = planes.before(writes)[members[weight > 0 ? lane(choice.from, k) : i]].value;
    left.weight = weight, left.confidence = lane(choice.confidence, k), left.target = lane(choice.image.target, k);
    if (weight > 0) change(left.value);
  }

  // The same for the pixels of groups, all at once.
  RayCounts share_in_groups(const SeriesStep& step, const PixelBounds& tile) {
    RayCounts counts;
    const bool last = step.stage == settings().rounds;
    const ImageSums sums = last ? shows_all() : ImageSums{};
    const int writes = step_number(step.frame, step.stage);
    const PixelGroups groups = groups_at(step, tile);
    ReuseInputs<F> inputs(groups.size, reuses_paths());
    for (std::size_t first = 0; first < groups.count(); first += lanes_of<F>) {
      meet_groups(step.frame, writes, groups, first, inputs);
      const M on = inputs.lights[0].confidence > F(0.0f);
      const GroupResult<F> result =
          combination(inputs, counts).group_result(group_stream(step, groups, first), on, sums);
      for (std::size_t k = 0; k < lanes_of<F> && first + k < groups.count(); ++k) {
        const std::span<const std::uint32_t> members = groups.group(first + k);
        for (std::size_t i = 0; i < members.size(); ++i) {
          if (settings().direct)
            leave_choice(lights_, writes, members, i, int(k), result.lights[i], [](LightPoint<float>&) {});
          else
            lights_.after(writes)[members[i]] = lights_.before(writes)[members[i]];
          if (reuses_paths())
            leave_choice(paths_, writes, members, i, int(k), result.paths[i], [&](PathSample<float>& value) {
              value.contribution = lane(result.paths[i].image.contribution, int(k));
            });
          if (last)
            frame_[members[i]].radiance += to_rgb(lane(inputs.vertices[i].throughput * result.light[i], int(k)));
        }
      }
    }
    return counts;
  }

  // The numbers of pixels for the groups of a step.
  template <class G>
  RandomStream<G> group_numbers(const SeriesStep& step, const Uint<G>& x, const Uint<G>& y) const {
    return numbers_of<G>(pass_.points, PathSite<G>{x, y, Uint<G>(std::uint32_t(step.frame))})
        .stream(Uint<G>(path_dimension::reuse))
        .fork(Uint<G>(restir_stream::spatial + std::uint32_t(step.stage)));
  }

  // Pixels in an order at random; where groups prefer what is similar, object by object.
  void put_in_order(const SeriesStep& step, std::span<PlacedPixel> pixels) const {
    const auto width = std::uint32_t(pass_.bounds.width());
    for (std::size_t first = 0; first < pixels.size(); first += lanes_of<F>) {
      const std::span<PlacedPixel> pack =
          pixels.subspan(first, std::min(pixels.size() - first, std::size_t(lanes_of<F>)));
      U xs(0u), ys(0u);
      for (std::size_t k = 0; k < pack.size(); ++k) {
        set_lane(xs, int(k), std::uint32_t(pass_.bounds.x0) + pack[k].pixel % width);
        set_lane(ys, int(k), std::uint32_t(pass_.bounds.y0) + pack[k].pixel / width);
      }
      const U random = to_uint(group_numbers<F>(step, xs, ys).at(U(2u)) * F(16777216.0f));
      for (std::size_t k = 0; k < pack.size(); ++k) {
        const std::uint32_t kind = settings().similar ? objects_[pack[k].pixel] : 0;
        pack[k].place = std::uint64_t(kind) << 32 | lane(random, int(k));
      }
    }
  }

  PixelGroups groups_at(const SeriesStep& step, const PixelBounds& tile) {
    const RandomStream<float> numbers = group_numbers<float>(step, 0u, 0u);
    const ReuseBlocks blocks(2 * double(settings().radius), 2 * pi * double(numbers.at(0)),
                             {double(numbers.at(1)), double(numbers.at(3))});
    return groups_of(
        blocks, pass_.bounds, tile, 1 + std::size_t(settings().neighbours),
        [&](std::size_t pixel) { return objects_[pixel] != no_vertex; },
        [&](std::span<PlacedPixel> pixels) { put_in_order(step, pixels); });
  }

  // Of the first pixel of each group.
  RandomStream<F> group_stream(const SeriesStep& step, const PixelGroups& groups, std::size_t first) const {
    U xs(0u), ys(0u);
    const auto width = std::uint32_t(pass_.bounds.width());
    for (std::size_t k = 0; k < lanes_of<F> && first + k < groups.count(); ++k) {
      const std::uint32_t pixel = groups.group(first + k)[0];
      set_lane(xs, int(k), std::uint32_t(pass_.bounds.x0) + pixel % width);
      set_lane(ys, int(k), std::uint32_t(pass_.bounds.y0) + pixel / width);
    }
    return numbers_of<F>(pass_.points, PathSite<F>{xs, ys, U(std::uint32_t(step.frame))})
        .stream(U(path_dimension::reuse))
        .fork(U(restir_stream::groups + std::uint32_t(step.stage)));
  }

  // The picture, once all rounds are over.
  RayCounts show_frame(const SeriesStep& step, const PixelBounds& tile, std::span<PixelSample> out) {
    RayCounts counts;
    copy_frame(tile, out);
    const ImageSums sums = shows_all();
    if (sums.lights && (sums.paths || !reuses_paths())) return counts;
    const int writes = step_number(step.frame, settings().rounds);
    ReuseInputs<F> inputs(1, reuses_paths());
    for (std::uint32_t next = 0; next < std::uint32_t(tile.area());) {
      const LanePixels<F> at = gather(step.frame, tile, next);
      if (!any(at.on)) break;
      for_each_lane(at.on, [&](int k) { inputs.put_pixel(0, k, after(step.frame, writes, lane(at.pixel, k))); });
      show_chosen(inputs, sums, at, out, counts);
    }
    return counts;
  }

  void copy_frame(const PixelBounds& tile, std::span<PixelSample> out) const {
    for_each_row(pass_.bounds, tile, [&](std::size_t pixel, std::size_t first, std::size_t n) {
      std::copy_n(frame_.begin() + std::ptrdiff_t(pixel), n, out.begin() + std::ptrdiff_t(first));
    });
  }
  // Those kinds of samples of the first input that are not shown as sums.
  void show_chosen(const ReuseInputs<F>& inputs, const ImageSums& sums, const LanePixels<F>& at,
                   std::span<PixelSample> out, RayCounts& counts) const {
    if (!sums.lights) show(inputs.vertices[0], inputs.lights[0], at, out, counts);
    if (reuses_paths() && !sums.paths) show(inputs.vertices[0], inputs.paths[0], at, out);
  }

  void meet_neighbours(int frame, int writes, const LanePixels<F>& at, RandomStream<F>& numbers,
                       ReuseInputs<F>& inputs) {
    for (std::size_t i = 1; i < inputs.vertices.size(); ++i) {
      const Vec2<F> u = numbers.next2();
      inputs.clear(i);
      for_each_lane(at.on, [&](int k) {
        const auto pixel =
            neighbour(settings(), pass_.bounds, vertices(frame), at.x(k), at.y(k), {lane(u.x, k), lane(u.y, k)});
        if (pixel) inputs.put_pixel(i, k, before(frame, writes, *pixel));
      });
    }
  }

  void show(const ReuseVertex<F>& vertex, const LightReservoir<F>& reservoir, const LanePixels<F>& at,
            std::span<PixelSample> out, RayCounts& counts) const {
    const M lit = at.on & (reservoir.weight > F(0.0f));
    if (!any(lit)) return;
    const LightConnection<F> way = connect(shared_.scene.media, shared_.lights.bvh, vertex, reservoir.value, lit);
    const Spectrum<F> radiance = vertex.throughput * way.value * reservoir.weight;
    // Where targets know what is in the way, the pixel sees whatever it holds.
    const M queries = lit & (way.target > F(0.0f));
    const M open =
        settings().visibility_reuse ? queries : is_open<F>(shared_.rays, vertex, way, queries, counts.shadow);
    add_light(radiance, at, open, out);
  }
  void add_light(const Spectrum<F>& radiance, const LanePixels<F>& at, M on, std::span<PixelSample> out) const {
    for_each_lane(on, [&](int k) { out[lane(at.output, k)].radiance += to_rgb(lane(radiance, k)); });
  }

  // Targets of paths know what is in the way.
  void show(const ReuseVertex<F>& vertex, const PathReservoir<F>& reservoir, const LanePixels<F>& at,
            std::span<PixelSample> out) const {
    const Spectrum<F> radiance = vertex.throughput * reservoir.value.contribution * reservoir.weight;
    add_light(radiance, at, at.on & (reservoir.weight > F(0.0f)), out);
  }

  const RestirScene<Rays> shared_;
  const SeriesPass pass_;
  std::shared_ptr<const ReuseMemory> before_;        // of the picture before, if there is one
  std::vector<std::optional<std::size_t>> earlier_;  // pixels of it that showed what the pixels show
  std::vector<ReuseVertex<float>> vertices_[2];      // of this frame and the one before
  static constexpr std::uint32_t no_vertex = 0;      // objects are counted from 1
  std::vector<std::uint32_t> objects_;               // of the vertices of this frame, or no_vertex
  ReservoirPlanes<LightPoint> lights_;
  ReservoirPlanes<PathSample> paths_;  // of no size where paths are not reused
  std::vector<PixelSample> frame_;     // without the reused light
};

}  // namespace montelux
