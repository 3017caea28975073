// Every scene that has a reference picture: Welch tests of the image mean and of 8x8 blocks, family-wise 1 % over all
// scenes, at a relative standard error of the image mean of 0.3 % or better. Prints the table of docs/validation.md.
// MONTELUX_REFERENCE_SAMPLES states the samples per pixel (default 512).
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "api/scene.h"
#include "reference_scenes.h"

namespace montelux::test {

namespace {

// Scenes that Montelux cannot render yet, and the word that its message must hold.
const std::map<std::string, std::string> not_yet{};

// Scenes that differ, and what is known or thought of the cause. Where one starts to agree, find out why.
constexpr std::string_view rough_coats =
    "the reference renderer weighs the light that leaves a rough coat by chance with the density of the reversed "
    "directions, which makes one bounce about 10 % too bright; see RoughCoat in distribution/material";
constexpr std::string_view filtered_texture =
    "not settled; likely: the reference renderer takes textures from reduced copies, so that the bright lines between "
    "the tiles of the floor are spread over the dark tiles, under a coat, whose light is not linear in what is below "
    "it";
const std::map<std::string, std::string_view> expected_failures{{"spot-herd-gray", rough_coats},
                                                                {"dining-room-gray", rough_coats},
                                                                {"bottles-dof-gray", filtered_texture},
                                                                {"staircase2-gray", filtered_texture}};

// Scenes whose light arrives by rare paths take more samples than the others.
const std::map<std::string, int> times_more{
    {"veach-ajar-gray", 8}, {"veach-mis-gray", 8}, {"many-lights-city-gray", 8}};

// Blocks of which the reference's error bar is too small. many-lights-city: eight runs saw a rare bright path there
// once; choice of lights by the hierarchy, by power and uniformly give one value, six of its standard errors below.
const std::map<std::string, std::size_t> odd_blocks{{"many-lights-city-gray", 1}};

int samples_of(const std::string& name) {
  const char* stated = std::getenv("MONTELUX_REFERENCE_SAMPLES");
  const auto times = times_more.find(name);
  return (stated ? std::max(reference_passes, std::atoi(stated)) : 512) *
         (times == times_more.end() ? 1 : times->second);
}

class ReferenceSceneTest : public testing::TestWithParam<ReferenceScene> {};

TEST_P(ReferenceSceneTest, agrees_with_the_reference) {
  const ReferenceScene& s = GetParam();
  if (auto missing = not_yet.find(s.name); missing != not_yet.end()) {
    const LoadResult loaded = load_scene(s.scene);
    EXPECT_FALSE(loaded.scene) << "it loads: give it its test";
    EXPECT_TRUE(std::any_of(loaded.diagnostics.all().begin(), loaded.diagnostics.all().end(),
                            [&](const Diagnostic& d) {
                              return d.severity == Severity::error &&
                                     d.message.find(missing->second) != std::string::npos;
                            }))
        << "no error names " << missing->second;
    std::printf("| %s | | | | | | | | waits for %s |\n", s.name.c_str(), missing->second.c_str());
    return;
  }
  const double level = sidak_level(reference_level, double(reference_scenes().size()));
  const int samples = samples_of(s.name);
  const Comparison c = compare_with_reference(s, samples, 0);
  std::printf("%s\n", table_row(s.name, c, samples, level).c_str());
  EXPECT_LE(c.relative_error(), 0.003) << "too few samples to decide";
  if (auto failure = expected_failures.find(s.name); failure != expected_failures.end()) {
    EXPECT_FALSE(c.agrees(level)) << "agrees, though it was not to: " << failure->second;
    return;
  }
  EXPECT_GE(c.image.p_value, level / 2) << "the means differ: " << c.ratio() << " +- " << c.ratio_error();
  const std::size_t differing = c.differing(level);
  const auto odd = odd_blocks.find(s.name);
  EXPECT_LE(differing, odd == odd_blocks.end() ? 0u : odd->second);
  for (std::size_t i = 0; i < std::min<std::size_t>(differing, 5); ++i) {
    const BlockDifference& b = c.blocks[i];
    std::printf("    block (%d, %d): %.5g +- %.2g, reference %.5g +- %.2g, t %.2f, %.0f degrees\n", b.x, b.y,
                b.ours.mean, std::sqrt(b.ours.variance), b.reference.mean, std::sqrt(b.reference.variance),
                b.test.statistic, b.test.degrees);
  }
}

std::string test_name(const testing::TestParamInfo<ReferenceScene>& scene) {
  std::string name = scene.param.name;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Scenes, ReferenceSceneTest, testing::ValuesIn(reference_scenes()), test_name);
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(ReferenceSceneTest);

TEST(ReferenceScenes, are_there) {
  if (!reference_folder()) GTEST_SKIP() << "no folder of reference scenes: set MONTELUX_SCENES";
  EXPECT_GE(reference_scenes().size(), 10u);
}

}  // namespace

}  // namespace montelux::test
