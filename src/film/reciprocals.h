// Estimates of what the squared errors of pixels are multiplied by to be relative.
#pragma once
#include <array>
#include <cstddef>

#include "film/film_planes.h"

namespace montelux {

// The divisor of a relative error must not share the noise of the squared error that it divides: else a bright outlier
// counts as 1 at most, and the picture looks better than it is. So the expectation of a pixel is estimated from its
// neighbours, and from the pixel itself as far as it is known to differ from them: by more than its noise explains, or,
// where few samples made it bright, as often as such pixels of this picture are bright in both halves of their passes.
class Reciprocals {
 public:
  // The planes must outlive it.
  explicit Reciprocals(const FilmPlanes& planes);
  explicit Reciprocals(FilmPlanes&&) = delete;
  // For each channel of a pixel that has two passes, the mean of 1 / (expectation^2 + relative_epsilon) over what the
  // expectation may be.
  std::array<double, rgb_size> of(std::size_t pixel) const;

 private:
  struct Excess;

  // Whether pixels that few bright samples made brighter than their neighbours are bright in both halves of their
  // passes. One rare sample that any of them might have had shows in one half alone. By classes of how much brighter
  // the brighter half is, and of whether the excess is an emitter that the camera sees.
  class Agreement {
   public:
    void add(const Excess& e);
    // The mean over the pixel's class: 1 where both halves are bright, 0 where one is; with two pixels of this mean
    // added.
    double operator()(const Excess& e, double prior) const;

   private:
    struct Class {
      double agreement = 0, pixels = 0;
    };
    static constexpr std::size_t ratios = 8;
    static std::size_t class_of(const Excess& e);
    std::array<Class, 2 * ratios> classes_{};
  };

  // What is known of the expectation of a pixel that is brighter than its neighbours.
  struct Belief {
    double own = 1;    // the probability that the excess is the pixel's own; else it is as its neighbours are
    double share = 1;  // then the mean of the expected excess, of the one that was seen
  };

  Excess excess_of(std::size_t pixel) const;
  Belief belief_of(const Excess& e) const;

  const FilmPlanes& planes_;
  const ColorPlanes neighbours_;
  Agreement agreement_;
};

}  // namespace montelux
