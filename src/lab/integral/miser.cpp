#include "mc/miser.h"

#include "lab/integral/whole_pass.h"

namespace montelux::lab {
namespace {

class Miser final : public Technique {
 public:
  explicit Miser(const Integrand& integrand) : integrand_(integrand) {}

  TechniqueTraits traits() const override {
    TechniqueTraits t;
    t.passes = 8, t.unit = 0, t.least = 2;
    return t;
  }
  TermSums run(const PassPart& part) const override {
    LargestTerms largest;
    const CubeFunction f = [&](std::span<const double> points, std::span<double> values) {
      integrand_.evaluate({points, integrand_.dimension, values.size()}, values);
      largest.add(values);
    };
    const RegionEstimate e = miser(f, integrand_.dimension, part.count, part.key.fork(std::uint32_t(part.block_first)));
    TermSums sums = sums_of_estimate(e.mean, e.variance, part.count);
    sums.evaluations = e.samples, sums.non_finite = e.non_finite, sums.largest = largest;
    return sums;
  }

 private:
  Integrand integrand_;
};

}  // namespace

TermSums sums_of_estimate(double mean, double variance, std::uint64_t samples) {
  TermSums sums;
  const double n = double(samples);
  sums.samples = samples, sums.sum = mean * n, sums.m2 = samples > 1 ? variance * n * (n - 1) : 0;
  return sums;
}

std::unique_ptr<Technique> make_miser(const Problem& problem) { return std::make_unique<Miser>(problem.integrand); }

}  // namespace montelux::lab
