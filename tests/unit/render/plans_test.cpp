// Plans of work whose rounds depend on the film, and stopping rules.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <thread>

#include "render/render.h"
#include "tile_numbers.h"

namespace montelux {
namespace {

constexpr PixelBounds bounds{0, 0, 80, 40};
constexpr double infinite = std::numeric_limits<double>::infinity();

// Random numbers, ten times as large in the last column of tiles.
class Noise final : public PixelIntegrator {
 public:
  RayCounts trace(const TilePass& pass, std::span<PixelSample> out) const override {
    RandomStream<float> random = test::tile_numbers(pass, 0);
    for (PixelSample& s : out) s.radiance = gray_rgb((pass.tile.x0 < 40 ? 1.0f : 10.0f) * random.next());
    return {out.size(), 0, 0};
  }
};

RenderSettings settings(const PassPlan& plan, int threads) {
  RenderSettings s;
  s.image.bounds = bounds, s.image.width = bounds.width(), s.image.height = bounds.height();
  s.plan = plan, s.threads = threads;
  return s;
}

double variance_of(const Film& film, const FilmTile& tile) {
  double sum = 0;
  for (int y = tile.cells.y0; y < tile.cells.y1; ++y)
    for (int x = tile.cells.x0; x < tile.cells.x1; ++x) sum += film.pixel(x, y).variance_of_mean(0);
  return sum / tile.cells.area();
}

// Two passes of every tile first; then one pass in each round, for the tiles whose variance is above the goal.
class WhereNoisy final : public WorkPlan {
 public:
  explicit WhereNoisy(double goal) : goal_(goal) {}
  WorkRound next_round(const Film& film, const PassPlan& passes, const std::function<bool()>&) const override {
    std::vector<WorkUnit> units;
    std::size_t number = 0;
    for (const auto& [index, tile] : film.tiles()) {
      const int done = int(tile.passes.size());
      for (int pass = done; pass < 2; ++pass) units.push_back({number, pass});
      if (done >= 2 && done < passes.passes && variance_of(film, tile) > goal_) units.push_back({number, done});
      ++number;
    }
    const std::size_t count = units.size();
    return {count, [all = std::move(units)](std::size_t i) { return all[i]; }};
  }
  std::uint64_t expected_units(const Film& film, const PassPlan& passes) const override {
    return std::uint64_t(film.tiles().size()) * std::uint64_t(passes.passes);
  }

 private:
  double goal_;
};

RenderResult render_where_noisy(int threads, BegunFilm* begun = nullptr, int max_passes = 200) {
  RenderSettings s = settings({1, max_passes}, threads);
  s.work = std::make_shared<WhereNoisy>(0.1);
  s.begun = begun;
  RenderObserver silent;
  return render(Noise(), s, silent);
}

void expect_same(const Film& a, const Film& b) {
  for (int y = bounds.y0; y < bounds.y1; ++y)
    for (int x = bounds.x0; x < bounds.x1; ++x) {
      ASSERT_EQ(a.pixel(x, y).passes, b.pixel(x, y).passes) << x << " " << y;
      ASSERT_EQ(a.pixel(x, y).mean[0], b.pixel(x, y).mean[0]) << x << " " << y;
      ASSERT_EQ(a.pixel(x, y).m2[0], b.pixel(x, y).m2[0]) << x << " " << y;
    }
}

TEST(WorkPlan, gives_tiles_as_many_passes_as_their_noise_needs) {
  const RenderResult r = render_where_noisy(1);
  EXPECT_FALSE(r.interrupted);
  for (const auto& [index, tile] : r.film.tiles()) {
    EXPECT_LE(variance_of(r.film, tile), 0.1);
    // The variance of the numbers is 1/12 and 100/12.
    if (tile.cells.x0 < 40)
      EXPECT_LE(tile.passes.size(), 3u);
    else
      EXPECT_NEAR(double(tile.passes.size()), 100 / 12.0 / 0.1, 15);
  }
}

TEST(WorkPlan, gives_the_same_bits_for_any_number_of_threads) {
  const Film one = render_where_noisy(1).film;
  for (int threads : {2, 5}) expect_same(one, render_where_noisy(threads).film);
}

TEST(WorkPlan, continues_a_film_where_it_stopped) {
  RenderResult part = render_where_noisy(2, nullptr, 7);
  BegunFilm begun{std::move(part.film), part.rays, part.seconds};
  expect_same(render_where_noisy(2).film, render_where_noisy(2, &begun).film);
}

TEST(WorkPlan, whose_round_has_no_new_pass_is_an_error) {
  class Repeats final : public WorkPlan {
   public:
    WorkRound next_round(const Film&, const PassPlan&, const std::function<bool()>&) const override {
      return {1, [](std::size_t) { return WorkUnit{0, 0}; }};
    }
    std::uint64_t expected_units(const Film&, const PassPlan&) const override { return 1; }
  };
  RenderSettings s = settings({1, 1}, 2);
  s.work = std::make_shared<Repeats>();
  RenderObserver silent;
  EXPECT_THROW(render(Noise(), s, silent), std::logic_error);
}

// A render that stops at an error.
class StopsAtError final : public StoppingRule {
 public:
  explicit StopsAtError(double mse) : mse_(mse) {}
  bool stops(const RenderState& state) const override { return state.error.whole() && state.error.mse <= mse_; }
  double seconds_left(const RenderState& state) const override {
    return state.error.whole() ? state.seconds * std::max(state.error.mse / mse_ - 1, 0.0) : infinite;
  }

 private:
  double mse_;
};

TEST(StoppingRule, can_depend_on_the_error_of_the_film) {
  RenderObserver silent;
  for (const double goal : {0.5, 0.05}) {
    RenderSettings s = settings({1, endless_passes}, 2);
    s.stop = std::make_shared<StopsAtError>(goal);
    const RenderResult r = render(Noise(), s, silent);
    EXPECT_FALSE(r.interrupted);
    EXPECT_LE(r.film.error().mse, goal);
    EXPECT_LT(r.film.image().passes, endless_passes);
  }
}

// A rule that never stops the render, and counts on another one.
class Never final : public StoppingRule {
 public:
  bool stops(const RenderState&) const override { return false; }
  double seconds_left(const RenderState&) const override { return infinite; }
};

TEST(StoppingRule, of_several_the_first_one_decides) {
  RenderState state;
  state.seconds = 2, state.is_covered = state.is_complete = true;
  const auto never = std::make_shared<Never>();
  const auto after = [](double seconds) { return std::make_shared<TimeLimit>(seconds); };
  EXPECT_TRUE(FirstOf({never, after(3), after(1)}).stops(state));
  EXPECT_FALSE(FirstOf({never, after(3)}).stops(state));
  EXPECT_EQ(FirstOf({after(7), never, after(3)}).seconds_left(state), 1);
  EXPECT_EQ(FirstOf({after(7), never}).time_for_estimate(state), 5);
  EXPECT_EQ(FirstOf({never}).time_for_estimate(state), infinite);
  EXPECT_EQ(FirstOf({never, std::make_shared<TimeBudget>(9, 0)}).time_for_estimate(state), 0);
}

TEST(TimeLimit, leaves_an_image) {
  RenderState state;
  state.seconds = 10;
  EXPECT_FALSE(TimeLimit(5).stops(state));
  state.is_covered = true;
  EXPECT_TRUE(TimeLimit(5).stops(state));
  state.warm_up = 6;
  EXPECT_TRUE(TimeLimit(5, true).stops(state));
  EXPECT_FALSE(TimeLimit(5, false).stops(state));
  EXPECT_EQ(TimeLimit(5, false).seconds_left(state), 1);
}

TEST(TimeBudget, has_room_for_the_next_frame_and_the_ending) {
  RenderState state;
  state.seconds = 10, state.next_frame = 2;
  EXPECT_FALSE(TimeBudget(5, 0).stops(state));  // no image yet
  state.is_covered = state.is_complete = true;
  EXPECT_FALSE(TimeBudget(12.5, 0.25).stops(state));
  EXPECT_TRUE(TimeBudget(12.5, 0.75).stops(state));
}

// Sums over the progress of a render.
class Fractions final : public RenderObserver {
 public:
  void progress(const Progress& p) override {
    EXPECT_GE(p.fraction, last);
    EXPECT_GE(p.remaining, 0);
    last = p.fraction, samples = p.samples, ended = p.finished;
  }
  double last = 0;
  std::uint64_t samples = 0;
  bool ended = false;
};

TEST(Progress, is_complete_at_the_end_of_the_plan_or_of_the_time) {
  Fractions plan, time;
  RenderSettings s = settings({2, 3}, 2);
  render(Noise(), s, plan);
  EXPECT_EQ(plan.last, 1);
  EXPECT_EQ(plan.samples, std::uint64_t(80 * 40 * 6));
  EXPECT_TRUE(plan.ended);
  s.plan.passes = endless_passes, s.stop = std::make_shared<TimeLimit>(0.1);
  render(Noise(), s, time);
  EXPECT_EQ(time.last, 1);
  EXPECT_TRUE(time.ended);
}

// Saved films.
TEST(FilmKeeping, receives_the_film_at_the_end_with_the_time_of_all_renders) {
  RenderSettings s = settings({2, 3}, 2);
  int saved = 0;
  FilmSnapshot last;
  s.keeping.keep = [&](FilmSnapshot snapshot) { ++saved, last = std::move(snapshot); };
  RenderObserver silent;
  RenderResult r = render(Noise(), s, silent);
  EXPECT_EQ(saved, 1);
  EXPECT_EQ(last.tile_side, 32);
  EXPECT_EQ(last.rays.camera, std::uint64_t(80 * 40 * 6));
  std::string tiles;
  for (const auto& [index, tile] : r.film.tiles()) r.film.write_tile(tile.cells, tiles);
  EXPECT_EQ(last.tiles, tiles);
  BegunFilm begun{std::move(r.film), r.rays, 1000};
  s.begun = &begun, s.plan.passes = 5;
  r = render(Noise(), s, silent);
  EXPECT_EQ(saved, 2);
  EXPECT_GT(last.seconds, 1000);
  EXPECT_LT(last.seconds, 1100);
  EXPECT_EQ(last.rays.camera, std::uint64_t(80 * 40 * 10));
}

// While other threads add passes.
TEST(FilmKeeping, counts_the_rays_of_the_passes_that_a_snapshot_has) {
  RenderSettings s = settings({300, 60}, 8);
  int saved = 0, wrong = 0;
  s.keeping = {0, [&](const FilmSnapshot& snapshot) {
                 std::uint64_t of_tiles = 0;
                 for (const std::uint64_t rays : snapshot.rays_of_tiles) of_tiles += rays;
                 ++saved, wrong += snapshot.rays.camera != of_tiles;
               }};
  RenderObserver silent;
  render(Noise(), s, silent);
  EXPECT_GT(saved, 1);
  EXPECT_EQ(wrong, 0) << "of " << saved;
}

TEST(FilmKeeper, saves_now_and_then_and_only_what_is_new) {
  int saved = 0;
  const FilmKeeping keeping{2, [&](FilmSnapshot) { ++saved; }};
  FilmKeeper keeper(keeping);
  EXPECT_FALSE(keeper.is_due(1.5));
  EXPECT_TRUE(keeper.is_due(2));
  const auto snapshot = [] { return FilmSnapshot{}; };
  keeper.keep(2.5, 0, snapshot);  // without a pass
  EXPECT_EQ(saved, 0);
  EXPECT_FALSE(keeper.is_due(4));
  keeper.keep(4.5, 7, snapshot);
  keeper.keep(6.5, 7, snapshot);
  EXPECT_EQ(saved, 1);
  keeper.keep(8.5, 8, snapshot);
  EXPECT_EQ(saved, 2);
  const FilmKeeping nowhere;
  EXPECT_FALSE(FilmKeeper(nowhere).is_due(1000));
}

}  // namespace
}  // namespace montelux
