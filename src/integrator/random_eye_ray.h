// Rays by which the scene is looked at before it is rendered.
#pragma once
#include "mc/random.h"
#include "scene/scene.h"

namespace montelux {

struct RandomEyeRay {
  Ray<float> ray;
  Vec2f lens;  // the point of the lens, as Camera::generate() takes it
};
// From any place of a picture of that many pixels, from any point of the lens, at any time.
inline RandomEyeRay random_eye_ray(const Scene& scene, int width, int height, RandomStream<float>& random) {
  const Vec2f place = random.next2(), lens = random.next2();
  const float time = scene.shutter.time(random.next());
  const Vec2f raster{place.x * float(width), place.y * float(height)};
  return {scene.camera.generate(raster, lens, time).ray, lens};
}

}  // namespace montelux
