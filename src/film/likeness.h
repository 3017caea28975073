// How alike two pixels are, by what they show.
#pragma once

namespace montelux {

// Squared distances of albedos and of normals at which the weight of a neighbour is a quarter, and its share where it
// shows another object.
inline constexpr float like_albedo = 0.02f, like_normal = 0.1f, other_object = 0.1f;

// The weight of a neighbour: `near`, which is its weight by distance, lowered by the squared distances of albedos and
// normals and by another object.
inline float likeness(float near, float albedos, float normals, bool same_object) {
  const float alike = 1 / (1 + albedos * (1 / like_albedo) + normals * (1 / like_normal));
  return near * (same_object ? 1.0f : other_object) * alike * alike;
}

}  // namespace montelux
