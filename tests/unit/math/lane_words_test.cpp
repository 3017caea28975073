// Structs of words in lanes.
#include "math/lane_words.h"

#include <gtest/gtest.h>

#include <array>

namespace montelux {
namespace {

template <int count>
struct Words {
  template <class F>
  struct In {
    std::array<Uint<F>, count> words;
  };
};

// Patterns that as floats are no numbers, too.
std::uint32_t pattern(int lane, int word) { return 0x7f800001u * std::uint32_t(lane % 2) + 1000u * word + lane; }

// The same as lane by lane, whether or not a struct fills its rows of sixteen words.
template <int count, class F>
void expect_same_words() {
  using Pack = typename Words<count>::template In<F>;
  using One = typename Words<count>::template In<float>;
  std::array<One, lanes_of<F>> all;
  std::array<const One*, lanes_of<F>> from;
  for (int k = 0; k < lanes_of<F>; ++k) {
    for (int w = 0; w < count; ++w) all[std::size_t(k)].words[std::size_t(w)] = pattern(k, w);
    // Several lanes may have the same struct.
    from[std::size_t(k)] = &all[std::size_t(k == 3 ? 1 : k)];
  }
  Pack pack;
  set_all_lane_words<Pack, One>(pack, from);
  for (int k = 0; k < lanes_of<F>; ++k)
    for (int w = 0; w < count; ++w)
      ASSERT_EQ(lane(pack.words[std::size_t(w)], k), pattern(k == 3 ? 1 : k, w)) << count << " words, lane " << k;
}

TEST(LaneWords, all_lanes_are_set_at_once) {
  expect_same_words<3, NativeFloats>();
  expect_same_words<14, NativeFloats>();
  expect_same_words<16, NativeFloats>();
  expect_same_words<17, NativeFloats>();
  expect_same_words<48, NativeFloats>();
  expect_same_words<85, NativeFloats>();
  expect_same_words<21, Floats<4>>();
  expect_same_words<21, float>();
}

}  // namespace
}  // namespace montelux
