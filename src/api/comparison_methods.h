// The methods of a comparison, from the user's text to integrators. Internal to the facade.
#pragma once
#include "api/comparison.h"
#include "api/parts.h"
#include "integrator/catalogue.h"

namespace montelux {

// A method as typed: "NAME=INTEGRATOR:key=value,...", where NAME= is optional and sampler may be a key.
struct MethodText {
  std::string label;  // "a"
  std::string name;   // unique in the comparison
  std::string text;   // what was typed, without its name
  ChoiceText integrator;
  std::optional<PointSetKind> sampler;

  // Integrator and settings in a canonical order: equal for methods that differ only in their samplers.
  std::string canonical() const;
};

// Each method with the common settings that it does not state itself. Fails for unknown names, and for
// two methods with the same name.
Result<std::vector<MethodText>> read_methods(const ComparisonOptions& options);

// The options with "auto=restir-pt" for a method "auto" that chooses restir-pt for a repeat, and a note of each choice.
struct ChosenMethods {
  ComparisonOptions options;
  std::vector<std::string> notes;
};
Result<ChosenMethods> choose_methods(const LoadedScene::Parts& parts, const ComparisonOptions& options,
                                     const ComparisonObserver& observer);

// The methods of one comparison with everything that they need.
struct Field {
  std::vector<ChosenIntegrator> integrators;
  std::vector<lab::ComparedMethod> compared_methods;
  std::vector<MethodShortcomings> shortcomings;
};
Result<Field> make_field(const LoadedScene::Parts& parts, const ComparisonOptions& options);

// Which methods may render the reference: those that are unbiased and find all light; if there are none, those whose
// only shortcomings are common to all; if there are none of these either, the same for biases only.
Result<std::vector<std::size_t>> who_may_serve(const std::vector<lab::ComparedMethod>& compared_methods);

}  // namespace montelux
