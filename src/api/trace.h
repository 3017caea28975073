// One sample of one pixel of a render, traced again and written down.
#pragma once
#include "api/render.h"
#include "integrator/traced_path.h"

namespace montelux {

struct SampleTrace {
  int x = 0, y = 0;             // the pixel
  int sample = 0, samples = 0;  // number of the sample from 0, and samples of the pixel
  int pass = 0, index = 0;      // where it is in the render
  std::uint32_t seed = 0;
  Rgb pixel_mean{};  // over all samples of the pixel
  std::string integrator, sampler;
  std::vector<std::string> notes;  // for the user, as a render has them
  TracedPath path;
  std::vector<std::string> materials;    // name of material number i; empty for one without a name
  std::vector<std::string> light_names;  // kind of light number i
};

// The path of sample `sample` of the pixel, in a render with these options or in the saved film that they resume, whose
// samples are counted in the order of its passes; no number: the sample with the largest luminance among all of the
// pixel. Fails where the pixel or the sample is not in the picture, the options are wrong, or the integrator has no
// paths to show.
Result<SampleTrace> trace_sample(const LoadedScene& scene, const RenderOptions& options, int x, int y,
                                 std::optional<int> sample);

}  // namespace montelux
