#include "mc/miser.h"

#include "lab/integral/whole_pass.h"

namespace montelux::lab {
namespace {

class Miser final : public Technique {
 public:
  explicit Miser(const Integrand& integrand) : integrand_(integrand) {}

  TechniqueTraits traits() const override {
    TechniqueTraits t;
    t.passes = 8, t.unit = 0, t.min_samples = 2;
    return t;
  }
  TermSums run(const PassPart& part) const override {
    TermSums terms(LargestTerms::of_run);
    const CubeFunction f = [&](std::span<const double> points, std::span<double> values) {
      integrand_.evaluate({points, integrand_.dimension, values.size()}, values);
      terms.add(values);
    };
    const CubeKey key = part.key.fork(std::uint32_t(part.block_first));
    const RegionEstimate e = miser(f, integrand_.dimension, part.count, key);
    terms.evaluations = e.samples;
    return sums_of_estimate(e.mean, e.variance, part.count, terms);
  }

 private:
  Integrand integrand_;
};

}  // namespace

TermSums sums_of_estimate(double mean, double variance, std::uint64_t samples, const TermSums& terms) {
  TermSums sums = terms;
  const double n = double(samples);
  sums.samples = samples, sums.sum = mean * n;
  sums.m2 = terms.samples > 0 ? terms.m2 * n / double(terms.samples) : 0;
  sums.own_variance = variance * n * n;
  return sums;
}

std::unique_ptr<Technique> make_miser(const Problem& problem) { return std::make_unique<Miser>(problem.integrand); }

}  // namespace montelux::lab
