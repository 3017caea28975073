// The shapes that a scene may state.
#pragma once
#include "parameter/models.h"
#include "scene/description.h"

namespace montelux {

// Every shape by name, with its parameters. Those of meshes include the arrays, which the readers take.
const Models<ShapeDesc>& shape_models();

// Whether the name states a mesh or a surface that is made of one.
bool is_mesh(std::string_view name);
// Gives a form that has a mesh this one.
void set_mesh(ShapeDesc& shape, std::shared_ptr<const Mesh> mesh);

// The name that states the form.
std::string_view name_of(const ShapeForm& form);

}  // namespace montelux
