// What a method of integration does in one pass. The engine only runs passes and adds them up.
#pragma once
#include <memory>

#include "lab/integral/integrate.h"
#include "mc/cube_points.h"

namespace montelux::lab {

// Sums over the terms of a part of a pass.
struct TermSums {
  std::uint64_t samples = 0, evaluations = 0, non_finite = 0, proposed = 0, accepted = 0;
  double sum = 0, m2 = 0, own_variance = 0;  // as in PassRecord
  double control_sum = 0, control_squares = 0, control_products = 0;
  OutsideSums outside{};  // as in PassRecord
  double magnitude = 0;   // as in PassRecord
  LargestTerms largest;

  explicit TermSums(std::size_t largest_kept = LargestTerms::of_part) : largest(largest_kept) {}

  // Adds terms; a non-finite one is counted and becomes 0 (in place).
  void add(std::span<double> terms);
  void merge(const TermSums& other);
};

// The samples [first, first + count) of a pass, within the block of samples that it was made longer by.
struct PassPart {
  CubeKey key;  // of the pass
  std::uint64_t first = 0, count = 0;
  std::uint64_t block_first = 0, block_count = 0;
};

// How a technique likes to be asked.
struct TechniqueTraits {
  std::uint32_t passes = 32;      // for a fixed number of samples
  std::uint64_t unit = 8192;      // a part may be cut at multiples of this, for threads; 0: never
  std::uint64_t min_samples = 1;  // that a part needs
  double cost = 1;                // evaluations of one sample
  std::uint64_t training_evaluations = 0;
};

// An unbiased estimator of the integral: the mean over the terms of a pass, whatever parts it was run in.
class Technique {
 public:
  virtual ~Technique() = default;
  virtual TechniqueTraits traits() const = 0;
  // The largest number of samples, not above this one, that suits a pass; 0 where there is none.
  virtual std::uint64_t fitting(std::uint64_t samples) const { return samples; }
  virtual TermSums run(const PassPart& part) const = 0;
  // What must not be 0 where the integrand is not: the density that points are drawn by. Empty: it is nowhere 0.
  virtual BatchFunction support() const { return {}; }
};

class MapTraining;

// Does the method train a map of the coordinates?
bool trains(const Method& method);
// The method made ready; one that trains takes its map from `training`. Throws like integrate.
std::unique_ptr<Technique> make_technique(const Problem& problem, const Method& method, std::uint64_t seed,
                                          const MapTraining* training);

// Points that go into one call of the integrand: so many that they fit the first cache.
std::size_t batch_size(std::size_t dimension);

}  // namespace montelux::lab
