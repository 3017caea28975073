#include "medium/table.h"

namespace montelux {

namespace {

using S = MediumModel;

template <class Stated>
Model<S> model() {
  Fields<S> fields;
  fields.part<Stated>([](S& medium) -> Stated& { return std::get<Stated>(medium); }, Stated::rows());
  return {Stated::name, Stated::meaning, Stated{}, std::move(fields)};
}
Model<S> later(std::string_view name, std::string_view meaning) { return {name, meaning, {}, {}, true}; }

// The models of the list.
template <class... Stated>
std::vector<Model<S>> models_of(const std::variant<Stated...>&) {
  return {model<Stated>()...};
}

}  // namespace

const Models<MediumModel>& medium_models() {
  static const Models<S> models([] {
    std::vector<Model<S>> all = models_of(S{});
    all.push_back(later("uniformgrid", "densities on a grid"));
    all.push_back(later("rgbgrid", "coefficients on a grid"));
    all.push_back(later("cloud", "procedural cloud"));
    all.push_back(later("nanovdb", "densities of a NanoVDB file"));
    return all;
  }());
  return models;
}

std::string_view name_of(const MediumModel& model) {
  return std::visit([](const auto& stated) { return stated.name; }, model);
}

}  // namespace montelux
