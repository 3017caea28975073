// From linear radiance, and the other quantities that an image contains, to the 8 bits of a display.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "image/color_map.h"
#include "image/image_file.h"
#include "image/pixel_buffer.h"

namespace montelux {

// How the range of radiance is compressed to [0, 1] before the sRGB transfer function.
enum class ToneCurve {
  // Values above one are cut off.
  clip,
  // The filmic curve of Hable (2010, "Uncharted 2: HDR Lighting"), white point 11.2, exposure bias 2.
  hable,
  // The fit of Narkowicz (2015, "ACES Filmic Tone Mapping Curve") to the ACES reference transform.
  aces,
};

// What the numbers of a layer mean, which decides how they are shown by default:
//   light      radiance: by exposure and tone curve;
//   share      in [0, 1] (reflectance, coverage): unchanged;
//   direction  components in [-1, 1]: (x + 1) / 2, encoded; the zero vector (nothing) is black;
//   position   components from the minimum to the maximum of all three;
//   distance   false colours from the 1st to the 99th percentile; 0 and non-finite values (nothing) are black;
//   amount     false colours from 0 to the 99th percentile: the mean of several channels, the length of two;
//   number     a colour for each number; 0 is black;
//   encoded    in [0, 1], stored in the bytes without a transfer function, as directions are.
enum class Content { light, share, direction, position, distance, amount, number, encoded };
inline constexpr std::array<std::string_view, 8> content_names{"light",    "share",  "direction", "position",
                                                               "distance", "amount", "number",    "encoded"};
// The content of a layer with this name; light for unknown names.
Content content_of_layer(std::string_view name);

// An interval of values, shown from black, or the first colour of a map, to white, or the last.
struct ValueRange {
  float low = 0, high = 1;
};

// What the user requests of a display; everything else follows from the image.
struct DisplayRequest {
  std::optional<float> exposure;  // stops
  bool automatic_exposure = false;
  std::optional<ToneCurve> curve;
  std::optional<ValueRange> range;
  bool automatic_range = false;
  std::optional<ColorMap> map;
  bool no_map = false;  // the channels themselves, even where false colours are the default
};

// How an image is shown, completely determined.
struct DisplayTransform {
  // Stops: the image is multiplied by 2^exposure.
  float exposure = 0.0f;
  ToneCurve curve = ToneCurve::clip;
  // Instead of exposure and curve.
  std::optional<ValueRange> range{};
  std::optional<ColorMap> map{};  // of one value per pixel
  Content content = Content::light;
};

// A transform, and which parts of it were chosen automatically.
struct ChosenDisplay {
  DisplayTransform transform;
  bool exposure_chosen = false, range_chosen = false;
};

// Completes a request for this image. If the exposure of light was not stated explicitly (`has_own_exposure`: the
// scene states one, or the file is for display) and more than 95 % of the lit pixels would be black or white, it is
// automatic_exposure(). A requested exposure or tone curve shows any layer as light; a requested range or map shows
// light as data.
ChosenDisplay choose_display(const PixelBuffer& image, Content content, const DisplayRequest& request,
                             bool has_own_exposure);

// In stops, rounded to a tenth: maps the log-average of the luminance to the key 0.18 (Reinhard, Stark, Shirley and
// Ferwerda 2002, eq. 1 and 2), over pixels up to the 99th percentile, which excludes fireflies and lamps, and down to
// 1e-4 of it, which excludes almost black pixels. 0 if no pixel is lit.
float automatic_exposure(const PixelBuffer& image);

// The curve alone, on a linear value; the result is in [0, 1]. Not a number gives 0, infinity 1.
float apply_curve(ToneCurve curve, float linear);

// The colour channels of an image as an image for display; a single channel stays grey without a map. Alpha is ignored.
DisplayImage to_display(const PixelBuffer& image, const DisplayTransform& transform = {});

// "exposure -12.3 EV, chosen automatically": the automatic choices, for a log; empty if there are none.
std::string choice_text(const ChosenDisplay& chosen);

}  // namespace montelux
