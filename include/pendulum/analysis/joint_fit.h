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
  std::string label;                 ///< For sentences: "recording 2 (b.csv)".
  FittedModels alone;                ///< What each model makes of the recording alone.
  std::vector<Constancy> constancy;  ///< Of these fits, in their order.
};

/// K recordings and M models: each fitted to all recordings at once.
struct JointModels {
  std::vector<std::string> models;       ///< M
  std::vector<RunModels> runs;           ///< K
  std::vector<JointFit> joint;           ///< M; one that cannot be made has failed, and says why.
  std::vector<Homogeneity> homogeneity;  ///< M

  /// Model m's joint fit as recording k sees it.
  const FitReport& FitOf(std::size_t k, std::size_t m) const { return joint[m].runs[k]; }

  /// Whether the readings of all recordings are of one unit.
  bool HaveOneUnit() const;
};

/// Fits every model to all recordings together, from where the fits alone ended (FitJointly), and asks whether they
/// agree (TestHomogeneity). `options` are those of the fits alone, `shared` the names of what is shared, of which each
/// model takes those it has. What does not converge because recordings disagree says so.
JointModels FitTogether(std::vector<RunModels> runs, const FitOptions& options, const std::vector<std::string>& models,
                        const std::vector<std::string>& shared);

}  // namespace pendulum
