// The relative error of pixels that something bright covers in part: an emitter that the camera sees, or a surface
// before darkness.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "film/film_planes.h"

namespace montelux {

// Such a pixel has the expectation base + p bright, where p is the covered part of it, and with n samples the variance
// bright^2 (m p (1 - p) + h p^2) / n: m is the mean square of the light of covered samples over their squared mean, h
// the relative variance of a sample of a covered pixel. The samples show both the expectation and the variance by the
// same number of hits. If they hit nothing, both seem to be zero, and the product of variance and 1 / expectation^2 is
// too small by far in the mean. So it is estimated as one: by its mean over the distribution of p that the hits leave
// possible (a beta distribution, whose prior mean is the cover of the pixels around).
class PartialCovers {
 public:
  // The planes must outlive it.
  explicit PartialCovers(const FilmPlanes& planes);
  explicit PartialCovers(FilmPlanes&&) = delete;
  // What to add to the relative squared error of each channel of a pixel that is variance x reciprocal, where
  // `reciprocal` is an estimate of 1 / (expectation^2 + relative_epsilon): 0 for pixels that are not covered in part.
  std::array<double, rgb_size> correction(std::size_t pixel, const std::array<double, rgb_size>& reciprocal) const;
  // The expectation of the square of the pixel's relative squared error (the mean of its channels), corrected as above:
  // few hits make it far larger than the square of the expectation. None for pixels whose error is not corrected.
  std::optional<double> mean_square(std::size_t pixel) const;
  // Whether the pixel is covered in part.
  bool has(std::size_t pixel) const { return index_[pixel] >= 0; }
  // Whether the pixel is at the rim of an emitter that is larger than a pixel: its error hides no more than what the
  // hits of the pixels around leave possible.
  bool is_at_rim(std::size_t pixel) const;

 private:
  struct Cover {
    std::uint32_t pixel = 0;
    bool of_emitter = false;
    bool at_rim = false;  // of an emitter that covers at least half of two pixels near
    double samples = 0;
    double share = 0;    // of the samples that are covered
    double around = 0;   // the mean share of the pixels around
    double largest = 1;  // the largest share of these and of the pixel itself; 1 at a rim: more is not expected
    double noise = 0;    // h
    std::array<double, rgb_size> base{}, bright{};

    double brightness() const;
    // How many samples the pixels around count like at most.
    double prior_samples() const;
    // The unbiased estimate of p (1 - p).
    double spread() const { return samples > 1 ? share * (1 - share) * samples / (samples - 1) : 0; }
  };

  // What the hits and misses leave possible: the beta distribution of p.
  struct PossibleParts {
    double hits = 0, misses = 0;  // with those that the pixels around count for
    double weight = 1;            // how probable it is that there is any cover
  };

  const Cover* cover_of(std::size_t pixel) const;
  std::optional<PossibleParts> possible_parts(const Cover& c) const;
  // The mean square of the light of covered samples over their squared mean.
  double mean_square_of_light(const Cover& c) const { return c.of_emitter ? 1 : mean_square_; }
  bool covered_by_emitter(int x, int y, Cover& cover) const;
  bool covered_before_darkness(int x, int y, Cover& cover) const;
  void find_covers();
  void measure_surfaces();
  void measure_prior();
  template <class Function>
  void for_each_around(int x, int y, int reach, Function f) const;
  double variance_of(std::size_t pixel) const;

  const FilmPlanes& planes_;
  Plane brightness_;                 // mean of the channels
  std::vector<Cover> covers_;        // in the order of their pixels
  std::vector<std::int32_t> index_;  // of each pixel's cover; -1: none
  double mean_square_ = 1;           // m of surfaces; that of emitters is 1
  double overlap_ = 0;  // of the filters of pixels: how probable it is that a pixel without a hit is not empty
};

}  // namespace montelux
