// Participating media that are the same everywhere: absorption, scattering and emission along a path.
#pragma once
#include <cstdint>
#include <vector>

#include "color/spectrum.h"
#include "phase/phase.h"

namespace montelux {

// Coefficients per unit of length in world space, on each colour component.
struct Medium {
  Rgb absorption{};          // sigma_a
  Rgb scattering{};          // sigma_s
  Rgb emission{};            // radiance that absorption emits in turn: sigma_a * emission per unit of length
  float mean_cosine = 0.0f;  // g of the phase function of Henyey and Greenstein
  PhaseKind phase = PhaseKind::henyey_greenstein;
};

// The number of a medium in a MediumSet; 0 is empty space.
inline constexpr std::uint32_t empty_space = 0;

// A distance to the next event along a ray, or the end of the ray before one.
template <class F>
struct DistanceSample {
  F distance;          // to the event
  Mask<F> is_event;    // it lies before the end of the ray
  Spectrum<F> weight;  // of the path from there on: coefficient times transmittance over the density, or probability
};

// exp(-depth); depths without bound are allowed.
template <class F>
MONTELUX_INLINE F attenuation(F depth) {
  return exp(-min(depth, F(1e3f)));
}

// The media of a scene, for packs: each lane has the number of its medium.
class MediumSet {
 public:
  MediumSet() : rows_(1) {}
  // The number of the medium.
  std::uint32_t add(const Medium& medium) {
    rows_.push_back({from_rgb(medium.absorption), from_rgb(medium.scattering), from_rgb(medium.emission),
                     medium.mean_cosine, std::uint32_t(medium.phase)});
    scatters_ = scatters_ || !is_black(medium.scattering), emits_ = emits_ || !is_black(medium.emission);
    return std::uint32_t(rows_.size() - 1);
  }
  bool empty() const { return rows_.size() == 1; }
  std::size_t count() const { return rows_.size(); }  // with empty space
  bool scatters() const { return scatters_; }         // whether any medium does
  bool emits() const { return emits_; }

  template <class F>
  MONTELUX_INLINE Spectrum<F> extinction(Uint<F> medium) const {
    return absorption<F>(medium) + scattering<F>(medium);
  }
  template <class F>
  MONTELUX_INLINE Spectrum<F> absorption(Uint<F> medium) const {
    return spectrum<F>(&Row::absorption, medium);
  }
  template <class F>
  MONTELUX_INLINE Spectrum<F> scattering(Uint<F> medium) const {
    return spectrum<F>(&Row::scattering, medium);
  }
  template <class F>
  MONTELUX_INLINE PhaseFunction<F> phase(Uint<F> medium) const {
    return {gather(&rows_.data()->phase, at<F>(medium)), gather(&rows_.data()->mean_cosine, at<F>(medium))};
  }

  // The probability, averaged over the components, that a path goes this far without an event; 1 where the medium does
  // not scatter, since paths pass there.
  template <class F>
  MONTELUX_INLINE F mean_passing(Uint<F> medium, F length) const {
    const Spectrum<F> extinct = extinction<F>(medium);
    F sum = F(0.0f);
    for (int c = 0; c < spectrum_size; ++c)
      sum = sum + select(extinct.c[c] > F(0.0f), attenuation(extinct.c[c] * length), F(1.0f));
    return select(max_component(scattering<F>(medium)) > F(0.0f), sum * (1.0f / float(spectrum_size)), F(1.0f));
  }

  // Radiance that the medium emits toward the start of a ray of this length: the closed form of its integral.
  template <class F>
  MONTELUX_INLINE Spectrum<F> emitted(Uint<F> medium, F length) const {
    const Spectrum<F> extinct = extinction<F>(medium);
    const Spectrum<F> source = absorption<F>(medium) * spectrum<F>(&Row::emission, medium);
    Spectrum<F> result;
    for (int c = 0; c < spectrum_size; ++c) {
      const F depth = extinct.c[c] * length;
      // (1 - exp(-x)) / x near 0 by its series.
      const F share =
          select(depth > F(1e-3f), (F(1.0f) - attenuation(depth)) / max(depth, F(1e-3f)), F(1.0f) - 0.5f * depth);
      const F mean_way = select(depth < F(1e30f), share * length, F(1.0f) / max(extinct.c[c], F(1e-30f)));
      result.c[c] = select(source.c[c] > F(0.0f), source.c[c] * mean_way, F(0.0f));
    }
    return result;
  }

  // The density, per unit of length, with which sample_distance() draws an event at this distance, before the end of
  // the ray; 0 where the medium does not scatter.
  template <class F>
  MONTELUX_INLINE F event_density(Uint<F> medium, const Spectrum<F>& throughput, F distance) const {
    const Spectrum<F> extinct = extinction<F>(medium), share = shares(throughput);
    F density = F(0.0f);
    for (int c = 0; c < spectrum_size; ++c)
      density = density + share.c[c] * extinct.c[c] * attenuation(extinct.c[c] * distance);
    return select(max_component(scattering<F>(medium)) > F(0.0f), density, F(0.0f));
  }

  // Draws the distance to a scattering event on a ray of this length (infinity: it meets nothing). One component,
  // chosen by u.x in proportion to the throughput, decides the distance by u.y; the density is that of the mixture, so
  // that no component of the weighted throughput exceeds the sum of the components before (balance heuristic, Veach
  // and Guibas 1995, over wavelengths as in Wilkie et al. 2014). A lane whose medium does not scatter passes with the
  // exact transmittance.
  template <class F>
  MONTELUX_INLINE DistanceSample<F> sample_distance(Uint<F> medium, const Spectrum<F>& throughput, F length,
                                                    Vec2<F> u) const {
    const Spectrum<F> extinct = extinction<F>(medium), scatter = scattering<F>(medium);
    const Mask<F> scatters = max_component(scatter) > F(0.0f);
    const Spectrum<F> share = shares(throughput);
    F chosen = extinct.c[0], below = F(0.0f);
    for (int c = 0; c < spectrum_size; ++c) {
      chosen = select((u.x >= below) & (share.c[c] > F(0.0f)), extinct.c[c], chosen);
      below = below + share.c[c];
    }
    DistanceSample<F> s;
    s.distance = -log(F(1.0f) - u.y) / max(chosen, F(1e-30f));
    s.is_event = scatters & (chosen > F(0.0f)) & (s.distance < length);
    const F way = select(s.is_event, s.distance, length);
    Spectrum<F> left;
    F density = F(0.0f), passes = F(0.0f);
    for (int c = 0; c < spectrum_size; ++c) {
      left.c[c] = select(extinct.c[c] > F(0.0f), attenuation(extinct.c[c] * way), F(1.0f));
      density = density + share.c[c] * extinct.c[c] * left.c[c], passes = passes + share.c[c] * left.c[c];
    }
    for (int c = 0; c < spectrum_size; ++c) {
      const F at_event = scatter.c[c] * left.c[c] / max(density, F(1e-37f));
      const F at_end = left.c[c] / select(scatters, max(passes, F(1e-37f)), F(1.0f));
      s.weight.c[c] = select(s.is_event, at_event, at_end);
    }
    return s;
  }

 private:
  struct Row {
    Spectrum<float> absorption{}, scattering{}, emission{};
    float mean_cosine = 0.0f;
    std::uint32_t phase = 0;
  };
  // The probability that each component decides a distance.
  template <class F>
  static MONTELUX_INLINE Spectrum<F> shares(const Spectrum<F>& throughput) {
    F total = F(0.0f);
    for (int c = 0; c < spectrum_size; ++c) total = total + throughput.c[c];
    const Mask<F> known = (total > F(0.0f)) & (total < F(1e30f));
    return per_component(
        [&](F t) { return select(known, t / select(known, total, F(1.0f)), F(1.0f / float(spectrum_size))); },
        throughput);
  }
  static_assert(sizeof(Row) == (3 * spectrum_size + 2) * sizeof(float));
  template <class F>
  static MONTELUX_INLINE Uint<F> at(Uint<F> medium) {
    return medium * Uint<F>(std::uint32_t(sizeof(Row) / sizeof(float)));
  }
  template <class F>
  MONTELUX_INLINE Spectrum<F> spectrum(Spectrum<float> Row::*member, Uint<F> medium) const {
    const float* first = (rows_.data()->*member).c;
    Spectrum<F> s;
    for (int c = 0; c < spectrum_size; ++c) s.c[c] = gather(first + c, at<F>(medium));
    return s;
  }

  std::vector<Row> rows_;  // the first is empty space
  bool scatters_ = false, emits_ = false;
};

}  // namespace montelux
