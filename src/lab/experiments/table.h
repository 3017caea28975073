// The closed table of experiments.
#pragma once
#include "lab/experiments/experiment.h"

namespace montelux::lab {

// K: KAIST "Rendering", chapter 14.
extern const Experiment running_estimate, three_densities, hemisphere_integral, inverse_cdf, rejection_sampling;
// H: CS348B, lecture 6.
extern const Experiment power_function, circle, triangle, variance_rate, efficiency_of_estimators, square_light;
// R: RIS and reservoirs.
extern const Experiment ris, uniform_reservoir, weighted_reservoir, merged_reservoirs, streamed_ris, neighbour_bias;
// B: Monte Carlo integrovani.
extern const Experiment one_light, russian_roulette, qmc_rates;
// F: COS 526.
extern const Experiment stratified_sampling, two_densities, phong_lobe, metropolis_chain;
// T: the methods for light that path tracing hardly finds.
extern const Experiment bidirectional_strategies, metropolis_picture, shrinking_radius, filling_cache;

inline constexpr std::string_view group_k = "Rendering, ch. 14 (Yoon, KAIST)";
inline constexpr std::string_view group_h = "CS348B lecture 6 (Hanrahan)";
inline constexpr std::string_view group_r = "Resampling and reservoirs";
inline constexpr std::string_view group_b = "Monte Carlo integrování (Bulant)";
inline constexpr std::string_view group_f = "COS 526 (Funkhouser)";
inline constexpr std::string_view group_t = "Light that is hard to find";

inline constexpr std::array<const Experiment*, 28> experiment_table{&running_estimate,
                                                                    &three_densities,
                                                                    &hemisphere_integral,
                                                                    &inverse_cdf,
                                                                    &rejection_sampling,
                                                                    &power_function,
                                                                    &circle,
                                                                    &triangle,
                                                                    &variance_rate,
                                                                    &efficiency_of_estimators,
                                                                    &square_light,
                                                                    &ris,
                                                                    &uniform_reservoir,
                                                                    &weighted_reservoir,
                                                                    &merged_reservoirs,
                                                                    &streamed_ris,
                                                                    &neighbour_bias,
                                                                    &one_light,
                                                                    &russian_roulette,
                                                                    &qmc_rates,
                                                                    &stratified_sampling,
                                                                    &two_densities,
                                                                    &phong_lobe,
                                                                    &metropolis_chain,
                                                                    &bidirectional_strategies,
                                                                    &metropolis_picture,
                                                                    &shrinking_radius,
                                                                    &filling_cache};

}  // namespace montelux::lab
