// SPDX-License-Identifier: Apache-2.0
#include "pendulum/batch/fit_run.h"

#include <algorithm>
#include <cstddef>
#include <stop_token>
#include <string>
#include <utility>

#include "pendulum/analysis/closed_form_check.h"
#include "pendulum/analysis/constancy.h"
#include "pendulum/analysis/fit_models.h"
#include "pendulum/analysis/inconstancy.h"
#include "pendulum/analysis/model_comparison.h"
#include "pendulum/closed_form/closed_forms.h"
#include "pendulum/model/motion_model.h"
#include "pendulum/recording/window.h"

namespace pendulum {
namespace {

/// The samples of a swing, without a fit.
Result<FittedModels> TakeSwing(Recording recording, const FreeSwing& swing) {
  auto used = SelectWindow(std::move(recording), swing.from, swing.to);
  if (!used) return tl::unexpected(used.error());
  used->warnings.clear();
  return FittedModels{*std::move(used), swing, {}};
}

/// The model whose closed forms are asked for. An angle in an unknown unit has only those of small angles.
MotionModel ClosedFormModel(const RunOptions& options, const Recording& used, RunReport& report) {
  const MotionModel asked = *FindMotionModel(options.fit.model);
  const MotionModel linear = *FindMotionModel("linear");
  if (used.is_calibrated() || asked.name == linear.name) return asked;
  report.warnings.push_back(
      {"uncalibrated", "the readings are in " + used.unit +
                           ", not in an angle's unit; the closed forms are those of model linear, "
                           "which takes small angles for granted"});
  return linear;
}

bool IsStopped(const RunOptions& options) { return options.fit.stop.stop_requested(); }

/// What is concluded from the fits together and from each, but for what is left out when it is stopped.
void AddAnalysis(const RunOptions& options, FittedModels& fitted, FitRun& run) {
  RunReport& report = run.report;
  FitOptions fit_options = options.fit;
  fit_options.rig = report.rig;
  if (fitted.fits.size() > 1) report.comparison = CompareModels(fitted, fit_options);
  for (FitReport& fit : fitted.fits) {
    if (IsStopped(options)) return;
    const FitOptions own = ForModel(fit_options, std::string(fit.model.name), options.models).options;
    report.constancy.push_back(TestConstancy(fitted.used, fit, own));
    CountInconstancy(report.constancy.back(), fit);
  }
}

/// As AddClosedForms of run_parts.h, until it is stopped.
void AddClosedForms(const MotionModel& model, const Recording& used, const std::stop_token& stop, RunReport& report) {
  auto forms = EstimateClosedForms(used, model, stop);
  if (!forms) {
    report.no_closed_forms = forms.error().message;
    return;
  }
  report.closed_forms = *std::move(forms);
  report.closed_forms_model = model.name;
}

/// As AddChecks of run_parts.h, until it is stopped.
void AddChecks(const Recording& used, const std::stop_token& stop, RunReport& report) {
  if (!report.closed_forms) return;
  for (const FitReport& fit : report.fits) {
    report.checks.emplace_back();
    if (fit.termination == Termination::kFailed) continue;
    const bool same = fit.model.name == report.closed_forms_model;
    const auto own = same ? Result<ClosedForms>(*report.closed_forms) : EstimateClosedForms(used, fit.model, stop);
    if (own) report.checks.back() = CheckClosedForms(used, *own, fit, report.rig, stop);
  }
}

/// What is reported of one swing, without meaning once it is stopped. kFailedPrecondition: there are neither fits nor
/// closed forms.
Result<FitRun> MakeRun(const RunOptions& options, const ReadSwings& one, int release, FittedModels fitted) {
  FitRun run{one.common, {}};
  run.report.data = SummarizeData(fitted.used, fitted.swing, one.swings, release, one.samples);
  if (!options.closed_form_only) AddAnalysis(options, fitted, run);
  run.used.push_back(std::move(fitted.used));
  const Recording& used = run.used.front();
  run.report.fits = std::move(fitted.fits);
  if (fitted.swing.undersampled) {
    run.report.no_closed_forms =
        "the samples are too far apart to show turning points: what they seem to show may be a faster swing's alias";
  } else if (options.closed_form_only) {
    AddClosedForms(ClosedFormModel(options, used, run.report), used, options.fit.stop, run.report);
  } else {
    AddClosedForms(run.report.fits[run.report.MainFit()].model, used, options.fit.stop, run.report);
    AddChecks(used, options.fit.stop, run.report);
  }
  if (IsStopped(options)) return FitStopped();
  if (options.closed_form_only && !run.report.closed_forms) {
    return Error(StatusCode::kFailedPrecondition, run.report.no_closed_forms);
  }
  AddSampling(fitted.swing, used, run.report);
  return run;
}

/// One chosen swing, `release`, of a recording that is used up.
Result<FitRun> FitOne(const RunOptions& options, const ReadSwings& one, int release, Recording recording) {
  if (IsStopped(options)) return FitStopped();
  FitOptions fit_options = options.fit;
  fit_options.rig = one.common.rig;
  const FreeSwing& found = one.swings.found[static_cast<std::size_t>(release - 1)];
  auto fitted = options.closed_form_only ? TakeSwing(std::move(recording), found)
                                         : FitModels(std::move(recording), found, fit_options, options.models);
  Result<FitRun> run = fitted ? MakeRun(options, one, release, *std::move(fitted)) : tl::unexpected(fitted.error());
  if (IsStopped(options)) return FitStopped();  // whatever the pieces have made of it
  return run;
}

}  // namespace

std::vector<Result<FitRun>> FitRuns(const RunOptions& options, ReadSwings one) {
  std::vector<Result<FitRun>> runs;
  const std::string path = one.recording.path;
  const bool several = one.swings.chosen.size() > 1;
  for (const int release : one.swings.chosen) {
    // The last one needs no copy: a long recording fills the memory.
    const bool last = release == one.swings.chosen.back();
    Recording recording = last ? std::exchange(one.recording, {}) : one.recording;
    Result<FitRun> run = FitOne(options, one, release, std::move(recording));
    if (!run && several) run = ErrorAmong(run.error(), path, release);
    runs.push_back(std::move(run));
  }
  return runs;
}

int ExitCodeOf(const FitRun& run) {
  const RunReport& report = run.report;
  return report.fits.empty() ? 0 : ExitCode(report.fits[report.MainFit()].termination);
}

}  // namespace pendulum
