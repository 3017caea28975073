// The numbers of the branches that leave one vertex: shadow rays, or secondary rays.
#pragma once
#include <optional>

#include "integrator/integrator.h"
#include "transport/dimensions.h"
#include "transport/path_state.h"

namespace montelux {

// A single branch takes its numbers from the render's own point set, so that it is as well spread over the pixel's
// samples as a path is. Several branches, or a pattern chosen by name, take those of a point set of their own,
// which is randomised independently at every vertex.
template <class F>
class Branches {
 public:
  using U = Uint<F>;
  // `first` is the dimension of the vertex; `vertex` distinguishes vertices that share site and dimension.
  Branches(const TilePass& pass, const PathSite<F>& site, U first, U vertex, std::uint32_t count,
           std::optional<PointSetKind> pattern = {})
      : site_(site), first_(first), own_(count > 1 || pattern) {
    set_ = pass.points;
    if (!own_) return;
    set_.kind = pattern.value_or(PointSetKind::padded_sobol);
    set_.samples_per_pass = count;
    set_.seed = mix_bits(set_.seed ^ 0x68bc21ebu);
    site_.x = site.x + mix_bits(U(site.index + mix_bits(U(vertex + U(0x1b873593u)))));
  }

  F get1(std::uint32_t branch, std::uint32_t what) const { return sampler(branch).get1(dimension(what)); }
  Vec2<F> get2(std::uint32_t branch, std::uint32_t what) const { return sampler(branch).get2(dimension(what)); }
  RandomStream<F> stream(std::uint32_t branch, std::uint32_t what) const {
    return sampler(branch).stream(dimension(what));
  }

 private:
  Sampler<F> sampler(std::uint32_t branch) const {
    return numbers_of<F>(set_, PathSite<F>{site_.x, site_.y, own_ ? U(branch) : site_.index});
  }
  U dimension(std::uint32_t what) const { return first_ + U(what); }

  PathSite<F> site_;
  U first_;
  bool own_;
  PointSet set_;
};

}  // namespace montelux
