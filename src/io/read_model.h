// From checked entities to the models of a family.
#pragma once
#include <optional>
#include <string>

#include "io/checks.h"
#include "io/reporter.h"
#include "parameter/models.h"

namespace montelux {

// Warns of the parameters that have no effect, each place once.
void report_unused(const std::string& owner, const ParameterList& parameters, Reporter& report);

// What the entity states; parameters without effect are reported. No value after an error, which is reported.
template <class S>
std::optional<S> read_model(const Models<S>& models, Family family, const Entity& stated, Reporter& report) {
  Result<S> read = models.read(stated);
  if (!read) report.error(stated.where, read.error());
  const std::string owner =
      family == Family::option ? stated.type : std::string(name_of(family)) + " '" + stated.type + "'";
  report_unused(owner, stated.parameters, report);
  return read ? std::optional<S>(*std::move(read)) : std::nullopt;
}

}  // namespace montelux
