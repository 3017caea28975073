// Which strategy of bidirectional path tracing finds a path: by how many vertices from the light and from the eye.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <tuple>
#include <vector>

#include "math/lanes.h"
#include "mc/random.h"

namespace montelux {

// A strategy in each lane, and the probability with which it was chosen.
template <class F>
struct ChosenStrategy {
  Uint<F> light_vertices, eye_vertices;
  F probability;
};

// Chooses the number of scattering events of a path, and then the strategy. The probabilities follow a pilot, mixed
// with others that are positive for every strategy: they decide the noise, and no bias.
class StrategyChoice {
 public:
  static constexpr int piloted_events = 16;
  // Strategies that find a path of so many events, by their number of vertices from the light: light that is seen
  // directly is found by the eye alone.
  static int count(int events) { return events == 0 ? 1 : events + 2; }

  // `brightness`: of the pilot, by number of events and by strategy; it ends after max_events if there are.
  StrategyChoice(const std::vector<std::vector<double>>& brightness, std::optional<int> max_events) {
    const int rows = int(brightness.size());
    std::vector<double> by_events;
    double all = 0;
    for (const auto& row : brightness) {
      double sum = 0;
      for (double b : row) sum += b;
      by_events.push_back(sum), all += sum;
    }
    const bool ends = max_events && *max_events < rows;
    double sum = 0, defensive = 1 - defensive_ratio;
    std::vector<double> p;
    for (int k = 0; k < rows; ++k, defensive *= defensive_ratio) {
      p.push_back(defensive_share * defensive +
                  (all > 0 ? (1 - defensive_share) * by_events[std::size_t(k)] / all : 0));
      sum += p.back();
    }
    // Beyond the pilot the ratio of its last rows continues.
    if (!ends) {
      const double last = by_events[std::size_t(rows - 1)] + by_events[std::size_t(rows - 2)],
                   before = by_events[std::size_t(rows - 3)] + by_events[std::size_t(rows - 4)];
      tail_ratio_ = float(std::clamp(before > 0 ? std::sqrt(last / before) : 0.0, 0.5, 0.98));
      p.push_back(p.back() * tail_ratio_ / (1 - tail_ratio_));
      sum += p.back();
    }
    double end = 0;
    for (double& value : p) events_.push_back(float(end += value / sum));
    events_.back() = 1;
    for (const auto& row : brightness) strategies_.push_back(strategies_of(row));
  }

  // The most events that u_events chooses in one of the lanes.
  template <class F>
  int longest(const F& u_events) const {
    int max_events = 0;
    for (int k = 0; k < lanes_of<F>; ++k) max_events = std::max(max_events, events_at(lane(u_events, k)).first);
    return max_events;
  }

  // u_events, u_strategy: numbers in [0, 1).
  template <class F>
  ChosenStrategy<F> choose(const F& u_events, const F& u_strategy) const {
    ChosenStrategy<F> chosen;
    for (int k = 0; k < lanes_of<F>; ++k) {
      const auto [events, p_events] = events_at(lane(u_events, k));
      const auto [s, p] = strategy_at(events, lane(u_strategy, k));
      set_lane(chosen.light_vertices, k, std::uint32_t(s));
      set_lane(chosen.eye_vertices, k, std::uint32_t(events + 2 - s));
      set_lane(chosen.probability, k, p_events * p);
    }
    return chosen;
  }

  // Numbers with which choose() takes these strategies, uniform in their cells where u_events and u_strategy are
  // uniform in [0, 1).
  template <class F>
  std::pair<F, F> numbers_for(const Uint<F>& light_vertices, const Uint<F>& eye_vertices, F u_events,
                              F u_strategy) const {
    for (int k = 0; k < lanes_of<F>; ++k) {
      const auto s = int(lane(light_vertices, k)), events = s + int(lane(eye_vertices, k)) - 2;
      set_lane(u_events, k, number_of_events(events, lane(u_events, k)));
      const float u = lane(u_strategy, k);
      const bool known = events < int(strategies_.size());
      set_lane(u_strategy, k,
               known ? number_in(strategies_[std::size_t(events)], s, u) : (float(s) + u) / float(count(events)));
    }
    return {u_events, u_strategy};
  }

 private:
  static float number_in(const std::vector<float>& ends, int cell, float u) {
    const float start = cell == 0 ? 0.0f : ends[std::size_t(cell - 1)], end = ends[std::size_t(cell)];
    return std::min(start + u * (end - start), std::nextafter(end, 0.0f));
  }
  // In the tail the numbers of events have a geometric distribution.
  std::pair<int, float> events_at(float u) const {
    const auto [row, p] = cell(events_, u);
    const auto rows = int(strategies_.size());
    if (row < rows) return {row, p};
    const float left = std::max(1 - u, 0x1p-24f) / p;  // what of the tail lies above u
    const auto further = std::max(int(std::log(left) / std::log(tail_ratio_)), 0);
    return {rows + further, p * std::pow(tail_ratio_, float(further)) * (1 - tail_ratio_)};
  }
  std::pair<int, float> strategy_at(int events, float u) const {
    if (events < int(strategies_.size())) return cell(strategies_[std::size_t(events)], u);
    const int all = count(events);
    return {std::min(int(u * float(all)), all - 1), 1 / float(all)};
  }
  float number_of_events(int events, float u) const {
    const int further = events - int(strategies_.size());
    if (further < 0) return number_in(events_, events, u);
    const float tail = 1 - events_[events_.size() - 2], nearer = std::pow(tail_ratio_, float(further));
    return std::min(1 - tail * nearer * (1 - u * (1 - tail_ratio_)), 1 - 0x1p-24f);
  }
  static constexpr double defensive_share = 0.5, defensive_ratio = 0.6;

  static std::vector<float> strategies_of(const std::vector<double>& brightness) {
    double all = 0, end = 0;
    for (double b : brightness) all += b;
    std::vector<float> ends;
    for (double b : brightness)
      ends.push_back(float(end += (all > 0 ? (1 - defensive_share) * b / all : 0) +
                                  (all > 0 ? defensive_share : 1.0) / double(brightness.size())));
    ends.back() = 1;
    return ends;
  }
  // Where u lies among the cells that end there, and the width of the cell.
  static std::pair<int, float> cell(const std::vector<float>& ends, float u) {
    const auto at = std::min(std::upper_bound(ends.begin(), ends.end(), u), ends.end() - 1);
    return {int(at - ends.begin()), *at - (at == ends.begin() ? 0.0f : *(at - 1))};
  }

  std::vector<float> events_;                   // where the cell of each number of events ends; the last is the tail
  std::vector<std::vector<float>> strategies_;  // the same of the strategies, by number of events
  float tail_ratio_ = 0;
};

}  // namespace montelux
