// The plan of the numbers of a path: no two decisions share a coordinate or a stream.
#include "transport/dimensions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace montelux::test {
namespace {

// The first of consecutive numbers, and how many they are.
struct Place {
  std::uint32_t first, count = 1;
};

bool have_no_number_twice(const std::vector<Place>& places) {
  std::vector<std::uint32_t> numbers;
  for (const Place& place : places)
    for (std::uint32_t i = 0; i < place.count; ++i) numbers.push_back(place.first + i);
  std::ranges::sort(numbers);
  return std::ranges::adjacent_find(numbers) == numbers.end();
}

// More than paths have: roulette ends them long before.
constexpr std::uint32_t vertices = 2000, crossings = 600;

std::vector<Place> coordinates_of_camera_paths() {
  using namespace path_dimension;
  std::vector<Place> places{{film, 2}, {lens, 2}, {time}, {rough_direction, 2}};
  for (std::uint32_t v = 0; v < vertices; ++v) {
    const std::uint32_t at = first_vertex + v * per_vertex;
    for (const Place& place :
         {Place{light_point, 2}, Place{direction, 2}, Place{light_choice}, Place{lobe}, Place{roulette}})
      places.push_back({at + place.first, place.count});
    for (std::uint32_t c = 0; c < crossings; ++c) places.push_back({at + c * per_crossing + distance, 2});
  }
  return places;
}
std::vector<Place> streams_of_camera_paths() {
  using namespace path_dimension;
  std::vector<Place> places{{reuse}};
  for (std::uint32_t v = 0; v < vertices; ++v)
    for (std::uint32_t c = 0; c < crossings; ++c)
      places.push_back({first_vertex + v * per_vertex + c * per_crossing + own});
  return places;
}
std::vector<Place> coordinates_of_light_paths() {
  using namespace light_dimension;
  std::vector<Place> places{{point, 2}, {direction, 2}, {lens, 2}, {choice}, {time}};
  for (std::uint32_t v = 0; v < vertices; ++v) {
    const std::uint32_t at = first_vertex + v * per_vertex;
    for (const Place& place : {Place{vertex_lens, 2}, Place{vertex_direction, 2}, Place{lobe}, Place{roulette}})
      places.push_back({at + place.first, place.count});
    for (std::uint32_t c = 0; c < crossings; ++c)
      places.push_back({at + distance + c * path_dimension::per_crossing, 2});
  }
  return places;
}
std::vector<Place> streams_of_light_paths() {
  using namespace light_dimension;
  std::vector<Place> places{{lens}};
  for (std::uint32_t v = 0; v < vertices; ++v)
    for (std::uint32_t stream : {vertex_lens, own}) places.push_back({first_vertex + v * per_vertex + stream});
  return places;
}

TEST(PlanOfNumbers, gives_each_decision_of_a_path_its_own) {
  EXPECT_TRUE(have_no_number_twice(coordinates_of_camera_paths()));
  EXPECT_TRUE(have_no_number_twice(streams_of_camera_paths()));
  EXPECT_TRUE(have_no_number_twice(coordinates_of_light_paths()));
  EXPECT_TRUE(have_no_number_twice(streams_of_light_paths()));
  using namespace element_dimension;
  EXPECT_TRUE(have_no_number_twice({{place, 2}, {direction, 2}, {light_choice}, {light_point, 2}}));
}
TEST(PlanOfNumbers, shows_a_number_that_two_decisions_share) {
  std::vector<Place> places = coordinates_of_camera_paths();
  // A second number for the choice of a lobe reaches that of roulette.
  places.push_back({path_dimension::first_vertex + path_dimension::lobe + 1});
  EXPECT_FALSE(have_no_number_twice(places));
  places = streams_of_camera_paths();
  places.push_back({path_dimension::reuse});
  EXPECT_FALSE(have_no_number_twice(places));
}

}  // namespace
}  // namespace montelux::test
