#include "lab/integral/sampled.h"

#include <algorithm>

namespace montelux::lab {
namespace {

class Uniform final : public Technique {
 public:
  explicit Uniform(const Integrand& integrand) : integrand_(integrand) {}

  TechniqueTraits traits() const override { return {}; }
  TermSums run(const PassPart& part) const override {
    const std::size_t dimension = integrand_.dimension, most = batch_size(dimension);
    std::vector<double> points(dimension * most), values(most);
    TermSums sums;
    for (std::uint64_t done = 0; done < part.count;) {
      const std::size_t n = std::size_t(std::min<std::uint64_t>(most, part.count - done));
      fill_independent(part.key, {dimension, part.first + done, n, points.data()});
      integrand_.evaluate({std::span(points).first(dimension * n), dimension, n}, std::span(values).first(n));
      sums.add(std::span(values).first(n));
      sums.evaluations += n;
      done += n;
    }
    return sums;
  }

 private:
  Integrand integrand_;
};

}  // namespace

std::unique_ptr<Technique> make_sampled(const Problem& problem, const Method&) {
  return std::make_unique<Uniform>(problem.integrand);
}

}  // namespace montelux::lab
