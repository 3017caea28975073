#include "material/coat_table.h"

#include <algorithm>

namespace montelux {

// The internal reflectance is smooth in the root of alpha, so that a short series has all of it.
CoatTable::CoatTable(float eta, float thickness) : words_(std::size_t(rows) * words_of_row) {
  static_assert(1 + coat_transmittance::terms <= words_of_row);
  constexpr std::uint32_t points = 1u << 12;
  const auto coat_of = [&](double row) {
    const float alpha = row == rows_of_series - 1 ? coat_transmittance::max_alpha : alpha_at(float(row));
    return CoatParameters{{alpha, alpha}, eta, thickness};
  };
  const auto internal =
      chebyshev::interpolation<16>([&](double x) { return double(internal_reflectance(coat_of(x * (rows - 1)))); });
  for (int row = 0; row < rows; ++row) {
    float* const words = words_.data() + row * words_of_row;
    words[0] = chebyshev::value(float(row) / (rows - 1), internal);
    std::ranges::copy(coat_transmittance::series(coat_of(row), points), words + 1);
  }
  has_series_ = words_[1] < coat_transmittance::none;
}

std::shared_ptr<const CoatTable> CoatTables::of(float eta, float thickness) {
  auto& table = tables_[{eta, thickness}];
  if (!table) table = std::make_shared<const CoatTable>(eta, thickness);
  return table;
}

}  // namespace montelux
