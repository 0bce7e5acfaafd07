// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "pendulum/analysis/constancy.h"
#include "pendulum/analysis/fit_models.h"
#include "pendulum/analysis/homogeneity.h"
#include "pendulum/fitting/fit/fit_jointly.h"

namespace pendulum {

/// K >= 1 recordings of one rig and M models. Each model is fitted to each recording alone, and to several at once.
struct FittedRecordings {
  std::vector<std::string> models;            ///< M
  std::vector<FittedRecording> recordings;    ///< K
  std::vector<JointFit> joint = {};           ///< M; an impossible fit is kFailed and gives the reason. K = 1: empty.
  std::vector<Homogeneity> homogeneity = {};  ///< M. K = 1: empty.

  /// The part of model m's fit to all recordings for recording k.
  const FitReport& FitOf(std::size_t k, std::size_t m) const {
    return joint.empty() ? recordings[k].fits[m] : joint[m].runs[k];
  }

  /// Whether the readings of all recordings have the same unit.
  bool HaveOneUnit() const;
};

/// Fits every model to all recordings together, starting from the separate fits (FitJointly), and tests whether the
/// recordings agree (TestHomogeneity). `options` are those of the separate fits. `shared` lists the shared parameters;
/// each model uses those it has. A fit that does not converge because the recordings disagree says so.
FittedRecordings FitTogether(std::vector<FittedRecording> recordings, const FitOptions& options,
                             const std::vector<std::string>& models, const std::vector<std::string>& shared);

}  // namespace pendulum
