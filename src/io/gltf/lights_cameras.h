// Cameras and lights of a glTF document.
#pragma once
#include "geometry/bounds.h"
#include "io/gltf/nodes.h"

namespace montelux::gltf {

// The node of the camera: the one with that name (of the node or of the camera) or that number (of the document's
// cameras), or the first of the scene. Nothing if the scene has none; an invalid choice is an error.
std::optional<std::size_t> choose_camera(Document& document, const NodeTree& tree,
                                         const std::optional<std::string>& choice);

// States camera, film and the transform to camera space (x right, y up, looking along +z) for the camera of a node.
void state_camera(Document& document, std::size_t camera, const Matrix4& node_to_world, SceneDesc& scene);
// From camera space to the world, for a camera at this node.
Matrix4 camera_to_world(const Document& document, std::size_t camera, const Matrix4& node_to_world);
// A camera that shows the whole box, from slightly above and from the right.
void state_default_camera(const Bounds3& box, SceneDesc& scene);

// The light of KHR_lights_punctual with that number, at a node: a candela is an intensity of 1, a lux an irradiance.
std::optional<LightDesc> light_of(Document& document, std::size_t light, const Matrix4& node_to_world);

// The environment map named by scenes[...].extras.environment, a longitude-latitude image: column u = atan2(z, x) / 2
// pi, row v = acos(y) / pi, radiance unchanged.
std::optional<LightDesc> environment_of(Document& document, const Element& scene);

}  // namespace montelux::gltf
