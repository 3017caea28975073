// Metropolis light transport in primary sample space (Kelemen, Szirmay-Kalos, Antal and Csonka 2002): Markov chains on
// the random numbers of paths, whose stationary distribution is the brightness of the paths. These are camera paths, or
// pairs of subpaths that one strategy of bidirectional path tracing joins (Hachisuka, Kaplanyan and Dachsbacher 2014).
#pragma once
#include "accel/accel.h"
#include "integrator/integrator.h"
#include "integrator/metropolis/settings.h"
#include "integrator/metropolis/strategy_paths.h"
#include "scene/scene.h"

namespace montelux {

// A pass is a set of Markov chains of its own. Independent paths over the whole picture estimate its brightness, and
// every chain starts at one of them, drawn in proportion to brightness: then each state of each chain gives an unbiased
// estimate, and none has to be discarded (Veach and Guibas 1997, sec. 5.1). So passes are independent and unbiased, and
// their spread is the error, whatever the correlation within a chain.
class MetropolisIntegrator final : public CoupledIntegrator {
 public:
  // Scene and accel must outlive the integrator, and the integrator its chains.
  MetropolisIntegrator(const Scene& scene, const Accel& accel, const MetropolisSettings& settings);

  int frames() const override { return 16; }
  int warm_up() const override { return 0; }
  int stages() const override { return 4; }
  bool has_layers() const override { return true; }
  std::unique_ptr<FrameSeries> begin(const SeriesPass& pass) const override;

 private:
  const Scene& scene_;
  const Accel& accel_;
  const MetropolisSettings settings_;
  PathSettings path_;                      // of the paths, where these are those of `path`; else:
  std::optional<AliasTable> by_power_;     // none: there is no light
  std::optional<LightSet> compensated_;    // as BidirectionalFrame has it
  std::optional<LightMedia> light_media_;  // none: the scene has no media, or no light
  StrategyPaths strategies_;
};

}  // namespace montelux
