// A few small scenes against another renderer's pictures, at a cost that every check can bear; the others are in the
// ring "full".
#include "reference_scenes.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace montelux::test {

namespace {

struct SmallScene {
  std::string name;
  int samples;
};
const std::vector<SmallScene> small_scenes{
    {"coffee-gray", 256}, {"cornell-box-gray", 128}, {"light-types-gray", 128}, {"testball-silver-aniso-gray", 128}};

void PrintTo(const SmallScene& s, std::ostream* out) { *out << s.name; }

double level() { return sidak_level(reference_level, double(small_scenes.size())); }

class SmallReferenceScene : public testing::TestWithParam<SmallScene> {};

TEST_P(SmallReferenceScene, agrees_with_the_reference) {
  for (const ReferenceScene& s : reference_scenes()) {
    if (s.name != GetParam().name) continue;
    const TestScene scene(read_text(s.scene), s.scene.parent_path().string());
    const PassPlan plan{GetParam().samples / reference_passes, reference_passes};
    const GrayPicture ours = gray_picture(render_independent_pixels(scene, plan, 1, 0).film);
    const GrayPicture reference = read_reference(s);
    const Comparison c = compare(ours, reference);
    std::printf("%s\n%s\n", table_head, table_row(s.name, c, GetParam().samples, level()).c_str());
    EXPECT_TRUE(c.agrees(level()));
    EXPECT_LE(c.relative_error(), 0.003);

    const Comparison bright = compare(scaled(ours, 1.03, 0, 0, ours.width, ours.height), reference);
    EXPECT_FALSE(bright.agrees(level())) << "a picture that is 3 % too bright passes";
    const BlockDifference& b = c.blocks[c.blocks.size() / 2];
    const double wrong = 1 + 12 * std::sqrt(b.ours.variance + b.reference.variance) / b.ours.mean;
    EXPECT_GE(compare(scaled(ours, wrong, b.x, b.y, b.x + 8, b.y + 8), reference).differing(level()), 1u)
        << "a block that is " << 100 * (wrong - 1) << " % too bright passes";
    return;
  }
  ASSERT_FALSE(reference_folder()) << "no scene " << GetParam().name << " in the folder of reference scenes";
  GTEST_SKIP() << "no folder of reference scenes: set MONTELUX_SCENES";
}

std::string test_name(const testing::TestParamInfo<SmallScene>& scene) {
  std::string name = scene.param.name;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(Scenes, SmallReferenceScene, testing::ValuesIn(small_scenes), test_name);

}  // namespace

}  // namespace montelux::test
