// Memory that is moved to large pages.
#include "work/huge_pages.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <numeric>
#include <vector>

namespace montelux::test {
namespace {

TEST(HugePages, keep_what_the_memory_contains) {
  // Filled and reserved memory, before and between other blocks.
  std::vector<std::vector<std::uint32_t>> blocks;
  for (std::uint32_t i = 0; i < 8; ++i) {
    blocks.emplace_back((std::size_t(i) << 19) + 1000);
    std::iota(blocks.back().begin(), blocks.back().end(), 1000003 * i);
  }
  std::vector<std::uint32_t> reserved;
  reserved.reserve(1 << 24);
  const std::uint32_t* const place = blocks.back().data();
  use_huge_pages();
  use_huge_pages();
  EXPECT_EQ(blocks.back().data(), place);
  for (std::uint32_t i = 0; i < 8; ++i)
    for (std::size_t k = 0; k < blocks[i].size(); ++k)
      ASSERT_EQ(blocks[i][k], 1000003 * i + std::uint32_t(k)) << i << ", " << k;
  reserved.assign(1 << 24, 7u);
  EXPECT_EQ(reserved.back(), 7u);
}

}  // namespace
}  // namespace montelux::test
