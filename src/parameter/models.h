// The names of a family, each of which states a struct S: "gaussian" of the filters.
#pragma once
#include <stdexcept>

#include "parameter/fields.h"

namespace montelux {

// One name: what it states without parameters, and the fields that its parameters set.
template <class S>
struct Model {
  std::string_view name, meaning;
  S initial;
  Fields<S> fields;
  bool later = false;             // as EntitySpec has it
  std::string_view instead = {};  // likewise
  bool same = false;              // likewise
};

template <class S>
class Models {
 public:
  explicit Models(std::vector<Model<S>> all) : all_(std::move(all)) {
    for (const Model<S>& m : all_)
      specs_.push_back({m.name, m.meaning, m.fields.specs(m.initial), m.later, m.instead, m.same});
  }

  std::span<const EntitySpec> specs() const { return specs_; }
  // What the entity states; its parameters have been checked. Here and below, throws std::logic_error if the table does
  // not have the name.
  Result<S> read(const Entity& stated) const {
    const Model<S>& model = named(stated.type);
    S s = model.initial;
    if (Status read = model.fields.read(stated.parameters, s); !read) return Failure{read.error()};
    return s;
  }
  // The reverse, with the parameters that differ from what the name alone states.
  Entity write(std::string_view name, const S& s) const {
    return {std::string(name), named(name).fields.write(s, named(name).initial), {}};
  }
  const S& initial(std::string_view name) const { return named(name).initial; }

 private:
  const Model<S>& named(std::string_view name) const {
    for (const Model<S>& m : all_)
      if (m.name == name) return m;
    throw std::logic_error("no model has this name");
  }

  std::vector<Model<S>> all_;
  std::vector<EntitySpec> specs_;
};

}  // namespace montelux
