// Radiosity: light between diffuse surfaces, solved on elements of the surfaces and shown from any side. Each frame
// applies the transport once more to the solution of the frame before, with form factors by fresh rays (stochastic
// Jacobi iteration: Neumann and Neumann 1995; Bekaert 1999, sec. 6.3), so that the expectation of every solution is
// that of exact form factors. What remains is the elements' size.
#pragma once
#include "accel/accel.h"
#include "integrator/integrator.h"
#include "integrator/radiosity/element_mesh.h"
#include "integrator/radiosity/settings.h"
#include "scene/scene.h"

namespace montelux {

class RadiosityIntegrator final : public CoupledIntegrator {
 public:
  // Fails where the scene is not one of diffuse surfaces, or its surfaces cannot be cut. Scene and accel must outlive
  // the integrator, and the integrator its series.
  static Result<std::unique_ptr<RadiosityIntegrator>> make(const Scene& scene, const Accel& accel,
                                                           const RadiositySettings& settings);

  int frames() const override { return settings_.frames; }
  int warm_up() const override { return settings_.warm_up; }
  int stages() const override { return 2; }
  std::unique_ptr<FrameSeries> begin(const SeriesPass& pass) const override;

 private:
  RadiosityIntegrator(const Scene& scene, const Accel& accel, const RadiositySettings& settings, ElementMesh mesh)
      : scene_(scene), accel_(accel), settings_(settings), mesh_(std::move(mesh)) {}

  const Scene& scene_;
  const Accel& accel_;
  RadiositySettings settings_;
  ElementMesh mesh_;
};

}  // namespace montelux
