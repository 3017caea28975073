// Saving the film of a render, and continuing a saved one.
#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "film/film.h"
#include "integrator/integrator.h"
#include "mc/mixing.h"
#include "render/measured_bias.h"

namespace montelux {

// A film that a render continues: passes that its tiles have are not rendered again.
struct BegunFilm {
  Film film;
  RayCounts rays;
  double seconds = 0;  // of the renders before
  BiasOfPasses bias{};
  MixingOfPasses mixing{};
  std::vector<std::uint64_t> rays_of_tiles{};  // in their order; none if they are not known
};

// A film at one time, to be saved: its tiles one after the other, as written by Film::write_tile(). It contains whole
// passes of tiles, or whole series.
struct FilmSnapshot {
  std::string tiles;
  int tile_side = 0;
  RayCounts rays;
  double seconds = 0;
  BiasOfPasses bias{};
  MixingOfPasses mixing{};
  std::vector<std::uint64_t> rays_of_tiles{};  // in their order; only of pixel integrators
};

// Receives the film now and then, and at the end of the render; not before it has a pass.
struct FilmKeeping {
  double every = 300;  // seconds from one snapshot to the next
  std::function<void(FilmSnapshot)> keep;
};

// Decides when a snapshot is due. For one thread.
class FilmKeeper {
 public:
  explicit FilmKeeper(const FilmKeeping& keeping) : keeping_(keeping), next_(keeping.every) {}
  bool is_due(double elapsed) const { return keeping_.keep && elapsed >= next_; }
  // Passes on the result of `snapshot` if the film has grown since the last one; `passes` are those of all its tiles.
  template <class Snapshot>
  void keep(double elapsed, std::uint64_t passes, Snapshot snapshot) {
    if (!keeping_.keep) return;
    next_ = elapsed + keeping_.every;
    if (passes == kept_) return;
    kept_ = passes;
    keeping_.keep(snapshot());
  }

 private:
  const FilmKeeping& keeping_;
  double next_;
  std::uint64_t kept_ = 0;
};

}  // namespace montelux
