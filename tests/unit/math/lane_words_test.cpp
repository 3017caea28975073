// Structs of words in lanes, and queues of them.
#include <gtest/gtest.h>

#include <array>

#include "math/lane_queue.h"

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

// Some of the lanes, in and out: the others, and structs beyond those of the lanes, stay as they are.
template <int count, class F>
void expect_same_words_in_some_lanes(std::uint32_t on) {
  using Pack = typename Words<count>::template In<F>;
  using One = typename Words<count>::template In<float>;
  std::array<One, lanes_of<F> + 1> all{}, taken{};
  std::array<const One*, lanes_of<F>> from;
  Pack pack{};
  for (int k = 0; k < lanes_of<F>; ++k) {
    for (int w = 0; w < count; ++w) all[std::size_t(k)].words[std::size_t(w)] = pattern(k, w);
    from[std::size_t(k)] = &all[std::size_t(k)];
  }
  set_lanes_words<Pack, One>(pack, on, from);
  get_lanes_words<Pack, One>(pack, on, taken.data());
  std::size_t next = 0;
  for (int k = 0; k < lanes_of<F>; ++k) {
    const bool is_on = ((on >> k) & 1u) != 0;
    for (int w = 0; w < count; ++w) {
      ASSERT_EQ(lane(pack.words[std::size_t(w)], k), is_on ? pattern(k, w) : 0u) << count << " words, lane " << k;
      if (is_on) {
        ASSERT_EQ(taken[next].words[std::size_t(w)], pattern(k, w)) << count << " words, lane " << k;
      }
    }
    next += is_on;
  }
  for (std::uint32_t word : taken[next].words) ASSERT_EQ(word, 0u);
}

TEST(LaneWords, some_lanes_are_set_and_taken_at_once) {
  for (std::uint32_t on : {0u, 1u, 0x8001u, 0x1234u, 0x7fffu, 0xffffu}) {
    expect_same_words_in_some_lanes<3, NativeFloats>(on);
    expect_same_words_in_some_lanes<16, NativeFloats>(on);
    expect_same_words_in_some_lanes<21, NativeFloats>(on);
    expect_same_words_in_some_lanes<48, NativeFloats>(on);
    expect_same_words_in_some_lanes<21, Floats<4>>(on & 0xfu);
    expect_same_words_in_some_lanes<21, float>(on & 1u);
  }
}

template <class F>
using ThreeWords = Words<3>::In<F>;

// Whatever is added and taken in whichever lanes, it leaves in the order in which it came.
template <class F>
void expect_order() {
  LaneQueue<ThreeWords, F> queue;
  std::uint32_t added = 0, taken = 0;
  std::uint32_t masks = 0x9e3779b9u;
  for (int turn = 0; turn < 200; ++turn) {
    masks = masks * 1664525u + 1013904223u;
    const Mask<F> on = mask_of_bits<F>((masks >> 8) & ((1u << lanes_of<F>)-1));
    ThreeWords<F> pack{};
    if (turn < 100 && turn % 3 != 0) {
      for_each_lane(on, [&](int k) { set_lane(pack.words[2], k, added++); });
      queue.add(pack, on);
    } else {
      for (int k = 0; k < lanes_of<F>; ++k) set_lane(pack.words[2], k, ~0u);
      const Mask<F> filled = queue.fill(pack, on);
      ASSERT_FALSE(any(Mask<F>(filled & on)));
      for (int k = 0; k < lanes_of<F>; ++k) ASSERT_EQ(lane(pack.words[2], k), lane(filled, k) ? taken++ : ~0u);
      ASSERT_TRUE(queue.is_empty() || all(Mask<F>(filled | on)));
    }
    ASSERT_EQ(queue.size(), added - taken);
  }
  EXPECT_GT(taken, 20u);
  EXPECT_TRUE(queue.is_empty());
}

TEST(LaneQueue, gives_in_the_order_in_which_it_took) {
  expect_order<NativeFloats>();
  expect_order<Floats<4>>();
  expect_order<float>();
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
