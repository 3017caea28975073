// The domain of an integral: a product of intervals and shapes, as stated by a user, and as a map from the unit
// cube.
#pragma once
#include <memory>
#include <span>

#include "lab/domain/shapes.h"
#include "parameter/spec.h"

namespace montelux::lab {

// Columns of variables at many points, and the local stretch of the cube.
struct DomainPoints {
  std::unique_ptr<double[]> memory;
  std::vector<const double*> columns;  // one per variable; those that were not needed are meaningless
  std::vector<double> stretch;
};

// The maximum number of dimensions of a domain.
inline constexpr std::size_t max_dimensions = 64;

class Domain {
 public:
  explicit Domain(std::vector<DomainFactor> factors);

  std::size_t dimension() const { return dimension_; }
  // Every name that an expression may use. Some domains have more names than dimensions.
  const std::vector<std::string>& variables() const { return variables_; }
  // Its measure; nothing if it is infinite or its bounds depend on each other.
  std::optional<double> volume() const;
  // Whether it consists only of intervals with one variable each: points can be mapped back to the cube.
  bool invertible() const;

  // Marks the variables that an expression or a bound needs.
  std::vector<char> needed_by(const Expression& expression) const;
  // The points must outlive the result, which may refer to them.
  DomainPoints map(PointBatch points, const std::vector<char>& needed) const;
  // From variables (all of them) to coordinates of the cube, in the layout of a BatchMap. For invertible domains.
  void invert(std::span<const double* const> variables, std::size_t count, std::span<double> cube) const;

 private:
  std::vector<DomainFactor> factors_;
  std::vector<std::string> variables_;
  std::vector<std::size_t> first_variables_;  // of each factor
  std::size_t dimension_ = 0;
};

// A text of the user with an error in it.
struct DomainMistake {
  std::string text;
  TextMistake mistake;
};
struct ParsedDomain {
  std::optional<Domain> domain;
  std::vector<DomainMistake> mistakes;
};

// Each text is "x=0:1,y=0:x" (intervals; bounds are expressions of earlier variables) or a named shape:
// "disk:radius=2"; the domain is the product of all.
ParsedDomain parse_domain(const std::vector<std::string>& texts);
// The shapes by name with their parameters.
std::span<const EntitySpec> domain_table();

// The expression times the measure, as a function on the cube; 0 where the measure is 0.
BatchFunction on_cube(std::shared_ptr<const Domain> domain, Expression expression);
// A density per unit of the domain's measure, as a density on the cube.
BatchFunction density_on_cube(std::shared_ptr<const Domain> domain, Expression density);
// The map from uniform points u1, u2, ... to the domain's variables, with one expression for each, as a map of the
// cube to itself. For invertible domains.
BatchMap inverse_on_cube(std::shared_ptr<const Domain> domain, std::vector<Expression> variables);

}  // namespace montelux::lab
