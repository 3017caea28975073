#include "integrator/metropolis/integrator.h"

#include <algorithm>
#include <cmath>

#include "integrator/compensated_lights.h"
#include "integrator/metropolis/path_function.h"
#include "integrator/metropolis/strategy_function.h"
#include "integrator/splats.h"

namespace montelux {

namespace {

using F = NativeFloats;
using U = Uint<F>;
using M = Mask<F>;

// Chains belong to square cells of the picture, so that their number and their numbers do not depend on the tiles that
// threads work on. A cell's chains make one step for each of its pixels in a frame, wherever in the picture they are.
constexpr int cell_side = 32, chains_per_cell = 16;
constexpr int packs_per_cell = (chains_per_cell + lanes_of<F> - 1) / lanes_of<F>;

// The stages of a frame; the first two do nothing after the first frame.
constexpr int draw_stage = 0, sum_stage = 1, walk_stage = 2, show_stage = 3;

// What the streams of a pass decide.
namespace purpose {
inline constexpr std::uint32_t seeds = 1, steps = 2, strategies = 3;
}

struct Cell {
  int number;
  PixelBounds bounds;
};

// The chains of a cell, and how they have moved.
struct CellChains {
  std::vector<MarkovChains<F>> packs;
  std::uint32_t steps_done = 0;
  MixingFigures figures;
  std::array<RegionShares, std::size_t(packs_per_cell* lanes_of<F>)> shares{};  // of each chain
};

// `Function`: PathFunction or StrategyFunction.
template <class Function>
class MetropolisSeries final : public FrameSeries {
 public:
  // What this refers to must outlive the series.
  MetropolisSeries(const Scene& scene, const Accel& accel, const MetropolisSettings& settings,
                   const typename Function::Settings& paths, const SeriesPass& pass)
      : scene_(scene),
        accel_(accel),
        settings_(settings),
        paths_(paths),
        pass_(pass),
        cells_across_((pass.bounds.width() + cell_side - 1) / cell_side),
        cells_down_((pass.bounds.height() + cell_side - 1) / cell_side),
        random_(U(mix_bits(pass.points.seed ^ 0x243f6a88u)), U(pass.points.pass)),
        plane_(pass.grid.value_or(PixelGrid{pass.bounds}), scene.filter, pass.layers),
        brightness_(std::size_t(pass.bounds.area()) * std::size_t(settings.bootstrap)),
        chains_(std::size_t(cells_across_ * cells_down_)),
        features_(std::size_t(pass.bounds.area())) {
    for (int cell = 0; cell < cells_across_ * cells_down_; ++cell)
      steps_of_frame_ += std::uint64_t(steps_of(cell_at(cell))) * chains_per_cell;
  }

  // The cells; one unit for the sum of what they have found.
  std::optional<std::size_t> units(const SeriesStep& step) const override {
    if (step.stage == show_stage) return std::nullopt;
    if (step.stage == walk_stage) return total_ > 0 ? chains_.size() : 0;
    if (step.frame > 0) return 0;
    return step.stage == sum_stage ? 1 : chains_.size();
  }
  RayCounts run_unit(const SeriesStep& step, std::size_t unit) override {
    RayCounts counts;
    if (step.stage == draw_stage) draw_independent(cell_at(int(unit)), counts);
    if (step.stage == sum_stage) sum_brightness();
    if (step.stage == walk_stage) walk(step, cell_at(int(unit)), counts);
    return counts;
  }
  RayCounts run(const SeriesStep& step, const PixelBounds& tile, std::span<PixelSample> out) override {
    return run_layers(step, tile, out, {});
  }
  RayCounts run_layers(const SeriesStep& step, const PixelBounds& tile, std::span<PixelSample> out,
                       std::span<ExactRgb> sums) override {
    RayCounts counts;
    if (step.frame == 0) look(tile, counts);
    show(tile, out, sums);
    return counts;
  }

  // The sums of the cells in their order: the same for any number of threads.
  std::optional<MixingFigures> mixing() const override {
    MixingFigures all;
    std::vector<RegionShares> shares;
    for (const CellChains& cell : chains_) {
      all += cell.figures;
      if (cell.steps_done > 0) shares.insert(shares.end(), cell.shares.begin(), cell.shares.end());
    }
    if (all.steps == 0) return std::nullopt;
    all.chains = shares.size();
    add_spread(shares, all);
    return all;
  }

 private:
  Cell cell_at(int number) const {
    const PixelBounds& b = pass_.bounds;
    const int x = b.x0 + number % cells_across_ * cell_side, y = b.y0 + number / cells_across_ * cell_side;
    return {number, {x, y, std::min(x + cell_side, b.x1), std::min(y + cell_side, b.y1)}};
  }
  // Of each chain in a frame.
  static std::uint32_t steps_of(const Cell& cell) {
    return std::uint32_t((cell.bounds.area() + chains_per_cell - 1) / chains_per_cell);
  }
  std::size_t pixel_number(int x, int y) const {
    return std::size_t(y - pass_.bounds.y0) * std::size_t(pass_.bounds.width()) + std::size_t(x - pass_.bounds.x0);
  }
  Function make_function() const {
    if constexpr (std::is_same_v<typename Function::Settings, PathSettings>)
      return {scene_, accel_, paths_, pass_};
    else
      return {scene_, accel_, paths_, pass_, plane_};
  }
  SamplePoint<F> new_point(const Function& evaluate) const {
    return {std::vector<float>(evaluate.dimensions() * lanes_of<F>), random_};
  }
  // The sample points of the independent paths are those of a path tracer, well spread over the picture and within
  // pixels: sample i of pixel p has number p * bootstrap + i.
  void draw_bootstrap(SamplePoint<F>& point, const U& sample) const {
    PointSet points = pass_.points;
    points.samples_per_pass = std::uint32_t(settings_.bootstrap);
    U x(0u), y(0u), index(0u);
    Vec2<F> corner{F(0.0f), F(0.0f)};
    const auto width = std::uint32_t(pass_.bounds.width());
    for (int k = 0; k < lanes_of<F>; ++k) {
      const std::uint32_t pixel = lane(sample, k) / points.samples_per_pass, column = pixel % width,
                          row = pixel / width;
      set_lane(index, k, lane(sample, k) % points.samples_per_pass);
      set_lane(x, k, std::uint32_t(pass_.bounds.x0) + column), set_lane(y, k, std::uint32_t(pass_.bounds.y0) + row);
      set_lane(corner.x, k, float(column)), set_lane(corner.y, k, float(row));
    }
    const auto numbers = numbers_of<F>(points, PathSite<F>{x, y, index});
    const auto size = Vec2f{float(width), float(pass_.bounds.height())};
    const auto dimensions = std::uint32_t(point.values.size() / lanes_of<F>);
    for (std::uint32_t d = 0; d < dimensions; d += 2) {
      Vec2<F> u = numbers.get2(U(d));
      if (d == path_dimension::film) u = {(corner.x + u.x) * (1 / size.x), (corner.y + u.y) * (1 / size.y)};
      put_numbers(point, d, u.x);
      if (d + 1 < dimensions) put_numbers(point, d + 1, u.y);
    }
    point.beyond = numbers.own();
  }

  // ---- independent paths

  void draw_independent(const Cell& cell, RayCounts& counts) {
    Function evaluate = make_function();
    SamplePoint<F> point = new_point(evaluate);
    std::vector<std::uint32_t> samples;
    for (int y = cell.bounds.y0; y < cell.bounds.y1; ++y)
      for (int x = cell.bounds.x0; x < cell.bounds.x1; ++x)
        for (int i = 0; i < settings_.bootstrap; ++i)
          samples.push_back(std::uint32_t(pixel_number(x, y) * std::size_t(settings_.bootstrap) + std::size_t(i)));
    for (std::size_t first = 0; first < samples.size(); first += lanes_of<F>) {
      U sample(samples.back());
      const int n = int(std::min(samples.size() - first, std::size_t(lanes_of<F>)));
      for (int k = 0; k < n; ++k) set_lane(sample, k, samples[first + std::size_t(k)]);
      draw_bootstrap(point, sample);
      const Contribution<F> c = evaluate.independent(point, counts);
      for (int k = 0; k < n; ++k) brightness_[samples[first + std::size_t(k)]] = lane(c.brightness, k);
      deposit_broken(c, M(lane_index<F>() < U(std::uint32_t(n))));
    }
  }

  // The features of the pixels, of one camera ray each.
  void look(const PixelBounds& tile, RayCounts& counts) {
    std::vector<PixelSample> out(std::size_t(tile.area()));
    const TilePass request{tile, pass_.points, pass_.shutter, 0u, {}, pass_.grid};
    counts += write_first_vertices<F>(scene_, accel_, request, out);
    std::size_t i = 0;
    for (int y = tile.y0; y < tile.y1; ++y)
      for (int x = tile.x0; x < tile.x1; ++x) features_[pixel_number(x, y)] = out[i++].features;
  }

  // ---- chains

  void sum_brightness() {
    cumulative_.reserve(brightness_.size());
    for (float b : brightness_) cumulative_.push_back(total_ += double(b));
    brightness_.clear(), brightness_.shrink_to_fit();
  }

  // The bootstrap path at which chain k of a cell starts: by systematic resampling, in proportion to brightness. The
  // chains of each cell are spread over all of the brightness: cells at the edges have fewer pixels and shorter chains,
  // and would be biased towards the paths at which they start.
  std::uint32_t seed_of(const Cell& cell, std::uint32_t k) const {
    const double random = double(lane(random_.fork(U(purpose::seeds)).at(U(0u)), 0));
    const double offset = random + double(cell.number) / double(chains_.size());
    const double place = (k + offset - std::floor(offset)) / double(chains_per_cell) * total_;
    const auto at = std::upper_bound(cumulative_.begin(), cumulative_.end(), place);
    return std::uint32_t(std::min(at, cumulative_.end() - 1) - cumulative_.begin());
  }

  float brightness_at(std::uint32_t sample) const {
    return float(cumulative_[sample] - (sample == 0 ? 0.0 : cumulative_[sample - 1]));
  }

  static U chain_numbers(const Cell& cell, int pack) {
    return lane_index<F>() + U(std::uint32_t(cell.number * chains_per_cell + pack * lanes_of<F>));
  }

  void start_chains(const Cell& cell, Function& evaluate, RayCounts& counts) {
    for (int pack = 0; pack < packs_per_cell; ++pack) {
      const U chains = chain_numbers(cell, pack);
      U seeds(0u);
      for (int k = 0; k < lanes_of<F>; ++k) set_lane(seeds, k, seed_of(cell, std::uint32_t(pack * lanes_of<F> + k)));
      MarkovChains<F> started{new_point(evaluate), {}};
      draw_bootstrap(started.point, seeds);
      F brightness(0.0f);
      for (int k = 0; k < lanes_of<F>; ++k) set_lane(brightness, k, brightness_at(lane(seeds, k)));
      const F u = random_.fork(U(purpose::strategies)).fork(chains).at(U(0u));
      started.value = evaluate.start(started.point, brightness, u, counts);
      chains_[std::size_t(cell.number)].packs.push_back(std::move(started));
    }
  }

  void walk(const SeriesStep& step, const Cell& cell, RayCounts& counts) {
    Function evaluate = make_function();
    if (step.frame == 0) start_chains(cell, evaluate, counts);
    CellChains& own = chains_[std::size_t(cell.number)];
    SamplePoint<F> proposal = new_point(evaluate);
    const float largest = settings_.largest_move;
    const MutationSizes sizes{settings_.large_step, largest / 16, largest};
    // A step stands for the mean brightness over all paths, and a frame has about one for each pixel.
    const double mean = total_ / double(cumulative_.size());
    const auto scale = float(mean * double(pass_.bounds.area()) / double(steps_of_frame_));
    const std::uint32_t steps = steps_of(cell);
    for (std::uint32_t i = 0; i < steps; ++i)
      for (int pack = 0; pack < packs_per_cell; ++pack) {
        const RandomStream<F> numbers =
            random_.fork(U(purpose::steps)).fork(chain_numbers(cell, pack)).fork(U(own.steps_done + i));
        const StepsMade<F> made = step_chains(own.packs[std::size_t(pack)], proposal, sizes, numbers, evaluate, counts,
                                              [&](const Contribution<F>& c, const F& share) {
                                                deposit(c, share * scale);
                                                note_place(own, pack, c, share);
                                              });
        note_steps(own.figures, made);
      }
    own.steps_done += steps;
  }

  // The region of the picture where the share of a step is.
  void note_place(CellChains& own, int pack, const Contribution<F>& c, const F& share) const {
    constexpr std::uint32_t across = 4, down = mixing_regions / across;
    const PixelBounds& b = pass_.bounds;
    for (int k = 0; k < lanes_of<F>; ++k) {
      const std::uint32_t x = (lane(c.x, k) - std::uint32_t(b.x0)) * across / std::uint32_t(b.width());
      const std::uint32_t y = (lane(c.y, k) - std::uint32_t(b.y0)) * down / std::uint32_t(b.height());
      own.shares[std::size_t(pack * lanes_of<F> + k)][y * across + x] += double(lane(share, k));
    }
  }
  static void note_steps(MixingFigures& figures, const StepsMade<F>& made) {
    figures.steps += lanes_of<F>;
    for (int k = 0; k < lanes_of<F>; ++k) {
      const bool is_large = lane(made.large, k);
      figures.large += is_large;
      (is_large ? figures.large_accepted : figures.small_accepted) += double(lane(made.accepted, k));
    }
  }

  // Light in proportion to its share in the brightness.
  void deposit(const Contribution<F>& c, const F& amount) {
    const F factor = amount / max(c.brightness, F(1e-37f));
    for_each_lane(M((c.brightness > F(0.0f)) & (amount > F(0.0f))), [&](int k) {
      const float scale = lane(factor, k);
      if (c.parts.empty()) return put(c, k, c.values[std::size_t(k)], scale);
      for (const LightPart& part : c.parts[std::size_t(k)]) put(c, k, to_rgb(part.contribution), scale, part.from);
    });
    deposit_broken(c, M(true));
  }
  // `origin`: one, in a pass with layers.
  template <class... Origin>
  void put(const Contribution<F>& c, int k, Rgb contribution, float scale, const Origin&... origin) {
    for (float& channel : contribution.c) channel *= scale;
    if (lane(c.splatted, k))
      scene_.camera.for_each_place(lane(c.raster, k), [&](Vec2f place) { plane_.add(place, contribution, origin...); });
    else
      plane_.add_to_pixel(int(lane(c.x, k)), int(lane(c.y, k)), contribution, origin...);
  }
  // Shows in the count of samples that are not finite.
  void deposit_broken(const Contribution<F>& c, M on) {
    for_each_lane(M(on & c.broken), [&](int k) {
      plane_.add_to_pixel(int(lane(c.x, k)), int(lane(c.y, k)), gray_rgb(std::numeric_limits<float>::quiet_NaN()));
    });
  }

  // ---- the picture

  void show(const PixelBounds& tile, std::span<PixelSample> out, std::span<ExactRgb> sums) {
    std::size_t i = 0;
    for (int y = tile.y0; y < tile.y1; ++y)
      for (int x = tile.x0; x < tile.x1; ++x, ++i)
        out[i].radiance = gray_rgb(0), out[i].features = features_[pixel_number(x, y)];
    plane_.take_tile(tile, out, sums);
  }

  const Scene& scene_;
  const Accel& accel_;
  const MetropolisSettings& settings_;
  const typename Function::Settings& paths_;
  const SeriesPass pass_;
  const int cells_across_, cells_down_;
  const RandomStream<F> random_;  // of the pass
  SplatPlane plane_;
  std::vector<float> brightness_;  // of the independent paths
  std::vector<double> cumulative_;
  double total_ = 0;  // of the brightness
  std::uint64_t steps_of_frame_ = 0;
  std::vector<CellChains> chains_;
  std::vector<Features> features_;
};

// How bright independent paths are, by the number of events and by strategy: the squared mean of the roots, which few
// bright paths do not determine.
template <class Function>
StrategyChoice pilot(const Scene& scene, const Accel& accel, const StrategyPaths& paths, const PixelBounds& picture) {
  constexpr int packs = 1024 / lanes_of<F>;  // for each number of events
  const SeriesPass pass{picture, {}};
  const SplatPlane plane(picture, scene.filter);
  Function evaluate(scene, accel, paths, pass, plane);
  SamplePoint<F> point{std::vector<float>(evaluate.dimensions() * lanes_of<F>), {}};
  std::vector<std::vector<double>> brightness;
  RayCounts counts;
  for (int events = 0; events < StrategyChoice::piloted_events; ++events) {
    if (paths.paths.max_depth && events > *paths.paths.max_depth) break;
    const int strategies = StrategyChoice::count(events);
    std::vector<double> sums(std::size_t(strategies), 0.0);
    for (int i = 0; i < packs; ++i) {
      ChosenStrategy<F> chosen{U(0u), U(0u), F(1.0f)};
      const U number = lane_index<F>() + U(std::uint32_t((events * packs + i) * lanes_of<F>));
      for (int k = 0; k < lanes_of<F>; ++k) {
        const std::uint32_t s = std::uint32_t(i * lanes_of<F> + k) % std::uint32_t(strategies);
        set_lane(chosen.light_vertices, k, s);
        set_lane(chosen.eye_vertices, k, std::uint32_t(events) + 2 - s);
      }
      point.beyond = RandomStream<F>(U(0x13198a2eu), number);
      for (std::size_t d = 0; d < evaluate.dimensions(); ++d)
        put_numbers(point, d, point.beyond.at(U(std::uint32_t(d))));
      const Contribution<F> c = evaluate.evaluate(point, chosen, counts);
      for (int k = 0; k < lanes_of<F>; ++k)
        sums[lane(chosen.light_vertices, k)] += std::sqrt(double(lane(c.brightness, k)));
    }
    for (double& sum : sums) sum = sum * sum;
    brightness.push_back(std::move(sums));
  }
  return {brightness, paths.paths.max_depth};
}

}  // namespace

MetropolisIntegrator::MetropolisIntegrator(const Scene& scene, const Accel& accel, const MetropolisSettings& settings)
    : scene_(scene), accel_(accel), settings_(settings) {
  path_.mis = PathMis::power;
  path_.max_depth = settings.max_depth, path_.roulette_depth = settings.depth_before_roulette();
  if (settings.strategies == MetropolisStrategies::path) return;
  if (scene.lights.count() > 0) by_power_ = scene.lights.by_power();
  light_media_ = light_media(scene, accel);
  compensated_ = compensated_lights(scene.lights, scene, accel);
  strategies_.compensated = compensated_ ? &*compensated_ : nullptr;
  strategies_.paths.max_depth = settings.max_depth, strategies_.paths.roulette_depth = settings.depth_before_roulette();
  strategies_.by_power = by_power_ ? &*by_power_ : nullptr;
  strategies_.light_media = light_media_ ? &*light_media_ : nullptr;
  strategies_.one_sided = has_one_sided_surfaces(scene);
  const PixelBounds picture{0, 0, std::max(settings.width, 1), std::max(settings.height, 1)};
  strategies_.choice = scene.has_participating_media()
                           ? pilot<StrategyFunction<F, Accel, true>>(scene, accel, strategies_, picture)
                           : pilot<StrategyFunction<F, Accel, false>>(scene, accel, strategies_, picture);
}

std::unique_ptr<FrameSeries> MetropolisIntegrator::begin(const SeriesPass& pass) const {
  const auto make = [&]<class Function>(const typename Function::Settings& paths) -> std::unique_ptr<FrameSeries> {
    return std::make_unique<MetropolisSeries<Function>>(scene_, accel_, settings_, paths, pass);
  };
  if (settings_.strategies == MetropolisStrategies::path)
    return make.template operator()<PathFunction<F, Accel>>(path_);
  if (scene_.has_participating_media()) return make.template operator()<StrategyFunction<F, Accel, true>>(strategies_);
  return make.template operator()<StrategyFunction<F, Accel, false>>(strategies_);
}

}  // namespace montelux
