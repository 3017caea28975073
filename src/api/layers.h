// The requested layers of light.
#pragma once
#include <optional>
#include <string>

#include "image/layers.h"
#include "math/result.h"
#include "scene/scene.h"

namespace montelux {

struct LayerRequest {
  std::optional<int> bounces;  // separate up to this one
  bool light_groups = false;
  std::optional<int> strategies;  // of bidirectional integrators, separate up to this bounce
  bool alone = false;             // each of these also by itself, without the weight by which they share the light
  bool errors = false;            // the standard error of each layer, too
  bool motion = false;            // between the pictures of a sequence
  bool halves = false;            // the colours and features of both halves of the passes
  bool intervals = false;         // that contain the expectations of the pixels
  bool of_light() const { return bounces || light_groups || strategies; }
};

// States the light groups of a scene in a plan; light that media emit has a group of its own, "media".
void state_light_groups(LayerPlan& plan, const Scene& scene);

// "bounces:3,light-groups,strategies:2,alone,errors,motion,halves,intervals". Fails if a word is unknown or nothing is
// requested.
Result<LayerRequest> parse_layers(const std::string& text);
// The text of a request; empty where nothing is requested.
std::string to_text(const LayerRequest& request);

}  // namespace montelux
