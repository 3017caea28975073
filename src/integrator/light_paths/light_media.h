// The media in which rays leave the lights.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "accel/accel.h"
#include "scene/scene.h"
#include "transport/media.h"

namespace montelux {

// A surface that bounds media states those on its sides. The medium around any other light follows from the boundaries
// that a straight line from the camera to the light crosses: as a path from the camera would find it.
class LightMedia {
 public:
  LightMedia(const Scene& scene, const Accel& accel);

  // Around a ray that leaves the light; `outside`: on the side of its surface to which the oriented normal points.
  template <class F>
  Media<F> around(const MediumSet& media, Uint<F> light, Mask<F> outside, Mask<F> on) const {
    using U = Uint<F>;
    const U place = select(on, light, U(0u)) * U(2u) + select(outside, U(1u), U(0u));
    return media_of<F>(media, gather(sides_.data(), place));
  }
  // The number of the medium on the outside of a light.
  std::uint32_t outside(std::uint32_t light) const { return sides_[2 * std::size_t(light) + 1]; }

 private:
  std::vector<std::uint32_t> sides_;  // of each light: inside, outside
};

// Those of a scene; none if it has no media, or no lights.
std::optional<LightMedia> light_media(const Scene& scene, const Accel& accel);

// Whether light from beyond the scene comes through a medium that no boundary ends: how much of it arrives is not
// defined by the scene.
bool shines_through_endless_medium(const Scene& scene, const Accel& accel);

}  // namespace montelux
