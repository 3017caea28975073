// Short sequences with a camera and a thing that move, and how they are measured: picture by picture over independent
// series, each of which continues its own of the previous image.
#pragma once
#include "pass_means.h"
#include "reuse_scenes.h"

namespace montelux::test {

inline constexpr int sequence_pictures = 5;

// The shutter of a picture: open for half of its share of the transforms' time.
inline Shutter sequence_shutter(int picture) {
  return {float(picture) / sequence_pictures, (float(picture) + 0.5f) / sequence_pictures};
}

// The camera pans past a screen, whose far side comes into sight, a box turns and slides over the floor (or stands),
// and slats throw shadows that pixels share unevenly.
inline std::string sequence_scene(int size, bool box_moves = true, int max_depth = 2) {
  std::string slats;
  for (int i = 0; i < 6; ++i)
    slats += fmt::format("Shape \"bilinearmesh\" \"point3 P\" [ {0} 1.1 -2  {1} 1.1 -2  {0} 1.1 2  {1} 1.1 2 ]\n",
                         -2 + 0.7 * i, -2 + 0.7 * i + 0.4);
  const char* moving = R"(ActiveTransform StartTime
Translate -0.9 0.3 0.2
ActiveTransform EndTime
Translate 0.7 0.3 -0.5
Rotate 80 0 1 0
ActiveTransform All)";
  return moving_camera_head(size, "-0.6 1 -4  -0.5 0.5 0  0 1 0", "0.9 1.2 -3.7  0.4 0.5 0  0 1 0", 45) +
         fmt::format(R"(Integrator "path" "integer maxdepth" [ {2} ]
WorldBegin
AttributeBegin
AreaLightSource "diffuse" "rgb L" [ 14 10 7 ]
Shape "bilinearmesh" "point3 P" [ -1.5 2.5 -0.3  -0.9 2.5 -0.3  -1.5 2.5 0.3  -0.9 2.5 0.3 ]
AttributeEnd
AttributeBegin
Translate 1.2 2.2 -0.6
AreaLightSource "diffuse" "rgb L" [ 5 8 16 ]
Shape "sphere" "float radius" [ 0.2 ]
AttributeEnd
Material "diffuse" "rgb reflectance" [ 0.6 0.5 0.4 ]
Shape "bilinearmesh" "point3 P" [ -3 0 -3  3 0 -3  -3 0 3  3 0 3 ]
{0}
Material "diffuse" "rgb reflectance" [ 0.3 0.5 0.6 ]
Shape "bilinearmesh" "point3 P" [ -0.3 0 -1.2  0.2 0 -1.2  -0.3 0.9 -1.2  0.2 0.9 -1.2 ]
AttributeBegin
{1}
Material "diffuse" "rgb reflectance" [ 0.7 0.6 0.2 ]
Shape "trianglemesh" "integer indices" [ 0 1 2 0 2 3  4 6 5 4 7 6  0 4 5 0 5 1  1 5 6 1 6 2  2 6 7 2 7 3  3 7 4 3 4 0 ]
    "point3 P" [ -0.3 -0.3 -0.3  0.3 -0.3 -0.3  0.3 0.3 -0.3  -0.3 0.3 -0.3
                 -0.3 -0.3 0.3  0.3 -0.3 0.3  0.3 0.3 0.3  -0.3 0.3 0.3 ]
AttributeEnd
)",
                     slats, box_moves ? moving : "Translate 0.7 0.3 -0.5", max_depth);
}

// What is done to the memory of a series before the next picture has it, for planted faults.
using MemoryChange =
    std::function<std::shared_ptr<const SeriesMemory>(std::shared_ptr<const SeriesMemory>, int picture)>;

struct SequencePlan {
  int frames = 2;  // of a series
  int passes = 48;
  std::uint32_t seed = 1;
  BlockSize block{};
};

// Means over passes of each picture of the sequence.
inline std::vector<PassMeans> measure_sequence(const TestScene& scene, const ChosenIntegrator& chosen,
                                               const SequencePlan& plan, const MemoryChange& change = {}) {
  std::vector<PassMeans> pictures(sequence_pictures);
  RenderObserver silent;
  for (int pass = 0; pass < plan.passes; ++pass) {
    SeriesMemories memories;
    for (int picture = 0; picture < sequence_pictures; ++picture) {
      RenderSettings s =
          scene.settings(PointSetKind::blue_noise, {plan.frames, 1}, plan.seed * 1000 + std::uint32_t(picture), 0);
      s.plan.first_pass = pass, s.image.shutter = sequence_shutter(picture), s.sequence.memories = &memories;
      if (change && !memories.empty()) memories[0] = change(std::move(memories[0]), picture);
      add_pass(render(chosen.any(), s, silent).film, plan.block, pictures[std::size_t(picture)]);
    }
  }
  return pictures;
}

// Of the pictures after the first, which have a history: how many differ from the truth, at one level for all of them.
struct SequenceVerdict {
  int differ = 0;
  double smallest_p = 1, largest_difference = 0, largest_error = 0;  // the last two of the image, relative
  std::uint64_t non_finite = 0;
};
inline SequenceVerdict compare_sequence(const std::vector<PassMeans>& pictures, const std::vector<PassMeans>& truth,
                                        double level) {
  SequenceVerdict all;
  for (std::size_t i = 1; i < pictures.size(); ++i) {
    const MeansVerdict v = compare_means(pictures[i], truth[i], sidak_level(level, double(pictures.size() - 1)));
    all.differ += v.differ;
    all.smallest_p = std::min(all.smallest_p, v.smallest_p);
    if (std::abs(v.image_difference) > std::abs(all.largest_difference)) all.largest_difference = v.image_difference;
    all.largest_error = std::max(all.largest_error, v.image_error);
    all.non_finite += pictures[i].non_finite;
  }
  return all;
}

}  // namespace montelux::test
