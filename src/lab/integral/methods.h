// The named methods of integration: one closed table feeds the parser, the help text and the documentation.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "mc/mis.h"
#include "mc/point_set.h"
#include "parameter/choice.h"

namespace montelux::lab {

enum class MethodKind : std::uint8_t {
  uniform,
  stratified,
  antithetic,
  control,
  importance,
  mis,
  qmc,
  vegas,
  miser,
  ris,
  metropolis,
  automatic
};
enum class Strata : std::uint8_t { grid, latin };

// A method with its parameters; those of other methods are ignored.
struct Method {
  MethodKind kind = MethodKind::automatic;
  std::optional<int> passes;  // independent randomisations; absent: depends on the method
  Strata strata = Strata::grid;
  std::optional<float> coefficient;  // of the control variate; absent: the best one, fitted on the other passes
  MisHeuristic heuristic = MisHeuristic::balance;
  PointSetKind points = PointSetKind::sobol;  // one with cube_fill()
  bool baker = false;  // fold each coordinate by the baker's transformation, which makes the integrand periodic
  bool adapt = false;  // qmc: through an adaptive map of each coordinate
  int candidates = 16, resamples = 1;  // ris: M and N
  float step = 0.3f;                   // metropolis: the size of a small step; 0 < step <= 1
};

// Every method by name, in the order of MethodKind, with its parameters.
std::span<const EntitySpec> method_table();
std::string_view name_of(MethodKind kind);

// The method with that name and settings. Fails with one message that lists all errors.
Result<Method> method_of(std::string_view name, const std::vector<Setting>& settings);
// The same from text as typed by a user: "qmc", "qmc:points=lattice,baker=true".
Result<Method> parse_method(std::string_view text);
// The shortest text that parse_method reads as this method.
std::string to_text(const Method& method);

}  // namespace montelux::lab
