#include "texture/table.h"

namespace montelux {

namespace {

using enum ParameterType;
using S = TextureDesc;

template <class Stated>
Model<S> model() {
  Fields<S> fields;
  fields.part<Stated>([](S& texture) -> Stated& { return std::get<Stated>(texture.model); }, Stated::rows());
  return {Stated::name, Stated::meaning, {"", false, Stated{}}, std::move(fields)};
}

// The models of the list.
template <class... Stated>
std::vector<Model<S>> models_of(const std::variant<Stated...>&) {
  return {model<Stated>()...};
}

Model<S> ptex() {
  Fields<S> fields;
  fields.other({"filename", {string}, "the file"});
  fields.other({"encoding", {string}, "default gamma 2.2"});
  fields.other({"scale", {number}, "default 1"});
  return {"ptex", "a per-face texture", {}, fields, true, "constant"};
}

}  // namespace

std::string_view name_of(const TextureModel& model) {
  return std::visit([](const auto& stated) { return stated.name; }, model);
}

bool can_be(const TextureModel& model, bool is_spectrum) {
  return std::visit(
      [&](const auto& stated) { return is_spectrum ? can_be_of<Rgb>(stated.values) : can_be_of<float>(stated.values); },
      model);
}

const Models<TextureDesc>& texture_models() {
  static const Models<S> models([] {
    std::vector<Model<S>> all = models_of(TextureModel{});
    all.push_back(ptex());
    return all;
  }());
  return models;
}

}  // namespace montelux
