// A scene prepared for rendering: immutable, complete, and independent of any file.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "camera/camera.h"
#include "camera/shutter.h"
#include "filter/filter.h"
#include "geometry/bounds.h"
#include "light/light_set.h"
#include "medium/medium.h"
#include "scene/geometry_store.h"
#include "scene/materials.h"
#include "scene/surface.h"
#include "texture/texture_set.h"

namespace montelux {

struct Scene {
  GeometryStore geometry;
  std::unique_ptr<TextureSet> textures;  // by pointer: the materials refer to it
  MaterialSet materials;
  MediumSet media{};
  std::uint32_t camera_medium = empty_space;  // in which the camera stands
  LightSet lights;
  Camera camera;
  Filter filter;
  float imaging_ratio = 1;                // of the film's reading to radiance
  Bounds3 bounds;                         // of all surfaces, world space
  std::vector<std::string> object_names;  // of object number i + 1
  Shutter shutter;
  bool pixel_centres = false;  // camera rays use the centres of pixels, of the lens and of the exposure

  // Whether rays must be followed through the scene's media event by event: they scatter or emit, rays pass straight
  // from one into another, or the camera is in one, which may have no boundary. Otherwise they absorb alone, each
  // segment of a path lies in one medium, and Media::left() is all there is to it, as for bodies of glass. (Vertices
  // that are stored have 16 bits for the number of a medium.)
  bool has_participating_media() const {
    return media.scatters() || media.emits() || (!media.empty() && geometry.has_open_boundaries) ||
           camera_medium != empty_space || media.count() > 1u << 16;
  }

  // Whether the geometry or the camera moves: only then does a path need a time.
  bool moves() const { return geometry.moves() || camera.moves(); }

  // Whether a surface exists for this ray: an alpha mask may have a hole there, and a mixture may be an
  // interface, which shadow rays do not hit (paths do, and cross it). `local`: in the space of the hit's instance.
  bool is_opaque(const Hit<float>& hit, const Ray<float>& local, RayUse use) const;
};

}  // namespace montelux
