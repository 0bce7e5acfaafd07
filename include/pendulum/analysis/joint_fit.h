// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "pendulum/analysis/constancy.h"
#include "pendulum/analysis/fit_models.h"
#include "pendulum/analysis/homogeneity.h"
#include "pendulum/fitting/joint/fit_jointly.h"

namespace pendulum {

/// Several recordings of one rig.
struct RunModels {
  std::string label;                 ///< Name in sentences: "recording 2 (b.csv)".
  FittedModels alone;                ///< The fits of each model to the recording alone.
  std::vector<Constancy> constancy;  ///< Constancy of these fits, in their order.
};

/// K recordings and M models; each model is fitted to all recordings at once.
struct JointModels {
  std::vector<std::string> models;       ///< M
  std::vector<RunModels> runs;           ///< K
  std::vector<JointFit> joint;           ///< M; an impossible fit is kFailed and gives the reason.
  std::vector<Homogeneity> homogeneity;  ///< M

  /// The part of model m's joint fit for recording k.
  const FitReport& FitOf(std::size_t k, std::size_t m) const { return joint[m].runs[k]; }

  /// Whether the readings of all recordings have the same unit.
  bool HaveOneUnit() const;
};

/// Fits every model to all recordings together, starting from the separate fits (FitJointly), and tests whether the
/// recordings agree (TestHomogeneity). `options` are those of the separate fits. `shared` lists the shared parameters;
/// each model uses those it has. A fit that does not converge because the recordings disagree says so.
JointModels FitTogether(std::vector<RunModels> runs, const FitOptions& options, const std::vector<std::string>& models,
                        const std::vector<std::string>& shared);

}  // namespace pendulum
