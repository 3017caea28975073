#include "scene/picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "geometry/ray.h"
#include "scene/table.h"

namespace montelux {

namespace {

// Pixels [ceil(size * low), ceil(size * high)), the rounding of pbrt.
int cut(int size, float fraction) { return std::clamp(int(std::ceil(float(size) * fraction)), 0, size); }

PixelBounds crop_of(const Entity& film, int width, int height, bool resized, Diagnostics& diagnostics) {
  PixelBounds all{0, 0, width, height};
  const auto& window = film.parameters.array<float>("cropwindow");
  const auto& pixels = film.parameters.array<int>("pixelbounds");
  PixelBounds crop = all;
  if (pixels.size() == 4 && !resized)
    crop = {std::clamp(pixels[0], 0, width), std::clamp(pixels[2], 0, height), std::clamp(pixels[1], 0, width),
            std::clamp(pixels[3], 0, height)};
  else if (window.size() == 4)
    crop = {cut(width, window[0]), cut(height, window[2]), cut(width, window[1]), cut(height, window[3])};
  if (crop.x0 < crop.x1 && crop.y0 < crop.y1) return crop;
  diagnostics.error(film.where, "the film's window contains no pixel");
  return all;
}

// Our name for what a file names.
std::string served_by(const EntitySpec* spec, const std::string& name) {
  return spec && !spec->instead.empty() ? std::string(spec->instead) : name;
}

void read_sampler(const SceneDesc& scene, PictureSettings& s, Diagnostics& diagnostics) {
  const ParameterList& p = scene.sampler.parameters;
  s.samples = scene.sampler.type == "stratified" ? p.integer("xsamples", 4) * p.integer("ysamples", 4)
                                                 : p.integer("pixelsamples", s.samples);
  s.seed = std::uint32_t(p.integer("seed", scene.options.integer("seed", 0)));
  std::string point_set = served_by(find_entity(sampler_table(), scene.sampler.type), scene.sampler.type);
  s.sampler = point_set_named(point_set).value_or(PointSetKind::blue_noise);
  if (const Parameter* jitter = p.find("jitter"); jitter && !p.boolean("jitter", true)) {
    s.sampler = PointSetKind::uniform_grid;
    const int x = p.integer("xsamples", 4), y = p.integer("ysamples", 4),
              columns = int(grid_columns(std::uint32_t(s.samples)));
    if (x != columns)
      diagnostics.warning(jitter->where, fmt::format("{} x {} strata without jitter: the {} samples are at the centres "
                                                     "of a grid with {} columns instead of {}",
                                                     x, y, s.samples, columns, x));
  }
  const std::string randomization = p.string("randomization", "fastowen");
  if (randomization == "none" || randomization == "permutedigits")
    diagnostics.warning(p.find("randomization")->where, "points are scrambled by Owen's method instead of by \"" +
                                                            randomization +
                                                            "\": error bars need passes that are random");
}

// The settings of ambientocclusion as our settings.
std::string ambient_occlusion(const ParameterList& p) {
  std::vector<std::string> settings;
  if (p.find("maxdistance")) settings.push_back(fmt::format("distance={}", p.number("maxdistance", 0)));
  if (!p.boolean("cossample", true)) settings.push_back("cossample=off");
  return settings.empty() ? "ao" : fmt::format("ao:{}", fmt::join(settings, ","));
}

// Likewise those of sppm.
std::string photon_mapping(const ParameterList& p) {
  std::vector<std::string> settings;
  if (const int photons = p.integer("photonsperiteration", -1); photons > 0)
    settings.push_back(fmt::format("photons={}", photons));
  if (p.find("radius")) settings.push_back(fmt::format("radius={}", p.number("radius", 0)));
  return settings.empty() ? "sppm" : fmt::format("sppm:{}", fmt::join(settings, ","));
}

// Likewise those of mlt.
std::string metropolis(const ParameterList& p) {
  if (!p.find("largestepprobability")) return "metropolis";
  return fmt::format("metropolis:large-step={}", p.number("largestepprobability", 0.3f));
}

void read_integrator(const Entity& integrator, PictureSettings& s, Diagnostics& diagnostics) {
  const ParameterList& p = integrator.parameters;
  s.integrator = served_by(find_entity(integrator_table(), integrator.type), integrator.type);
  if (s.integrator == "ao") s.integrator = ambient_occlusion(p);
  if (s.integrator == "sppm") s.integrator = photon_mapping(p), s.seed = std::uint32_t(p.integer("seed", int(s.seed)));
  if (s.integrator == "metropolis") s.integrator = metropolis(p), s.samples = p.integer("mutationsperpixel", s.samples);
  if (!p.boolean("samplelights", true)) s.integrator = "naive";
  if (p.find("maxdepth")) s.max_depth = p.integer("maxdepth", 0);
  std::string selection = p.string("lightsampler", "bvh");
  if (selection == "exhaustive")
    diagnostics.note(integrator.where, "light sampler \"exhaustive\" is replaced by \"bvh\"");
  s.light_selection = selection == "uniform" ? LightSelection::uniform
                      : selection == "power" ? LightSelection::power
                                             : LightSelection::bvh;
}

}  // namespace

std::string size_complaint(std::int64_t width, std::int64_t height) {
  constexpr std::int64_t max_pixels = std::int64_t{1} << 28;
  if (width >= 1 && height >= 1 && width <= max_picture_side && height <= max_picture_side &&
      width * height <= max_pixels)
    return {};
  return "a picture of " + std::to_string(width) + " x " + std::to_string(height) + " pixels is too " +
         (width < 1 || height < 1 ? "small" : "large") + "; each side is from 1 to " +
         std::to_string(max_picture_side) + ", and at most 2^28 pixels in all are valid";
}

PictureSettings picture_settings(const SceneDesc& scene, std::optional<std::pair<int, int>> resolution,
                                 Diagnostics& diagnostics) {
  PictureSettings s;
  const ParameterList& film = scene.film.parameters;
  if (resolution)
    if (std::string complaint = size_complaint(resolution->first, resolution->second); !complaint.empty()) {
      diagnostics.error(scene.film.where, complaint);
      return s;
    }
  s.width = film.integer("xresolution", s.width), s.height = film.integer("yresolution", s.height);
  if (resolution) std::tie(s.width, s.height) = *resolution;
  s.file = film.string("filename", "");
  s.crop = crop_of(scene.film, s.width, s.height, resolution.has_value(), diagnostics);
  if (float clamp = film.number("maxcomponentvalue", ray_infinity); clamp < ray_infinity) s.max_component = clamp;
  const float open = scene.camera.parameters.number("shutteropen", 0),
              close = scene.camera.parameters.number("shutterclose", 1);
  s.transforms_start = scene.transforms_start, s.transforms_end = scene.transforms_end;
  s.shutter_open = double(open), s.shutter_close = double(close);
  // Uses the exposure that the file states, even if another one is requested.
  s.imaging_ratio = (close - open) * film.number("iso", 100) / 100;
  if (scene.shutter) s.shutter_open = scene.shutter->first, s.shutter_close = scene.shutter->second;

  s.pixel_centres = scene.options.boolean("disablepixeljitter", false);
  read_sampler(scene, s, diagnostics);
  read_integrator(scene.integrator, s, diagnostics);
  if (s.integrator == "bdpt" && !scene.media.empty()) {
    s.integrator = "path";
    diagnostics.note(scene.integrator.where, "bdpt cannot cross participating media: replaced by 'path'");
  }
  return s;
}

}  // namespace montelux
