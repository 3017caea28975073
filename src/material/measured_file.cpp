#include "material/measured_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <stdexcept>

#include "color/sampled_spectrum.h"
#include "material/tensor_file.h"

namespace montelux {

namespace {

// What is found in no measurement, and whose products might overflow.
constexpr float max_value = 1e9f;

constexpr std::size_t max_wavelengths = 10000;
constexpr std::uint64_t max_side = 65536;  // of a grid

struct Invalid : std::runtime_error {
  using std::runtime_error::runtime_error;
};

std::string sizes_text(const std::vector<std::uint64_t>& sizes) { return fmt::format("{}", fmt::join(sizes, " x ")); }

// The numbers of a field.
struct Numbers {
  std::vector<std::uint64_t> sizes;
  std::vector<float> values;

  GridSize grid() const { return {std::uint32_t(sizes[sizes.size() - 1]), std::uint32_t(sizes[sizes.size() - 2])}; }
};

class FieldReader {
 public:
  explicit FieldReader(const std::vector<TensorField>& fields) : fields_(fields) {}

  bool has(std::string_view name) const { return find(name) != nullptr; }
  // Numbers within the limit. Throws Invalid, here and below.
  Numbers numbers(std::string_view name, std::size_t dimensions) const {
    const TensorField& field = of_type(name, TensorType::float32, "float32", dimensions);
    Numbers n{field.sizes, std::vector<float>(field.bytes.size() / sizeof(float))};
    if (n.values.empty()) throw Invalid(fmt::format("field '{}' is empty", name));
    std::memcpy(n.values.data(), field.bytes.data(), field.bytes.size());
    for (std::size_t i = 0; i < n.values.size(); ++i)
      if (!(std::abs(n.values[i]) <= max_value))
        throw Invalid(fmt::format("element {} of field '{}' is {}", i, name, n.values[i]));
    return n;
  }
  // Strictly increasing ones between two limits.
  std::vector<float> increasing(std::string_view name, float low, float high) const {
    std::vector<float> x = numbers(name, 1).values;
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (!(x[i] >= low && x[i] <= high))
        throw Invalid(fmt::format("element {} of field '{}' is {:.4g}; it should be from {:.4g} to {:.4g}", i, name,
                                  x[i], low, high));
      if (i > 0 && !(x[i] > x[i - 1]))
        throw Invalid(fmt::format("field '{}' does not increase at element {}", name, i));
    }
    return x;
  }
  // The same with a grid as the last two dimensions.
  Numbers grids(std::string_view name, std::size_t dimensions) const {
    Numbers n = numbers(name, dimensions);
    if (std::max(n.sizes[dimensions - 1], n.sizes[dimensions - 2]) > max_side)
      throw Invalid(fmt::format("field '{}' is {}; at most {} points along a side are read", name, sizes_text(n.sizes),
                                max_side));
    return n;
  }
  bool flag(std::string_view name) const {
    const TensorField& field = of_type(name, TensorType::uint8, "uint8", 1);
    if (field.bytes.size() != 1) throw Invalid(fmt::format("field '{}' should have one element", name));
    return field.bytes[0] != 0;
  }

 private:
  const TensorField* find(std::string_view name) const {
    const auto found = std::ranges::find(fields_, name, &TensorField::name);
    return found == fields_.end() ? nullptr : &*found;
  }
  const TensorField& of_type(std::string_view name, TensorType type, std::string_view type_name,
                             std::size_t dimensions) const {
    const TensorField* field = find(name);
    if (!field) throw Invalid(fmt::format("there is no field '{}'", name));
    if (field->type != type) throw Invalid(fmt::format("field '{}' is not of type {}", name, type_name));
    if (field->sizes.size() != dimensions)
      throw Invalid(
          fmt::format("field '{}' should have {} dimensions; it has {}", name, dimensions, field->sizes.size()));
    return *field;
  }

  const std::vector<TensorField>& fields_;
};

// The numbers of the first tables of a field: all but noise, and no more than count tables of that many numbers.
std::vector<float> positive_part(const Numbers& n, std::size_t count) {
  std::vector<float> x(n.values.begin(), n.values.begin() + std::ptrdiff_t(std::min(count, n.values.size())));
  for (float& v : x) v = std::max(v, 0.0f);
  return x;
}

// Tables for each azimuth and elevation, on grids that have cells.
Numbers tables(const FieldReader& file, std::string_view name, std::vector<std::uint64_t> first_sizes) {
  Numbers n = file.grids(name, first_sizes.size() + 2);
  const std::vector<std::uint64_t> first(n.sizes.begin(), n.sizes.end() - 2);
  if (first != first_sizes)
    throw Invalid(fmt::format("field '{}' is {}; it should be {} x height x width", name, sizes_text(n.sizes),
                              sizes_text(first_sizes)));
  if (n.sizes.back() < 2 || n.sizes[n.sizes.size() - 2] < 2)
    throw Invalid(fmt::format("field '{}' is {}; a grid should have at least 2 x 2 points", name, sizes_text(n.sizes)));
  return n;
}

AzimuthSymmetry symmetry_of(const std::vector<float>& azimuths) {
  const float first = azimuths.front(), range = azimuths.back() - first;
  // The last azimuth may be that of the end, or one step before it.
  const float step = range / float(azimuths.size() - 1);
  const auto covers = [&](float part) {
    return std::abs(first + pi) < 0.01f && range > part - 1.5f * step - 0.01f && range < part + 0.01f;
  };
  if (covers(pi / 2)) return AzimuthSymmetry::two_mirrors;
  if (covers(pi)) return AzimuthSymmetry::half_turn;
  if (covers(2 * pi)) return AzimuthSymmetry::none;
  throw Invalid(
      fmt::format("field 'phi_i' is from {:.4g} to {:.4g}; it should begin at -pi and be the whole circle, a half or a "
                  "quarter of it",
                  first, azimuths.back()));
}

// Red, green and blue side by side, from channels that are tables.
std::vector<float> colors(const Numbers& n, std::size_t table_count, const std::vector<Rgb>& weights) {
  const std::size_t points = n.grid().points();
  std::vector<float> result;
  const float* value = n.values.data();
  for (std::size_t table = 0; table < table_count; ++table) {
    std::vector<double> sums(points * rgb_size);
    for (const Rgb& weight : weights)
      for (std::size_t i = 0; i < points; ++i, ++value)
        for (std::size_t c = 0; c < rgb_size; ++c) sums[i * rgb_size + c] += double(weight[int(c)]) * double(*value);
    for (double sum : sums) result.push_back(float(std::max(sum, 0.0)));
  }
  return result;
}

MeasuredData data_of(const FieldReader& file) {
  MeasuredData data;
  data.elevations = file.increasing("theta_i", 0, 1.001f * (pi / 2));
  data.azimuths = file.increasing("phi_i", -1.001f * two_pi, 1.001f * two_pi);
  const std::uint64_t elevations = data.elevations.size(), azimuths = data.azimuths.size();
  // Up to two azimuths stand for an isotropic surface, whose tables do not depend on them.
  if (azimuths <= 2)
    data.azimuths.resize(1);
  else
    data.symmetry = symmetry_of(data.azimuths);
  const std::size_t count = data.azimuths.size() * elevations;

  const Numbers ndf = file.grids("ndf", 2), sigma = file.grids("sigma", 2);
  data.ndf_size = ndf.grid(), data.ndf = positive_part(ndf, ndf.values.size());
  data.sigma_size = sigma.grid(), data.sigma = positive_part(sigma, sigma.values.size());
  const Numbers vndf = tables(file, "vndf", {azimuths, elevations});
  data.vndf_size = vndf.grid(), data.vndf = positive_part(vndf, count * vndf.grid().points());
  const Numbers luminance = tables(file, "luminance", {azimuths, elevations});
  data.value_size = luminance.grid(), data.luminance = positive_part(luminance, count * luminance.grid().points());

  std::vector<Rgb> weights{Rgb{{1, 0, 0}}, Rgb{{0, 1, 0}}, Rgb{{0, 0, 1}}};
  const bool is_rgb = file.has("rgb");
  if (!is_rgb) {
    const std::vector<float> wavelengths = file.increasing("wavelengths", 1, 1e6f);
    if (wavelengths.size() > max_wavelengths)
      throw Invalid(
          fmt::format("field 'wavelengths' has {} elements; at most {} are read", wavelengths.size(), max_wavelengths));
    weights = reflectance_weights({wavelengths.begin(), wavelengths.end()});
  }
  const std::string_view name = is_rgb ? "rgb" : "spectra";
  const Numbers values = tables(file, name, {azimuths, elevations, weights.size()});
  if (values.grid().width != data.value_size.width || values.grid().height != data.value_size.height)
    throw Invalid(fmt::format("the grids of fields '{}' and 'luminance' differ: {} and {}", name,
                              sizes_text(values.sizes), sizes_text(luminance.sizes)));
  data.values = colors(values, count, weights);
  data.divided_by_facets = file.flag("jacobian");
  return data;
}

}  // namespace

Result<MeasuredData> read_measured_data(std::string_view bytes) {
  const auto fields = read_tensor_file(bytes);
  if (!fields) return fields.failure();
  try {
    return data_of(FieldReader(*fields));
  } catch (const Invalid& invalid) {
    return Failure{invalid.what()};
  }
}

Result<MeasuredTable> read_measured_table(const std::filesystem::path& file) {
  std::error_code problem;
  const std::uintmax_t size = std::filesystem::file_size(file, problem);
  std::string bytes(problem ? 0 : std::size_t(size), '\0');
  std::ifstream in(file, std::ios::binary);
  if (problem || !in.read(bytes.data(), std::streamsize(bytes.size())))
    return Failure{fmt::format("cannot read '{}'", file.string())};
  Result<MeasuredData> data = read_measured_data(bytes);
  if (!data) return Failure{fmt::format("'{}' is not a table of a measured material: {}", file.string(), data.error())};
  return MeasuredTable(std::move(data).value());
}

}  // namespace montelux
