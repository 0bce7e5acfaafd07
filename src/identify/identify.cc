// SPDX-License-Identifier: Apache-2.0
#include "pendulum/identify/identify.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "identify/conclusions.h"
#include "pendulum/analysis/amplitude_dependence.h"
#include "pendulum/analysis/constancy.h"
#include "pendulum/analysis/fit_models.h"
#include "pendulum/analysis/inconstancy.h"
#include "pendulum/analysis/joint_fit.h"
#include "pendulum/analysis/model_comparison.h"
#include "pendulum/analysis/rig_verdict.h"
#include "pendulum/base/format.h"
#include "pendulum/base/parallel.h"
#include "pendulum/base/physics.h"
#include "pendulum/base/try.h"
#include "pendulum/closed_form/free_swing.h"
#include "pendulum/fitting/fit/fit.h"
#include "pendulum/fitting/fit/rig_quantities.h"
#include "pendulum/model/motion_model.h"
#include "pendulum/model/rig_check.h"
#include "pendulum/model/rig_values.h"
#include "pendulum/recording/calibration/calibration_source.h"
#include "pendulum/recording/readers/read_recording.h"
#include "pendulum/recording/sensor.h"
#include "pendulum/recording/sensor_defaults.h"
#include "pendulum/recording/window.h"

namespace pendulum {
namespace {

/// A chosen swing as input of the pipeline TakeSwing -> FitEachAlone -> AddFits -> CompleteRecording.
struct Swing {
  std::string path;
  Recording recording;
  FreeSwing found;
  std::optional<Rig> rig;
  IdentifiedRecording known;
  int release = 0;  ///< Number of the swing if several swings of its recording were chosen, otherwise 0.
};

/// Takes the swing with the number `release` (from 1) out of a prepared recording. The last chosen swing takes over the
/// samples, because a copy of a long recording is large.
Swing TakeSwing(PreparedRecording& from, int release) {
  const bool last = release == from.swings.chosen.back();
  Swing swing;
  swing.path = from.recording.path;
  swing.found = from.swings.found[static_cast<std::size_t>(release - 1)];
  swing.rig = from.rig;
  swing.known = from.known;
  swing.release = from.swings.chosen.size() > 1 ? release : 0;
  swing.known.data.samples = from.samples;
  if (!(swing.found.from_given && swing.found.to_given)) {
    for (const FreeSwing& found : from.swings.found) swing.known.data.releases.push_back({found.from, found.to});
    swing.known.data.release = release;
  }
  swing.recording = last ? std::exchange(from.recording, {}) : from.recording;
  swing.recording.sensor_errors = SensorErrorsOf(swing.recording, swing.found.from, swing.found.to, from.sensor);
  return swing;
}

/// The samples of a swing, without a fit.
Result<FittedRecording> SelectSwing(Recording recording, const FreeSwing& swing) {
  ASSIGN_OR_RETURN(auto used, SelectWindow(std::move(recording), swing.from, swing.to));
  used.warnings.clear();
  return FittedRecording{std::move(used), swing, {}};
}

/// Whether fit m is checked; `main` is the index of the main fit.
bool IsChecked(Checks checks, std::size_t m, std::size_t main) {
  return checks == Checks::kFull || (checks == Checks::kStandard && m == main);
}

/// Tests whether a fit holds over the whole swing, if `is_checked`.
Constancy TestFit(const IdentifyOptions& options, const FitOptions& fit_options, const Recording& used,
                  const FitReport& fit, bool is_checked) {
  if (!is_checked) {
    return UntestedConstancy(used, fit, fit_options,
                             options.checks == Checks::kNone
                                 ? "not tested (--checks none)"
                                 : "only the recommended model is tested; --checks full tests all");
  }
  return TestConstancy(used, fit, ForModel(fit_options, std::string(fit.model.name), options.models).options);
}

/// The model whose closed forms are computed without a fit. For readings in an unknown unit it is the linear model,
/// because only small-angle formulas apply.
MotionModel ClosedFormModel(const IdentifyOptions& options, IdentifiedRecording& recording) {
  const MotionModel asked = *FindMotionModel(options.fit.model);
  const MotionModel linear = *FindMotionModel("linear");
  if (recording.used.is_calibrated() || asked.gravity.is_linear()) return asked;
  recording.warnings.push_back(
      {.code = "uncalibrated",
       .finding = "the readings are in " + recording.used.unit + ", not in a unit of angle",
       .explanation = "the closed forms are those of model linear, which assumes small angles"});
  return linear;
}

/// Whether readings that are named degrees follow the equation of motion much better as radians, because their period
/// depends on the amplitude.
bool FitsBetterInRadians(const Recording& used, const FitReport& fit, const FitOptions& options) {
  constexpr double kMuchLess = 0.7;
  Recording in_radians = used;
  in_radians.value /= kRadFromDeg;
  in_radians.resolution /= kRadFromDeg;
  in_radians.range.reset();
  in_radians.edge.reset();
  FitOptions quick;
  quick.model = fit.model.name;
  quick.search.max_traces = 200;
  quick.search.may_correct = fit.correction.size() > 0;
  quick.noise = NoiseFamily::kGaussian;
  quick.interval = IntervalMethod::kCovariance;
  quick.stop = options.stop;
  const Result<FitReport> other = FitRecording(in_radians, quick);
  return other && other->termination != Termination::kFailed &&
         other->statistics.rms_residual * kRadFromDeg < kMuchLess * fit.statistics.rms_residual;
}

/// Readings in rad under the name of degrees are 57 times too small. Below 0.6 deg the size tells; the period of so
/// small a swing says nothing of its amplitude. Above, a fit of the readings as radians tells. half_period: of the
/// swing [s]. fit: its main fit, or nullptr.
void QuestionUnit(const Recording& used, double half_period, const FitReport* fit, const FitOptions& options,
                  IdentifiedRecording& recording) {
  constexpr double kOddlySmall = 0.6 * kRadFromDeg, kMayBeRadians = 3.4 * kRadFromDeg;
  const bool is_rate = used.unit == "deg/s";
  const bool is_spring = fit != nullptr && fit->model.gravity.is_linear();
  if (is_spring || (used.unit != "deg" && !is_rate)) return;
  if (is_rate && !(half_period > 0)) return;  // the ends of the window were chosen, and no half swings were measured
  const double range = 0.5 * (used.value.maxCoeff() - used.value.minCoeff());
  const double amplitude = is_rate ? range * half_period / kPi : range;
  if (amplitude > kMayBeRadians) return;
  if (amplitude > kOddlySmall && (fit == nullptr || !FitsBetterInRadians(used, *fit, options))) return;
  const std::string degrees = NumberText(amplitude / kRadFromDeg, 3), radians = is_rate ? "rad_s" : "rad";
  recording.warnings.push_back(
      {.code = "unit_questioned",
       .finding = "the pendulum swings by only " + degrees + " deg",
       .advice = std::string("if the readings are in ") + (is_rate ? "rad/s" : "rad") + " (" +
                 NumberText(amplitude / kRadFromDeg / kRadFromDeg, 3) + " deg), correct the unit (--unit " + radians +
                 ", or in the column's name): the period stays, but angles and dry friction are 57.3 times larger",
       .flags = {"unit"},
       .assumed = "readings in deg" + std::string(is_rate ? "/s" : "") + ", though the swing is only " + degrees +
                  " deg (--unit " + radians + ")"});
}

/// Adds the samples, the fits' constancy and the conclusions to recording k. Closed forms have the friction of the
/// model of the main fit.
void CompleteRecording(const IdentifyOptions& options, FittedRecording fitted, std::size_t k,
                       Identification& identification) {
  const std::size_t main = identification.MainFit();
  IdentifiedRecording& recording = identification.recordings[k];
  const FitReport* const fit = identification.fits.empty() ? nullptr : &identification.FitOf(k, main);
  QuestionUnit(fitted.used, fitted.swing.half_period, fit, options.fit, recording);
  SummarizeUsed(fitted.used, fitted.swing, recording.data);
  recording.used = std::move(fitted.used);
  recording.constancy = std::move(fitted.constancy);
  std::optional<MotionModel> model;
  if (fitted.swing.undersampled) {
    recording.no_closed_forms =
        "the samples are too far apart to show turning points: the swing that they show may be the alias of a faster "
        "one";
  } else if (options.checks == Checks::kNone && fit != nullptr) {
    recording.no_closed_forms = "not computed (--checks none)";
  } else {
    model = fit == nullptr ? ClosedFormModel(options, recording) : fit->model;
  }
  const auto is_checked = [&](std::size_t m) { return IsChecked(options.checks, m, main); };
  AddConclusions(fitted.swing, model, is_checked, options.fit.stop, k, identification);
}

// ---- The rig --------------------------------------------------------------------------------------------------------

/// Whether the rig leaves open what pulls the pendulum back.
bool MayBelongToSpring(const std::optional<Rig>& rig) {
  return !rig || (rig->known_inertia && !rig->gravity && !rig->length);
}

/// Gives the models a linear restoring torque if the rig has a stiffness. kInvalidArgument: the user chose gravity.
Result<IdentifyOptions> OptionsForRig(IdentifyOptions options, const std::optional<Rig>& rig) {
  options.fit.may_be_spring = options.fit.may_be_spring && MayBelongToSpring(rig);
  if (!rig || !rig->is_spring) return options;
  for (std::string& name : options.models) {
    const auto model = FindMotionModel(name);
    if (!model) return tl::unexpected(model.error());
    if (model->gravity.is_linear()) continue;
    const auto spring = WithGravity(*model, Gravity::kLinear);
    if (!options.rig_chooses_gravity || !spring) {
      return WithTry(
          ErrorAt(StatusCode::kInvalidArgument, rig->name,
                  "the rig gives the stiffness of a spring, but model " + name +
                      " has the restoring torque of gravity; give " +
                      (spring ? "--gravity linear" : "--model coulomb") + ", or a rig with a gravity torque"),
          {spring ? "--gravity linear" : "--model coulomb"});
    }
    name = spring->name;
  }
  options.fit.model = options.models.front();
  options.fit.gravity = Gravity::kLinear;
  return options;
}

/// Says that the rig changed the models.
void WarnOfSpring(const IdentifyOptions& asked, const IdentifyOptions& options, Identification& identification) {
  if (asked.models == options.models) return;
  identification.warnings.push_back(
      {.code = "linear_restoring_torque",
       .finding =
           "the rig gives a stiffness, so a restoring torque proportional to the angle is assumed, as of a spring "
           "or wire (--gravity linear)",
       .explanation = "a pendulum needs a rig with masses and lengths, or gravity_torque",
       .flags = {"gravity"},
       .assumed = "a spring, as the rig gives a stiffness (--gravity)"});
}

/// Adds what the rig makes known to the fits, and compares the rig with the first converged fit. kDataLoss: the rig
/// contradicts it.
Result<void> ApplyRig(bool is_undersampled, Identification& identification) {
  if (!identification.rig) return {};
  const Rig& rig = *identification.rig;
  for (FitReport& fit : identification.fits) AddRigQuantities(rig, fit);
  const auto converged = std::ranges::find(identification.fits, Termination::kConverged, &FitReport::termination);
  // An undersampled swing has the period that the rig selected among the possible ones.
  if (converged == identification.fits.end() || is_undersampled) return {};
  const auto ratio = std::ranges::find(converged->derived, "gravity_over_inertia", &DerivedQuantity::name);
  if (ratio == converged->derived.end()) return {};
  ASSIGN_OR_RETURN(auto warnings, CompareRigWithSwing(rig, ratio->estimate));
  const bool is_questioned = !warnings.empty();
  std::ranges::move(warnings, std::back_inserter(identification.warnings));
  if (is_questioned) return {};
  const auto verdict = JudgeInertia(identification.rig, identification.fits[identification.MainFit()]);
  if (verdict && verdict->differs())
    identification.warnings.push_back({.code = "inertia_differs_from_rig",
                                       .finding = verdict->finding,
                                       .advice = verdict->advice,
                                       .about = {.parameters = {"inertia"}}});
  return {};
}

// ---- The fits -------------------------------------------------------------------------------------------------------

Result<std::vector<Swing>> TakeAllSwings(std::vector<PreparedRecording> recordings) {
  std::vector<Swing> swings;
  for (PreparedRecording& recording : recordings) {
    for (const int release : recording.swings.chosen) swings.push_back(TakeSwing(recording, release));
  }
  if (swings.size() > 1) return swings;
  return Error(
      StatusCode::kInvalidArgument,
      "--shared is for several recordings, or several releases of one (--release all), but there is only one swing");
}

/// The same readings twice would count as two recordings with independent errors.
Result<void> CheckDifferent(const std::vector<Swing>& swings) {
  for (std::size_t k = 0; k < swings.size(); ++k) {
    for (std::size_t i = 0; i < k; ++i) {
      const Recording& one = swings[i].recording;
      const Recording& other = swings[k].recording;
      if (one.size() != other.size() || swings[i].release != swings[k].release) continue;
      if (one.time != other.time || one.value != other.value) continue;
      return Error(StatusCode::kInvalidArgument, swings[i].path + " and " + swings[k].path +
                                                     " are the same recording: all readings are equal; name it once");
    }
  }
  return {};
}

/// A resolution that is given for all recordings is in the unit of their readings, which must be the same.
Result<void> CheckResolution(const IdentifyOptions& options, const std::vector<Swing>& swings) {
  if (!options.read.resolution) return {};
  const Swing& first = swings.front();
  for (const Swing& swing : swings) {
    if (swing.recording.unit == first.recording.unit) continue;
    return Error(StatusCode::kInvalidArgument, "--resolution is in the file's unit, but " + first.path + " is in " +
                                                   first.recording.unit + " and " + swing.path + " in " +
                                                   swing.recording.unit +
                                                   "; write a line # resolution: VALUE into each file instead");
  }
  return {};
}

/// The one rig that the user gave or that the recordings describe.
Result<std::optional<Rig>> CommonRig(const std::vector<Swing>& swings) {
  const Swing* known = nullptr;
  for (const Swing& swing : swings) {
    if (!swing.rig) continue;
    if (known == nullptr) known = &swing;
    const Rig& rig = *swing.rig;
    const Rig& first = *known->rig;
    const bool is_same = rig.gives_torque ? rig.gravity_torque.value == first.gravity_torque.value &&
                                                rig.gravity_torque.std_dev == first.gravity_torque.std_dev
                                          : rig.source == first.source;
    if (is_same && rig.gives_torque == first.gives_torque && rig.is_spring == first.is_spring) continue;
    return Error(StatusCode::kDataLoss,
                 known->path + " and " + swing.path +
                     " describe different rigs (# rig), but recordings that are fitted together must have one rig; "
                     "give it with --rig, or fit the recordings separately with --shared none");
  }
  return known == nullptr ? std::nullopt : known->rig;
}

/// The names of the recordings in sentences.
std::vector<std::string> LabelsOf(const std::vector<Swing>& swings) {
  Identification all;
  for (const Swing& swing : swings) {
    all.recordings.emplace_back();
    all.recordings.back().data.path = swing.path;
    all.recordings.back().data.release = swing.release;
  }
  std::vector<std::string> labels;
  for (std::size_t k = 0; k < swings.size(); ++k) labels.push_back(RecordingLabel(all, k));
  return labels;
}

/// Fits every model to each swing alone; the samples move into the result. Several swings are fitted at the same time,
/// as recorded, and each fit is tested for constancy, because the test of their agreement needs it.
Result<std::vector<FittedRecording>> FitEachAlone(const IdentifyOptions& options, const FitOptions& fit_options,
                                                  std::vector<Swing>& swings) {
  const bool is_joint = swings.size() > 1;
  const std::vector<std::string> labels = LabelsOf(swings);
  std::vector<Result<FittedRecording>> fitted(swings.size());
  FitOptions each = fit_options;
  if (is_joint) {
    each.threads = 1;
    each.progress = nullptr;
    each.search.may_correct = false;  // the joint fit has the readings as recorded
  }
  const auto count = static_cast<int>(swings.size());
  const auto report = [&](int done) {
    if (is_joint) ReportProgress(fit_options.progress, "fitting each recording", done, count);
  };
  std::atomic<int> done = 0;
  report(done);
  ParallelFor(count, fit_options.threads, [&](int i) {
    if (options.fit.stop.stop_requested()) return;
    const auto k = static_cast<std::size_t>(i);
    Recording& recording = swings[k].recording;
    fitted[k] = options.closed_form_only ? SelectSwing(std::move(recording), swings[k].found)
                                         : FitModels(std::move(recording), swings[k].found, each, options.models);
    if (!is_joint || !fitted[k]) return;
    fitted[k]->label = labels[k];
    for (const FitReport& fit : fitted[k]->fits) {
      const bool is_checked = options.checks != Checks::kNone;
      fitted[k]->constancy.push_back(TestFit(options, each, fitted[k]->used, fit, is_checked));
    }
    report(++done);
  });
  if (options.fit.stop.stop_requested()) return FitStopped();
  std::vector<FittedRecording> recordings;
  for (std::size_t k = 0; k < fitted.size(); ++k) {
    if (!fitted[k] && is_joint) return ErrorOfRun(fitted[k].error(), swings[k].path, swings[k].release);
    if (!fitted[k]) return tl::unexpected(fitted[k].error());
    recordings.push_back(*std::move(fitted[k]));
  }
  return recordings;
}

/// What fit m says across the recordings.
AcrossRecordings AcrossOf(const FittedRecordings& fitted, std::size_t m, const FitOptions& fit_options) {
  AcrossRecordings across;
  for (const FittedRecording& recording : fitted.recordings) {
    const FitReport& fit = recording.fits[m];
    const std::string status(TerminationName(fit.termination));
    across.separate.push_back(fit.termination == Termination::kConverged ? status : status + ": " + fit.reason);
    across.lacks_fit = across.lacks_fit || fit.HasWarning("lack_of_fit");
  }
  if (fitted.recordings.size() > 1) {
    across.shared = fitted.joint[m].shared;
    across.amplitudes = fitted.homogeneity[m].amplitudes;
    across.homogeneity = fitted.homogeneity[m];
    return across;
  }
  const FittedRecording& only = fitted.recordings.front();
  for (const ParameterInfo& parameter : PhysicalParameters(only.fits[m].model)) {
    across.shared.emplace_back(parameter.name);
  }
  const FitOptions own = ForModel(fit_options, fitted.models[m], fitted.models).options;
  across.amplitudes = {MeanAmplitude(only.used, only.fits[m], own)};
  return across;
}

/// Tests whether the parameters of the fits to one recording are constant, and adds what follows to their errors.
void TestFits(const IdentifyOptions& options, const FitOptions& fit_options, std::size_t main, FittedRecording& only,
              std::vector<FitReport>& fits) {
  for (std::size_t m = 0; m < fits.size(); ++m) {
    const bool is_checked = IsChecked(options.checks, m, main);
    if (is_checked) ReportProgress(options.fit.progress, "testing whether the parameters are constant");
    only.constancy.push_back(TestFit(options, fit_options, only.used, fits[m], is_checked));
    const std::vector<RunAlone> alone = {{only.label, only.used, fits[m], fit_options, &only.constancy.back()}};
    AddInconstancyError(alone, {}, fits[m]);
    AddFrictionLawError(alone, fits[m]);
  }
}

/// Adds the warnings of the separate fit about the window, the sampling and other local minima, unless the joint fit
/// repeats them. kOfTheFit lists warnings that the joint fit gives itself if they apply.
void AddOwnWarnings(const FitReport& alone, const FitReport& joint, IdentifiedRecording& recording) {
  constexpr std::array<WarningCode, 8> kOfTheFit = {
      "lack_of_fit",         "correlated_residuals", "zero_drift", "noise_below_resolution",
      "trajectory_accuracy", "prior_conflict",       "at_bound",   "uncertain_stop"};
  for (const Warning& warning : alone.warnings) {
    const bool of_the_fit = std::ranges::find(kOfTheFit, warning.code) != kOfTheFit.end();
    if (!of_the_fit && !joint.HasWarning(warning.code)) recording.warnings.push_back(warning);
  }
  if (alone.termination == Termination::kConverged) return;
  const std::string ended = "the separate fit of this recording is " + std::string(TerminationName(alone.termination));
  const Warning* const why = alone.ReasonWarning();
  recording.warnings.push_back({.code = "separate_fit_not_converged",
                                .finding = ended + ": " + (why == nullptr ? alone.reason : why->finding),
                                .explanation = why == nullptr ? "" : why->explanation,
                                .advice = why == nullptr ? "" : why->advice,
                                .flags = why == nullptr ? std::vector<std::string>() : why->flags});
}

/// Adds the fits: those to the only recording, or of every law to all recordings together. Compares the laws.
void AddFits(const IdentifyOptions& options, const FitOptions& fit_options, FittedRecordings& fitted,
             Identification& identification) {
  const bool is_joint = identification.is_joint();
  if (is_joint) fitted = FitTogether(std::move(fitted.recordings), fit_options, options.models, options.shared);
  if (fitted.models.size() > 1) {
    ReportProgress(fit_options.progress, "comparing the laws");
    identification.comparison = CompareModels(fitted, fit_options);
  }
  if (!fitted.HaveOneUnit()) identification.unit = "sigma";
  std::vector<FittedRecording>& recordings = fitted.recordings;
  for (std::size_t m = 0; m < fitted.models.size(); ++m) {
    identification.across.push_back(AcrossOf(fitted, m, fit_options));
    identification.fits.push_back(is_joint ? fitted.joint[m].whole : std::move(recordings.front().fits[m]));
  }
  const std::size_t main = identification.MainFit();
  if (!is_joint) return TestFits(options, fit_options, main, recordings.front(), identification.fits);
  for (std::size_t k = 0; k < recordings.size(); ++k) {
    IdentifiedRecording& recording = identification.recordings[k];
    for (JointFit& fit : fitted.joint) recording.own_fits.push_back(std::move(fit.runs[k]));
    AddOwnWarnings(recordings[k].fits[main], recording.own_fits[main], recording);
  }
}

Result<Identification> Identify(const IdentifyOptions& asked, std::vector<Swing> swings) {
  const bool is_joint = swings.size() > 1;
  ASSIGN_OR_RETURN(const auto rig, CommonRig(swings));
  ASSIGN_OR_RETURN(auto options, OptionsForRig(asked, rig));
  if (is_joint) options.fit.may_be_spring = false;  // all recordings have the same models
  FitOptions fit_options = options.fit;
  fit_options.rig = rig;
  fit_options.with_losses = options.checks != Checks::kNone && swings.size() == 1;
  ASSIGN_OR_RETURN(auto each, FitEachAlone(options, fit_options, swings));
  FittedRecordings fitted{options.models, std::move(each)};
  Identification identification;
  identification.rig = rig;
  identification.unit = fitted.recordings.front().used.value_unit();
  for (Swing& swing : swings) identification.recordings.push_back(std::move(swing.known));
  WarnOfSpring(asked, options, identification);
  if (!options.closed_form_only) AddFits(options, fit_options, fitted, identification);
  std::vector<FittedRecording>& recordings = fitted.recordings;
  const bool is_undersampled =
      std::ranges::any_of(recordings, [](const FittedRecording& one) { return one.swing.undersampled; });
  RETURN_IF_ERROR(ApplyRig(is_undersampled, identification));
  for (std::size_t k = 0; k < recordings.size(); ++k)
    CompleteRecording(options, std::move(recordings[k]), k, identification);
  if (options.fit.stop.stop_requested()) return FitStopped();
  const IdentifiedRecording& first = identification.recordings.front();
  if (options.closed_form_only && !first.closed_forms)
    return Error(StatusCode::kFailedPrecondition, first.no_closed_forms);
  return identification;
}

}  // namespace

Result<void> CheckBeforeFit(const IdentifyOptions& options, const PreparedRecording& recording) {
  ASSIGN_OR_RETURN(const auto for_rig, OptionsForRig(options, recording.rig));
  if (options.closed_form_only) return {};
  FitOptions fit_options = for_rig.fit;
  fit_options.rig = recording.rig;
  const auto first = static_cast<std::size_t>(recording.swings.chosen.front()) - 1;
  return CheckModels(recording.recording, recording.swings.found[first], fit_options, for_rig.models);
}

std::vector<Result<Identification>> IdentifyEach(const IdentifyOptions& options, PreparedRecording recording) {
  std::vector<Result<Identification>> all;
  const std::vector<int> chosen = recording.swings.chosen;
  const std::string path = recording.recording.path;
  for (const int release : chosen) {
    std::vector<Swing> only;
    only.push_back(TakeSwing(recording, release));
    auto identification = Identify(options, std::move(only));
    // A stop may have caused another error.
    if (!identification && options.fit.stop.stop_requested()) identification = FitStopped();
    if (!identification && chosen.size() > 1) identification = ErrorOfRun(identification.error(), path, release);
    all.push_back(std::move(identification));
  }
  return all;
}

Result<Identification> IdentifyJointly(const IdentifyOptions& asked, std::vector<PreparedRecording> recordings) {
  if (asked.closed_form_only) {
    return Error(StatusCode::kInvalidArgument,
                 "several recordings are identified together by fits; closed forms exist only for a single recording");
  }
  ASSIGN_OR_RETURN(auto swings, TakeAllSwings(std::move(recordings)));
  RETURN_IF_ERROR(CheckDifferent(swings));
  RETURN_IF_ERROR(CheckResolution(asked, swings));
  return Identify(asked, std::move(swings));
}

Result<ReadRun> ReadBytesOfRun(IdentifyOptions& options, const RunFiles& files) {
  ReadRun run;
  if (files.rig) {
    ASSIGN_OR_RETURN(auto parsed, ParseRigWith(options.rig_values, files.rig->bytes, files.rig->name, options.notes));
    run.rig = std::move(parsed);
  }
  if (files.calibration) {
    ASSIGN_OR_RETURN(auto parsed, CalibrationFromText(files.calibration->bytes, files.calibration->name));
    options.read.calibration = std::move(parsed);
  }
  ASSIGN_OR_RETURN(auto read, ParseRecording(files.data.bytes, files.data.name, ReadOptionsOf(options)));
  run.recording = std::move(read);
  return run;
}

Result<Identification> IdentifyBytes(IdentifyOptions options, RunFiles files) {
  auto read = ReadBytesOfRun(options, files);
  files = {};  // the bytes of a long recording take much memory
  if (!read) return tl::unexpected(read.error());
  ASSIGN_OR_RETURN(auto prepared, PrepareRecording(std::move(read->recording), options, std::move(read->rig)));
  return std::move(IdentifyEach(options, std::move(prepared)).front());
}

}  // namespace pendulum
