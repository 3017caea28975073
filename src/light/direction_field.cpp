#include "light/direction_field.h"

namespace montelux {

template <std::uint32_t side>
DirectionField<side>::DirectionField(PlaceTree tree, const std::vector<Table>& tables) : tree_(std::move(tree)) {
  sums_.reserve(tables.size() * sums_of_table), densities_.reserve(tables.size() * cells);
  for (const Table& table : tables) add(table);
}

template <std::uint32_t side>
void DirectionField<side>::add(const Table& table) {
  std::array<double, side> of_rows{}, row{};
  for (std::uint32_t c = 0; c < cells; ++c) of_rows[c / side] += double(table.weights[c]);
  const std::vector<float> rows = cumulative_sums(of_rows);
  sums_.insert(sums_.end(), rows.begin(), rows.end());
  for (std::uint32_t y = 0; y < side; ++y) {
    for (std::uint32_t x = 0; x < side; ++x) row[x] = double(table.weights[y * side + x]);
    const std::vector<float> columns = cumulative_sums(row);
    sums_.insert(sums_.end(), columns.begin(), columns.end());
    // Of what the sums draw, rounding included.
    for (std::uint32_t x = 0; x < side; ++x)
      densities_.push_back((rows[y + 1] - rows[y]) * (columns[x + 1] - columns[x]) * float(cells) * inv_four_pi);
  }
  shares_.push_back(table.share);
}

template class DirectionField<16>;
template class DirectionField<32>;

}  // namespace montelux
