// The integrator that lowers an error most for its cost, chosen by short pilots.
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "film/error_target.h"
#include "integrator/integrator.h"
#include "render/image_settings.h"
#include "render/observer.h"
#include "render/pilot_figures.h"

namespace montelux {

// An integrator that may render an image. All candidates estimate the same image.
struct Candidate {
  std::string name;
  // Called once, before its first pilot, at the same time as that of other candidates; the integrator must outlive the
  // choice.
  std::function<AnyIntegrator()> make;
  double ray_cost = 1;     // the time of a ray, relative to that of the first candidate
  double sample_cost = 1;  // about the time of a sample, likewise: whether there is time for a pilot; measured after
  double making = 0;       // samples of the first candidate that take as long as making it
  bool splats = false;     // CoupledIntegrator::splats()
};

struct ChoiceSettings {
  ImageSettings image;
  // Of a pixel, that the render takes with the first candidate: at most, if an error ends it.
  double samples = 1;
  std::optional<ErrorTarget> target;  // the error to be lowered; by default that of the pixels
  // Noise is removed from the image. A filter averages what differs from pixel to pixel, but leaves noise that
  // neighbours share: errors are those of means over filtered_side x filtered_side pixels.
  bool is_filtered = false;
  // The share of the render's work that pilots should take; they take at most max_pilot_share.
  double share = 0.04;
  int threads = 0;  // 0: all of the machine
};
inline constexpr int filtered_side = 4;
inline constexpr double max_pilot_share = 0.05;

enum class ChoiceReason {
  single,       // there is no other candidate
  too_short,    // the render is too short for pilots
  none_better,  // no candidate is better with confidence
  better,       // the chosen one is better with confidence
  more_light,   // the same, and the first candidate's pilot lacks light that it found
  interrupted,  // the observer requested a stop
};

struct IntegratorChoice {
  std::size_t chosen = 0;
  ChoiceReason reason = ChoiceReason::single;
  std::vector<CandidateRatio> ratios;  // of the candidates that were measured against the first one
  double samples = 0;                  // of a pixel with the first candidate, that take as long as the pilots took
  double share = 0;                    // that is of the work of the pilots and of the render with the first candidate
};

// The choice by successive elimination. Pilots of all candidates on a few windows of the image show which of the others
// may be more efficient than the first candidate. Longer ones compare these with it on more windows. It is kept unless
// another one is better with confidence, by all pilots: by the bootstrap over windows (Efron 1979), whose errors are
// independent. Work is counted in rays, each with the cost of its candidate, so the choice is the same for any number
// of threads and on every run. No pass of a pilot is one of an image: the choice is independent of the image's samples,
// and the image stays unbiased.
//
// A pilot of few samples underestimates the error of a candidate that rarely finds bright light. So the squared errors
// of all candidates are divided by the same expectation, the mean of all pilots; and where one shows more light than
// the other with significance, the squared error of the latter is measured against the mean of the former.
IntegratorChoice choose_by_pilots(const std::vector<Candidate>& candidates, const ChoiceSettings& settings,
                                  RenderObserver& observer);

}  // namespace montelux
