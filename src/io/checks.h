// Checks of what a scene file or a program states against the tables.
#pragma once
#include <optional>
#include <string>

#include "io/reporter.h"
#include "parameter/spec.h"
#include "parameter/value.h"

namespace montelux {

enum class Family {
  material,
  texture,
  light,
  area_light,
  shape,
  camera,
  filter,
  film,
  sampler,
  integrator,
  accelerator,
  medium,
  option
};

std::string_view name_of(Family family);
// The table of a family; that of the options has one entity.
std::span<const EntitySpec> table_of(Family family);

enum class TextureKind { number, spectrum };

struct CheckContext {
  Reporter& report;
  const std::string& folder;                        // of the scene: files are relative to it
  std::string_view (*name_of_type)(ParameterType);  // in messages
  std::optional<TextureKind> kind{};                // of the texture whose parameters are checked
};

// The parameters that the entity has and that are valid in type, number and range; all others are reported.
ParameterList checked_parameters(Family family, const EntitySpec& spec, const ParameterList& stated,
                                 const CheckContext& context);

// Whether a parameter fits its row in everything but range; what is valid for it otherwise.
bool type_fits(const ParameterSpec& spec, ParameterType type, std::optional<TextureKind> kind);

// What no table can state: parameters that must agree with each other, files that must exist, total sizes.
void check_entity(Family family, const Entity& entity, const CheckContext& context);

// After the checks, whose look-ups count as no use: parameters without effect have been reported, and if only a single
// value is valid, it is already in effect. Such parameters are marked as used, all others as unused.
void expect_uses(const ParameterList& checked, const EntitySpec& spec);

// Reports a name that the table does not have, with the closest one that it has.
void report_unknown_name(Family family, const std::string& name, const SourceLocation& where, Reporter& report);

}  // namespace montelux
