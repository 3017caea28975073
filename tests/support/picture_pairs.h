// Pairs of rendered pictures as `montelux diff` reads them, and what its tests say of each.
#pragma once
#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "api/diff.h"
#include "api/render.h"
#include "temporary_folder.h"

namespace montelux::test {

// How a picture is rendered.
struct PictureWay {
  std::string integrator, sampler;
  int samples = 0;
  bool shared_filters = true;  // as renders have it by default
};

struct PicturePair {
  PictureWay a, b;
};

class PictureScene {
 public:
  PictureScene(const std::filesystem::path& file, int width, int height) : scene_(loaded(file, width, height)) {}

  // Through a file, so that all that the comparison knows is what the file holds.
  PictureEstimate picture(const PictureWay& way, std::uint32_t seed) const {
    RenderOptions options;
    options.samples = way.samples, options.seed = seed;
    options.integrator = way.integrator, options.sampler = way.sampler;
    if (!way.shared_filters) options.shared_filters = false;
    RenderObserver observer;
    Result<Rendering> rendering = render_scene(scene_, options, observer);
    if (!rendering) throw std::runtime_error(rendering.error());
    const std::filesystem::path file = std::filesystem::path(folder_.path()) / "picture.exr";
    if (Status written = write_rendering(file, *rendering, {}); !written) throw std::runtime_error(written.error());
    Result<PictureEstimate> estimate = read_estimate({file, {}, {}});
    if (!estimate) throw std::runtime_error(estimate.error());
    return std::move(*estimate);
  }

 private:
  static LoadedScene loaded(const std::filesystem::path& file, int width, int height) {
    LoadOptions options;
    options.resolution = {width, height};
    LoadResult result = load_scene(file, options);
    if (!result.scene) throw std::runtime_error("cannot load " + file.string());
    return std::move(*result.scene);
  }

  LoadedScene scene_;
  TemporaryFolder folder_;
};

// Of two pictures of equal size that have error bars.
inline WelchReport welch_of(const PictureEstimate& a, const PictureEstimate& b, double level = 0.01) {
  const auto difference = compare_pictures(a, b, level);
  if (!difference || !difference->welch) throw std::runtime_error("pictures that cannot be compared");
  return *difference->welch;
}

// The picture with its error bars made smaller by a factor: what a comparison that trusts them must find different.
inline PictureEstimate with_smaller_errors(PictureEstimate picture, float factor) {
  for (float& error : picture.bars->standard_error.values) error /= factor;
  if (picture.bars->error_of_mean)
    for (double& error : *picture.bars->error_of_mean) error /= double(factor);
  return picture;
}

// A part of the picture, or all, scaled together with its errors.
inline PictureEstimate brighter(PictureEstimate picture, float factor, int x0 = 0, int y0 = 0, int x1 = 1 << 20,
                                int y1 = 1 << 20) {
  for (int y = y0; y < std::min(y1, picture.color.height); ++y)
    for (int x = x0; x < std::min(x1, picture.color.width); ++x)
      for (int c = 0; c < 3; ++c)
        picture.color.at(x, y, c) *= factor, picture.bars->standard_error.at(x, y, c) *= factor;
  return picture;
}

struct DifferingPairs {
  int pairs = 0, differ = 0, differ_with_smaller_errors = 0;
};

// Every pair with seeds of its own, from `seed` on.
inline DifferingPairs differing_pairs(const PictureScene& scene, const std::vector<PicturePair>& pairs,
                                      std::uint32_t seed) {
  DifferingPairs count;
  for (const PicturePair& pair : pairs) {
    const PictureEstimate a = scene.picture(pair.a, seed++), b = scene.picture(pair.b, seed++);
    const WelchReport report = welch_of(a, b);
    ++count.pairs;
    count.differ += report.differs ? 1 : 0;
    count.differ_with_smaller_errors += welch_of(with_smaller_errors(a, 3), with_smaller_errors(b, 3)).differs ? 1 : 0;
    if (report.differs)
      std::printf("differ: %s %s %d and %s %s %d, seed %u: image %g, blocks %g, pixels %g\n", pair.a.integrator.c_str(),
                  pair.a.sampler.c_str(), pair.a.samples, pair.b.integrator.c_str(), pair.b.sampler.c_str(),
                  pair.b.samples, seed - 2, report.image.smallest_p, report.blocks.smallest_p,
                  report.pixels.smallest_p);
  }
  return count;
}

}  // namespace montelux::test
