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
#include "pendulum/base/warning.h"
#include "pendulum/closed_form/closed_forms.h"
#include "pendulum/closed_form/free_swing.h"
#include "pendulum/closed_form/sampling.h"
#include "pendulum/fitting/fit/fit.h"
#include "pendulum/fitting/swing/fit_swing.h"
#include "pendulum/model/rig.h"
#include "pendulum/recording/recording.h"
#include "pendulum/recording/sensor_errors.h"

namespace pendulum {

struct DataSummary {
  std::string path, sha256;  ///< Path as given by the user; hash of the file's bytes. Empty if the data is not from a
                             ///< file.
  std::string unit = "rad";  ///< Unit of resolution, residuals and noise: rad, rad/s, counts or volts.
  Eigen::Index samples = 0;  ///< Number of samples in the file.
  Eigen::Index used_samples = 0;  ///< Number of samples in the fitted window, at least kMinimumSamples.
  double from = 0, to = 0;        ///< Times of the first and the last used sample [s, on the file's clock].
  double resolution = 0;          ///< Spacing of the values; 0: none.
  std::string resolution_source;  ///< "given", "file" or "found"; empty: none.
  double clock_scale = 1;         ///< True seconds per second of the file's clock; the fit uses true seconds.
  double clock_scale_std_dev = 0;
  SensorErrors sensor;                          ///< What the sensor may do to the readings.
  std::string begins, ends;                     ///< Why the window begins and ends where it does; may be empty.
  std::vector<std::array<double, 2>> releases;  ///< Begin and end of each free swing found [s].
  int release = 0;  ///< Number of the fitted free swing, from 1; 0: the user gave the window.

  double duration() const { return to - from; }                                              ///< s
  double sample_rate() const { return static_cast<double>(used_samples - 1) / duration(); }  ///< Hz, mean
};

/// Sets all members that follow from the used samples of a swing: all but samples, releases and release.
void SummarizeUsed(const Recording& used, const FreeSwing& swing, DataSummary& data);

/// Additional results of a joint fit.
struct JointPart {
  std::vector<std::string> shared;  ///< Names of the shared parameters.
  Homogeneity homogeneity;
  std::vector<std::string> alone;  ///< How each separate fit ended: its status, and the reason if it did not converge.
  bool lacks_fit = false;          ///< Whether the law does not describe a recording completely in its separate fit.
};

/// Everything that was identified from a free swing, or from several recordings together. In a joint identification,
/// used samples, data, sampling, calibration and closed forms are in `runs`, and `fits` have only the shared
/// parameters. Reports in every format are made from it.
struct Identification {
  Recording used;  ///< The N samples that were fitted, without warnings.
  DataSummary data;
  std::optional<Rig> rig;                   ///< As the user described it; see also si_rig.
  nlohmann::ordered_json calibration;       ///< Converts counts or volts to angles, as given by the user; null: none.
  std::vector<FitReport> fits;              ///< In the order of the requested models; empty: closed forms only.
  std::optional<Sampling> sampling;         ///< Sampling of the used samples.
  std::optional<ClosedForms> closed_forms;  ///< Closed forms of the used samples, with the friction of the first model.
  std::string closed_forms_model;           ///< The name of that model; empty if closed forms were not requested.
  std::string no_closed_forms;              ///< Why there are no closed forms.
  std::vector<ClosedFormCheck> checks;      ///< One per fit, in order; or empty.
  std::optional<Comparison> comparison;     ///< Comparison of the fits, if several were requested.
  std::vector<Constancy> constancy;         ///< One per fit, in order; or empty.
  std::vector<JointPart> joint;             ///< One per joint fit; otherwise empty.
  std::vector<Identification> runs;         ///< Recordings of a joint fit, each with its part of `fits`.
  std::vector<Warning> warnings;            ///< Warnings of the recording; those of a fit are in its FitReport.

  /// The check of fit `fit`, or nullptr.
  const ClosedFormCheck* CheckOf(std::size_t fit) const { return fit < checks.size() ? &checks[fit] : nullptr; }

  /// The constancy of fit `fit`, or nullptr.
  const Constancy* ConstancyOf(std::size_t fit) const { return fit < constancy.size() ? &constancy[fit] : nullptr; }

  /// The rig, if it gives the restoring torque that converts results to SI; otherwise torques are in units of G.
  const std::optional<Rig>& si_rig() const;

  bool is_joint() const { return !runs.empty(); }

  /// The identifications of single recordings: `runs` of a joint one, else this one alone.
  std::vector<const Identification*> Parts() const;

  /// Index of the main fit: the recommended one, otherwise the one with the smallest residuals among those that
  /// converged, otherwise among all.
  std::size_t MainFit() const;

  /// Whether text output shows all details of fit `fit`; in a comparison only those of the main fit.
  bool IsShownInFull(std::size_t fit) const { return !comparison || fit == MainFit(); }
};

/// The exit code of a run: that of its main fit; 0 for closed forms alone.
int ExitCode(const Identification& identification);

/// The warnings of the recording, then those of the fits, without repetitions. With several fits a warning names its
/// model; with several recordings it names its recording, or says that it applies to each.
std::vector<Warning> AllWarnings(const Identification& identification);

/// The warnings that concern fit `fit`: those of the recording or the recordings, and of this fit alone. A warning of a
/// single recording of a joint fit names it.
std::vector<Warning> WarningsOfFit(const Identification& identification, std::size_t fit);

/// Whether recording `run` (0-based) of a joint fit is one of several free swings of its file.
bool IsOneOfSeveral(const Identification& identification, std::size_t run);

/// The label of recording `run` (0-based) of a joint fit: "recording 2 (b.csv)".
std::string RecordingLabel(const Identification& identification, std::size_t run);

}  // namespace pendulum
