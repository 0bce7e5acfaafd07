// SPDX-License-Identifier: Apache-2.0
#include "tools/fit_joint_run.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include "pendulum/analysis/joint_comparison.h"
#include "pendulum/analysis/joint_fit.h"
#include "pendulum/base/parallel.h"
#include "pendulum/batch/run_parts.h"

namespace pendulum {
namespace {

/// One swing of one recording, on its way into a joint fit.
struct Swing {
  std::string path;
  Recording recording;
  FreeSwing found;
  RunReport report;  ///< What is known of it beside its fits.
  int release = 0;   ///< Unless 0, one of several that were chosen.
};

/// All chosen swings of all recordings.
Result<std::vector<Swing>> ReadSwingsOf(const FitPendulumOptions& options, const Setup& setup) {
  std::vector<Swing> swings;
  for (const std::string& path : setup.paths) {
    auto one = ReadOne(options, path, setup.rig);
    if (!one) return ErrorAmong(one.error(), path, 0);
    const bool several = one->swings.chosen.size() > 1;
    for (const int release : one->swings.chosen) {
      const bool last = release == one->swings.chosen.back();
      Swing swing{path, last ? std::exchange(one->recording, {}) : one->recording,
                  one->swings.found[static_cast<std::size_t>(release - 1)], one->common, several ? release : 0};
      swing.report.data.samples = one->samples;
      if (!(swing.found.from_given && swing.found.to_given)) {
        for (const FreeSwing& found : one->swings.found) swing.report.data.releases.push_back({found.from, found.to});
        swing.report.data.release = release;
      }
      swings.push_back(std::move(swing));
    }
  }
  if (swings.size() > 1) return swings;
  return Error(StatusCode::kInvalidArgument,
               "--shared is for several recordings, or the releases of one (--release all), and there is one swing");
}

/// The rig that the command line gives, or that the recordings describe: it is one.
Result<std::optional<Rig>> RigOf(const std::vector<Swing>& swings) {
  const Swing* known = nullptr;
  for (const Swing& swing : swings) {
    if (!swing.report.rig) continue;
    if (known == nullptr) known = &swing;
    const auto& torque = swing.report.rig->gravity_torque;
    const auto& first = known->report.rig->gravity_torque;
    if (torque.value == first.value && torque.std_dev == first.std_dev) continue;
    return Error(StatusCode::kDataLoss, known->path + " and " + swing.path +
                                            " describe different rigs (# rig), and one rig's recordings are fitted "
                                            "together; give the one of all with --rig, or fit them apart with --shared "
                                            "none");
  }
  return known == nullptr ? std::nullopt : known->report.rig;
}

/// Each recording alone, on as many threads as were asked for.
Result<std::vector<RunModels>> FitAlone(const FitPendulumOptions& options, const FitOptions& fit_options,
                                        std::vector<Swing>& swings, const RunReport& all) {
  std::vector<Result<RunModels>> fitted(swings.size());
  FitOptions each = fit_options;
  if (swings.size() > 1) each.threads = 1;
  ParallelFor(static_cast<int>(swings.size()), fit_options.threads, [&](int i) {
    const auto k = static_cast<std::size_t>(i);
    auto models = FitModels(std::move(swings[k].recording), swings[k].found, each, options.models);
    if (!models) {
      fitted[k] = tl::unexpected(models.error());
      return;
    }
    RunModels run{RecordingLabel(all, k), *std::move(models), {}};
    for (const FitReport& fit : run.alone.fits) {
      const FitOptions own = ForModel(each, std::string(fit.model.name), options.models).options;
      run.constancy.push_back(TestConstancy(run.alone.used, fit, own));
    }
    fitted[k] = std::move(run);
  });
  std::vector<RunModels> runs;
  for (std::size_t k = 0; k < fitted.size(); ++k) {
    if (!fitted[k]) return ErrorAmong(fitted[k].error(), swings[k].path, swings[k].release);
    runs.push_back(*std::move(fitted[k]));
  }
  return runs;
}

/// What the fit to a recording alone warned of, and a joint fit has no words for: its window, its sampling, other
/// minima.
void AddOwnWarnings(const FitReport& alone, const FitReport& joint, RunReport& report) {
  constexpr std::array<std::string_view, 8> kOfTheFit = {"lack_of_fit",  "correlated_residuals", "zero_drift",
                                                         "quiet_sensor", "trace_accuracy",       "prior_conflict",
                                                         "at_bound",     "stop_is_a_kink"};
  for (const Warning& warning : alone.warnings) {
    const bool of_the_fit = std::ranges::find(kOfTheFit, warning.code) != kOfTheFit.end();
    if (!of_the_fit && !joint.Warns(warning.code)) report.warnings.push_back(warning);
  }
  if (alone.termination == Termination::kConverged) return;
  report.warnings.push_back(
      {"not_alone", "fitted alone it is " + std::string(TerminationName(alone.termination)) + ": " + alone.reason});
}

/// What is said of recording k: the joint fits as it sees them, checked against its closed forms.
void CompleteRun(const JointModels& joint, std::size_t k, std::size_t main, RunReport& report) {
  const RunModels& run = joint.runs[k];
  const Recording& used = run.alone.used;
  DataSummary data = SummarizeData(used, used);
  data.samples = report.data.samples;
  data.releases = std::move(report.data.releases);
  data.release = report.data.release;
  data.begins = run.alone.swing.begins;
  data.ends = run.alone.swing.ends;
  report.data = std::move(data);
  for (std::size_t m = 0; m < joint.models.size(); ++m) report.fits.push_back(joint.FitOf(k, m));
  report.constancy = run.constancy;
  AddOwnWarnings(run.alone.fits[main], report.fits[main], report);
  if (run.alone.swing.undersampled) {
    report.no_closed_forms = "the samples are too far apart to show turning points";
  } else {
    AddClosedForms(report.fits[main].model, used, report);
    AddChecks(used, report);
  }
  AddSampling(run.alone.swing, used, report);
}

JointPart PartOf(const JointModels& joint, std::size_t m) {
  JointPart part{joint.joint[m].shared, joint.homogeneity[m], {}};
  for (const RunModels& run : joint.runs) {
    const FitReport& fit = run.alone.fits[m];
    const std::string status(TerminationName(fit.termination));
    part.alone.push_back(fit.termination == Termination::kConverged ? status : status + ": " + fit.reason);
  }
  return part;
}

/// The same readings twice would count as two recordings, whose errors are independent.
Result<void> CheckDifferent(const std::vector<Swing>& swings) {
  for (std::size_t k = 0; k < swings.size(); ++k) {
    for (std::size_t i = 0; i < k; ++i) {
      const Recording& one = swings[i].recording;
      const Recording& other = swings[k].recording;
      if (one.size() != other.size() || swings[i].release != swings[k].release) continue;
      if (one.time != other.time || one.value != other.value) continue;
      return Error(StatusCode::kInvalidArgument, swings[i].path + " and " + swings[k].path +
                                                     " are the same recording, reading for reading; name it once");
    }
  }
  return {};
}

/// All recordings have their paths before they are fitted, for labels.
RunReport LabelsOf(const std::vector<Swing>& swings) {
  RunReport all;
  for (const Swing& swing : swings) {
    all.runs.emplace_back();
    all.runs.back().data.path = swing.recording.path;
    all.runs.back().data.release = swing.release;
  }
  return all;
}

/// A resolution given for all is in the unit of the readings, which then is one.
Result<void> CheckResolution(const FitPendulumOptions& options, const std::vector<Swing>& swings) {
  if (!options.read.resolution) return {};
  const Swing& first = swings.front();
  for (const Swing& swing : swings) {
    if (swing.recording.unit == first.recording.unit) continue;
    return Error(StatusCode::kInvalidArgument, "--resolution is in the file's unit, and " + first.path + " is in " +
                                                   first.recording.unit + ", " + swing.path + " in " +
                                                   swing.recording.unit +
                                                   "; write it into each file instead, as a line # resolution: VALUE");
  }
  return {};
}

/// All chosen swings, which can be fitted together and written.
Result<std::vector<Swing>> ReadFittable(const FitPendulumOptions& options, const Setup& setup) {
  auto swings = ReadSwingsOf(options, setup);
  if (!swings) return swings;
  if (const auto checked = CheckNumberedOutputs(options, setup, swings->size()); !checked) {
    return tl::unexpected(checked.error());
  }
  if (const auto checked = CheckDifferent(*swings); !checked) return tl::unexpected(checked.error());
  if (const auto checked = CheckResolution(options, *swings); !checked) return tl::unexpected(checked.error());
  return swings;
}

/// What is told of all recordings together.
RunReport ReportOf(const JointModels& joint, const FitOptions& options) {
  RunReport report;
  report.rig = options.rig;
  report.data.unit = joint.HaveOneUnit() ? joint.runs.front().alone.used.value_unit() : "sigma";
  for (std::size_t m = 0; m < joint.models.size(); ++m) {
    report.fits.push_back(joint.joint[m].whole);
    report.joint.push_back(PartOf(joint, m));
  }
  if (joint.models.size() > 1) report.comparison = CompareJointModels(joint, options);
  return report;
}

}  // namespace

Result<FitRun> FitJointRun(const FitPendulumOptions& options, const Setup& setup) {
  auto swings = ReadFittable(options, setup);
  if (!swings) return tl::unexpected(swings.error());
  const auto rig = RigOf(*swings);
  if (!rig) return tl::unexpected(rig.error());
  FitOptions fit_options = options.fit;
  fit_options.rig = *rig;
  auto alone = FitAlone(options, fit_options, *swings, LabelsOf(*swings));
  if (!alone) return tl::unexpected(alone.error());
  JointModels joint = FitTogether(*std::move(alone), fit_options, options.models, options.shared);
  FitRun run;
  run.report = ReportOf(joint, fit_options);
  const std::size_t main = run.report.MainFit();
  for (std::size_t k = 0; k < joint.runs.size(); ++k) {
    (*swings)[k].report.rig = *rig;
    CompleteRun(joint, k, main, (*swings)[k].report);
    run.report.runs.push_back(std::move((*swings)[k].report));
    run.used.push_back(std::move(joint.runs[k].alone.used));
  }
  return run;
}

}  // namespace pendulum
