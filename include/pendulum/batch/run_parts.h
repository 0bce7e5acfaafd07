// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "pendulum/base/status.h"
#include "pendulum/batch/run_options.h"
#include "pendulum/fitting/swing/choose_swings.h"
#include "pendulum/fitting/swing/fit_swing.h"
#include "pendulum/model/motion_model.h"
#include "pendulum/model/rig.h"
#include "pendulum/recording/recording.h"
#include "pendulum/report/run_report.h"

namespace pendulum {

/// A recording that was read, and the swings to be fitted in it.
struct ReadSwings {
  Recording recording;
  ChosenSwings swings;
  Eigen::Index samples = 0;  ///< As read, before repairs.
  RunReport common;          ///< What the reports of all its swings say.
};

/// Repairs a recording that was read, takes the edges of one that is event-driven unless `fit` asks for other noise,
/// and finds its swings; `rig` wins over what the recording says of its rig. Errors as ParseRig and ChooseSwings.
Result<ReadSwings> FindSwings(Recording read, const SwingChoice& choice, std::optional<Rig> rig,
                              const FitOptions& fit = {});

/// The same from a file. Errors as ReadRecording too.
Result<ReadSwings> ReadOne(const RunOptions& options, const std::string& path, std::optional<Rig> rig);

/// The error of one among several runs, which names its recording and, unless 0, its release.
tl::unexpected<Status> ErrorAmong(const Status& status, const std::string& path, int release);

/// Puts the closed forms with that model's friction into the report.
void AddClosedForms(const MotionModel& model, const Recording& used, RunReport& report);

/// Checks every fit against the closed forms with its own friction; a failed one has an empty check.
void AddChecks(const Recording& used, RunReport& report);

/// How the swing was sampled, beside what turning points and rig tell of its period. An undersampled one shows none,
/// and its fit has warned.
void AddSampling(const FreeSwing& swing, const Recording& used, RunReport& report);

}  // namespace pendulum
