// The values of which scenes are made.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace montelux::api {

struct Vec2 {
  float x = 0, y = 0;
};

// A point, a direction or a normal, by what it is used for. Lengths are in the scene's unit; the world is left-handed.
struct Vec3 {
  float x = 0, y = 0, z = 0;
};

// Linear components in the primaries of sRGB with white D65: a reflectance, a radiance in W/(m^2 sr), or a factor, by
// what it is used for.
struct Rgb {
  float r = 0, g = 0, b = 0;
};

// A spectrum by samples, linear between them.
struct SampledSpectrum {
  std::vector<float> wavelengths;  // nm, rising
  std::vector<float> values;       // as many
};

// A measured spectrum by its name: "metal-Cu-eta", "glass-BK7", "stdillum-D65".
struct NamedSpectrum {
  std::string name;
};

// Thermal emission, scaled to luminance 1.
struct Blackbody {
  float kelvin = 6500;
};

// Parts of one Scene, as its functions return them.
enum class MaterialId : std::uint32_t {};
enum class MediumId : std::uint32_t {};
enum class TextureId : std::uint32_t {};
enum class ObjectId : std::uint32_t {};

// A value of a parameter, of any type that a parameter may have. Integers serve where a number is meant; any other
// mismatch is reported by prepare().
class Value {
 public:
  using Data = std::variant<std::vector<bool>, std::vector<int>, std::vector<double>, std::vector<std::string>,
                            std::vector<Vec2>, std::vector<Vec3>, std::vector<Rgb>, std::vector<MaterialId>,
                            SampledSpectrum, NamedSpectrum, Blackbody, TextureId>;

  template <class T>
  requires std::is_same_v<T, bool> Value(T value) : data_(std::vector<bool>{value}) {}
  Value(int value) : data_(std::vector{value}) {}
  Value(double value) : data_(std::vector{value}) {}
  Value(const char* value) : data_(std::vector<std::string>{value}) {}
  Value(std::string value) : data_(std::vector{std::move(value)}) {}
  Value(Vec2 value) : data_(std::vector{value}) {}
  Value(Vec3 value) : data_(std::vector{value}) {}
  Value(Rgb value) : data_(std::vector{value}) {}
  Value(SampledSpectrum value) : data_(std::move(value)) {}
  Value(NamedSpectrum value) : data_(std::move(value)) {}
  Value(Blackbody value) : data_(value) {}
  Value(TextureId value) : data_(value) {}
  Value(std::vector<int> values) : data_(std::move(values)) {}
  Value(std::vector<double> values) : data_(std::move(values)) {}
  Value(std::vector<std::string> values) : data_(std::move(values)) {}
  Value(std::vector<Vec2> values) : data_(std::move(values)) {}
  Value(std::vector<Vec3> values) : data_(std::move(values)) {}
  Value(std::vector<MaterialId> values) : data_(std::move(values)) {}

  const Data& data() const { return data_; }

 private:
  Data data_;
};

struct Parameter {
  std::string name;
  Value value;
};
using Parameters = std::vector<Parameter>;

// A material, a light, ... by Montelux's name, with its parameters: Model{"conductor", {{"roughness", 0.1}}}. Names,
// ranges and defaults are those of `montelux list` (docs/formats.md); what is not stated has its default.
struct Model {
  std::string name;
  Parameters parameters{};
};

// An affine map: a 4 x 4 matrix in row-major order that acts on column vectors; the last row is 0 0 0 1.
struct Transform {
  std::array<double, 16> m{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
};
// a * b: first b, then a.
Transform operator*(const Transform& a, const Transform& b);
Transform translate(double x, double y, double z);
Transform scale(double x, double y, double z);
// By the right-hand rule about the axis, which must not be zero; degrees.
Transform rotate(double degrees, double x, double y, double z);
// From camera space (x to the right of the picture, y up, z into it) to the world: the camera stands at `eye`. The
// target must be elsewhere and not in the direction of `up`; prepare() reports a transform without an inverse.
Transform look_at(Vec3 eye, Vec3 target, Vec3 up);

}  // namespace montelux::api
