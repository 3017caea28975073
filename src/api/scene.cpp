#include "api/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>

#include "api/description.h"
#include "api/frames.h"
#include "api/parts.h"
#include "io/report.h"
#include "io/scene_file.h"
#include "material/table.h"
#include "scene/prepare.h"
#include "work/huge_pages.h"
#include "work/scheduler.h"

namespace montelux {

namespace {

class Stopwatch {
 public:
  // Seconds since it was made or last asked.
  double lap() {
    auto now = std::chrono::steady_clock::now();
    double seconds = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    return seconds;
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

template <class T>
std::size_t bytes_of(const std::vector<T>& v) {
  return v.capacity() * sizeof(T);
}

std::size_t geometry_bytes(const GeometryStore& g) {
  return bytes_of(g.vertices) + bytes_of(g.triangles) + bytes_of(g.shapes) + bytes_of(g.rows) + bytes_of(g.instances) +
         bytes_of(g.instance_rows) + bytes_of(g.instance_keys);
}

// Counts triangles as they are in memory and, through the instances, as rays see them.
void count_geometry(const GeometryStore& g, SceneInfo& info) {
  std::vector<std::size_t> object_triangles;
  auto triangles_in = [&](std::size_t first, std::size_t count) {
    std::size_t n = 0;
    for (std::size_t i = first; i < first + count; ++i)
      if (g.rows[i].kind == GeometryKind::triangles) n += g.rows[i].count;
    return n;
  };
  for (const ObjectRange& object : g.objects) object_triangles.push_back(triangles_in(object.first, object.count));
  info.triangles = triangles_in(0, g.rows.size());
  info.instanced_triangles = triangles_in(0, g.world_rows);
  for (const PlacedObject& instance : g.instances) info.instanced_triangles += object_triangles[instance.object];
  for (const Shape& shape : g.shapes) ++(std::holds_alternative<BilinearPatch>(shape) ? info.patches : info.quadrics);
  for (const CurveSet& curves : g.curves) info.curve_segments += curves.first.size();
  info.instances = g.instances.size();
  info.objects = g.objects.size();
}

SceneInfo info_of(const SceneDesc& desc, const LoadedScene::Parts& parts) {
  const PictureSettings& picture = parts.picture;
  SceneInfo info;
  info.file = desc.file;
  info.width = picture.width, info.height = picture.height, info.crop = picture.crop;
  info.camera = name_of(desc.camera.kind), info.filter = name_of(desc.filter.kind);
  info.film = "rgb";
  for (const ReplacedName& name : desc.replaced)
    if (name.family == "film") info.film = name.stated;
  info.sampler = name_of(picture.sampler), info.integrator = picture.integrator;
  info.picture_file = picture.file, info.seed = picture.seed;
  info.samples = picture.samples, info.max_depth = picture.max_depth;
  info.moves = parts.scene.moves();
  info.transforms_start = picture.transforms_start, info.transforms_end = picture.transforms_end;
  info.shutter_open = picture.shutter_open, info.shutter_close = picture.shutter_close;
  const auto whole = desc.whole_time.value_or(std::pair{desc.transforms_start, desc.transforms_end});
  info.time_start = whole.first, info.time_end = whole.second;
  info.frame_rate = desc.frame_rate, info.frames_held = desc.frames_held;
  info.states_exposure = desc.film.iso.has_value();
  count_geometry(parts.scene.geometry, info);
  info.materials = desc.materials.size(), info.textures = desc.textures.size();
  for (const MaterialDesc& material : desc.materials) {
    info.materials_by_number.push_back(material.name);
    info.material_names.push_back({material.name, std::string(name_of(material.model))});
  }
  for (const TextureDesc& texture : desc.textures)
    info.texture_names.push_back({texture.name, std::string(name_of(texture.model))});
  const auto has_name = [](const NamedThing& thing) { return !thing.name.empty(); };
  std::stable_partition(info.material_names.begin(), info.material_names.end(), has_name);
  std::map<std::string, std::size_t> lights;
  for (std::uint32_t i = 0; i < parts.scene.lights.count(); ++i)
    ++lights[std::string(light_kind_names[std::size_t(parts.scene.lights.kind(LightId(i)))])];
  info.lights.assign(lights.begin(), lights.end());
  const Bounds3& b = parts.scene.bounds;
  const float low[3] = {b.low.x, b.low.y, b.low.z}, high[3] = {b.high.x, b.high.y, b.high.z};
  std::copy(low, low + 3, info.low), std::copy(high, high + 3, info.high);
  info.geometry_bytes = geometry_bytes(parts.scene.geometry);
  info.accel_bytes = parts.accel->memory();
  info.texture_bytes = parts.scene.textures->image_bytes();
  return info;
}

// What serves for names of the file that Montelux does not have itself. A default that the file does not state is no
// such name.
std::vector<Replacement> replacements(const SceneDesc& desc) {
  std::vector<Replacement> all;
  for (const ReplacedName& name : desc.replaced) all.push_back({name.family, name.stated, name.instead});
  return all;
}

std::vector<std::string> left_out(const std::vector<Omission>& omissions) {
  std::vector<std::string> all;
  for (const Omission& omission : omissions) {
    const SourceLocation& at = omission.first;
    std::string where = at.file ? std::filesystem::path(*at.file).filename().string() : std::string();
    if (at.file && at.line > 0) where += fmt::format(":{}:{}", at.line, at.column);
    std::string count = omission.count > 1 ? fmt::format("{} times, first at ", omission.count) : std::string();
    all.push_back(where.empty() ? omission.what : fmt::format("{} ({}{})", omission.what, count, where));
  }
  return all;
}

// Width and height where they are not the film's.
std::optional<std::pair<int, int>> resolution_of(const LoadOptions& options, const SceneDesc& desc) {
  if (!options.resolution_scale) return options.resolution;
  const auto scaled = [&](int size) {
    return int(std::clamp(std::round(double(size) * *options.resolution_scale), 1.0, 1e9));
  };
  return std::pair{scaled(desc.film.width), scaled(desc.film.height)};
}

// The part of an animation that the pictures need: each frame's time and that of the frame before the first.
AnimationWindow window_of(const LoadOptions& options, const AnimationTime& time) {
  const ShutterTimes shutter = options.shutter.value_or(ShutterTimes{time.start, time.start});
  const bool open = shutter.close > shutter.open;
  if (!options.frames) return {shutter.open, shutter.close, 1, open};
  SceneInfo info;
  info.time_start = time.start, info.time_end = time.end, info.frame_rate = time.frame_rate;
  info.shutter_open = shutter.open, info.shutter_close = shutter.close;
  const FrameRange& frames = *options.frames;
  const double start = frame_shutter(info, frames, frames.first - 1).open;
  const double step = frame_shutter(info, frames, frames.first).open - start;
  int intervals = frames.count();
  // With an open shutter, up to the end of the last exposure.
  const double end = frame_shutter(info, frames, frames.last).close;
  while (open && step > 0 && start + step * intervals < end && intervals < 1 << 20) ++intervals;
  const ShutterTimes one = frame_shutter(info, frames, frames.first);
  return {start, start + step * intervals, intervals, open, step > 0 ? (one.close - one.open) / step : 0};
}

}  // namespace

LoadedScene::LoadedScene(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
LoadedScene::~LoadedScene() = default;
LoadedScene::LoadedScene(LoadedScene&&) noexcept = default;
const SceneInfo& LoadedScene::info() const { return parts_->info; }

Status check_resolution(int width, int height) {
  std::string complaint = size_complaint(width, height);
  return complaint.empty() ? Status(Done{}) : Status(Failure{std::move(complaint)});
}

namespace {

// Runs a step of loading; what it throws becomes an error of the whole scene.
template <class Step>
void guarded(const std::string& name, Diagnostics& diagnostics, Step step) {
  const auto fail = [&](std::string message) {
    diagnostics.error({std::make_shared<std::string>(name), 0, 0}, std::move(message));
  };
  try {
    step();
  } catch (const std::bad_alloc&) {
    fail("the scene does not fit in memory");
  } catch (const std::exception& e) {
    fail(fmt::format("the scene could not be loaded: {}", e.what()));
  }
}

LoadResult load(const std::filesystem::path& file, const LoadOptions& options) {
  Stopwatch watch;
  ReadResult read;
  guarded(file.string(), read.diagnostics, [&] {
    ReadOptions how{options.lenient, options.camera, options.animation,
                    [&](const AnimationTime& time) { return window_of(options, time); }};
    if (options.environment)
      how.environment = {options.environment->file, options.environment->rotation, options.environment->scale};
    read = read_scene(file.string(), how);
  });
  return load_description(std::move(read), options, watch.lap());
}

}  // namespace

LoadResult load_description(ReadResult read, const LoadOptions& options, double read_seconds) {
  LoadResult result;
  result.diagnostics = std::move(read.diagnostics);
  if (!read.scene || result.diagnostics.has_errors()) return result;
  const std::string name = read.scene->file;
  guarded(name, result.diagnostics, [&] {
    Stopwatch watch;
    if (options.shutter) read.scene->shutter = std::pair{options.shutter->open, options.shutter->close};
    LoadOptions settled = options;
    settled.resolution = resolution_of(options, *read.scene), settled.resolution_scale.reset();
    if (settled.resolution)
      if (Status possible = check_resolution(settled.resolution->first, settled.resolution->second); !possible) {
        result.diagnostics.error({std::make_shared<std::string>(name), 0, 0}, possible.error());
        return;
      }
    Scheduler readers(options.threads);
    const auto for_each = [&](std::size_t count, const std::function<void(std::size_t)>& body) {
      readers.run(count, [&](std::size_t i, int) { body(i); });
    };
    std::optional<PreparedScene> prepared = prepare(*read.scene, {settled.resolution, for_each}, result.diagnostics);
    if (!prepared || result.diagnostics.has_errors()) return;
    // The description's meshes are copied: their memory goes before the kernel takes its own.
    SceneDesc desc = std::move(*read.scene);
    for (ShapeDesc& shape : desc.shapes) shape.form = MeshForm{};
    for (ObjectDesc& object : desc.objects)
      for (ShapeDesc& shape : object.shapes) shape.form = MeshForm{};
    const double prepare_seconds = watch.lap();
    auto parts = std::make_unique<LoadedScene::Parts>(
        LoadedScene::Parts{std::move(prepared->scene), std::move(prepared->picture), nullptr, {}, settled});
    const Scene& scene = parts->scene;
    parts->accel = std::make_unique<Accel>(
        scene.geometry,
        [&scene](const Hit<float>& hit, const Ray<float>& ray, RayUse use) { return scene.is_opaque(hit, ray, use); },
        options.threads);
    constexpr std::size_t large = std::size_t(8) << 20;
    if (options.huge_pages && parts->accel->memory() > large) use_huge_pages();
    const double build_seconds = watch.lap();
    parts->info = info_of(desc, *parts);
    parts->info.replaced = replacements(desc);
    parts->info.left_out = left_out(read.omissions);
    parts->info.cameras = read.cameras;
    for (const NamedAnimation& animation : read.animations)
      parts->info.animations.push_back({animation.name, animation.seconds});
    parts->info.read_seconds = read_seconds;
    parts->info.prepare_seconds = prepare_seconds;
    parts->info.build_seconds = build_seconds;
    result.scene.emplace(std::move(parts));
  });
  return result;
}

std::string scene_extensions() { return scene_file_extensions(); }

LoadResult load_scene(const std::filesystem::path& file, const LoadOptions& options) {
  LoadResult result = load(file, options);
  if (!options.verbose) result.diagnostics = grouped(result.diagnostics);
  return result;
}

std::string to_text(const Replacement& r) { return fmt::format("{} {} by {}", r.family, r.name, r.by); }

std::string to_text(const Diagnostic& diagnostic, bool color) { return render(diagnostic, ReportStyle{color, true}); }

}  // namespace montelux
