// What a Scene holds. Inside the library only.
#pragma once
#include "montelux/scene.h"

namespace montelux::api {

struct PlacedModel {
  Model model;
  Transform transform;
};

struct Texture {
  TextureKind kind;
  PlacedModel placed;
};

struct Shape {
  std::variant<Model, Mesh> form;
  Surface surface;
};

struct Instance {
  ObjectId object;
  Transform object_to_world;
};

struct Scene::Content {
  std::filesystem::path folder;
  Model film{"rgb"};
  PlacedModel camera{{"perspective"}, {}};
  std::optional<Model> filter, sampler, integrator;
  std::vector<Model> materials, media;
  std::optional<MediumId> camera_medium;
  std::vector<Texture> textures;
  std::vector<PlacedModel> lights;
  std::vector<Shape> shapes;
  std::uint32_t objects = 0;
  std::vector<Instance> instances;
};

}  // namespace montelux::api
