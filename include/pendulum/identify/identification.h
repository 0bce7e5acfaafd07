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
  std::optional<LeftOut> left_out;              ///< What the window leaves out of its free swing.
  std::vector<std::array<double, 2>> releases;  ///< Begin and end of each free swing found [s].
  int release = 0;  ///< Number of the fitted free swing, from 1; 0: the user gave the window.

  double duration() const { return to - from; }                                              ///< s
  double sample_rate() const { return static_cast<double>(used_samples - 1) / duration(); }  ///< Hz, mean
};

/// Sets all members that follow from the used samples of a swing: all but samples, releases and release.
void SummarizeUsed(const Recording& used, const FreeSwing& swing, DataSummary& data);

/// One of the recordings of an Identification, and what was found in it alone.
struct IdentifiedRecording {
  Recording used;  ///< The N samples that were fitted, without warnings.
  DataSummary data;
  nlohmann::ordered_json calibration;       ///< Converts counts or volts to angles, as given by the user; null: none.
  std::optional<Sampling> sampling;         ///< Sampling of the used samples.
  std::optional<ClosedForms> closed_forms;  ///< Closed forms of the used samples, with the friction of the main fit.
  std::string closed_forms_model;           ///< The name of that model; empty if closed forms were not requested.
  std::string no_closed_forms;              ///< Why there are no closed forms.
  std::vector<FitReport> own_fits;          ///< One of several recordings: its part of each fit. See FitOf.
  std::vector<ClosedFormCheck> checks;      ///< One per fit, in order; or empty.
  std::vector<Constancy> constancy;         ///< One per fit, in order; or empty.
  std::vector<Warning> warnings;            ///< Warnings of the recording; those of a fit are in its FitReport.

  /// The check of fit `fit`, or nullptr.
  const ClosedFormCheck* CheckOf(std::size_t fit) const { return fit < checks.size() ? &checks[fit] : nullptr; }

  /// The constancy of fit `fit`, or nullptr.
  const Constancy* ConstancyOf(std::size_t fit) const { return fit < constancy.size() ? &constancy[fit] : nullptr; }
};

/// What one fit says across its K recordings.
struct AcrossRecordings {
  std::vector<std::string> shared;         ///< Names of the parameters that all recordings share.
  std::vector<double> amplitudes;          ///< K, of each recording's motion, rms [rad]; NaN if unknown.
  std::vector<std::string> separate;       ///< K: how the fit of each recording alone ended: status, and reason.
  std::optional<Homogeneity> homogeneity;  ///< Whether the recordings agree; absent for one.
  bool lacks_fit = false;  ///< Whether the law does not describe a recording completely in its separate fit.
};

/// Everything that was identified from K >= 1 free swings of one pendulum. Reports in every format are made from it.
struct Identification {
  std::vector<IdentifiedRecording> recordings;  ///< K
  std::optional<Rig> rig;                       ///< As the user described it; see also si_rig.
  std::string unit = "rad";  ///< Of the residuals of all recordings; "sigma" if their readings have several units.
  /// The fits to all recordings, in the order of the requested models; empty: closed forms only. A fit to one recording
  /// has all parameters, a fit to several has those that they share.
  std::vector<FitReport> fits;
  std::vector<AcrossRecordings> across;  ///< One per fit.
  std::optional<Comparison> comparison;  ///< Comparison of the fits, if several were requested.
  std::vector<Warning> warnings;         ///< Those that are not about one recording or one fit.

  /// Fit m of recording k, with all parameters of the recording.
  const FitReport& FitOf(std::size_t k, std::size_t m) const {
    return is_joint() ? recordings[k].own_fits[m] : fits[m];
  }
  FitReport& FitOf(std::size_t k, std::size_t m) { return is_joint() ? recordings[k].own_fits[m] : fits[m]; }

  /// The rig, if it gives the restoring torque that converts results to SI; otherwise torques are in units of G.
  const std::optional<Rig>& si_rig() const;

  /// Whether several recordings were fitted together.
  bool is_joint() const { return recordings.size() > 1; }

  /// The path of the only recording; empty for several.
  std::string path() const { return is_joint() ? "" : recordings.front().data.path; }

  /// Whether fit m determines the pendulum of all recordings: inertia and all friction parameters are shared.
  bool SharesMotion(std::size_t m) const;

  /// Index of the main fit: the recommended one, otherwise the one with the smallest residuals among those that
  /// converged, otherwise among all.
  std::size_t MainFit() const;

  /// Whether text output shows all details of fit `fit`; in a comparison only those of the main fit.
  bool IsShownInFull(std::size_t fit) const { return !comparison || fit == MainFit(); }
};

/// The exit code of a run: that of its main fit; 0 for closed forms alone.
int ExitCode(const Identification& identification);

/// All warnings without repetitions: of the whole, of the only recording, of the fits, of each of several recordings.
/// With several fits a warning names its model; with several recordings it names its recording, or says that it applies
/// to each.
std::vector<Warning> AllWarnings(const Identification& identification);

/// The same with the warnings of fit `fit` alone. A warning of one of several recordings names it.
std::vector<Warning> WarningsOfFit(const Identification& identification, std::size_t fit);

/// Whether recording k (0-based) is one of several free swings of its file.
bool IsOneOfSeveral(const Identification& identification, std::size_t k);

/// The label of recording k (0-based): "recording 2 (b.csv)".
std::string RecordingLabel(const Identification& identification, std::size_t k);

}  // namespace pendulum
