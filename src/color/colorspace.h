// CIE XYZ, and RGB colour spaces as defined by their primaries and white.
#pragma once
#include <optional>
#include <string_view>
#include <vector>

#include "color/rgb.h"

namespace montelux {

// Tristimulus values of the CIE 1931 observer; Y of a perfect white is one.
struct Xyz {
  double x = 0.0, y = 0.0, z = 0.0;
};

struct Chromaticity {
  double x = 0.0, y = 0.0;
};
Chromaticity chromaticity(const Xyz& color);
// The colour of the given chromaticity with Y = 1.
Xyz unit_luminance(const Chromaticity& c);

struct Matrix3 {
  double m[3][3];
};
Matrix3 operator*(const Matrix3& a, const Matrix3& b);
// The matrix must not be singular.
Matrix3 inverse(const Matrix3& a);
Xyz operator*(const Matrix3& a, const Xyz& v);
Rgb operator*(const Matrix3& a, const Rgb& v);

struct ColorSpace {
  std::string_view name;
  Chromaticity red, green, blue, white;
};

// "srgb" (IEC 61966-2-1), "dci-p3" (its primaries with the white D65, as displays use it), "rec2020" (ITU-R BT.2020)
// and "aces2065-1" (SMPTE ST 2065-1, white near D60).
std::optional<ColorSpace> color_space(std::string_view name);
std::vector<std::string_view> color_spaces();

// The matrix that takes linear components to XYZ: (1, 1, 1) becomes the white with Y = 1 (SMPTE RP 177:1993).
Matrix3 to_xyz(const ColorSpace& space);

// Linear components of emitted light to linear sRGB by way of XYZ, without adaptation: a white light of a space with
// another white stays tinted, as an eye adapted to D65 sees it.
Matrix3 emission_to_srgb(const ColorSpace& space);
// Linear components of a reflectance to linear sRGB with the white adapted to D65 (Bradford; Lam 1985), so that a
// perfect white stays (1, 1, 1).
Matrix3 reflectance_to_srgb(const ColorSpace& space);

// XYZ to linear sRGB and back.
Rgb to_srgb(const Xyz& color);
Xyz to_xyz(const Rgb& color);

}  // namespace montelux
