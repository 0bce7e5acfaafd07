// SPDX-License-Identifier: Apache-2.0
// Recordings of the textbook's rig, and the fits of several models to each of them, as input of joint fits.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "pendulum/analysis/joint_fit.h"
#include "tests/analysis/joint_runs.h"
#include "tests/analysis/whole_swing.h"

namespace pendulum {

inline const std::vector<std::string> kThreeLaws = {"viscous", "coulomb", "drag"};

/// Intervals from covariances, without a rig.
inline FitOptions PlainOptions() {
  FitOptions options;
  options.interval = IntervalMethod::kCovariance;
  return options;
}

/// Fits every model to each recording alone.
inline std::vector<FittedRecording> FitEach(const std::vector<Recording>& recordings,
                                            const std::vector<std::string>& models, const FitOptions& options) {
  std::vector<FittedRecording> runs;
  for (const Recording& recording : recordings) {
    const std::string label = "recording " + std::to_string(runs.size() + 1);
    runs.push_back(Must(FitModels(recording, Whole(recording), options, models)));
    runs.back().label = label;
  }
  return runs;
}

inline std::vector<Recording> Simulate(const std::vector<SyntheticOptions>& runs) {
  std::vector<Recording> recordings;
  for (const SyntheticOptions& run : runs) recordings.push_back(Must(SimulateRecording(run)));
  return recordings;
}

/// Runs of 10 s each, released at 0.4, 0.5 ... rad.
inline std::vector<SyntheticOptions> ShortRuns(int count, std::string_view model, std::uint64_t seed) {
  std::vector<SyntheticOptions> runs = SeveralRuns(count, seed, model);
  for (SyntheticOptions& run : runs) {
    run.release_angle += 0.1;
    run.duration = 10;
  }
  return runs;
}

/// Joint fits with all physical parameters shared.
inline FittedRecordings FitJointModels(const std::vector<Recording>& recordings, const std::vector<std::string>& models,
                                       const FitOptions& options) {
  return FitTogether(FitEach(recordings, models, options), options, models, PhysicalNames(models));
}

}  // namespace pendulum
