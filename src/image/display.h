// From linear radiance, and from the other numbers that a picture holds, to the 8 bits of a display.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "image/color_map.h"
#include "image/image_file.h"
#include "image/pixel_buffer.h"

namespace montelux {

// How the range of radiance is pressed into [0, 1] before the sRGB transfer function.
enum class ToneCurve {
  // Values above one are cut off.
  clip,
  // The filmic curve of Hable (2010, "Uncharted 2: HDR Lighting"), white point 11.2, exposure bias 2.
  hable,
  // The fit of Narkowicz (2015, "ACES Filmic Tone Mapping Curve") to the ACES reference transform.
  aces,
};

// What the numbers of a layer are, and so how they are shown where nothing else is asked for:
//   light      radiance: by exposure and tone curve;
//   share      in [0, 1] (reflectance, coverage): as it is;
//   direction  components in [-1, 1]: (x + 1) / 2, encoded; the zero vector (nothing is there) is black;
//   position   components from the least to the largest of all three;
//   distance   false colours from the 1st to the 99th percentile; 0 and what is not finite (nothing is there) is black;
//   amount     false colours from 0 to the 99th percentile: of several channels their mean, of two their length;
//   number     a colour for each number; 0 is black;
//   encoded    in [0, 1], and so held by the bytes themselves, without a transfer function, as directions are.
enum class Content { light, share, direction, position, distance, amount, number, encoded };
inline constexpr std::array<std::string_view, 8> content_names{"light",    "share",  "direction", "position",
                                                               "distance", "amount", "number",    "encoded"};
// Of a layer of this name; light for names that are not known.
Content content_of_layer(std::string_view name);

// An interval of values, shown from black or the first colour of a map to white or the last.
struct ValueRange {
  float low = 0, high = 1;
};

// What is asked of a display; what is not stated follows from the picture.
struct DisplayRequest {
  std::optional<float> exposure;  // stops
  bool automatic_exposure = false;
  std::optional<ToneCurve> curve;
  std::optional<ValueRange> range;
  bool automatic_range = false;
  std::optional<ColorMap> map;
  bool no_map = false;  // the channels themselves, where false colours would be usual
};

// How a picture is shown, with nothing left to choose.
struct DisplayTransform {
  // Stops: the image is multiplied by 2^exposure.
  float exposure = 0.0f;
  ToneCurve curve = ToneCurve::clip;
  // Instead of exposure and curve.
  std::optional<ValueRange> range{};
  std::optional<ColorMap> map{};  // of one value a pixel
  Content content = Content::light;
};

// A transform, and what of it was chosen by the picture.
struct ChosenDisplay {
  DisplayTransform transform;
  bool exposure_chosen = false, range_chosen = false;
};

// What a request means for this picture. Where light has no exposure that somebody stated (`has_own_exposure`: the
// scene does, or the file is one for display) and more than 95 % of the lit pixels would be black or white, it gets
// automatic_exposure(). Exposure or tone curve that is asked for shows any layer as light, range or map show light by
// them.
ChosenDisplay choose_display(const PixelBuffer& image, Content content, const DisplayRequest& request,
                             bool has_own_exposure);

// In stops, to a tenth: takes the log-average of the luminance to the key 0.18 (Reinhard, Stark, Shirley and Ferwerda
// 2002, eq. 1 and 2), over pixels up to the 99th percentile, so that fireflies and lamps do not count, and down to
// 1e-4 of it, so that almost black ones do not. 0 where no pixel is lit.
float automatic_exposure(const PixelBuffer& image);

// The curve alone, on a linear value; the result is in [0, 1]. Not a number gives 0, infinity 1.
float apply_curve(ToneCurve curve, float linear);

// The colour channels of an image as a picture for display; one channel stays gray without a map. Alpha is ignored.
DisplayImage to_display(const PixelBuffer& image, const DisplayTransform& transform = {});

// "exposure -12.3 EV, chosen automatically": what was chosen by the picture, for a log; empty where nothing was.
std::string choice_text(const ChosenDisplay& chosen);

}  // namespace montelux
