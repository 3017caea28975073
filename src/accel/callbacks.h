// Geometries of the kernel, and its callbacks: for surfaces that some rays pass, and for shapes that the kernel does
// not support.
#pragma once
#include "accel/accel.h"
#include "accel/rtcore.h"

namespace montelux {

// The data of a callback for its geometry. Lives as long as the kernel's scene.
struct GeometryContext {
  const GeometryStore* store;
  std::uint32_t row;
  const OpacityTest* is_opaque;
  Ball ball;  // around a shape
};

// A kernel geometry for one row, with its buffers shared with the store; not committed.
RTCGeometry make_geometry(RTCDevice device, const GeometryStore& store, const GeometryRow& row,
                          GeometryContext* context);

}  // namespace montelux
