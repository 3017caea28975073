// Bidirectional path tracing: one image by all strategies, and by each of them alone.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "accel/accel.h"
#include "integrator/catalogue.h"
#include "io/pbrt.h"
#include "lab/experiments/floor_scene.h"
#include "lab/experiments/statistics.h"
#include "lab/experiments/table.h"
#include "math/vec.h"
#include "render/render.h"
#include "scene/prepare.h"

namespace montelux::lab {

namespace {

// A floor from -1 to 1 in x and z, seen from above, and a lamp that stands at its edge: a rectangle in the plane
// x = lamp_x, which faces the floor and reflects nothing. Its radiance is 1.
constexpr double lamp_x = -1.1, lamp_low = 0.02, lamp_high = 0.6, lamp_half_width = 0.3, reflectance = 0.6;

std::string scene_text(int size) {
  return fmt::format(R"(
Film "rgb" "integer xresolution" [ {0} ] "integer yresolution" [ {0} ]
PixelFilter "box"
Integrator "path" "integer maxdepth" [ 1 ]
LookAt 0 2 0   0 0 0   0 0 1
Camera "orthographic" "float screenwindow" [ -1 1 -1 1 ]
WorldBegin
Material "diffuse" "rgb reflectance" [ {1} {1} {1} ]
Shape "trianglemesh" "integer indices" [ 0 1 2  0 2 3 ] "point3 P" [ -1 0 -1   -1 0 1   1 0 1   1 0 -1 ]
AreaLightSource "diffuse" "rgb L" [ 1 1 1 ]
Material "diffuse" "rgb reflectance" [ 0 0 0 ]
Shape "trianglemesh" "integer indices" [ 0 1 2  0 2 3 ] "point3 P" [ {2} {3} -{5}   {2} {4} -{5}   {2} {4} {5}   {2} {3} {5} ]
)",
                     size, reflectance, lamp_x, lamp_low, lamp_high, lamp_half_width);
}

// The radiance of the floor at (x, 0, z): of a polygon of radiance 1 that is above the horizon, half the sum over its
// edges of the angle that they subtend times the cosine of the normal of the plane in which they are seen (Lambert
// 1760).
double floor_radiance(double x, double z) {
  struct Point {
    double x, y, z;
  };
  const double dx = lamp_x - x;
  const Point corners[]{{dx, lamp_low, -lamp_half_width - z},
                        {dx, lamp_high, -lamp_half_width - z},
                        {dx, lamp_high, lamp_half_width - z},
                        {dx, lamp_low, lamp_half_width - z}};
  double sum = 0;
  for (int i = 0; i < 4; ++i) {
    const Point &a = corners[i], &b = corners[(i + 1) % 4];
    const Point normal{a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
    const double size = std::hypot(normal.x, normal.y, normal.z), cosine = a.x * b.x + a.y * b.y + a.z * b.z;
    sum += std::atan2(size, cosine) * normal.y / size;
  }
  return reflectance / std::numbers::pi * std::abs(sum) / 2;
}

// Averaged over each pixel; columns go along x.
std::vector<double> floor_reference(int size) {
  std::vector<double> values;
  for (int row = 0; row < size; ++row)
    for (int column = 0; column < size; ++column) {
      const auto edge = [&](int i) { return 2.0 * i / size - 1; };
      const auto along_z = [&](double x) {
        return quadrature([&](double z) { return floor_radiance(x, z); }, edge(row), edge(row + 1), 1);
      };
      values.push_back(quadrature(along_z, edge(column), edge(column + 1), 1) * size * size / 4);
    }
  return values;
}

// The layers of light of one bounce: weighted, and each strategy alone.
enum Layer : std::uint8_t { weighted, alone };
constexpr std::array<std::string_view, 3> strategies{"s0_t3", "s1_t2", "s2_t1"};
constexpr std::array<std::string_view, 3> explanations{"a path from the eye meets the lamp",
                                                       "a point of the lamp is sampled",
                                                       "a path from the lamp is connected with the lens"};

// The image of all light and its layers over independent passes. Columns go along x, whichever way the camera shows it.
class Render {
 public:
  explicit Render(const Setup& setup) : size_(int(setup.count("pixels"))), passes_(int(setup.count("passes"))) {
    ReadResult read = read_pbrt_text(scene_text(size_), ".");
    auto prepared = prepare(*read.scene, {}, read.diagnostics);
    const Scene& scene = prepared->scene;
    const Accel accel(
        scene.geometry,
        [&scene](const Hit<float>& hit, const Ray<float>& ray, RayUse use) { return scene.is_opaque(hit, ray, use); },
        1);
    const ChosenIntegrator chosen =
        choose_integrator(*parse_choice("bdpt:mis=balance"), {1, {}, size_, size_}, scene, accel).value();
    plan_.strategies = 1, plan_.alone = plan_.spread = true;
    plan_.group_names = {"default"};
    RenderSettings settings;
    settings.image.bounds = {0, 0, size_, size_}, settings.image.width = settings.image.height = size_;
    settings.image.sampler = PointSetKind::independent, settings.image.seed = setup.seed();
    settings.image.layers = plan_, settings.plan = {int(setup.count("samples")), 1}, settings.threads = 1;
    RenderObserver silent;
    for (settings.plan.first_pass = 0; settings.plan.first_pass < passes_; ++settings.plan.first_pass) {
      Film film = montelux::render(chosen.any(), settings, silent).film;
      for (std::size_t s = 0; s < strategies.size(); ++s) means_[s].push_back(image_mean(film, number(alone, s)));
      double sum = 0;
      for (std::size_t s = 0; s < strategies.size(); ++s)
        sum += image_mean(film, number(setup.fault() ? alone : weighted, s));
      sums_.push_back(sum);
      if (film_)
        film_->merge(film);
      else
        film_.emplace(std::move(film));
    }
    // The picture may show x from left to right or from right to left.
    flipped_ = film_->features(0, 0).position(0) > 0;
  }

  int size() const { return size_; }
  Spread sums() const { return spread_of(sums_); }                                    // of image means
  Spread mean_of(std::size_t strategy) const { return spread_of(means_[strategy]); }  // alone
  // By pixel; of a strategy, or of all of them together.
  std::vector<double> picture(Layer kind, std::size_t strategy) const {
    return pixels([&](int x, int y) { return film_->layers()->layer_mean(x, y, number(kind, strategy), 0); });
  }
  std::vector<double> picture() const {
    return pixels([&](int x, int y) { return film_->layers()->mean(x, y, 0); });
  }
  // The variance of one sample of a pixel.
  std::vector<double> variance(std::size_t strategy) const { return variance_of(number(alone, strategy)); }
  std::vector<double> variance() const { return variance_of(-1); }

 private:
  int number(Layer kind, std::size_t strategy) const {
    const std::vector<std::string> names = layer_names(plan_);
    const std::string name = (kind == alone ? "alone_" : "strategy_") + std::string(strategies[strategy]);
    return int(std::ranges::find(names, name) - names.begin());
  }
  double image_mean(const Film& film, int layer) const {
    double sum = 0;
    for (int y = 0; y < size_; ++y)
      for (int x = 0; x < size_; ++x) sum += film.layers()->layer_mean(x, y, layer, 0);
    return sum / (size_ * size_);
  }
  std::vector<double> pixels(const std::function<double(int, int)>& value) const {
    std::vector<double> values;
    for (int y = 0; y < size_; ++y)
      for (int x = 0; x < size_; ++x) values.push_back(value(flipped_ ? size_ - 1 - x : x, y));
    return values;
  }
  std::vector<double> variance_of(int layer) const {
    const double samples = film_->samples(0, 0);
    return pixels([&](int x, int y) { return samples * film_->layers()->variance_of_mean(x, y, layer, 0); });
  }

  int size_, passes_;
  LayerPlan plan_;
  std::optional<Film> film_;
  std::array<std::vector<double>, 3> means_;
  std::vector<double> sums_;
  bool flipped_ = false;
};

// One-sided: is the mean of these independent values above 0?
Check below_zero_check(std::string claim, const Spread& s) {
  Check check = z_check(std::move(claim), s.mean, s.mean_error, 0);
  if (s.mean < 0) check.p_value = 1;
  return check;
}

std::vector<double> along_x(const std::vector<double>& values, int size) {
  std::vector<double> columns(std::size_t(size), 0.0);
  for (std::size_t i = 0; i < values.size(); ++i) columns[i % std::size_t(size)] += values[i] / size;
  return columns;
}

Findings run(const Setup& setup) {
  const Render render(setup);
  const int size = render.size();
  const std::vector<double> truth = floor_reference(size);
  double truth_mean = 0;
  for (double value : truth) truth_mean += value / double(truth.size());
  const double white = *std::ranges::max_element(truth);

  Images images{"strategies",
                "The floor seen from above, the lamp stands at its left edge. First row: each strategy alone, and the "
                "closed form. Second row: what each contributes with its weight, and their sum.",
                4,
                {}};
  const auto show = [&](const std::vector<double>& values, std::string caption) {
    images.pictures.push_back(gray_picture(values, size, white));
    images.pictures.back().caption = std::move(caption);
  };
  Table table{"means",
              "Mean of the floor's radiance and of the variance of a sample.",
              {"strategy", "how a path is found", "mean, alone", "variance, alone", "share of the light, weighted"},
              {}};
  Figure figure{"deviation",
                "The standard deviation of a sample by the distance from the lamp. No strategy alone is good "
                "everywhere; their weighted sum is close to the best one everywhere.",
                {"$x$", false, -1, 1},
                {"standard deviation", true, {}, {}},
                {},
                false};
  std::vector<double> places;
  for (int i = 0; i < size; ++i) places.push_back((2 * i + 1.0) / size - 1);
  const auto deviation = [&](std::string name, const std::vector<double>& variance) {
    std::vector<double> y = along_x(variance, size);
    for (double& value : y) value = std::sqrt(value);
    figure.curves.push_back({std::move(name), Mark::line, places, std::move(y), {}, {}});
  };

  Findings findings;
  const std::vector<double> combined = render.variance();
  // Veach's bound for one sample of each of three strategies: the variance of the sum exceeds that of none of them by
  // more than (1 - 1/3) of the squared mean.
  const std::array<std::vector<double>, 3> variances{render.variance(0), render.variance(1), render.variance(2)};
  std::vector<double> above_bound = combined;
  for (std::size_t i = 0; i < above_bound.size(); ++i)
    above_bound[i] -= std::min({variances[0][i], variances[1][i], variances[2][i]}) + 2.0 / 3 * truth[i] * truth[i];
  for (std::size_t s = 0; s < strategies.size(); ++s) {
    show(render.picture(alone, s), std::string(strategies[s]) + ": " + std::string(explanations[s]));
    const Spread mean = render.mean_of(s);
    const std::vector<double>&variance = variances[s], part = render.picture(weighted, s);
    double share = 0;
    for (double value : part) share += value / (truth_mean * double(part.size()));
    table.rows.push_back({std::string(strategies[s]), std::string(explanations[s]),
                          with_error(mean.mean, mean.mean_error), spread_of(variance).mean, share});
    deviation(std::string(strategies[s]) + " alone", variance);
    findings.checks.push_back(
        mean_check(fmt::format("The strategy {} alone is unbiased.", strategies[s]), mean, truth_mean));
  }
  show(truth, "closed form");
  for (std::size_t s = 0; s < strategies.size(); ++s)
    show(render.picture(weighted, s), std::string(strategies[s]) + ", weighted");
  show(render.picture(), "the sum of the weighted ones");
  const Spread sum = render.sums();
  table.rows.push_back({"all", "weighted", with_error(sum.mean, sum.mean_error), spread_of(combined).mean, 1.0});
  deviation("weighted sum", combined);

  findings.checks.push_back(mean_check("The sum of the weighted strategies is unbiased.", sum, truth_mean));
  findings.checks.push_back(
      below_zero_check("The variance of the weighted sum stays below the bound of Veach, in the mean over the floor.",
                       spread_of(above_bound)));
  findings.sections = {images, figure, table};
  return findings;
}

}  // namespace

const Experiment bidirectional_strategies{
    .name = "bidirectional",
    .title = "All strategies of bidirectional path tracing",
    .group = group_t,
    .question =
        "Light that a lamp sends to the lens by way of the floor can be found from the eye, by a sample of the lamp, "
        "or from the lamp. Each way alone has the right mean. What does each of them contribute when multiple "
        "importance sampling weighs them, and how noisy is the sum?",
    .formula =
        R"(F = \sum_{s,t} w_{s,t}(x)\,\frac{f(x)}{p_{s,t}(x)},\qquad w_{s,t} = \frac{p_{s,t}}{\sum_{s',t'} p_{s',t'}},\qquad V[F] \le \min_i V[F_i] + \Bigl(1-\frac1n\Bigr)\mu^2)",
    .source = "Veach and Guibas 1994, 1995; Veach 1997, theorem 9.2 and chapter 10",
    .fault = "the strategies are added without their weights",
    .knobs = {{{"passes", 24, "independent images"},
               {"samples", 8, "samples of a pixel in each of them"},
               {"pixels", 32, "pixels along a side"}}},
    .checks = 5,
    .run = run};

}  // namespace montelux::lab
