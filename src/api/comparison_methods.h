// The methods of a comparison, from the words of its user to integrators that are ready. Inside the facade only.
#pragma once
#include "api/comparison.h"
#include "api/parts.h"
#include "integrator/catalogue.h"

namespace montelux {

// A method as it was typed: "NAME=INTEGRATOR:key=value,...", where NAME= may be left out and sampler may be a key.
struct MethodText {
  std::string label;  // "a"
  std::string name;   // unique in the comparison
  std::string text;   // what was typed, without its name
  ChoiceText integrator;
  std::optional<PointSetKind> sampler;

  // Integrator and settings in one order: equal for methods that are the same but for their samplers.
  std::string canonical() const;
};

// Each with the settings that all are to have, where it does not have its own. Fails on what no catalogue knows, and on
// two methods of one name.
Result<std::vector<MethodText>> read_methods(const ComparisonOptions& options);

// The methods of one comparison with all that they need.
struct Field {
  std::vector<ChosenIntegrator> integrators;
  std::vector<lab::ComparedMethod> compared_methods;
  std::vector<MethodShortcomings> shortcomings;
};
Result<Field> make_field(const LoadedScene::Parts& parts, const ComparisonOptions& options);

// Who may make the reference: the methods that are unbiased and find all light; where there are none, those that lack
// nothing but what all lack; where there are none of these either, the same by biases alone.
Result<std::vector<std::size_t>> who_may_serve(const std::vector<lab::ComparedMethod>& compared_methods);

}  // namespace montelux
