#include "light/adder.h"

namespace montelux {

float factor_for(const std::optional<float>& wanted, float present) {
  return wanted && *wanted > 0 && present > 0 ? *wanted / present : 1.0f;
}

std::shared_ptr<const LightImage> LightAdder::image(const std::string& name, bool must_be_square) const {
  if (name.empty()) return nullptr;
  auto image = inputs_.image(name, light_.where);
  if (!image) {
    error("the image \"" + name + "\" of the " + std::string(name_of(light_.model)) + " light cannot be read");
  } else if (image->width < 1 || image->height < 1 ||
             image->texels.size() != std::size_t(image->width) * std::size_t(image->height)) {
    error("the image \"" + name + "\" is empty");
  } else if (must_be_square && image->width != image->height) {
    error("the image \"" + name + "\" has " + std::to_string(image->width) + " x " + std::to_string(image->height) +
              " pixels, but an equal-area image of directions is square",
          "convert a longitude-latitude map to the equal-area octahedral form first");
  } else {
    for (const Rgb& t : image->texels)
      if (!is_finite(t[0] + t[1] + t[2])) {
        error("the image \"" + name + "\" has pixels that are not finite");
        return nullptr;
      }
    return image;
  }
  return nullptr;
}

}  // namespace montelux
