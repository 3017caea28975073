// What is known of a coat (coat_integrals.h) as a function of its roughness, for coats whose roughness is a texture.
#pragma once
#include <map>
#include <memory>
#include <vector>

#include "material/coat_integrals.h"
#include "math/row_gather.h"

namespace montelux {

template <class F>
struct CoatKnowledge {
  F internal;                                       // internal_reflectance(); 0: unknown
  std::array<F, coat_transmittance::terms> series;  // coat_transmittance::series()
};

// Both at a number of roughnesses that increase by the square, and between them by linear interpolation.
class CoatTable {
 public:
  // The index of the coat, and the layer's thickness times extinction.
  CoatTable(float eta, float thickness);

  // Of a coat whose facets have the roughness alpha in both directions, with the errors of
  // coat_transmittance::series(); the internal reflectance within 0.3 %. Nothing is known above max_alpha().
  template <class F>
  CoatKnowledge<F> at(F alpha) const {
    const F place = sqrt(max(alpha - min_alpha, F(0.0f)) * (1 / scale));
    const Mask<F> within = place < F(float(rows - 1));
    const F known_place = select(within, place, F(0.0f));
    const Uint<F> first = to_uint(known_place);
    const F t = known_place - to_float(first);
    const auto low = gather_rows<F>(words_.data(), first), high = gather_rows<F>(words_.data(), first + Uint<F>(1u));
    CoatKnowledge<F> result{select(within, lerp(t, low[0], high[0]), F(0.0f)), {}};
    for (std::size_t k = 0; k < result.series.size(); ++k) result.series[k] = lerp(t, low[k + 1], high[k + 1]);
    const Mask<F> smooth = alpha <= F(min_alpha);
    for (F& term : result.series) term = select(smooth, F(0.0f), term);
    const Mask<F> has_series = Mask<F>(has_series_) & (alpha <= F(coat_transmittance::max_alpha));
    result.series[0] = select(has_series, result.series[0], F(coat_transmittance::none));
    return result;
  }
  static constexpr float max_alpha() { return alpha_at(rows - 1); }

 private:
  // max_alpha of the series is that of a row, so that no series is interpolated with none.
  static constexpr int rows_of_series = 54, rows = 70;
  // Facets below min_alpha are smooth.
  static constexpr float min_alpha = 1.001e-3f, scale = (coat_transmittance::max_alpha - min_alpha) /
                                                        ((rows_of_series - 1) * (rows_of_series - 1));
  static constexpr float alpha_at(float row) { return min_alpha + scale * row * row; }

  std::vector<float> words_;  // one row of words_of_row per roughness: internal reflectance, series
  bool has_series_;
};

// The tables of a scene, each made once.
class CoatTables {
 public:
  std::shared_ptr<const CoatTable> of(float eta, float thickness);

 private:
  std::map<std::pair<float, float>, std::shared_ptr<const CoatTable>> tables_;
};

}  // namespace montelux
