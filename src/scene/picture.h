// What a scene file asks of the picture: its size, its samples, its integrator.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "image/pixel_sample.h"
#include "light/light.h"
#include "mc/point_set.h"
#include "scene/description.h"

namespace montelux {

struct PictureSettings {
  int width = 1280, height = 720;
  PixelBounds crop;  // the part to render, within the picture
  int samples = 16;  // a pixel
  std::uint32_t seed = 0;
  PointSetKind sampler = PointSetKind::blue_noise;
  std::string integrator;              // ours, that serves what the file names, with settings as --integrator has them
  std::optional<int> max_depth;        // where the file sets it
  std::optional<float> max_component;  // clamp of a sample's components, where the file sets it: biased
  LightSelection light_selection = LightSelection::bvh;
  double transforms_start = 0, transforms_end = 1;  // the time in which what moves goes its way
  double shutter_open = 0, shutter_close = 1;       // in the same unit
  float imaging_ratio = 1;                          // of the film's reading to radiance: exposure time x ISO / 100
  std::string file;                                 // picture to write, as the film states it; may be empty
  bool pixel_centres = false;                       // all samples at the pixel's centre: biased
};

// What is wrong with the size of a picture, in pixels; empty where nothing is. Every picture is held to it, whoever
// states its size.
inline constexpr int max_picture_side = 65536;
std::string size_complaint(std::int64_t width, std::int64_t height);

// `resolution` takes the place of the film's. Notes say what serves a name that Montelux lacks.
PictureSettings picture_settings(const SceneDesc& scene, std::optional<std::pair<int, int>> resolution,
                                 Diagnostics& diagnostics);

}  // namespace montelux
