// What a scene file states about the image: its size, its samples, its integrator.
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
  PixelBounds crop;  // the part to render, within the image
  int samples = 16;  // per pixel
  std::uint32_t seed = 0;
  PointSetKind sampler = PointSetKind::blue_noise;
  std::string integrator;              // our integrator for what the file names, with settings as for --integrator
  std::optional<int> max_depth;        // if the file sets it
  std::optional<float> max_component;  // clamp of a sample's components, if the file sets it: biased
  LightSelection light_selection = LightSelection::bvh;
  double transforms_start = 0, transforms_end = 1;  // the time interval of motion
  double shutter_open = 0, shutter_close = 1;       // in the same unit
  float imaging_ratio = 1;                          // of the film's reading to radiance: exposure time x ISO / 100
  std::string file;                                 // output file, as stated by the film; may be empty
  bool pixel_centres = false;                       // all samples at the pixel's centre: biased
};

// What is wrong with the size of an image, in pixels; empty if it is valid. The limit applies to every image, wherever
// its size is stated.
inline constexpr int max_picture_side = 65536;
std::string size_complaint(std::int64_t width, std::int64_t height);

// `resolution` overrides that of the film. Notes state substitutes for names that Montelux does not have.
PictureSettings picture_settings(const SceneDesc& scene, std::optional<std::pair<int, int>> resolution,
                                 Diagnostics& diagnostics);

}  // namespace montelux
