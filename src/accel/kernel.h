// The kernel objects of an Accel: its device, and one scene for the world and for each object.
#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <stdexcept>

#include "accel/callbacks.h"
#include "geometry/ray_reach.h"

namespace montelux {

// Owners of kernel handles.
struct ReleaseScene {
  void operator()(RTCScene s) const { rtcReleaseScene(s); }
};
struct ReleaseDevice {
  void operator()(RTCDevice d) const { rtcReleaseDevice(d); }
};
using SceneHandle = std::unique_ptr<std::remove_pointer_t<RTCScene>, ReleaseScene>;
using DeviceHandle = std::unique_ptr<std::remove_pointer_t<RTCDevice>, ReleaseDevice>;

inline bool count_memory(void* counter, ssize_t bytes, bool) {
  static_cast<std::atomic<std::int64_t>*>(counter)->fetch_add(bytes, std::memory_order_relaxed);
  return true;
}

struct Accel::Kernel {
  const GeometryStore& store;
  float max_ray = max_ray_coordinate;  // of the coordinates of origins and directions
  OpacityTest is_opaque;
  std::atomic<std::int64_t> bytes{0};
  DeviceHandle device;
  std::vector<SceneHandle> objects;
  SceneHandle world;
  std::vector<std::unique_ptr<GeometryContext>> contexts;

  Kernel(const GeometryStore& s, OpacityTest test, int threads) : store(s), is_opaque(std::move(test)) {
    std::string config = threads > 0 ? fmt::format("threads={}", threads) : "";
    device.reset(rtcNewDevice(config.c_str()));
    if (!device) throw std::runtime_error("the ray-tracing kernel cannot start on this machine");
    rtcSetDeviceMemoryMonitorFunction(device.get(), count_memory, &bytes);
    for (const ObjectRange& object : store.objects) objects.push_back(build(object, {}));
    world = build({0, store.world_rows}, store.instances);
    for (const PlacedObject& placed : store.instances) max_ray = std::min(max_ray, ray_reach(placed.object_to_world));
    if (RTCError error = rtcGetDeviceError(device.get()); error != RTC_ERROR_NONE)
      throw std::runtime_error(fmt::format("the ray-tracing kernel failed to build the scene (error {})", int(error)));
  }

  SceneHandle build(ObjectRange range, const std::vector<PlacedObject>& instances) {
    SceneHandle scene(rtcNewScene(device.get()));
    // Spatial splits double the time of the build, and scenes render as fast or faster without them.
    rtcSetSceneBuildQuality(scene.get(), RTC_BUILD_QUALITY_MEDIUM);
    for (std::uint32_t i = 0; i < range.count; ++i) attach(scene.get(), range.first + i, i);
    for (std::size_t i = 0; i < instances.size(); ++i) {
      RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_INSTANCE);
      rtcSetGeometryInstancedScene(geometry, objects[instances[i].object].get());
      const PlacedObject& placed = instances[i];
      if (placed.keys.count > 1) rtcSetGeometryTimeStepCount(geometry, placed.keys.count);
      for (std::uint32_t key = 0; key < std::max(placed.keys.count, 1u); ++key)
        rtcSetGeometryTransform(geometry, key, RTC_FORMAT_FLOAT3X4_ROW_MAJOR,
                                placed.keys.count > 1 ? store.instance_keys[placed.keys.first + key].data()
                                                      : placed.object_to_world.rows().data());
      rtcCommitGeometry(geometry);
      rtcAttachGeometryByID(scene.get(), geometry, range.count + std::uint32_t(i));
      rtcReleaseGeometry(geometry);
    }
    rtcCommitScene(scene.get());
    return scene;
  }

  void attach(RTCScene scene, std::uint32_t row_number, std::uint32_t id) {
    const GeometryRow& row = store.rows[row_number];
    const Ball ball = row.kind == GeometryKind::shape ? ball_around(store.shapes[row.first]) : Ball{};
    contexts.push_back(std::make_unique<GeometryContext>(GeometryContext{&store, row_number, &is_opaque, ball}));
    RTCGeometry geometry = make_geometry(device.get(), store, row, contexts.back().get());
    rtcCommitGeometry(geometry);
    rtcAttachGeometryByID(scene, geometry, id);
    rtcReleaseGeometry(geometry);
  }
};

}  // namespace montelux
