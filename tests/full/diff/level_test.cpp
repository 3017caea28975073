// The level and the power of `montelux diff` on ten scenes at 80 x 60 pixels. Prints the tables of
// docs/command-line.md. Scenes of the folder MONTELUX_SCENES are left out, with a message, where there is none.
#include <gtest/gtest.h>

#include "picture_pairs.h"
#include "reference_scenes.h"

namespace montelux::test {
namespace {

struct NamedScene {
  std::string name;
  std::filesystem::path file;
};

std::vector<NamedScene> scenes() {
  const std::filesystem::path own = std::filesystem::path(MONTELUX_SOURCE_DIR) / "scenes";
  std::vector<NamedScene> all{{"first-light", own / "first-light" / "first-light.pbrt"},
                              {"carousel", own / "carousel" / "carousel.pbrt"},
                              {"glossy-indirect", own / "glossy-indirect" / "glossy-indirect.pbrt"},
                              {"lsde", own / "path-classes" / "lsde.pbrt"}};
  const auto folder = reference_folder();
  for (const std::string name :
       {"cornell-box", "veach-mis", "veach-ajar", "dining-room", "living-room", "many-lights-city"})
    if (folder && std::filesystem::exists(*folder / name / (name + ".pbrt")))
      all.push_back({name, *folder / name / (name + ".pbrt")});
    else
      std::printf("%s is left out: MONTELUX_SCENES has it not\n", name.c_str());
  return all;
}

std::vector<PicturePair> pairs() {
  const auto path = [](const char* sampler, int samples) { return PictureWay{"path", sampler, samples}; };
  return {{path("blue-noise", 16), path("blue-noise", 256)},
          {path("blue-noise", 16), path("blue-noise", 1024)},
          {path("blue-noise", 64), path("blue-noise", 256)},
          {path("blue-noise", 16), path("blue-noise", 64)},
          {path("blue-noise", 16), path("blue-noise", 16)},
          {path("blue-noise", 64), path("blue-noise", 64)},
          {path("sobol", 16), path("independent", 256)},
          {path("sobol", 64), path("sobol", 256)},
          {path("sobol", 16), path("halton", 64)},
          {path("halton", 16), path("blue-noise", 1024)},
          {path("halton", 64), path("independent", 16)},
          {path("halton", 256), path("sobol", 256)},
          {path("independent", 16), path("sobol", 256)},
          {path("independent", 64), path("independent", 256)},
          {{"restir-di", "blue-noise", 16}, path("blue-noise", 256)},
          {{"restir-di", "independent", 64}, path("sobol", 64)},
          {{"restir-di", "blue-noise", 64}, {"restir-di", "blue-noise", 16}},
          {{"restir-pt", "blue-noise", 64}, path("blue-noise", 64)},
          {{"naive", "independent", 256}, path("blue-noise", 64)},
          {{"naive", "sobol", 64}, {"naive", "independent", 256}}};
}

TEST(DiffLevel, at_most_five_of_two_hundred_pairs_of_one_expectation_differ) {
  DifferingPairs all;
  std::uint32_t seed = 5000;
  std::printf("| scene | pairs | different | with errors that are a third |\n|---|---|---|---|\n");
  for (const NamedScene& s : scenes()) {
    const DifferingPairs count = differing_pairs(PictureScene(s.file, 80, 60), pairs(), seed);
    seed += 100;
    std::printf("| %s | %d | %d | %d |\n", s.name.c_str(), count.pairs, count.differ, count.differ_with_smaller_errors);
    std::fflush(stdout);
    all.pairs += count.pairs, all.differ += count.differ;
    all.differ_with_smaller_errors += count.differ_with_smaller_errors;
  }
  std::printf("| all | %d | %d | %d |\n", all.pairs, all.differ, all.differ_with_smaller_errors);
  EXPECT_LE(all.differ, std::max(1, all.pairs / 40));
  EXPECT_GE(all.differ_with_smaller_errors, all.pairs / 2) << "errors that are a third of the true ones pass";
}

// The error that decides is that of the picture with fewer samples. What is twice the stated detectable difference must
// be found: of the whole image, and of a square of 20 pixels that is a tenth brighter where blocks can tell that.
TEST(DiffPower, what_the_noise_allows_is_found) {
  std::printf("| scene | samples | image mean, %% | block, %% | pixel, %% | 1 %% of the mean | 10 %% of a square |\n");
  std::printf("|---|---|---|---|---|---|---|\n");
  std::uint32_t seed = 9000;
  for (const NamedScene& s : scenes()) {
    const PictureScene scene(s.file, 80, 60);
    for (const int samples : {64, 256, 1024}) {
      const PictureEstimate a = scene.picture({"path", "blue-noise", samples}, seed++),
                            b = scene.picture({"path", "blue-noise", samples}, seed++);
      const WelchReport alike = welch_of(a, b), scaled = welch_of(a, brighter(b, 1.01f)),
                        square = welch_of(a, brighter(b, 1.1f, 40, 30, 60, 50));
      double mean = 0;
      for (std::size_t i = 0; i < b.color.pixel_count(); ++i)
        mean += double(b.color.values[3 * i + std::size_t(alike.image.channel)]) / double(b.color.pixel_count());
      const double image = 100 * alike.image.detectable / mean;
      std::printf("| %s | %d | %.2f | %.1f | %.0f | %s | %s |\n", s.name.c_str(), samples, image,
                  100 * alike.blocks.detectable_median / mean, 100 * alike.pixels.detectable_median / mean,
                  scaled.image.differs ? "found" : "-", square.blocks.differs ? "found" : "-");
      std::fflush(stdout);
      EXPECT_TRUE(image > 0.5 || scaled.image.differs) << s.name << ' ' << samples;
      EXPECT_TRUE(welch_of(a, brighter(b, 1 + float(0.02 * image))).image.differs) << s.name << ' ' << samples;
    }
  }
}

}  // namespace
}  // namespace montelux::test
