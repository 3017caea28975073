#include "mc/piecewise.h"

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

}  // namespace montelux
