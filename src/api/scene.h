// Reading a scene and preparing it for rendering.
#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "api/frame_range.h"
#include "image/pixel_sample.h"
#include "math/result.h"
#include "parameter/diagnostic.h"

namespace montelux {

// A panorama that takes the place of the scene's own environment: equirectangular (twice as wide as high: column u
// shows the azimuth atan2(z, x) = 2 pi u, row v the angle acos(y) = pi v) or square and of equal areas.
struct EnvironmentOptions {
  std::string file;                // relative to the working directory
  double rotation = 0, scale = 1;  // degrees about +y, from +x toward +z; factor of the radiance
};

struct LoadOptions {
  bool lenient = false;  // unknown parameters and what Montelux cannot do yet are warnings, not errors
  bool verbose = false;  // each warning and note by itself, not one for all of a kind
  std::optional<std::pair<int, int>> resolution;  // width, height instead of the file's
  std::optional<double> resolution_scale{};       // or that many times those of the file
  int threads = 0;                                // for building; 0: all of the machine
  // Of a file that may hold several: by name or number; default: the first.
  std::optional<std::string> camera{}, animation{};
  // The shutter interval in the scene's unit of time; overrides that of the file. frame_shutter() applies it to a
  // sequence as it applies that of the file. The brightness of the image does not depend on it.
  std::optional<ShutterTimes> shutter{};
  std::optional<EnvironmentOptions> environment{};
  std::optional<FrameRange> frames{};  // of a sequence: the part of an animation that is needed
  // A large scene is moved to huge pages, and so is all other memory that the process has filled: for a program of its
  // own that renders for long.
  bool huge_pages = false;
};

// A substitute of Montelux for a name in the scene file.
struct Replacement {
  std::string family, name, by;  // "integrator", "bdpt", "path"
};

// "integrator bdpt by path".
std::string to_text(const Replacement& replacement);

// A material or a texture: "" where it has no name; "conductor".
struct NamedThing {
  std::string name, kind;
};

// An animation of a file that may hold several, with its length in the file's unit of time.
struct AnimationInfo {
  std::string name;
  double seconds = 0;
};

// A description of a scene for the user.
struct SceneInfo {
  std::string file;
  int width = 0, height = 0;
  PixelBounds crop;  // of the file; the whole picture where it has none
  std::string camera, film, filter, sampler, integrator;
  std::string picture_file;      // that the film names, relative to the working directory; empty: none
  std::uint32_t seed = 0;        // that the file states
  int samples = 0;               // that the file states
  std::optional<int> max_depth;  // that the file states
  bool moves = false;            // the camera or a shape
  double transforms_start = 0, transforms_end = 1, shutter_open = 0, shutter_close = 1;  // in the scene's unit of time
  // The time that the frames of a sequence divide, their default number per unit of time, and
  // how many of the requested ones (from the first) the scene has motion for.
  double time_start = 0, time_end = 1;
  std::optional<double> frame_rate;
  int frames_held = 1 << 30;
  std::size_t triangles = 0;            // in memory
  std::size_t instanced_triangles = 0;  // as rays see them
  std::size_t quadrics = 0, patches = 0, curve_segments = 0, instances = 0, objects = 0;
  std::size_t materials = 0, textures = 0, images = 0;
  std::vector<std::string> materials_by_number;  // names as the scene numbers them; empty for one without a name
  std::vector<NamedThing> material_names, texture_names;  // the named ones first, both in the order of the file
  std::vector<std::string> cameras;                       // of a file that may hold several; a name may be empty
  std::vector<AnimationInfo> animations;
  std::vector<std::pair<std::string, std::size_t>> lights;  // by kind, with how many there are
  float low[3] = {}, high[3] = {};                          // bounds of the scene
  std::size_t geometry_bytes = 0, accel_bytes = 0, texture_bytes = 0, light_bytes = 0;
  double read_seconds = 0, prepare_seconds = 0, build_seconds = 0;
  bool states_exposure = false;  // how sensitive the film is: a picture is then not made brighter or darker by itself
  std::vector<Replacement> replaced;
  // By a lenient reading: what, how often, and where first, a line each.
  std::vector<std::string> left_out;
};

// A scene that is ready to render. Opaque; movable; may be rendered from many threads at once.
class LoadedScene {
 public:
  struct Parts;
  explicit LoadedScene(std::unique_ptr<Parts> parts);
  ~LoadedScene();
  LoadedScene(LoadedScene&&) noexcept;

  const SceneInfo& info() const;
  const Parts& parts() const { return *parts_; }

 private:
  std::unique_ptr<Parts> parts_;
};

struct LoadResult {
  std::optional<LoadedScene> scene;  // none where there were errors
  Diagnostics diagnostics;           // all of them, in the order of the file
};

// The extensions of scene files: ".pbrt, .pbrt.gz, ...".
std::string scene_extensions();

// Never throws: what is wrong is in the diagnostics.
LoadResult load_scene(const std::filesystem::path& file, const LoadOptions& options = {});

// Whether a picture of this size is possible, in pixels.
Status check_resolution(int width, int height);

// "file:line:column: error: message", an excerpt with a caret, and the hint; for a terminal or a log.
std::string to_text(const Diagnostic& diagnostic, bool color);

}  // namespace montelux
