// Which layers of light a picture is asked for.
#pragma once
#include <optional>
#include <string>

#include "image/layers.h"
#include "math/result.h"

namespace montelux {

struct LayerRequest {
  std::optional<int> bounces;  // told apart up to this one
  bool light_groups = false;
  bool errors = false;  // the standard error of each layer, too
  bool motion = false;  // between the pictures of a sequence
  bool of_light() const { return bounces || light_groups; }
};

// "bounces:3,light-groups,errors,motion". Fails where a word is unknown or nothing is asked for.
Result<LayerRequest> parse_layers(const std::string& text);
// The text of a request; empty where nothing is asked for.
std::string to_text(const LayerRequest& request);

}  // namespace montelux
