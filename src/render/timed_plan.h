// Plans for renders that end by time.
#pragma once
#include "render/render.h"

namespace montelux {

// A plan, and the measurement that it is based on.
struct TimedPlan {
  PassPlan plan;              // with a stride above 1 if less than one sample per pixel fits into the time
  double sample_seconds = 0;  // the measured time of one sample of every pixel
  double first_seconds = 0;   // that of the first sample of the pixels of the plan, including the warm-up of a series
};

// The passes have as many samples as possible while there are enough passes. Measures the speed on a part of the pixels
// that is spread over the image. Ends early if the observer requests a stop.
TimedPlan plan_for_time(const AnyIntegrator& integrator, RenderSettings settings, const TimeLimit& limit,
                        RenderObserver& observer);

// The plan for a TimeBudget: one series of a coupled integrator, synchronous passes of one sample of any other one,
// with more frames or passes than the time allows.
PassPlan plan_for_budget(const AnyIntegrator& integrator);

}  // namespace montelux
