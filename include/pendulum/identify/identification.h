// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include "pendulum/analysis/closed_form_check.h"
#include "pendulum/analysis/constancy.h"
#include "pendulum/analysis/homogeneity.h"
#include "pendulum/analysis/model_comparison.h"
#include "pendulum/closed_form/closed_forms.h"
#include "pendulum/closed_form/free_swing.h"
#include "pendulum/closed_form/sampling.h"
#include "pendulum/fitting/fit/fit.h"
#include "pendulum/fitting/swing/fit_swing.h"
#include "pendulum/model/rig.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

struct DataSummary {
  std::string path, sha256;  ///< As the user named it; of the file's bytes. Empty when it did not come from a file.
  std::string unit = "rad";  ///< Of resolution, residuals and noise: rad, rad/s, counts or volts.
  Eigen::Index samples = 0, used_samples = 0;  ///< In the file; in the fitted window, at least kMinimumSamples.
  double from = 0, to = 0;        ///< Times of the first and the last used sample [s, on the file's clock].
  double resolution = 0;          ///< Spacing of the values; 0 for none.
  std::string resolution_source;  ///< "given", "file" or "found"; empty for none.
  double clock_scale = 1;         ///< True seconds in a second of the file's clock; the fit is in true ones.
  double clock_scale_std_dev = 0;
  std::string begins, ends;                     ///< Why the window is what it is; empty where nothing was chosen.
  std::vector<std::array<double, 2>> releases;  ///< From and to of each free swing that was found [s].
  int release = 0;                              ///< The one that was fitted, from 1; 0: a window as it was asked for.

  double duration() const { return to - from; }                                              ///< s
  double sample_rate() const { return static_cast<double>(used_samples - 1) / duration(); }  ///< Hz, the mean
};

/// Sets what the used samples of a swing say: all but samples, releases and release.
void SummarizeUsed(const Recording& used, const FreeSwing& swing, DataSummary& data);

/// What a fit of several recordings has besides.
struct JointPart {
  std::vector<std::string> shared;  ///< Names of the parameters that the recordings share.
  Homogeneity homogeneity;
  std::vector<std::string> alone;  ///< How the fit to each recording alone ended: its status, and why if not converged.
};

/// Everything that was identified from a free swing, or from several recordings together. Of a joint identification,
/// used samples, data, sampling, calibration and closed forms are in `runs`, and `fits` hold what is shared. Reports in
/// every format are made from it.
struct Identification {
  Recording used;  ///< The N samples that were fitted, without warnings.
  DataSummary data;
  std::optional<Rig> rig;
  nlohmann::ordered_json calibration;  ///< What turned counts or volts into angles, as it was given; null for none.
  std::vector<FitReport> fits;         ///< In the order asked for; empty: closed forms only.
  std::optional<Sampling> sampling;    ///< Of the used samples.
  std::optional<ClosedForms> closed_forms;  ///< Of the used samples, with the friction of the first model.
  std::string closed_forms_model;           ///< The name of that model; empty when no closed forms were asked for.
  std::string no_closed_forms;              ///< Why there are none.
  std::vector<ClosedFormCheck> checks;      ///< One for each fit, in their order, or none at all.
  std::optional<Comparison> comparison;     ///< Of the fits, where several were asked for.
  std::vector<Constancy> constancy;         ///< One for each fit, in their order, or none at all.
  std::vector<JointPart> joint;             ///< One for each fit of several recordings together, else empty.
  std::vector<Identification> runs;         ///< Of a joint fit: each recording, with `fits` as they see it.
  std::vector<Warning> warnings;            ///< Of the recording; a fit's own stand in its FitReport.

  /// The check of the fit of that index, or nullptr.
  const ClosedFormCheck* CheckOf(std::size_t fit) const { return fit < checks.size() ? &checks[fit] : nullptr; }

  /// The constancy of the fit of that index, or nullptr.
  const Constancy* ConstancyOf(std::size_t fit) const { return fit < constancy.size() ? &constancy[fit] : nullptr; }

  bool is_joint() const { return !runs.empty(); }

  /// The identifications of single recordings: `runs` of a joint one, else this one alone.
  std::vector<const Identification*> Parts() const;

  /// The fit that stands for the run: the recommended one, else the first that converged, else the first.
  std::size_t MainFit() const;

  /// Whether text for people gives all of the fit of that index: of a comparison only the main fit.
  bool IsShownInFull(std::size_t fit) const { return !comparison || fit == MainFit(); }
};

/// The exit code of a run: that of its main fit; 0 for closed forms alone.
int ExitCode(const Identification& one);

/// The warnings of the recording, then those of the fits, each said once; of several fits, with the model it is about;
/// of several recordings, with the one it is about, or that it is about each.
std::vector<Warning> AllWarnings(const Identification& report);

/// Whether recording `run` (0-based) of a joint fit is one of several free swings of its file.
bool IsOneOfSeveral(const Identification& report, std::size_t run);

/// "recording 2 (b.csv)": recording `run` (0-based) of a joint fit.
std::string RecordingLabel(const Identification& report, std::size_t run);

}  // namespace pendulum
