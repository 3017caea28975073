// The rounds of paths that teach.
#include <gtest/gtest.h>

#include "integrator/guiding/rounds.h"

namespace montelux::test {
namespace {

std::vector<TrainingRound> rounds_of(const std::vector<double>& totals) {
  std::vector<TrainingRound> all;
  for_each_round(totals, [&](const TrainingRound& round) { all.push_back(round); });
  return all;
}

TEST(TrainingRounds, double_their_paths_up_to_the_total) {
  const std::vector<TrainingRound> rounds = rounds_of({100000});
  double before = 0, usual = rounds.front().paths;
  for (std::size_t i = 0; i < rounds.size(); ++i, usual *= 2) {
    EXPECT_EQ(rounds[i].number, i + 1);
    EXPECT_EQ(rounds[i].before, before);
    EXPECT_EQ(rounds[i].paths, std::min(usual, 100000 - before));
    before += rounds[i].paths;
  }
  EXPECT_EQ(before, 100000);
  EXPECT_GT(rounds.size(), 3u);
}

// What paths teach one learner does not depend on whether more of them teach another one.
TEST(TrainingRounds, end_at_each_total) {
  const std::vector<TrainingRound> few = rounds_of({30000}), both = rounds_of({100000, 0, 30000});
  ASSERT_GT(both.size(), few.size());
  for (std::size_t i = 0; i < few.size(); ++i) {
    EXPECT_EQ(both[i].paths, few[i].paths);
    EXPECT_EQ(both[i].before, few[i].before);
  }
  EXPECT_EQ(both[few.size()].before, 30000);
  EXPECT_EQ(both.back().before + both.back().paths, 100000);
}

TEST(TrainingRounds, are_none_without_paths) {
  EXPECT_TRUE(rounds_of({}).empty());
  EXPECT_TRUE(rounds_of({0, 0}).empty());
}

}  // namespace
}  // namespace montelux::test
