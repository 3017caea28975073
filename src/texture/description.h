// Textures as stated by a scene: plain data. Inputs are values or the names of textures stated before. A texture is of
// numbers or of spectra; a number that a texture of spectra takes is the same in all components.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "color/transfer.h"
#include "math/transform.h"
#include "parameter/input.h"
#include "texture/wrap.h"

namespace montelux {

enum class MappingKind { uv, spherical, cylindrical, planar };

// From a point of a surface to the position (s, t) in the plane of a texture.
struct MappingDesc {
  MappingKind kind = MappingKind::uv;
  float u_scale = 1, v_scale = 1;                   // of uv: s = u_scale u + u_delta
  float u_delta = 0, v_delta = 0;                   // of uv and planar
  std::optional<std::array<float, 6>> uv_matrix{};  // of uv, instead: the rows of an affine map
  Vec3f s_axis{1, 0, 0}, t_axis{0, 1, 0};           // of planar, in the space of the texture
};

// One value everywhere.
struct ConstantTextureDesc {
  ValueInput value = 1.0f;
};

// The product of two textures.
struct ScaleTextureDesc {
  ValueInput texture = 1.0f;
  NumberInput factor = 1.0f;
};

// Interpolation between two textures.
struct MixTextureDesc {
  ValueInput first = 0.0f, second = 1.0f;
  NumberInput amount = 0.5f;  // share of the second
};

// 1 where a texture is at least as large as a number, else 0; of numbers alone.
struct ThresholdTextureDesc {
  NumberInput texture = 1.0f;
  float edge = 0.5f;
};

// Interpolation by the angle of the normal.
struct DirectionMixTextureDesc {
  ValueInput along = 0.0f, across = 1.0f;
  Vec3f direction{0, 1, 0};  // in the space of the texture; not zero
};

// How texels are interpolated. Prefilters are replaced by bilinear interpolation.
enum class TextureFilter { point, bilinear, trilinear, ewa };
enum class ImageChannel { r, g, b, a };

// An image.
struct ImageTextureDesc {
  std::string file{};  // it is needed
  Wrap wrap = Wrap::repeat;
  std::array<Fold, 2> folds{};            // along u and v, in place of `wrap`
  std::optional<ImageChannel> channel{};  // of a texture of numbers; none: alpha if there is one, else the mean
  SpectrumValue tint = gray_value(1);     // factor, of a texture of spectra
  float scale = 1;                        // factor
  bool invert = false;                    // 1 - value
  TextureFilter filter = TextureFilter::bilinear;
  std::optional<ColorEncoding> encoding{};  // of images of integers; none: sRGB. Floats are linear
  MappingDesc mapping{};
};

// Checks of size 1.
struct CheckerboardTextureDesc {
  int dimension = 2;  // 2, by the mapping, or 3, in the space of the texture
  ValueInput even = 1.0f, odd = 0.0f;
  MappingDesc mapping{};
};

// Bilinear interpolation of the values at four corners (u, v).
struct BilerpTextureDesc {
  ConstantInput v00 = 0.0f, v01 = 1.0f, v10 = 0.0f, v11 = 1.0f;
  MappingDesc mapping{};
};

// Discs at random positions.
struct DotsTextureDesc {
  ValueInput inside = 1.0f, outside = 0.0f;
  MappingDesc mapping{};
};

// Sums of octaves of noise.
struct OctavesDesc {
  int octaves = 8;
  float roughness = 0.5f;  // factor from one octave to the next
};

// Fractional Brownian motion; of numbers alone.
struct FbmTextureDesc {
  OctavesDesc noise{};
};

// Sums of absolute values of noise; of numbers alone.
struct WrinkledTextureDesc {
  OctavesDesc noise{};
};

// Waves of varying height; of numbers alone.
struct WindyTextureDesc {};

// Veins of marble; of spectra alone.
struct MarbleTextureDesc {
  OctavesDesc noise{};
  float scale = 1;         // factor of space
  float variation = 0.2f;  // strength of the veins
};

using TextureModel =
    std::variant<ConstantTextureDesc, ScaleTextureDesc, MixTextureDesc, ThresholdTextureDesc, DirectionMixTextureDesc,
                 ImageTextureDesc, CheckerboardTextureDesc, BilerpTextureDesc, DotsTextureDesc, FbmTextureDesc,
                 WrinkledTextureDesc, WindyTextureDesc, MarbleTextureDesc>;
// The name by which files and programs state it.
std::string_view name_of(const TextureModel& model);
// Whether a texture of spectra, or of numbers, can be of this model.
bool can_be(const TextureModel& model, bool is_spectrum);

struct TextureDesc {
  std::string name;
  bool is_spectrum = false;  // false: a texture of numbers
  TextureModel model{};
  Transform texture_to_world{};
  SourceLocation where{};
};

}  // namespace montelux
