#include "lab/domain/domain.h"

#include <algorithm>
#include <cmath>

namespace montelux::lab {

Domain::Domain(std::vector<DomainFactor> factors) : factors_(std::move(factors)) {
  for (const DomainFactor& factor : factors_)
    std::visit(
        [this](const auto& f) {
          dimension_ += f.dimension();
          const std::vector<std::string> names = f.names();
          first_variables_.push_back(variables_.size());
          variables_.insert(variables_.end(), names.begin(), names.end());
        },
        factor);
}

std::optional<double> Domain::volume() const {
  double product = 1;
  for (const DomainFactor& factor : factors_) {
    const auto volume = std::visit([](const auto& f) { return f.volume(); }, factor);
    if (!volume) return std::nullopt;
    product *= *volume;
  }
  return product;
}

bool Domain::invertible() const {
  return std::ranges::all_of(factors_, [](const DomainFactor& f) { return std::holds_alternative<Side>(f); });
}

std::vector<char> Domain::needed_by(const Expression& expression) const {
  std::vector<char> needed(variables_.size(), 0);
  for (std::size_t k = 0; k < needed.size(); ++k) {
    bool use = expression.uses(k);
    for (const DomainFactor& factor : factors_)
      if (const Side* side = std::get_if<Side>(&factor)) use |= side->low.uses(k) || side->high.uses(k);
    needed[k] = use;
  }
  return needed;
}

DomainPoints Domain::map(PointBatch points, const std::vector<char>& needed) const {
  DomainPoints result;
  result.memory = std::make_unique_for_overwrite<double[]>(variables_.size() * points.count);
  for (std::size_t k = 0; k < variables_.size(); ++k) result.columns.push_back(result.memory.get() + k * points.count);
  result.stretch.assign(points.count, 1.0);
  MapTask task{points, 0, 0, result.columns, result.memory.get(), needed, result.stretch};
  for (std::size_t k = 0; k < factors_.size(); ++k) {
    task.column = first_variables_[k];
    std::visit(
        [&task](const auto& f) {
          f.map(task);
          task.first += f.dimension();
        },
        factors_[k]);
  }
  return result;
}

void Domain::invert(std::span<const double* const> variables, std::size_t count, std::span<double> cube) const {
  for (std::size_t k = 0; k < factors_.size(); ++k)
    std::get<Side>(factors_[k]).invert(variables, k, cube.subspan(k * count, count));
}

namespace {

// Reversed bounds change the sign of an integral, but not that of a density.
template <bool turns_sign>
BatchFunction times_stretch(std::shared_ptr<const Domain> domain, Expression expression) {
  std::vector<char> needed = domain->needed_by(expression);
  return [domain = std::move(domain), expression = std::move(expression), needed = std::move(needed)](
             PointBatch points, std::span<double> values) {
    const DomainPoints p = domain->map(points, needed);
    expression.evaluate(p.columns, values);
    for (std::size_t i = 0; i < values.size(); ++i) {
      const double stretch = turns_sign ? p.stretch[i] : std::abs(p.stretch[i]);
      values[i] = stretch == 0 ? 0.0 : values[i] * stretch;
    }
  };
}

}  // namespace

BatchFunction on_cube(std::shared_ptr<const Domain> domain, Expression expression) {
  return times_stretch<true>(std::move(domain), std::move(expression));
}

BatchFunction density_on_cube(std::shared_ptr<const Domain> domain, Expression density) {
  return times_stretch<false>(std::move(domain), std::move(density));
}

BatchMap inverse_on_cube(std::shared_ptr<const Domain> domain, std::vector<Expression> variables) {
  return [domain = std::move(domain), variables = std::move(variables)](PointBatch points, std::span<double> image) {
    std::vector<const double*> uniform;
    for (std::size_t d = 0; d < points.dimension; ++d) uniform.push_back(points[d].data());
    std::vector<double> memory(variables.size() * points.count);
    std::vector<const double*> columns;
    for (std::size_t k = 0; k < variables.size(); ++k) {
      const std::span<double> column = std::span(memory).subspan(k * points.count, points.count);
      variables[k].evaluate(uniform, column);
      columns.push_back(column.data());
    }
    domain->invert(columns, points.count, image);
    for (double& u : image) u = std::clamp(u, 0.0, 1 - 0x1p-53);
  };
}

}  // namespace montelux::lab
