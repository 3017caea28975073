// Spends samples: hands the passes of every tile to threads and adds them up in the film, until a rule says stop.
#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "film/film.h"
#include "integrator/integrator.h"
#include "render/stopwatch.h"

namespace montelux {

// How many samples a pass takes at each pixel, and how many passes there are.
struct PassPlan {
  int samples_per_pass = 1;
  int passes = 1;
  int samples() const { return samples_per_pass * passes; }
};

// Points that are fixed are one pass, of so many samples at most.
inline constexpr int max_fixed_samples = 1 << 16;

// The plan for at least `samples` samples a pixel. Passes are replicates: more of them make the error bar surer, fewer
// make each point set longer and so the picture better; docs/error-bars.md has the measurement behind the choice.
PassPlan plan_passes(int samples, PointSetKind kind);
// Of any integrator: a pass of a coupled one is a chain of its frames.
PassPlan plan_passes(const AnyIntegrator& integrator, int samples, PointSetKind kind);

// A picture within a time: the plan's samples are then bounds. A frame, or a pass, begins only where it is likely to
// end in time; one there always is.
struct TimeBudget {
  double seconds = 0;
  double ending = 0;  // of that, what the end of a picture takes once its last frame is done, by experience
};

// What the chains of a picture have learned, by their number in the render.
using ChainMemories = std::vector<std::shared_ptr<const ChainMemory>>;

// A film that a render continues: passes that its tiles have are not done again.
struct BegunFilm {
  Film film;
  RayCounts rays;
  double seconds = 0;  // that it has taken so far
};

// A film at one moment, to be kept: its tiles one after the other, as Film::write_tile() has them.
struct FilmSnapshot {
  std::string tiles;
  int tile_side = 0;
  RayCounts rays;
  double seconds = 0;
};

// Where a render leaves its film now and then, and at its end: it holds whole passes of tiles, or whole chains. One
// without any pass is not left.
struct FilmKeeping {
  double every = 300;  // seconds from one snapshot to the next
  std::function<void(FilmSnapshot)> keep;
};

struct RenderSettings {
  PixelBounds bounds;         // of the picture, or of the crop; within width x height
  int width = 0, height = 0;  // of the full image
  PointSetKind sampler = PointSetKind::blue_noise;
  std::uint32_t seed = 0;
  PassPlan plan;
  std::optional<double> seconds;  // stop at this time, with as many passes as fit, one at least; plan.passes is a bound
  bool warm_up_counts = true;     // in these seconds; no: only the time of frames that are shown does
  std::optional<TimeBudget> budget;  // the same for whole frames, of one chain; not for layers
  int threads = 0;                   // 0: all of the machine
  int first_pass = 0;                // the passes are this one and those after it
  BegunFilm* begun = nullptr;        // of these bounds and layers, without a stride; it is moved from
  FilmKeeping keeping;               // nothing is left where `keep` is empty
  int stride = 1;                    // only one pixel of stride x stride is sampled; not for coupled integrators
  int max_unit_samples = 1 << 16;    // of one unit of work of a thread, as far as a pass allows
  std::optional<LayerPlan> layers;   // of an integrator that has them
  std::optional<Shutter> shutter;    // instead of the scene's
  SecondsClock clock;                // that `seconds` and the result's time go by; empty: the machine's
  // Of a coupled integrator in a sequence: each chain begins with what stands at its number, and leaves there what it
  // has learned. Null: chains begin with nothing.
  ChainMemories* memories = nullptr;
  // Bytes that they leave there in all, at most: a chain beyond leaves nothing. 0: none does, as none goes on.
  std::size_t max_memory = std::size_t(8) << 30;
};

// Of a film that was begun before, with what it had then.
struct Progress {
  double fraction = 0;   // of the work, or of the time, in [0, 1]
  double elapsed = 0;    // seconds
  double remaining = 0;  // seconds, estimated
  std::uint64_t samples = 0;
  ErrorEstimate error;
  bool finished = false;
};

// Receives progress a few times a second, from one thread; decides whether the work continues.
class RenderObserver {
 public:
  virtual ~RenderObserver() = default;
  virtual void progress(const Progress&) {}
  // What the user should know before the work starts: one sentence.
  virtual void announce(const std::string&) {}
  virtual bool stop_requested() { return false; }
};

struct RenderResult {
  Film film;
  RayCounts rays;
  double seconds = 0;
  bool interrupted = false;  // the observer asked to stop before the work was done
  double ending = 0;         // of the seconds, those after the last frame; where there was a budget
  double warm_up = 0;  // of the seconds, those of frames of a warm-up: where chains begin and end is not among them
  int forgotten = 0;   // chains that would have left a memory, had there been room
  double shown_seconds() const { return seconds - warm_up; }
};

// A plan for a render that time ends, and the measurement behind it.
struct TimedPlan {
  PassPlan plan;
  int stride = 1;             // above 1: less than a sample a pixel fits into the time
  int max_unit_samples = 1;   // so that threads can stop in time
  double sample_seconds = 0;  // that one sample of every pixel takes, as measured
};

// As many samples a pass as leave enough passes. Measures the speed on a part of the pixels, spread over the picture,
// of a coupled integrator on a whole frame; ends early where the observer requests it.
TimedPlan plan_for_time(const AnyIntegrator& integrator, RenderSettings settings, double seconds,
                        RenderObserver& observer);

// The plan for a render within a budget: one chain of a coupled integrator, passes of one sample of any other, and as
// many frames or passes as time allows.
PassPlan plan_for_budget(const AnyIntegrator& integrator);

// The film is the same bits for any number of threads (where no time limit is set and nobody interrupts).
RenderResult render(const AnyIntegrator& integrator, const RenderSettings& settings, RenderObserver& observer);

}  // namespace montelux
