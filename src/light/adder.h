// From what a scene states of one light to its row.
#pragma once
#include "light/builder.h"

namespace montelux {

// The factor that scales an emission of `present` to the power (or illuminance) that is stated.
float factor_for(const std::optional<float>& wanted, float present);

class LightAdder {
 public:
  // All must outlive the adder.
  LightAdder(LightSetBuilder& builder, const LightDesc& light, const LightInputs& inputs, Diagnostics& diagnostics)
      : builder_(builder), light_(light), inputs_(inputs), diagnostics_(diagnostics) {}

  LightSetBuilder& builder() { return builder_; }
  const Transform& to_world() const { return light_.light_to_world; }
  // The factor that all emission has.
  float scale() const { return light_.scale; }
  Rgb emitted(const SpectrumValue& stated, float factor) const { return inputs_.emission(stated) * (scale() * factor); }
  // Null: not stated, or invalid and reported.
  std::shared_ptr<const LightImage> image(const std::string& name, bool must_be_square) const;
  void error(std::string message, std::string hint = {}) const {
    diagnostics_.error(light_.where, std::move(message), std::move(hint));
  }

 private:
  LightSetBuilder& builder_;
  const LightDesc& light_;
  const LightInputs& inputs_;
  Diagnostics& diagnostics_;
};

}  // namespace montelux
