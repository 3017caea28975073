#include "montelux/scene.h"

#include "montelux/content.h"

namespace montelux::api {

Scene::Scene() : content_(std::make_unique<Content>()) {}
Scene::Scene(const Scene& other) : content_(std::make_unique<Content>(*other.content_)) {}
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene other) {
  content_ = std::move(other.content_);
  return *this;
}
Scene::~Scene() = default;

void Scene::set_folder(std::filesystem::path folder) { content_->folder = std::move(folder); }

void Scene::set_film(int width, int height, Parameters parameters) {
  content_->film = {"rgb", std::move(parameters)};
  content_->film.parameters.push_back({"xresolution", width});
  content_->film.parameters.push_back({"yresolution", height});
}

void Scene::set_camera(Model camera, const Transform& camera_to_world) {
  content_->camera = {std::move(camera), camera_to_world};
}
void Scene::set_filter(Model filter) { content_->filter = std::move(filter); }
void Scene::set_sampler(Model sampler) { content_->sampler = std::move(sampler); }
void Scene::set_integrator(Model integrator) { content_->integrator = std::move(integrator); }

MaterialId Scene::add_material(Model material) {
  content_->materials.push_back(std::move(material));
  return MaterialId(content_->materials.size() - 1);
}

MediumId Scene::add_medium(Model medium) {
  content_->media.push_back(std::move(medium));
  return MediumId(content_->media.size() - 1);
}
void Scene::set_camera_medium(std::optional<MediumId> medium) { content_->camera_medium = medium; }

TextureId Scene::add_texture(TextureKind kind, Model texture, const Transform& texture_to_world) {
  content_->textures.push_back({kind, {std::move(texture), texture_to_world}});
  return TextureId(content_->textures.size() - 1);
}

void Scene::add_light(Model light, const Transform& light_to_world) {
  content_->lights.push_back({std::move(light), light_to_world});
}

void Scene::add_shape(Model shape, const Surface& surface) { content_->shapes.push_back({std::move(shape), surface}); }
void Scene::add_mesh(Mesh mesh, const Surface& surface) { content_->shapes.push_back({std::move(mesh), surface}); }

ObjectId Scene::add_object() { return ObjectId(content_->objects++); }

void Scene::add_instance(ObjectId object, const Transform& object_to_world) {
  content_->instances.push_back({object, object_to_world});
}

}  // namespace montelux::api
