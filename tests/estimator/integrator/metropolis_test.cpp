// Metropolis light transport: chains on a function whose integrals have a closed form, and pictures against path.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "integrator/metropolis/markov_chains.h"
#include "integrator/metropolis/strategy_function.h"
#include "pass_means.h"
#include "render_scenes.h"
#include "statistics.h"
#include "transport/numbers.h"

namespace montelux::test {
namespace {

using F = NativeFloats;
using U = Uint<F>;

// ---- chains on a known function

// Four pixels by the first number. Red 12 u^11 of the second number is bright in few places, green 2 u over the third,
// blue is dark but in a twentieth of a number of a stream, which the fourth chooses: each integrates to 1 over a pixel.
struct KnownFunction {
  void propose(SamplePoint<F>& to, const SamplePoint<F>& from, const StepOfNumbers<F>& step) const {
    for (std::size_t d = 0; d < 4; ++d) put_numbers(to, d, step.moved(from, d));
  }
  Contribution<F> operator()(const SamplePoint<F>& point, RayCounts&) const {
    Contribution<F> c;
    c.x = U(0u), c.y = U(0u);
    const RecordedNumbers<F> numbers(point.values, point.beyond);
    const F of_stream = numbers.stream(U(3u)).fork(U(2u)).at(U(7u));
    for (int k = 0; k < lanes_of<F>; ++k) {
      const auto u = [&](std::size_t d) { return point.values[d * lanes_of<F> + std::size_t(k)]; };
      set_lane(c.x, k, std::min(std::uint32_t(4 * u(0)), 3u));
      const Rgb light{{12 * std::pow(u(1), 11.0f), 2 * u(2), lane(of_stream, k) < 0.05f ? 20.0f : 0.0f}};
      c.values[std::size_t(k)] = light;
      set_lane(c.brightness, k, (light.c[0] + light.c[1] + light.c[2]) / 3);
    }
    return c;
  }
};

enum class Fault { none, start_anywhere, proposals_alone, one_sided_moves };

// The four pixels by one pass: bootstrap, seeds in proportion to brightness, and steps of one pack of chains.
std::array<std::array<double, 3>, 4> picture_of_pass(std::uint32_t pass, Fault fault) {
  constexpr int dimensions = 4, bootstrap = 24 * lanes_of<F>, steps = 12;
  const RandomStream<F> random(U(99u), U(pass));
  KnownFunction evaluate;
  RayCounts counts;
  SamplePoint<F> point{std::vector<float>(dimensions * lanes_of<F>), random};
  std::vector<SamplePoint<F>> points;
  std::vector<double> cumulative;
  double total = 0;
  for (int i = 0; i < bootstrap / lanes_of<F>; ++i) {
    const RandomStream<F> numbers = random.fork(lane_index<F>() + U(std::uint32_t(i * lanes_of<F>)));
    for (std::size_t d = 0; d < dimensions; ++d) put_numbers<F>(point, d, numbers.at(U(std::uint32_t(d))));
    points.push_back(point);
    const F brightness = evaluate(point, counts).brightness;
    for (int k = 0; k < lanes_of<F>; ++k) cumulative.push_back(total += double(lane(brightness, k)));
  }
  MarkovChains<F> chains{point, {}};
  for (int k = 0; k < lanes_of<F>; ++k) {
    const double u = (k + double(lane(random.fork(U(7777u)).at(U(0u)), 0))) / lanes_of<F>;
    const auto at =
        fault == Fault::start_anywhere
            ? std::size_t(u * bootstrap)
            : std::size_t(std::upper_bound(cumulative.begin(), cumulative.end(), u * total) - cumulative.begin());
    for (std::size_t d = 0; d < dimensions; ++d)
      chains.point.values[d * lanes_of<F> + std::size_t(k)] =
          points[at / lanes_of<F>].values[d * lanes_of<F> + at % lanes_of<F>];
  }
  chains.value = evaluate(chains.point, counts);
  std::array<std::array<double, 3>, 4> picture{};
  const double scale = 4 * total / bootstrap / (steps * lanes_of<F>);
  const auto deposit = [&](const Contribution<F>& c, const F& share) {
    for (int k = 0; k < lanes_of<F>; ++k)
      for (std::size_t channel = 0; channel < 3; ++channel)
        if (lane(c.brightness, k) > 0)
          picture[lane(c.x, k)][channel] += scale * double(lane(share, k)) *
                                            double(c.values[std::size_t(k)].c[channel]) / double(lane(c.brightness, k));
  };
  for (std::uint32_t i = 0; i < steps; ++i) {
    const MutationSizes sizes{fault == Fault::one_sided_moves ? 0.0f : 0.3f, 1.0f / 1024, 1.0f / 64};
    if (fault == Fault::one_sided_moves)  // toward larger numbers between the steps
      for (std::size_t d = 1; d < dimensions; ++d)
        put_numbers<F>(chains.point, d, min(numbers_at(chains.point, d) + 0.02f, F(0.999f)));
    if (fault == Fault::one_sided_moves) chains.value = evaluate(chains.point, counts);
    int ends = 0;
    step_chains(chains, point, sizes, random.fork(U(5555u)).fork(lane_index<F>()).fork(U(i)), evaluate, counts,
                [&](const Contribution<F>& c, const F& share) {
                  if (fault != Fault::proposals_alone || ends++ == 0) deposit(c, share);
                });
  }
  return picture;
}

// The largest number of standard errors between a mean over passes and the closed form.
double largest_deviation(Fault fault) {
  constexpr std::uint32_t passes = 4000;
  std::array<std::array<std::vector<double>, 3>, 4> values;
  for (std::uint32_t pass = 0; pass < passes; ++pass) {
    const auto picture = picture_of_pass(pass, fault);
    for (std::size_t pixel = 0; pixel < 4; ++pixel)
      for (std::size_t c = 0; c < 3; ++c) values[pixel][c].push_back(picture[pixel][c]);
  }
  double largest = 0;
  for (const auto& pixel : values)
    for (const auto& channel : pixel) {
      const auto s = summarize(channel);
      largest = std::max(largest, std::abs(s.mean - 1) / std::sqrt(s.variance / passes));
    }
  return largest;
}

TEST(MarkovChains, have_the_integrals_of_a_known_function) {
  // Twelve tests at a family-wise level of 0.1 %.
  EXPECT_LT(largest_deviation(Fault::none), 3.94);
}
TEST(MarkovChains, show_planted_faults) {
  EXPECT_GT(largest_deviation(Fault::start_anywhere), 8);
  EXPECT_GT(largest_deviation(Fault::proposals_alone), 8);
  EXPECT_GT(largest_deviation(Fault::one_sided_moves), 8);
}

TEST(MovedNumbers, are_symmetric_and_wrap_around) {
  // The mean of the signed distance around the circle is zero, and its absolute value is within the sizes.
  const RandomStream<F> random(U(5u), lane_index<F>());
  double sum = 0, squares = 0;
  constexpr int n = 4000;
  for (std::uint32_t i = 0; i < n; ++i) {
    const F x = random.at(U(2 * i)), u = random.at(U(2 * i + 1));
    const F to = moved<F>(x, u, 1.0f / 1024, 1.0f / 64);
    for (int k = 0; k < lanes_of<F>; ++k) {
      double way = double(lane(to, k)) - double(lane(x, k));
      way -= std::round(way);
      EXPECT_GE(lane(to, k), 0.0f);
      EXPECT_LT(lane(to, k), 1.0f);
      EXPECT_GT(std::abs(way), 0.999 / 1024);
      EXPECT_LT(std::abs(way), 1.001 / 64);
      sum += way, squares += way * way;
    }
  }
  const double mean = sum / (n * lanes_of<F>), error = std::sqrt(squares) / (n * lanes_of<F>);
  EXPECT_LT(std::abs(mean), 4 * error);
}

// ---- pictures

// A room with coloured walls, a lamp, and a ball of glass that focuses its light.
const std::string room = R"(
LookAt 0 0 3.4  0 -0.2 0  0 1 0
Camera "perspective" "float fov" 50
Film "rgb" "integer xresolution" 24 "integer yresolution" 24
PixelFilter "gaussian"
WorldBegin
AttributeBegin
AreaLightSource "diffuse" "rgb L" [ 9 8 6 ]
Shape "bilinearmesh" "point3 P" [ -0.4 0.98 -0.4  0.4 0.98 -0.4  -0.4 0.98 0.4  0.4 0.98 0.4 ]
AttributeEnd
Material "diffuse" "rgb reflectance" [ 0.7 0.7 0.7 ]
Shape "bilinearmesh" "point3 P" [ -1 -1 -1  -1 -1 1  1 -1 -1  1 -1 1 ]
Shape "bilinearmesh" "point3 P" [ -1 1 -1  1 1 -1  -1 1 1  1 1 1 ]
Shape "bilinearmesh" "point3 P" [ -1 -1 -1  1 -1 -1  -1 1 -1  1 1 -1 ]
Material "diffuse" "rgb reflectance" [ 0.7 0.1 0.1 ]
Shape "bilinearmesh" "point3 P" [ -1 -1 -1  -1 1 -1  -1 -1 1  -1 1 1 ]
Material "diffuse" "rgb reflectance" [ 0.1 0.6 0.2 ]
Shape "bilinearmesh" "point3 P" [ 1 -1 -1  1 -1 1  1 1 -1  1 1 1 ]
Material "dielectric" "float eta" 1.5
Translate 0.3 -0.6 0.2
Shape "sphere" "float radius" 0.35
)";

// Welch tests of the pixels and of the colours of the picture, which also reject chains that are brighter by a factor.
void expect_agreement_with_path(const std::string& text, int passes, double fault) {
  const TestScene scene(text);
  const auto measured = [&](const std::string& way, int per_pass, int count, std::uint32_t seed) {
    return measure_passes(scene, scene.integrator(way), per_pass, count, seed);
  };
  const PassMeans path = measured("path", 64, 60, 1);
  for (const char* way : {"metropolis", "metropolis:strategies=bdpt"}) {
    PassMeans chains = measured(way, 32, passes, 2);
    EXPECT_EQ(path.non_finite + chains.non_finite, 0u);
    const auto smallest_p = [&] {
      double smallest = 1;
      const auto test = [&](const std::vector<double>& a, const std::vector<double>& b) {
        smallest = std::min(smallest, welch_test(summarize(a), summarize(b)).p_value);
      };
      for (std::size_t i = 0; i < path.values.size(); ++i) test(path.values[i], chains.values[i]);
      for (std::size_t i = 0; i < path.colours.size(); ++i) test(path.colours[i], chains.colours[i]);
      return smallest;
    };
    const double level = sidak_level(family_level, double(path.values.size() + path.colours.size()));
    EXPECT_GE(smallest_p(), level) << way;
    for (auto& values : chains.values)
      for (double& value : values) value *= fault;
    for (auto& values : chains.colours)
      for (double& value : values) value *= fault;
    EXPECT_LT(smallest_p(), level) << way;
  }
}

TEST(Metropolis, agrees_with_path_in_a_room_and_would_show_a_fault) { expect_agreement_with_path(room, 400, 1.03); }

// The same room with a floor, a wall and a ball whose coats are evaluated by random walks.
std::string coated_room() {
  std::string text = room;
  const auto put = [&](std::string_view from, std::string_view to) { text.replace(text.find(from), from.size(), to); };
  put("\"diffuse\" \"rgb reflectance\" [ 0.7 0.7 0.7 ]",
      "\"coateddiffuse\" \"rgb reflectance\" [ 0.7 0.6 0.3 ] \"float roughness\" 0.2");
  put("\"dielectric\" \"float eta\" 1.5",
      "\"coatedconductor\" \"rgb reflectance\" [ 0.9 0.5 0.2 ] \"float interface.roughness\" 0.1");
  return text;
}
TEST(Metropolis, agrees_with_path_among_coats_and_would_show_a_fault) {
  expect_agreement_with_path(coated_room(), 250, 1.05);
}

TEST(Metropolis, is_the_same_bits_for_any_number_of_threads) {
  const TestScene scene(room);
  for (const char* way : {"metropolis", "metropolis:strategies=bdpt"}) {
    const auto film = [&](int threads) {
      const ChosenIntegrator chosen = scene.integrator(way);
      RenderSettings settings = scene.settings(PointSetKind::blue_noise, {8, 2}, 5);
      settings.threads = threads;
      RenderObserver silent;
      return render(chosen.any(), settings, silent).film;
    };
    const Film one = film(1), three = film(3);
    for (int y = 0; y < 24; ++y)
      for (int x = 0; x < 24; ++x)
        for (int c = 0; c < 3; ++c) EXPECT_EQ(one.pixel(x, y).mean[c], three.pixel(x, y).mean[c]) << x << ", " << y;
  }
}

// ---- strategies of pairs of subpaths

// Of a pilot over three numbers of events, or over sixteen, beyond which it continues.
StrategyChoice short_choice() { return {{{2}, {1, 0, 3}, {0, 5, 0, 1}}, 2}; }
StrategyChoice endless_choice() {
  std::vector<std::vector<double>> brightness;
  for (int k = 0; k < StrategyChoice::piloted_events; ++k)
    brightness.emplace_back(std::size_t(StrategyChoice::count(k)), std::pow(0.7, k) / StrategyChoice::count(k));
  return {brightness, {}};
}

TEST(StrategyChoice, chooses_by_the_probabilities_that_it_states) {
  for (const StrategyChoice& choice : {short_choice(), endless_choice()}) {
    // Each number of events takes an interval of one number, each strategy one of the other: so frequencies over even
    // numbers are the probabilities, except for the cells at the ends of intervals.
    constexpr int n = 4096;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::pair<double, float>> found;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < 512; j += lanes_of<F>) {
        const auto c =
            choice.choose<F>(F((float(i) + 0.5f) / n), (to_float(lane_index<F>()) + float(j) + 0.5f) / 512.0f);
        for (int k = 0; k < lanes_of<F>; ++k) {
          auto& [frequency, p] = found[{lane(c.light_vertices, k), lane(c.eye_vertices, k)}];
          frequency += 1.0 / (n * 512), p = lane(c.probability, k);
        }
      }
    double sum = 0;
    for (const auto& [strategy, value] : found) {
      const auto& [frequency, p] = value;
      EXPECT_NEAR(frequency, double(p), 1.0 / n + 1.0 / 512 * p * StrategyChoice::count(14))
          << strategy.first << ", " << strategy.second;
      sum += double(p);
    }
    EXPECT_NEAR(sum, 1, 2e-3);
  }
}

TEST(StrategyChoice, finds_the_numbers_of_a_strategy) {
  const RandomStream<F> random(U(3u), lane_index<F>());
  for (const StrategyChoice& choice : {short_choice(), endless_choice()}) {
    const int longest = choice.longest(F(1.0f - 0x1p-24f)) == 2 ? 2 : 24;
    for (int events = 0; events <= longest; ++events)
      for (int s = 0; s < StrategyChoice::count(events); ++s) {
        const U light{std::uint32_t(s)}, eye{std::uint32_t(events + 2 - s)};
        const std::uint32_t at = std::uint32_t(2 * (100 * events + s));
        const auto [u, v] = choice.numbers_for<F>(light, eye, random.at(U(at)), random.at(U(at + 1)));
        const auto chosen = choice.choose<F>(u, v);
        EXPECT_TRUE(all(chosen.light_vertices == light)) << events << ", " << s;
        EXPECT_TRUE(all(chosen.eye_vertices == eye)) << events << ", " << s;
      }
  }
}

// The function of the room's chains, as the integrator has it.
struct RoomStrategies {
  explicit RoomStrategies(const TestScene& s)
      : by_power(s.scene().lights.by_power()),
        paths{{}, &by_power, nullptr, nullptr, false, endless_choice()},
        pass{{0, 0, 24, 24}, {}},
        plane(pass.bounds, s.scene().filter),
        evaluate(s.scene(), s.accel(), paths, pass, plane),
        point{std::vector<float>(evaluate.dimensions() * lanes_of<F>), {}} {}
  void draw(std::uint32_t number) {
    point.beyond = RandomStream<F>(U(17u), lane_index<F>() + U(number * lanes_of<F>));
    for (std::size_t d = 0; d < evaluate.dimensions(); ++d) put_numbers(point, d, point.beyond.at(U(std::uint32_t(d))));
  }

  AliasTable by_power;
  StrategyPaths paths;
  SeriesPass pass;
  SplatPlane plane;
  StrategyFunction<F, Accel, false> evaluate;
  SamplePoint<F> point;
  RayCounts counts;
};

// What all strategies find with a pair of subpaths is what bdpt does; one that is chosen and weighted by its
// probability has the same mean.
TEST(Strategies, have_together_the_light_of_the_pair) {
  const TestScene scene(room);
  RoomStrategies f(scene);
  int found = 0;
  for (std::uint32_t i = 0; i < 200; ++i) {
    f.draw(i);
    const F pair = f.evaluate.independent(f.point, f.counts).brightness;
    F sum(0.0f), without_lens(0.0f);
    for (int events = 0; events < 40; ++events)
      for (int s = 0; s < StrategyChoice::count(events); ++s) {
        const ChosenStrategy<F> chosen{U(std::uint32_t(s)), U(std::uint32_t(events + 2 - s)), F(1.0f)};
        const F b = f.evaluate.evaluate(f.point, chosen, f.counts).brightness;
        sum += b;
        if (events + 2 - s > 1) without_lens += b;
      }
    for (int k = 0; k < lanes_of<F>; ++k) {
      EXPECT_NEAR(lane(sum, k), lane(pair, k), 1e-4f * lane(pair, k)) << i << ", " << k;
      found += lane(without_lens, k) < 0.99f * lane(pair, k);
    }
  }
  EXPECT_GT(found, 100);  // the strategy that meets the lens is missed
}

TEST(Strategies, that_are_chosen_have_the_mean_of_all_and_a_wrong_probability_is_found) {
  const TestScene scene(room);
  RoomStrategies f(scene);
  std::vector<double> pairs, chosen, faulty;
  for (std::uint32_t i = 0; i < 30000; ++i) {
    f.draw(i);
    const F pair = f.evaluate.independent(f.point, f.counts).brightness;
    f.draw(100000 + i);
    const Contribution<F> one = f.evaluate(f.point, f.counts);
    double all = 0, some = 0;
    for (int k = 0; k < lanes_of<F>; ++k) all += double(lane(pair, k)), some += double(lane(one.brightness, k));
    pairs.push_back(all), chosen.push_back(some);
    // The strategy that samples a light counts 1.3 times.
    const auto strategy = f.paths.choice->choose<F>(numbers_at(f.point, f.evaluate.dimensions() - 1),
                                                    numbers_at(f.point, f.evaluate.dimensions() - 2));
    for (int k = 0; k < lanes_of<F>; ++k)
      if (lane(strategy.light_vertices, k) == 1) some += 0.3 * double(lane(one.brightness, k));
    faulty.push_back(some);
  }
  EXPECT_GE(welch_test(summarize(pairs), summarize(chosen)).p_value, family_level);
  EXPECT_LT(welch_test(summarize(pairs), summarize(faulty)).p_value, family_level);
}

// A start takes each strategy in proportion to what it finds.
TEST(Strategies, start_in_proportion_to_brightness) {
  const TestScene scene(room);
  RoomStrategies f(scene);
  constexpr int n = 256;
  int strategies = 0, uneven = 0;
  for (std::uint32_t i = 0; i < 4; ++i) {
    f.draw(i);
    const SamplePoint<F> drawn = f.point;
    const F pair = f.evaluate.independent(f.point, f.counts).brightness;
    std::array<std::map<std::uint32_t, int>, lanes_of<F>> taken;
    for (int j = 0; j < n; ++j) {
      f.point = drawn;
      const Contribution<F> start = f.evaluate.start(f.point, pair, F((float(j) + 0.5f) / n), f.counts);
      const auto chosen = f.paths.choice->choose<F>(numbers_at(f.point, f.evaluate.dimensions() - 1),
                                                    numbers_at(f.point, f.evaluate.dimensions() - 2));
      for (int k = 0; k < lanes_of<F>; ++k) {
        EXPECT_EQ(lane(start.brightness, k) > 0, lane(pair, k) > 0);
        ++taken[std::size_t(k)][lane(chosen.light_vertices, k) * 1000 + lane(chosen.eye_vertices, k)];
      }
    }
    for (int k = 0; k < lanes_of<F>; ++k)
      for (const auto& [strategy, count] : taken[std::size_t(k)]) {
        if (!(lane(pair, k) > 0)) continue;
        const ChosenStrategy<F> chosen{U(strategy / 1000), U(strategy % 1000), F(1.0f)};
        const float found = lane(f.evaluate.evaluate(drawn, chosen, f.counts).brightness, k);
        EXPECT_NEAR(count, n * double(found) / double(lane(pair, k)), 1.1) << strategy;
        ++strategies;
        uneven += std::abs(count - double(n) / double(taken[std::size_t(k)].size())) > 1.1;
      }
  }
  EXPECT_GT(strategies, 100);
  EXPECT_GT(uneven, strategies / 2) << "an even choice would be found";
}

// ---- how the chains move

// A camera that sees two lamps, one in each half of the picture, and nothing else. Without roulette and reflections a
// path's brightness is that of its lamp.
std::string two_lamps(double left, double right) {
  const auto lamp = [](double brightness, const char* corners) {
    return "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [ " + std::to_string(brightness * 2) + " " +
           std::to_string(brightness) +
           " 0 ] \"bool twosided\" true Material \"diffuse\" \"rgb reflectance\" [ 0 0 0 ] "
           "Shape \"bilinearmesh\" \"point3 P\" [ " +
           corners + " ] AttributeEnd\n";
  };
  return "Camera \"orthographic\" Film \"rgb\" \"integer xresolution\" 64 \"integer yresolution\" 64\n"
         "PixelFilter \"box\" WorldBegin\n" +
         lamp(left, "0 -1 1  0 1 1  -1 -1 1  -1 1 1") + lamp(right, "1 -1 1  1 1 1  0 -1 1  0 1 1");
}

// Chains of the cells at the edges are shorter than others. They must not start at other paths: chains that hardly mix
// would show each part of the picture too bright or too dark.
TEST(Metropolis, shows_each_part_of_a_picture_of_unequal_cells_as_bright_as_it_is) {
  const TestScene scene(two_lamps(2, 0.5), ".", std::pair(48, 48));
  for (const char* way : {"metropolis:large-step=0.05", "metropolis:strategies=bdpt,large-step=0.05"}) {
    const PassMeans m = measure_passes(scene, scene.integrator(way), 2, 400, 7, {24, 8});
    const double level = sidak_level(family_level, 12);
    ASSERT_EQ(m.values.size(), 13u) << "the image and its blocks, two in each row";
    for (std::size_t block = 1; block <= 12; ++block) {
      const double truth = block % 2 == 1 ? 2 : 0.5;
      EXPECT_GE(t_test(m.values[block], truth).p_value, level) << way << ", block " << block;
      EXPECT_LT(t_test(m.values[block], 1.1 * truth).p_value, level) << way << ", block " << block;
    }
  }
}

MixingOfPasses mixing_of(const TestScene& scene, const std::string& way, PassPlan plan, int threads = 0) {
  const ChosenIntegrator chosen = scene.integrator(way);
  RenderSettings settings = scene.settings(PointSetKind::blue_noise, plan, 5);
  settings.threads = threads;
  RenderObserver silent;
  return render(chosen.any(), settings, silent).mixing;
}

TEST(Mixing, accepts_what_the_brightness_of_two_lamps_says) {
  // Independent proposals meet either lamp equally often. Chains are at the brighter one 4 times in 5, and leave it for
  // the other with probability 1/4: they accept 4/5 (1/2 + 1/2 1/4) + 1/5 = 7/10.
  const TestScene scene(two_lamps(2, 0.5));
  std::vector<double> accepted, of_small;
  std::uint64_t large = 0, steps = 0;
  for (const auto& [pass, figures] : mixing_of(scene, "metropolis:large-step=0.5", {16, 20})) {
    EXPECT_EQ(figures.steps, 64u * 64 * 16);
    EXPECT_EQ(figures.chains, 64u);
    large += figures.large, steps += figures.steps;
    accepted.push_back(figures.large_acceptance().value());
    of_small.push_back(figures.small_acceptance().value());
  }
  ASSERT_EQ(accepted.size(), 20u);
  EXPECT_GT(proportion_test(double(large), double(steps), 0.5).p_value, family_level);
  EXPECT_LT(proportion_test(double(large), double(steps), 0.505).p_value, family_level);
  EXPECT_GT(t_test(accepted, 0.7).p_value, family_level);
  EXPECT_LT(t_test(accepted, 0.71).p_value, family_level);
  // Small moves seldom cross from one lamp to the other.
  EXPECT_GT(summarize(of_small).mean, 0.97);
}

TEST(Mixing, of_independent_states_has_one_step_of_autocorrelation) {
  // All proposals are independent and all are accepted: the lamps are equally bright.
  const TestScene scene(two_lamps(1, 1));
  std::vector<double> times, of_small_moves;
  for (const auto& [pass, figures] : mixing_of(scene, "metropolis:large-step=1", {16, 40})) {
    EXPECT_DOUBLE_EQ(figures.large_acceptance().value(), 1);
    EXPECT_FALSE(figures.small_acceptance());
    times.push_back(figures.autocorrelation_time().value());
  }
  for (const auto& [pass, figures] : mixing_of(scene, "metropolis:large-step=0.02", {16, 4}))
    of_small_moves.push_back(figures.autocorrelation_time().value());
  EXPECT_GT(t_test(times, 1).p_value, family_level);
  EXPECT_GT(summarize(of_small_moves).mean, 20);
}

TEST(Mixing, is_the_same_for_any_number_of_threads) {
  const TestScene scene(room);
  const MixingFigures one = sum_of(mixing_of(scene, "metropolis", {8, 2}, 1)),
                      three = sum_of(mixing_of(scene, "metropolis", {8, 2}, 3));
  EXPECT_GT(one.steps, 0u);
  EXPECT_EQ(one.large, three.large);
  EXPECT_EQ(one.large_accepted, three.large_accepted);
  EXPECT_EQ(one.small_accepted, three.small_accepted);
  EXPECT_EQ(one.between_chains, three.between_chains);
  EXPECT_TRUE(mixing_of(scene, "path", {8, 2}).empty());
}

}  // namespace
}  // namespace montelux::test
