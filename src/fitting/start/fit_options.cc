// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/start/fit_options.h"

namespace pendulum {

FitOptions TrialOptions(const Recording& recording, const FitOptions& options, int max_traces) {
  FitOptions trial;
  trial.model = "drag";
  trial.gravity = recording.is_calibrated() ? options.gravity : Gravity::kLinear;
  trial.start = options.start;
  trial.search.max_traces = max_traces;
  trial.noise = IsRobust(options.noise) ? options.noise : NoiseFamily::kGaussian;
  trial.interval = IntervalMethod::kNone;
  trial.threads = options.threads;
  trial.stop = options.stop;
  return trial;
}

}  // namespace pendulum
