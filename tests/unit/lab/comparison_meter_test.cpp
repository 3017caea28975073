// How a comparison states its progress.
#include "api/comparison_meter.h"

#include <gtest/gtest.h>

namespace montelux {
namespace {

TEST(ComparisonMeter, counts_pieces_against_what_was_expected) {
  std::vector<ComparisonProgress> seen;
  ComparisonObserver observer;
  observer.progress = [&](const ComparisonProgress& p) { seen.push_back(p); };
  ComparisonMeter meter(observer);
  meter.expect(1000);
  const lab::WorkPiece pilot{"pilot of path", 250}, repeat{"repeat 1 of 1, path", 750};
  meter.watch().progress(pilot, 0);
  EXPECT_EQ(seen.back().what, "pilot of path");
  EXPECT_NEAR(seen.back().remaining, 1000, 1e-9);
  meter.watch().progress(pilot, 0.5);
  // The test takes no time: the work runs as much faster than expected as is believed.
  EXPECT_NEAR(seen.back().remaining, 875 * 0.1, 875 * 0.001);
  meter.watch().progress(pilot, 1);
  meter.watch().progress(pilot, 1);  // told twice, counted once
  EXPECT_NEAR(seen.back().remaining, 75, 0.1);
  meter.watch().progress(repeat, 0);
  meter.watch().progress(repeat, 0.5);
  meter.watch().progress(repeat, 0.2);  // of a part of it: what is done stays done
  EXPECT_NEAR(seen.back().remaining, 37.5, 0.1);
  meter.watch().progress(repeat, 1);
  EXPECT_EQ(seen.back().remaining, 0);
  for (const ComparisonProgress& p : seen) {
    EXPECT_GE(p.fraction, 0);
    EXPECT_LE(p.fraction, 1);
  }
}

TEST(ComparisonMeter, believes_a_pace_only_after_a_tenth_of_the_work) {
  ComparisonObserver observer;
  ComparisonProgress last;
  observer.progress = [&](const ComparisonProgress& p) { last = p; };
  ComparisonMeter meter(observer);
  meter.expect(1000);
  const lab::WorkPiece piece{"reference", 1000};
  meter.watch().progress(piece, 0);
  meter.watch().progress(piece, 0.01);
  EXPECT_NEAR(last.remaining, 990 * (1 - 0.1 * 0.9), 1);
}

TEST(ComparisonMeter, passes_on_the_wish_to_stop) {
  bool stop = false;
  ComparisonObserver observer;
  observer.stop = [&] { return stop; };
  const ComparisonMeter meter(observer);
  EXPECT_FALSE(meter.watch().stopped());
  stop = true;
  EXPECT_TRUE(meter.watch().stopped());
}

}  // namespace
}  // namespace montelux
