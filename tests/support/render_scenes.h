// Small scenes rendered inside a test: from text or from a file, with nothing between the test and the integrator.
#pragma once
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>

#include "accel/accel.h"
#include "integrator/catalogue.h"
#include "integrator/path/tracer.h"
#include "io/pbrt.h"
#include "render/render.h"
#include "render/shared_samples.h"
#include "scene/prepare.h"

namespace montelux::test {

inline std::string read_text(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) throw std::runtime_error("cannot read " + path.string());
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

// The text with its only `old` replaced; throws where there is none or more than one.
inline std::string replaced(std::string text, const std::string& old, const std::string& by) {
  const std::size_t at = text.find(old);
  if (at == std::string::npos || text.find(old, at + 1) != std::string::npos)
    throw std::runtime_error("\"" + old + "\" is not there exactly once");
  return text.replace(at, old.size(), by);
}

// A scene ready to render; throws with all diagnostics where it has errors.
class TestScene {
 public:
  explicit TestScene(std::string_view text, const std::string& folder = ".",
                     std::optional<std::pair<int, int>> resolution = {})
      : TestScene(read_pbrt_text(text, folder), resolution) {}
  explicit TestScene(ReadResult read, std::optional<std::pair<int, int>> resolution = {}) {
    if (read.scene) prepared_ = prepare(*read.scene, {resolution}, read.diagnostics);
    if (!prepared_ || read.diagnostics.has_errors()) {
      std::string all;
      for (const Diagnostic& d : read.diagnostics.all()) all += d.message + "\n";
      throw std::runtime_error(all);
    }
    const Scene& scene = prepared_->scene;
    accel_ = std::make_unique<Accel>(
        scene.geometry,
        [&scene](const Hit<float>& hit, const Ray<float>& ray, RayUse use) { return scene.is_opaque(hit, ray, use); },
        1);
  }
  TestScene(const TestScene&) = delete;

  const PictureSettings& picture() const { return prepared_->picture; }
  const Scene& scene() const { return prepared_->scene; }
  const Accel& accel() const { return *accel_; }
  PathTracer tracer(Lanes lanes = Lanes::native) const {
    PathSettings settings;
    settings.max_depth = prepared_->picture.max_depth;
    settings.lanes = lanes;
    return PathTracer(prepared_->scene, *accel_, settings);
  }
  // The integrator of this name and settings, as --integrator takes them; throws where there is none.
  ChosenIntegrator integrator(std::string_view text) const {
    auto choice = parse_choice(text);
    if (!choice) throw std::runtime_error(choice.error());
    const PictureSettings& p = prepared_->picture;
    auto chosen =
        choose_integrator(*choice, {p.max_depth, p.max_component, p.width, p.height}, prepared_->scene, *accel_);
    if (!chosen) throw std::runtime_error(chosen.error());
    return *std::move(chosen);
  }
  RenderSettings settings(PointSetKind sampler, PassPlan plan, std::uint32_t seed, int threads = 1) const {
    const PictureSettings& p = prepared_->picture;
    RenderSettings s;
    s.image.bounds = p.crop, s.image.width = p.width, s.image.height = p.height;
    s.image.sampler = sampler, s.image.seed = seed, s.plan = plan, s.threads = threads;
    // As renders do by default.
    if (!scene().pixel_centres) s.image.sharing = sharing_for(scene().filter);
    return s;
  }
  RenderResult render(PointSetKind sampler, PassPlan plan, std::uint32_t seed, Lanes lanes = Lanes::native,
                      int threads = 1) const {
    const PathTracer path = tracer(lanes);
    RenderObserver silent;
    return montelux::render(path, settings(sampler, plan, seed, threads), silent);
  }

 private:
  std::optional<PreparedScene> prepared_;
  std::unique_ptr<Accel> accel_;
};

inline double mean_of_channels(const double (&x)[rgb_size]) { return (x[0] + x[1] + x[2]) / 3; }

}  // namespace montelux::test
