// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/joint_fit.h"

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>

#include "pendulum/analysis/inconstancy.h"

namespace pendulum {
namespace {

/// Report of an impossible joint fit, with one run per recording.
JointFit FailedFit(const std::vector<FittedRecording>& recordings, std::size_t m, const std::string& reason) {
  JointFit fit;
  fit.whole.model = recordings.front().fits[m].model;
  fit.whole.termination = Termination::kFailed;
  fit.whole.reason = reason;
  for (const FittedRecording& recording : recordings) {
    fit.runs.push_back(recording.fits[m]);
    WithdrawErrors("the joint fit failed", fit.runs.back());
    fit.runs.back().termination = Termination::kFailed;
    fit.runs.back().reason = reason;
    fit.runs.back().warnings.clear();  // they are about the separate fit
    fit.runs.back().identifiability.clear();
    fit.runs.back().std_error_method.clear();
    fit.runs.back().interval_method.clear();
  }
  return fit;
}

JointFit FitModel(const std::vector<FittedRecording>& recordings, std::size_t m, const FitOptions& options,
                  const std::vector<std::string>& shared) {
  std::vector<JointRun> joint;
  joint.reserve(recordings.size());
  for (const FittedRecording& recording : recordings) joint.push_back({recording.used, recording.fits[m], options});
  Result<JointFit> fit = FitJointly(joint, shared);
  return fit ? *std::move(fit) : FailedFit(recordings, m, fit.error().message());
}

std::vector<RunAlone> FitsAlone(const std::vector<FittedRecording>& recordings, std::size_t m,
                                const FitOptions& options) {
  std::vector<RunAlone> alone;
  for (const FittedRecording& recording : recordings) {
    const Constancy* const constancy = m < recording.constancy.size() ? &recording.constancy[m] : nullptr;
    alone.push_back({recording.label, recording.used, recording.fits[m], options, constancy});
  }
  return alone;
}

/// Whether a parameter differs between recordings by more than its errors from all other sources. Its total error
/// contains the difference.
bool ExceedsOtherErrors(const SharedParameter& between, const FitReport& whole) {
  const ParameterEstimate* const parameter = whole.Find(between.name);
  const auto total = parameter == nullptr ? std::nullopt : TotalStdError(parameter->std_error, parameter->systematic);
  if (!total) return true;
  const double difference = parameter->systematic.Of(ErrorSource::kInconstancy);
  return 2 * difference * difference > *total * *total;
}

/// Judges a disagreement beside the errors of the joint fit. Warns of estimates that mix rigs, and of a disagreement of
/// all parameters together, which the total errors do not contain as they do that of a single parameter.
void SetVerdict(Homogeneity& homogeneity, FitReport& whole) {
  if (homogeneity.agrees()) return;
  const bool is_only_joint = std::ranges::all_of(homogeneity.parameters, &SharedParameter::agrees);
  const bool exceeds = is_only_joint || std::ranges::any_of(homogeneity.parameters, [&](const SharedParameter& one) {
                         return !one.agrees() && ExceedsOtherErrors(one, whole);
                       });
  homogeneity.matters = exceeds || homogeneity.has_different_rigs();
  if (whole.termination != Termination::kConverged) {
    whole.reason += "; under this law the recordings do not agree";
  } else if (!exceeds) {
    homogeneity.verdict += "; the errors from other sources are larger than that";
  } else if (homogeneity.has_different_rigs()) {
    whole.warnings.push_back(
        {.code = "recordings_disagree",
         .finding = "the estimates mix recordings that do not belong together: do not quote them"});
  } else if (is_only_joint) {
    whole.warnings.push_back({.code = "recordings_disagree",
                              .finding = "the errors assume that the recordings agree, but they do not: do not quote "
                                         "them"});
  }
}

}  // namespace

bool FittedRecordings::HaveOneUnit() const {
  const std::string unit = recordings.front().used.value_unit();
  return std::ranges::all_of(recordings, [&](const auto& recording) { return recording.used.value_unit() == unit; });
}

FittedRecordings FitTogether(std::vector<FittedRecording> recordings, const FitOptions& options,
                             const std::vector<std::string>& models, const std::vector<std::string>& shared) {
  FittedRecordings result{models, std::move(recordings)};
  for (std::size_t m = 0; m < models.size(); ++m) {
    ReportProgress(options.progress, "fitting all recordings together with " + models[m], static_cast<int>(m),
                   static_cast<int>(models.size()));
    const FitOptions own = ForModel(options, models[m], models).options;
    const std::vector<RunAlone> alone = FitsAlone(result.recordings, m, own);
    JointFit& fit = result.joint.emplace_back(FitModel(result.recordings, m, own, shared));
    Homogeneity& homogeneity = result.homogeneity.emplace_back(TestHomogeneity(alone, shared));
    AddInconstancyError(alone, homogeneity.parameters, fit.whole, fit.runs);
    AddFrictionLawError(alone, fit.whole, fit.runs);
    SetVerdict(homogeneity, fit.whole);
  }
  return result;
}

}  // namespace pendulum
