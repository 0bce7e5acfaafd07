// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/start/fit_options.h"

namespace pendulum {

const Rig* SiRig(const FitOptions& options) {
  return options.rig && options.rig->gives_torque ? &*options.rig : nullptr;
}

Result<MotionModel> ModelOf(const FitOptions& options) {
  Result<MotionModel> model = FindMotionModel(options.model);
  if (model) model->gravity = options.gravity.value_or(model->gravity);
  return model;
}

FitOptions TrialOptions(const Recording& recording, const FitOptions& options, int max_traces) {
  FitOptions trial;
  trial.model = "drag";
  const Result<MotionModel> model = ModelOf(options);
  trial.gravity = recording.is_calibrated() && model ? model->gravity : Gravity::kLinear;
  // Model linear alone may be the textbook's approximation of a pendulum, whose misfit is no disturbance.
  const bool may_be_pendulum = options.model == "linear" && !options.gravity;
  if (recording.is_calibrated() && may_be_pendulum) trial.gravity = Gravity::kSine;
  trial.start = options.start;
  trial.search.max_traces = max_traces;
  trial.noise = IsRobust(options.noise) ? options.noise : NoiseFamily::kGaussian;
  trial.interval = IntervalMethod::kNone;
  trial.threads = options.threads;
  trial.stop = options.stop;
  return trial;
}

}  // namespace pendulum
