// The numbers of a path as a parameter of the path loop: a path that is traced by recorded numbers is the path that the
// sampler's numbers gave.
#include "transport/numbers.h"

#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "integrator/path/loop.h"
#include "render_scenes.h"

namespace montelux::test {

namespace {

constexpr int recorded_dimensions = 64;

// A scene with a coloured wall, a lamp and a glass ball: deep paths of all kinds of vertices.
constexpr std::string_view scene_text = R"(
LookAt 0 0 4  0 0 0  0 1 0
Camera "perspective" "float fov" 50
Sampler "independent"
Film "rgb" "integer xresolution" 8 "integer yresolution" 8
WorldBegin
AttributeBegin
AreaLightSource "diffuse" "rgb L" [ 5 4 3 ]
Translate 0 1.5 1
Shape "sphere" "float radius" 0.3
AttributeEnd
Material "diffuse" "rgb reflectance" [ 0.8 0.5 0.2 ]
Shape "bilinearmesh" "point3 P" [ -2 -2 -1  2 -2 -1  -2 2 -1  2 2 -1 ]
Shape "bilinearmesh" "point3 P" [ -2 -1.2 -1  2 -1.2 -1  -2 -1.2 3  2 -1.2 3 ]
Material "dielectric" "float eta" 1.5
Shape "sphere" "float radius" 0.7
)";

// The numbers that a sampler gives, lane by lane.
template <class F>
class Recording {
 public:
  explicit Recording(const Sampler<F>& sampler) {
    for (std::uint32_t d = 0; d < recorded_dimensions; ++d) {
      const F value = sampler.get1(Uint<F>(d));
      for (int k = 0; k < lanes_of<F>; ++k) values.push_back(lane(value, k));
    }
  }
  std::vector<float> values;
};

// One path a lane, which starts at a camera ray of the pixel of its lane.
template <class F, class Numbers>
struct OneStart {
  const Scene& scene;
  const Accel& accel;
  const TilePass& pass;
  PathSite<F> site;
  const Numbers& own;
  bool started = false;

  Mask<F> refill(PathState<F>& path, Mask<F> on) {
    if (std::exchange(started, true)) return on;
    PathStart<F> start = start_of_path<F>(scene, pass, site, own);
    start.output = site.x;
    const auto [found, hit] =
        accel.trace<F>({start.o, start.d, F(ray_infinity), start.time}, Mask<F>(true), RayUse::camera);
    start.hit = hit;
    begin_paths(path, start, no_media<F>(), found);
    return found;
  }
  const Numbers& numbers(const PathState<F>&) const { return own; }
};

template <class F, class Numbers>
std::vector<PixelSample> trace_with(const TestScene& scene, const TilePass& pass, const PathSite<F>& site,
                                    const Numbers& numbers) {
  std::vector<PixelSample> out(lanes_of<F>);
  OneStart<F, Numbers> source{scene.scene(), scene.accel(), pass, site, numbers};
  PathSettings settings;
  run_paths<F>(scene.scene(), scene.scene().lights, scene.accel(), settings, pass, std::span(out), source, no_tally);
  return out;
}

template <class F>
PathSite<F> sites_of_row(int row) {
  return {lane_index<F>(), Uint<F>(std::uint32_t(row)), Uint<F>(0u)};
}

template <class F>
void expect_replay_is_exact() {
  const TestScene scene(scene_text);
  int bright = 0;
  for (int row = 0; row < 8; ++row) {
    const PathSite<F> site = sites_of_row<F>(row);
    const TilePass pass{{0, row, lanes_of<F>, row + 1}, {PointSetKind::independent, 7, 0, 1}};
    const Sampler<F> sampler(pass.points, site.x, site.y, site.index);
    const Recording<F> recording(sampler);
    const std::vector<PixelSample> first = trace_with<F>(scene, pass, site, sampler);
    const std::vector<PixelSample> again =
        trace_with<F>(scene, pass, site, RecordedNumbers<F>(recording.values, sampler.own()));
    // One number differs in the first lane: the place on the film.
    Recording<F> mutated(sampler);
    mutated.values[0] = mutated.values[0] < 0.5f ? 0.9f : 0.1f;
    const std::vector<PixelSample> other =
        trace_with<F>(scene, pass, site, RecordedNumbers<F>(mutated.values, sampler.own()));
    for (int k = 0; k < lanes_of<F>; ++k)
      for (int c = 0; c < 3; ++c) {
        const auto value = [&](const std::vector<PixelSample>& of) { return of[std::size_t(k)].radiance.c[c]; };
        EXPECT_EQ(value(first), value(again)) << row << " " << k;
        if (k > 0) {
          EXPECT_EQ(value(first), value(other)) << row << " " << k;
        }
        bright += value(first) > 0;
      }
    if (first[0].radiance.c[0] > 0) {
      EXPECT_NE(first[0].radiance.c[0], other[0].radiance.c[0]);
    }
  }
  EXPECT_GT(bright, 3);
}

}  // namespace

TEST(RecordedNumbers, replay_a_path_exactly) { expect_replay_is_exact<float>(); }
TEST(RecordedNumbers, replay_a_pack_of_paths_exactly) { expect_replay_is_exact<NativeFloats>(); }

TEST(RecordedNumbers, choose_a_stream_by_its_coordinate) {
  const RandomStream<float> beyond(3, 4);
  const auto first_number = [&](float coordinate) {
    const std::vector<float> values{0.5f, coordinate};
    return RecordedNumbers<float>(values, beyond).stream(1).at(0);
  };
  EXPECT_EQ(first_number(0), beyond.fork(1).at(0));
  constexpr int cells = RecordedNumbers<float>::cells, within = 8;
  std::set<float> all;
  for (int i = 0; i < cells * within; ++i) {
    const float number = first_number((float(i) + 0.5f) / (cells * within));
    EXPECT_EQ(number, first_number(float(i / within) / cells));
    all.insert(number);
  }
  EXPECT_EQ(all.size(), std::size_t(cells));
}

TEST(RecordedNumbers, beyond_the_record_are_those_of_the_stream) {
  const std::vector<float> values{0.25f, 0.5f};
  const RandomStream<float> beyond(3, 4);
  const RecordedNumbers<float> numbers(values, beyond);
  EXPECT_EQ(numbers.get1(1), 0.5f);
  EXPECT_EQ(numbers.get2(1).x, 0.5f);
  EXPECT_EQ(numbers.get2(1).y, beyond.at(2));
  EXPECT_EQ(numbers.get1(100), beyond.at(100));
}

}  // namespace montelux::test
