#include "mc/piecewise.h"

#include <algorithm>
#include <stdexcept>

namespace montelux {

PiecewiseConstant2::Sums PiecewiseConstant2::sums_of(std::span<const float> weights, std::uint32_t width,
                                                     std::uint32_t height) {
  if (width == 0 || height == 0 || weights.size() != std::size_t(width) * height)
    throw std::invalid_argument("a table of weights needs width x height of them");
  std::vector<double> row_sums;
  std::vector<float> columns;
  columns.reserve((std::size_t(width) + 1) * height);
  double total = 0;
  for (std::uint32_t y = 0; y < height; ++y) {
    const auto source = weights.subspan(std::size_t(y) * width, width);
    const std::vector<double> row(source.begin(), source.end());
    const std::vector<float> sums = cumulative_sums(row);
    columns.insert(columns.end(), sums.begin(), sums.end());
    double sum = 0;
    for (double w : row) sum += w;
    row_sums.push_back(sum);
    total += sum;
  }
  return {cumulative_sums(row_sums), std::move(columns), total / (double(width) * double(height))};
}

PiecewiseTiles::PiecewiseTiles(std::shared_ptr<const PiecewiseConstant2> table, std::uint32_t side)
    : table_(std::move(table)), side_(side), rows_((table_->height() + side - 1) / side + 1) {
  const auto& t = *table_;
  const float across = float(t.width_) / float(side), down = float(t.height_) / float(side);
  for (std::uint32_t row = 0; row < side; ++row)
    for (std::uint32_t column = 0; column < side; ++column) {
      // As sample() has them, rounding included.
      const float top = float(row) * down, bottom = float(row + 1) * down;
      const float left = float(column) * across, right = float(column + 1) * across;
      std::vector<double> of_rows(rows_, 0.0);
      double sum = 0;
      for (std::uint32_t place = 0; place < rows_; ++place) {
        const std::uint32_t y = std::uint32_t(top) + place;
        if (y >= t.height_ || float(y) >= bottom) break;
        const float part = std::min(bottom, float(y) + 1) - std::max(top, float(y));
        const float of_row = sum_before<float>(y, right) - sum_before<float>(y, left);
        of_rows[place] = double(t.rows_[y + 1] - t.rows_[y]) * double(part) * double(std::max(of_row, 0.0f));
        sum += of_rows[place];
      }
      masses_.push_back(sum);
      const std::vector<float> sums = cumulative_sums(of_rows);
      sums_.insert(sums_.end(), sums.begin(), sums.end());
    }
}

}  // namespace montelux
