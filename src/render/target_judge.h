// Judges films against a requested error.
#pragma once
#include <array>
#include <functional>
#include <memory>
#include <optional>

#include "film/error_target.h"
#include "film/film.h"

namespace montelux {

// Looks at a film after whole passes over all tiles, at numbers of passes that grow by an eighth or by one; by a third
// where each look removes the noise, which takes as long as several samples. The probability of a wrong statement is
// spent over the looks (alpha spending, Lan and DeMets 1983). Most of it is spent where renders are planned to end, at
// 8 to 16 passes (plan_passes()), or, for the error of the mean, at 24 to 48: 16 % by the four looks before, 48 % by
// the next eight, 24 % by eight more, and of the rest the share 1 / ((i + 1) (i + 2)) by each look i = 0, 1, ... after
// these (Howard, Ramdas, McAuliffe and Sekhon 2021).
class Looks {
 public:
  explicit Looks(TargetMeasure measure)
      : first_(measure == TargetMeasure::mean       ? 8
               : measure == TargetMeasure::denoised ? 6
                                                    : 4),
        growth_(measure == TargetMeasure::denoised ? 3 : 8) {}
  // The first look after this number of passes.
  int after(int passes) const;
  bool is_look(int passes) const { return passes >= first_ && after(passes - 1) == passes; }
  // The share that a look at this number of passes spends; of a number between two looks, that of the later one.
  double spent(int passes) const;

 private:
  int first_, growth_;
};

// What films differ by: no two have the same mean to the last digit.
struct FilmMark {
  explicit FilmMark(const ImageEstimate& image);
  bool operator==(const FilmMark&) const = default;
  int passes;
  std::array<double, rgb_size> mean;
};

// What the removal of noise leaves of a film's error; nothing if that is not known. `stops`, unless it is empty, is
// queried now and then: true ends it early, with nothing.
using NoiseFilter = std::function<std::optional<FilteredError>(const Film& film, const std::function<bool()>& stops)>;

// The film that was filtered last, shared by the copies of a judge.
class FilteredFilm;

// Judges films against one target. Copies share what they know.
class TargetJudge {
 public:
  // `filter`: for TargetMeasure::denoised, without which such errors are unknown. Its films have halves.
  explicit TargetJudge(const ErrorTarget& target, NoiseFilter filter = {});

  const ErrorTarget& target() const { return target_; }
  bool needs_halves() const { return bool(filter_); }
  // The same for another error.
  TargetJudge with_error(double error) const;

  // What is known of a whole film, by the passes of the tile that has most. `single_look`: the film's number of samples
  // does not depend on it.
  TargetState judge(const Film& film, bool single_look, const std::function<bool()>& stops = {}) const;
  // The same of a film that is in work, by its planes: what noise would be left is that of the last whole film, scaled
  // by how the error before the filter has changed since.
  TargetState judge(const FilmPlanes& planes, const ErrorEstimate& error, const ImageEstimate& image) const;
  // Whether a look shows that the whole film has the requested error.
  bool is_reached(const Film& film, const std::function<bool()>& stops = {}) const;

 private:
  ErrorTarget target_;
  NoiseFilter filter_;
  std::shared_ptr<FilteredFilm> last_;
};

}  // namespace montelux
