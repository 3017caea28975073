// The number of passes and samples of a run, and when to stop.
#pragma once
#include <chrono>

#include "lab/integral/runner.h"
#include "lab/integral/summary.h"

namespace montelux::lab {

inline constexpr std::uint64_t default_samples = 1u << 20;
// If a pass cannot be divided, a stop waits for it.
inline constexpr std::uint64_t max_samples_of_whole_pass = std::uint64_t(1) << 22;

class Schedule {
 public:
  using Clock = std::chrono::steady_clock;

  // `start` is the time when the work began, including pilots and training.
  Schedule(const Technique& technique, const Budget& budget, const Execution& execution, IntegralState& state,
           Clock::time_point start);

  // Throws std::invalid_argument if the number of passes that the method states makes them too long.
  StopReason run();
  bool target_reached() const { return reached_; }
  double confidence() const { return confidence_; }  // of the last test

 private:
  double elapsed() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }
  std::uint64_t spent() const;  // samples of this run
  std::uint64_t max_samples() const { return std::uint64_t(double(*budget_.samples) / traits_.cost); }
  std::uint64_t max_length() const;
  bool add(std::uint32_t begin, std::uint32_t end, std::uint64_t first, std::uint64_t count);
  void observe(double fraction) const;
  std::string_view note() const;

  StopReason run_fixed(std::uint64_t samples);
  std::uint64_t fixed_passes(std::uint64_t samples);
  StopReason run_growing();
  StopReason spend_rest();
  bool affordable(std::uint64_t samples) const;
  double fraction() const;
  double target() const;
  std::optional<StopReason> look();

  const Technique& technique_;
  TechniqueTraits traits_;
  const Budget& budget_;
  const Execution& execution_;
  IntegralState& state_;
  Runner runner_;
  Clock::time_point start_;
  double seconds_before_;
  std::uint64_t evaluations_before_;
  std::uint32_t passes_ = 0;  // of this seed
  std::uint64_t length_ = 0;  // samples of each
  bool reached_ = false;
  double confidence_ = 0;
};

}  // namespace montelux::lab
