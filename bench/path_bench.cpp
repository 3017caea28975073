// The bounce loop against the ray-tracing kernel alone, and a pack of lanes against one lane, on one core.
//
//   bench_path [SCENE.pbrt [SAMPLES [SAMPLER]]]     (the bundled scene, from the root of the source, by default)
//
// Prints millions of camera samples a second for the pack and for the single lane (the same text, compiled for float),
// and the share of the pack's time that the kernel takes: its packets are recorded and traced once more by themselves.
// Processor time of the thread; a few rounds, since shared machines are noisy: look at the medians.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <vector>

#include "accel/replay.h"
#include "api/parts.h"
#include "integrator/path/loop.h"
#include "render/float_mode.h"

namespace {

using namespace montelux;

double thread_seconds() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

struct Bench {
  const LoadedScene::Parts& parts;
  PointSetKind sampler;

  // Processor seconds of one pass over the picture.
  template <class F, class Rays>
  double pass(const Rays& rays, int samples) const {
    PathSettings settings;
    settings.max_depth = parts.picture.max_depth;
    const int width = parts.picture.width, height = parts.picture.height;
    std::vector<PixelSample> out;
    const double start = thread_seconds();
    for (int y = 0; y < height; y += 32)
      for (int x = 0; x < width; x += 32) {
        const PixelBounds tile{x, y, std::min(x + 32, width), std::min(y + 32, height)};
        const TilePass pass{tile, {sampler, 1, 0, std::uint32_t(samples)}};
        out.assign(std::size_t(tile.area()) * std::size_t(samples), {});
        trace_paths<F>(parts.scene, parts.scene.lights, rays, settings, pass, out);
      }
    return thread_seconds() - start;
  }
  double megasamples(int samples) const {
    return 1e-6 * double(parts.picture.width) * double(parts.picture.height) * double(samples);
  }
};

double median(std::vector<double> x) {
  std::nth_element(x.begin(), x.begin() + std::ptrdiff_t(x.size() / 2), x.end());
  return x[x.size() / 2];
}

}  // namespace

int main(int count, char** arguments) {
  const char* scene = count > 1 ? arguments[1] : "scenes/first-light/first-light.pbrt";
  LoadResult loaded = load_scene(scene, {true, {}, 1});
  if (!loaded.scene) {
    for (const Diagnostic& d : loaded.diagnostics.all()) std::fputs(to_text(d, false).c_str(), stderr);
    return 2;
  }
  const int samples = count > 2 ? std::max(1, std::atoi(arguments[2])) : 8;
  const auto sampler = count > 3 ? point_set_named(arguments[3]) : PointSetKind::independent;
  if (!sampler) {
    std::fprintf(stderr, "unknown sampler \"%s\"\n", arguments[3]);
    return 2;
  }
  FlushDenormals flush;
  const Bench bench{loaded.scene->parts(), *sampler};
  const Accel& accel = *bench.parts.accel;
  const int recorded = std::max(1, samples / 4);
  bench.pass<NativeFloats>(accel, recorded);  // warm up
  std::vector<double> pack, single, share, raw;
  for (int round = 0; round < 5; ++round) {
    pack.push_back(bench.megasamples(samples) / bench.pass<NativeFloats>(accel, samples));
    single.push_back(bench.megasamples(samples) / bench.pass<float>(accel, samples));
    RayRecorder recorder(accel);
    bench.pass<NativeFloats>(recorder, recorded);
    const RayRecorder::Replay replay = recorder.replay();
    const double whole = bench.pass<NativeFloats>(accel, recorded);
    share.push_back(replay.seconds / whole);
    raw.push_back(1e-6 * double(replay.rays) / replay.seconds);
  }
  std::printf(
      "%s: pack of %d %.3f M samples/s, one lane %.3f, ratio %.2f; kernel's share %.1f %% (%.2f M rays/s raw)\n",
      arguments[1], native_lanes, median(pack), median(single), median(pack) / median(single), 100 * median(share),
      median(raw));
}
