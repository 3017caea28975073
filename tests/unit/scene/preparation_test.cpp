// What preparing a scene costs, counted in bytes that it allocates: time would depend on the machine.
#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

#include "gltf_files.h"
#include "scene/prepare.h"

namespace {

std::size_t allocated = 0;  // by this program; its tests have one thread

}  // namespace

// Kept out of line: the compiler takes the two for a mismatched pair where it sees into them.
__attribute__((noinline)) void* operator new(std::size_t size) {
  allocated += size;
  if (void* p = std::malloc(size)) return p;
  throw std::bad_alloc();
}
__attribute__((noinline)) void operator delete(void* p) noexcept { std::free(p); }
__attribute__((noinline)) void operator delete(void* p, std::size_t) noexcept { std::free(p); }

namespace montelux::test {

namespace {

// A scene of so many nodes that show the same triangle, which is too small to be instanced.
ReadResult scene_of(std::size_t nodes) {
  std::string roots, list;
  for (std::size_t i = 0; i < nodes; ++i) {
    const std::string comma = i == 0 ? "" : ",";
    roots += comma + std::to_string(i);
    list += comma + R"({"mesh": 0, "translation": [)" + std::to_string(i) + ", 0, 0]}";
  }
  std::string json = triangle_json();
  const auto replace = [&](const std::string& old, const std::string& by) {
    json.replace(json.find(old), old.size(), by);
  };
  replace(R"("nodes": [0])", "\"nodes\": [" + roots + "]");
  replace(R"("nodes": [{"mesh": 0}])", "\"nodes\": [" + list + "]");
  return read_text(json);
}

std::size_t bytes_to_prepare(std::size_t nodes) {
  ReadResult read = scene_of(nodes);
  EXPECT_TRUE(read.scene);
  if (!read.scene) return 0;
  const std::size_t before = allocated;
  EXPECT_TRUE(prepare(*read.scene, {}, read.diagnostics));
  return allocated - before;
}

std::size_t bytes_to_read(std::size_t nodes) {
  const std::size_t before = allocated;
  EXPECT_TRUE(scene_of(nodes).scene);
  return allocated - before;
}

// Buffers that double as they grow cost twice as much for twice as many, and up to a doubling more.
constexpr double largest = 2.5;

TEST(Preparation, costs_in_proportion_to_the_nodes_of_a_scene) {
  const auto few = double(bytes_to_prepare(2000)), many = double(bytes_to_prepare(4000));
  EXPECT_GT(few, 1e5);
  EXPECT_LT(many, largest * few);
  EXPECT_LT(double(bytes_to_prepare(8000)), largest * many);
}

TEST(Reading, costs_in_proportion_to_the_nodes_of_a_scene) {
  const auto few = double(bytes_to_read(2000)), many = double(bytes_to_read(4000));
  EXPECT_LT(many, largest * few);
}

// The planted fault: room for one more, each time.
TEST(Allocations, show_a_buffer_that_grows_by_one) {
  const auto grow = [](std::size_t n) {
    const std::size_t before = allocated;
    std::vector<int> v;
    for (std::size_t i = 0; i < n; ++i) {
      v.reserve(v.size() + 1);
      v.push_back(1);
    }
    return double(allocated - before);
  };
  EXPECT_GT(grow(4000), 3.9 * grow(2000));
}

}  // namespace

}  // namespace montelux::test
