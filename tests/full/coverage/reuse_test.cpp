// Error bars of the integrators that share samples between pixels and frames: 95 % intervals of pixels and of the image
// mean cover 93 % to 97 %, and the estimated mean squared error is the true one within a tenth. Frames of a series and
// pixels beside each other depend on each other; series do not. Prints the table of docs/error-bars.md.
#include <gtest/gtest.h>

#include "error_bars.h"
#include "sequence_scenes.h"

namespace montelux::test {

namespace {

// Series as long as they are by default. An image gives one interval of its mean and many of its pixels: small images
// serve the former.
constexpr PassPlan plan{16, 8};
constexpr int seeds = 200, seeds_of_small_images = 800, last_picture = 2;
constexpr double low = 0.93, high = 0.97, ratio_low = 0.9, ratio_high = 1.1;
constexpr double family = 0.01;

const char* const ways[] = {"restir-di", "restir-di:groups=off", "restir-di:temporal=off", "restir-gi",
                            "restir-pt", "restir-pt:temporal=on"};
// Every scene by every way, and six sequences.
double level_of_a_row() { return sidak_level(family, 3 * double(std::size(ways) * error_bar_scenes().size() + 6)); }
// Of both kinds of images the intervals of the mean, of the large ones those of the pixels.
struct Row {
  Coverage large, small;
  double held() const { return large.images + small.images; }
  double images() const { return large.seeds + small.seeds; }
};

void print(const std::string& scene, const std::string& way, PassPlan p, const Row& row) {
  const ShareInterval pixels = mean_interval(row.large.pixel_share, 0.05),
                      images = binomial_interval(row.held(), row.images(), 0.05);
  std::printf("| %s | `%s` | %d x %d | %.1f %% (%.1f to %.1f) | %.1f %% (%.1f to %.1f) | %.3f |\n", scene.c_str(),
              way.c_str(), p.passes, p.samples_per_pass, 100 * row.large.pixels / row.large.pixel_intervals,
              100 * pixels.low, 100 * pixels.high, 100 * row.held() / row.images(), 100 * images.low, 100 * images.high,
              row.large.ratio());
  std::fflush(stdout);
}
void expect_true(const std::string& name, const Row& row) {
  const double level = level_of_a_row();
  EXPECT_GE(row.large.pixels_p_value(low, high), level) << name << ": pixels";
  EXPECT_GE(binomial_p_value(row.held(), row.images(), low, high), level) << name << ": image means";
  EXPECT_GE(row.large.ratio_p_value(ratio_low, ratio_high), level) << name << ": estimated over true";
}

TEST(ErrorBarsOfReuse, cover_the_truth_as_often_as_they_say) {
  const std::vector<ErrorBarScene>& scenes = error_bar_scenes();
  double held = 0, images = 0;
  // Of each seed of each scene, over the ways.
  std::vector<double> pixel_share(scenes.size() * std::size_t(seeds), 0.0);
  for (std::size_t i = scenes.size(); i-- > 0;) {
    const TestScene scene(scenes[i].text), small(scenes[i].text, ".", std::pair{8, 8});
    const Truth truth = truth_of(scene, {2048, 16}), small_truth = truth_of(small, {2048, 16});
    for (const char* way : ways) {
      const Row row{measure_coverage(scene, truth, way, plan, seeds),
                    measure_coverage(small, small_truth, way, plan, seeds_of_small_images)};
      print(scenes[i].name, way, plan, row);
      expect_true(scenes[i].name + ", " + way, row);
      held += row.held(), images += row.images();
      for (std::size_t k = 0; k < std::size_t(seeds); ++k)
        pixel_share[i * std::size_t(seeds) + k] += row.large.pixel_share[k] / double(std::size(ways));
    }
  }
  // What a single row cannot exclude, all of them together can: their figures lie in the range for certain. The ways
  // share seeds, and so the light that is not reused: at worst they say one thing as often as there are ways.
  const double own = 1 / double(std::size(ways));
  const ShareInterval of_pixels = mean_interval(pixel_share, family),
                      of_images = binomial_interval(own * held, own * images, family);
  std::printf("all: pixels %.2f %% to %.2f %%, image means %.2f %% to %.2f %%\n", 100 * of_pixels.low,
              100 * of_pixels.high, 100 * of_images.low, 100 * of_images.high);
  EXPECT_TRUE(low <= of_pixels.low && of_pixels.high <= high);
  EXPECT_TRUE(low <= of_images.low && of_images.high <= high);
}

// The last picture of a sequence, whose series continue those of the previous images.
Coverage coverage_of_sequence(const TestScene& scene, const char* way, int count) {
  const ChosenIntegrator chosen = scene.integrator(way);
  const auto film_of = [&](std::uint32_t seed) {
    SeriesMemories memories;
    std::optional<Film> film;
    RenderObserver silent;
    for (int picture = 0; picture <= last_picture; ++picture) {
      RenderSettings s = scene.settings(PointSetKind::blue_noise, plan, 1000 * seed + std::uint32_t(picture), 0);
      s.image.shutter = sequence_shutter(picture), s.sequence.memories = &memories;
      film = render(chosen.any(), s, silent).film;
    }
    return *film;
  };
  return measure_coverage_of(film_of, truth_of(scene, {2048, 16}, sequence_shutter(last_picture)), plan, count);
}

// The camera flies over the scene.
std::string flight(const std::string& text, const std::string& from) {
  return replaced(text, from,
                  "ActiveTransform StartTime\n" + from + "ActiveTransform EndTime\nTranslate -0.4 -0.1 0.3\n" + from +
                      "ActiveTransform All\n");
}

TEST(ErrorBarsOfSequence, cover_the_truth_as_often_as_they_say) {
  const std::string sky = flight(error_bar_scenes()[1].text, "LookAt 0 1.2 -4  0 0.4 0  0 1 0\n"),
                    lamps = flight(error_bar_scenes()[2].text, "LookAt 0 0.9 -2.5  0 0 -1  0 1 0\n");
  struct Sequence {
    const char *name, *way;
    const std::string& text;
  };
  for (const auto& [name, way, text] : {Sequence{"sky, third picture", "restir-di", sky},
                                        {"lamps, third picture", "restir-di", lamps},
                                        {"sky, third picture", "restir-pt:temporal=on", sky}}) {
    const TestScene scene(text), small(text, ".", std::pair{8, 8});
    const Row row{coverage_of_sequence(scene, way, seeds), coverage_of_sequence(small, way, seeds_of_small_images)};
    print(name, way, plan, row);
    expect_true(std::string(name) + ", " + way, row);
  }
}

// In gaps between slats there is light that few samples find. Intervals of pixels are too short there, whether samples
// are shared or not; the image mean and the mean squared error are not touched by that.
TEST(ErrorBarsOfSequence, cover_the_image_behind_slats_and_estimate_its_error) {
  const TestScene scene(sequence_scene(16)), small(sequence_scene(8));
  for (const char* way : {"path", "restir-di:carry=off", "restir-di"}) {
    const Row row{coverage_of_sequence(scene, way, seeds / 2),
                  coverage_of_sequence(small, way, seeds_of_small_images / 2)};
    print("slats, third picture", way, plan, row);
    const double level = level_of_a_row();
    EXPECT_GE(row.large.pixels_p_value(0.85, high), level) << way;
    EXPECT_GE(binomial_p_value(row.held(), row.images(), low, high), level) << way;
    EXPECT_GE(row.large.ratio_p_value(ratio_low, ratio_high), level) << way;
  }
}

// Frames that reuse previous frames, each treated as a separate pass: their error bars must be found too
// small where direct light rules the error, as it does not in the box.
TEST(ErrorBarsOfReusePlanted, of_frames_taken_for_independent_are_found) {
  struct Case {
    const ErrorBarScene& text;
    const char* way;
  };
  for (const Case& c :
       {Case{error_bar_scenes()[1], "restir-di:frames=1"}, Case{error_bar_scenes()[2], "restir-di:frames=1"},
        Case{error_bar_scenes()[1], "restir-pt:temporal=on,frames=1"}}) {
    const auto coverage = [&](std::optional<std::pair<int, int>> resolution, int count) {
      const TestScene scene(c.text.text, ".", resolution);
      const ChosenIntegrator chosen = scene.integrator(c.way);
      const auto film_of = [&](std::uint32_t seed) {
        SeriesMemories memories;
        std::optional<Film> film;
        RenderObserver silent;
        for (int frame = 0; frame < plan.samples_per_pass; ++frame) {
          RenderSettings s =
              scene.settings(PointSetKind::blue_noise, {1, plan.passes}, 1000 * seed + std::uint32_t(frame), 0);
          s.plan.first_pass = frame * plan.passes;
          s.sequence.memories = &memories;
          const Film one = render(chosen.any(), s, silent).film;
          if (film)
            film->merge(one);
          else
            film = one;
        }
        return *film;
      };
      return measure_coverage_of(film_of, truth_of(scene, {2048, 16}), {1, plan.samples()}, count);
    };
    const Row row{coverage({}, seeds / 4), coverage(std::pair{8, 8}, seeds_of_small_images / 4)};
    print(c.text.name, std::string(c.way) + ", frames as passes", {1, plan.samples()}, row);
    const double level = level_of_a_row();
    EXPECT_LT(row.large.pixels_p_value(low, high), level) << c.text.name;
    EXPECT_LT(binomial_p_value(row.held(), row.images(), low, high), level) << c.text.name;
    EXPECT_LT(row.large.ratio_p_value(ratio_low, ratio_high), level) << c.text.name;
  }
}

}  // namespace

}  // namespace montelux::test
