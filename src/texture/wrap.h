// What lies beyond the edges of an image.
#pragma once

namespace montelux {

// octahedral: the image is an equal-area map of the sphere and continues across its edges.
enum class Wrap { repeat, black, clamp, octahedral };

// Along one axis, if it differs from `Wrap`.
enum class Fold { none, clamp, mirror };

}  // namespace montelux
