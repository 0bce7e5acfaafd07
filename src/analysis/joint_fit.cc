// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/joint_fit.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "pendulum/analysis/inconstancy.h"

namespace pendulum {
namespace {

/// Report of an impossible joint fit, with one run per recording.
JointFit FailedFit(const std::vector<RunModels>& runs, std::size_t m, const std::string& reason) {
  JointFit fit;
  fit.whole.model = runs.front().alone.fits[m].model;
  fit.whole.termination = Termination::kFailed;
  fit.whole.reason = reason;
  for (const RunModels& run : runs) {
    fit.runs.push_back(run.alone.fits[m]);
    WithdrawErrors("the joint fit failed", fit.runs.back());
    fit.runs.back().termination = Termination::kFailed;
    fit.runs.back().reason = reason;
  }
  return fit;
}

JointFit FitModel(const std::vector<RunModels>& runs, std::size_t m, const FitOptions& options,
                  const std::vector<std::string>& shared) {
  std::vector<JointRun> joint;
  joint.reserve(runs.size());
  for (const RunModels& run : runs) joint.push_back({run.alone.used, run.alone.fits[m], options});
  Result<JointFit> fit = FitJointly(joint, shared);
  return fit ? *std::move(fit) : FailedFit(runs, m, fit.error().message);
}

Homogeneity CompareRuns(const std::vector<RunModels>& runs, std::size_t m, const FitOptions& options,
                        const std::vector<std::string>& shared) {
  std::vector<RunAlone> alone;
  for (const RunModels& run : runs) {
    const Constancy* const constancy = m < run.constancy.size() ? &run.constancy[m] : nullptr;
    alone.push_back({run.label, run.alone.used, run.alone.fits[m], options, constancy});
  }
  return TestHomogeneity(alone, shared);
}

void AddChanges(const std::vector<RunModels>& runs, std::size_t m, const Homogeneity& homogeneity, JointFit& fit) {
  std::vector<ChangingRun> changing;
  for (const RunModels& run : runs) {
    if (m < run.constancy.size()) changing.push_back({run.alone.fits[m], run.constancy[m]});
  }
  AddInconstancyError(changing, homogeneity.parameters, fit);
  AddFrictionLawError(changing, fit);
}

/// If the recordings disagree, adds this to the reason of a fit that did not converge, and a warning otherwise. Both
/// are short, because the homogeneity's verdict is shown beside them.
void SetVerdict(const Homogeneity& homogeneity, FitReport& whole) {
  if (homogeneity.agrees()) return;
  if (whole.termination != Termination::kConverged) {
    whole.reason += "; the recordings do not agree";
    return;
  }
  whole.warnings.push_back({.code = "recordings_disagree",
                            .finding = "the errors assume that the recordings agree, but they do not",
                            .advice = "do not quote them"});
}

}  // namespace

bool JointModels::HaveOneUnit() const {
  const std::string unit = runs.front().alone.used.value_unit();
  return std::ranges::all_of(runs, [&](const RunModels& run) { return run.alone.used.value_unit() == unit; });
}

JointModels FitTogether(std::vector<RunModels> runs, const FitOptions& options, const std::vector<std::string>& models,
                        const std::vector<std::string>& shared) {
  JointModels result{models, std::move(runs), {}, {}};
  for (std::size_t m = 0; m < models.size(); ++m) {
    ReportProgress(options.progress, "fitting all recordings together with " + models[m], static_cast<int>(m),
                   static_cast<int>(models.size()));
    const FitOptions own = ForModel(options, models[m], models).options;
    result.joint.push_back(FitModel(result.runs, m, own, shared));
    result.homogeneity.push_back(CompareRuns(result.runs, m, own, shared));
    SetVerdict(result.homogeneity.back(), result.joint.back().whole);
    AddChanges(result.runs, m, result.homogeneity.back(), result.joint.back());
  }
  return result;
}

}  // namespace pendulum
