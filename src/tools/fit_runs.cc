// SPDX-License-Identifier: Apache-2.0
#include "tools/fit_runs.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "pendulum/analysis/constancy.h"
#include "pendulum/analysis/fit_models.h"
#include "pendulum/analysis/model_comparison.h"
#include "pendulum/model/motion_model.h"
#include "pendulum/recording/data_list.h"
#include "pendulum/recording/sensor.h"
#include "pendulum/recording/window.h"
#include "tools/fit_joint_run.h"
#include "tools/run_parts.h"

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
MotionModel ClosedFormModel(const FitPendulumOptions& options, const Recording& used, RunReport& report) {
  const MotionModel asked = *FindMotionModel(options.fit.model);
  const MotionModel linear = *FindMotionModel("linear");
  if (used.is_calibrated() || asked.name == linear.name) return asked;
  report.warnings.push_back(
      {"uncalibrated", "the readings are in " + used.unit +
                           ", not in an angle's unit; the closed forms are those of model linear, "
                           "which takes small angles for granted"});
  return linear;
}

/// What is concluded from the fits together and from each.
void AddAnalysis(const FitPendulumOptions& options, const FittedModels& fitted, FitRun& run) {
  RunReport& report = run.report;
  FitOptions fit_options = options.fit;
  fit_options.rig = report.rig;
  if (fitted.fits.size() > 1) report.comparison = CompareModels(fitted, fit_options);
  for (const FitReport& fit : fitted.fits) {
    const FitOptions own = ForModel(fit_options, std::string(fit.model.name), options.models).options;
    report.constancy.push_back(TestConstancy(fitted.used, fit, own));
  }
}

/// What is reported of one swing. kFailedPrecondition: there are neither fits nor closed forms.
Result<FitRun> MakeRun(const FitPendulumOptions& options, const ReadSwings& one, int release, FittedModels fitted) {
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
    AddClosedForms(ClosedFormModel(options, used, run.report), used, run.report);
  } else {
    AddClosedForms(run.report.fits[run.report.MainFit()].model, used, run.report);
    AddChecks(used, run.report);
  }
  if (options.closed_form_only && !run.report.closed_forms) {
    return Error(StatusCode::kFailedPrecondition, run.report.no_closed_forms);
  }
  AddSampling(fitted.swing, used, run.report);
  return run;
}

/// Fits the chosen swings of one recording one by one and appends their runs.
void FitOne(const FitPendulumOptions& options, const std::string& path, ReadSwings one, bool among_others,
            std::vector<Result<FitRun>>& runs) {
  FitOptions fit_options = options.fit;
  fit_options.rig = one.common.rig;
  const bool several = one.swings.chosen.size() > 1;
  for (const int release : one.swings.chosen) {
    // The last one needs no copy: a long recording fills the memory.
    const bool last = release == one.swings.chosen.back();
    Recording recording = last ? std::exchange(one.recording, {}) : one.recording;
    const FreeSwing& found = one.swings.found[static_cast<std::size_t>(release - 1)];
    auto fitted = options.closed_form_only ? TakeSwing(std::move(recording), found)
                                           : FitModels(std::move(recording), found, fit_options, options.models);
    Result<FitRun> run = fitted ? MakeRun(options, one, release, *std::move(fitted)) : tl::unexpected(fitted.error());
    if (!run && (among_others || several)) run = ErrorAmong(run.error(), path, several ? release : 0);
    runs.push_back(std::move(run));
  }
}

}  // namespace

Result<Setup> ReadSetup(FitPendulumOptions& options) {
  Setup setup{options.data, options.Inputs(), std::nullopt};
  if (!options.rig.empty()) {
    auto rig = ReadRig(options.rig);
    if (!rig) return tl::unexpected(rig.error());
    setup.rig = *std::move(rig);
  }
  if (!options.calibration.empty()) {
    auto calibration = ReadCalibration(options.calibration);
    if (!calibration) return tl::unexpected(calibration.error());
    options.read.calibration = *std::move(calibration);
  }
  if (options.data_list.empty()) return setup;
  const auto listed = ReadDataList(options.data_list);
  if (!listed) return tl::unexpected(listed.error());
  for (const ListedFile& file : *listed) {
    setup.paths.push_back(file.path.string());
    setup.inputs.push_back({"--data_list", file.path.string()});
  }
  return setup;
}

Result<void> CheckNumberedOutputs(const FitPendulumOptions& options, const Setup& setup, std::size_t count) {
  if (options.IsJoint(setup.paths.size())) {
    if (count > 1 && IsStandardOutput(options.residuals)) {
      return Error(StatusCode::kInvalidArgument, "--residuals " + options.residuals +
                                                     " takes one recording, and there are " + std::to_string(count) +
                                                     "; name a file, and they are numbered");
    }
    return CheckOutputs(options.JointOutputs(static_cast<int>(count)), setup.inputs);
  }
  if (count == 1) return {};
  for (const NamedFile& output : options.Outputs()) {
    if (!IsStandardOutput(output.path)) continue;
    return Error(StatusCode::kInvalidArgument, output.flag + " " + output.path + " takes one fit, and there are " +
                                                   std::to_string(count) + "; name a file, and they are numbered");
  }
  std::vector<NamedFile> outputs;
  for (std::size_t i = 0; i < count; ++i) {
    std::ranges::move(options.Outputs(static_cast<int>(i), static_cast<int>(count)), std::back_inserter(outputs));
  }
  return CheckOutputs(outputs, setup.inputs);
}

Result<std::vector<Result<FitRun>>> FitAll(const FitPendulumOptions& options, const Setup& setup) {
  std::vector<Result<FitRun>> runs;
  if (options.IsJoint(setup.paths.size())) {
    auto joint = FitJointRun(options, setup);
    if (!joint) return tl::unexpected(joint.error());
    runs.emplace_back(*std::move(joint));
    return runs;
  }
  const std::size_t files = setup.paths.size();
  std::size_t count = files;  // of places: at least one for each recording
  for (const std::string& path : setup.paths) {
    auto one = ReadOne(options, path, setup.rig);
    if (!one) {
      runs.emplace_back(files > 1 ? ErrorAmong(one.error(), path, 0) : tl::unexpected(one.error()));
      continue;
    }
    if (const std::size_t more = one->swings.chosen.size() - 1; more > 0) {
      count += more;
      if (const auto checked = CheckNumberedOutputs(options, setup, count); !checked) {
        return tl::unexpected(checked.error());
      }
    }
    FitOne(options, path, *std::move(one), files > 1, runs);
  }
  return runs;
}

}  // namespace pendulum
