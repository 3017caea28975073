// Which vertex of a path finds its light by a chain: of all paths of up to six vertices, each has one such vertex, or
// none where light sampling passes none and no chain is short enough.
#include <gtest/gtest.h>

#include <vector>

#include "integrator/manifold/chain_light.h"

namespace montelux::test {
namespace {

// A vertex that is no part of chains, a slightly rough surface, a smooth one, and one with deltas that chains do not
// pass.
enum class Kind { plain, rough_caster, smooth_caster, other_delta };
bool is_delta(Kind k) { return k == Kind::smooth_caster || k == Kind::other_delta; }
bool casts(Kind k) { return k == Kind::rough_caster || k == Kind::smooth_caster; }

// The vertices of the path, from the eye, that find the light which the last vertex sees. `every_chain`: a planted
// fault, rough vertices that leave nothing to others.
int finders(const std::vector<Kind>& path, std::uint32_t length, bool every_chain) {
  ChainTail<float> tail(length);
  int count = 0;
  for (std::size_t i = 0; i < path.size(); ++i) {
    tail.arrive(casts(path[i]), is_delta(path[i]), i == 0, true);
    if (is_delta(path[i])) continue;
    const auto chain = std::uint32_t(path.size() - 1 - i);
    bool leads_there = chain <= length;
    for (std::size_t k = i + 1; k < path.size(); ++k) leads_there = leads_there && casts(path[k]);
    if (leads_there && (every_chain || chain >= tail.min_length())) ++count;
  }
  return count;
}
// Whether a chain, or light sampling, leads to the light from some rough vertex.
bool is_found(const std::vector<Kind>& path, std::uint32_t length) {
  for (std::size_t i = path.size(); i-- > 0;) {
    if (path.size() - 1 - i > length) return false;
    if (!is_delta(path[i])) return true;
    if (!casts(path[i])) return false;
  }
  return false;
}

TEST(ChainTail, lets_one_vertex_of_each_path_find_its_light_and_a_planted_fault_is_found) {
  int doubled = 0;
  for (std::size_t vertices = 1; vertices <= 6; ++vertices)
    for (std::size_t number = 0; number < (std::size_t(1) << (2 * vertices)); ++number) {
      std::vector<Kind> path;
      for (std::size_t i = 0; i < vertices; ++i) path.push_back(Kind((number >> (2 * i)) & 3));
      for (std::uint32_t length = 1; length <= 4; ++length) {
        ASSERT_EQ(finders(path, length, false), is_found(path, length) ? 1 : 0) << vertices << " " << number;
        doubled += finders(path, length, true) > 1;
      }
    }
  EXPECT_GT(doubled, 0);
}

// A path that begins in a lane does not remember the one before.
TEST(ChainTail, starts_again_with_a_path) {
  ChainTail<float> tail(2);
  tail.arrive(false, false, true, true);
  tail.arrive(true, false, false, true);
  EXPECT_EQ(tail.min_length(), 2u);
  tail.arrive(true, false, true, true);
  EXPECT_EQ(tail.min_length(), 0u);
}

}  // namespace
}  // namespace montelux::test
