// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "pendulum/base/status.h"
#include "pendulum/fitting/fit.h"
#include "pendulum/model/rig.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

/// What is said of a recording beside its samples.
struct DataSummary {
  std::string path;                      ///< As the user named it; empty when it did not come from a file.
  std::string sha256;                    ///< Of the file's bytes; empty when it did not come from a file.
  Quantity quantity = Quantity::kAngle;  ///< Decides the unit of resolution, residuals and noise: rad or rad/s.
  Eigen::Index samples = 0;              ///< In the file.
  Eigen::Index used_samples = 0;         ///< In the window that was fitted; at least kMinimumSamples.
  double from = 0;                       ///< Time of the first used sample [s, on the file's clock].
  double to = 0;                         ///< Time of the last used sample [s, on the file's clock].
  double resolution = 0;                 ///< Spacing of the values, rad or rad/s; 0 when the file does not tell.

  double duration() const { return to - from; }                                              ///< s
  double sample_rate() const { return static_cast<double>(used_samples - 1) / duration(); }  ///< Hz, the mean
};

/// The summary of a recording of which `used` was fitted.
DataSummary SummarizeData(const Recording& recording, const Recording& used);

/// All that a run of fit_pendulum found: what every form of the report is made from.
struct RunReport {
  DataSummary data;
  std::optional<Rig> rig;         ///< The rig all fits used.
  std::vector<FitReport> fits;    ///< At least one, in the order asked for.
  std::vector<Warning> warnings;  ///< Of the recording; a fit's own stand in its FitReport.
};

/// The warnings of the recording, then those of the fits, each said once.
std::vector<Warning> AllWarnings(const RunReport& report);

/// Correlation of two free parameters, by their rows in the fit's covariance; NaN when a variance is 0.
double Correlation(const FitReport& fit, Eigen::Index row, Eigen::Index column);

/// How the standard errors of a fit were obtained.
inline constexpr std::string_view kStdErrorMethod = "covariance sigma^2 (J'J)^-1, residuals taken as independent";

}  // namespace pendulum
