// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace pendulum {

/// Systematic errors of S estimates, each in the unit of its parameter.
struct SystematicParts {
  Eigen::MatrixXd covariance;   ///< S x S, of all sources together.
  Eigen::VectorXd rig;          ///< S, standard deviations caused by the rig.
  Eigen::VectorXd inconstancy;  ///< S, standard deviations caused by parameters that are not constant.
};

/// The fit of one recording alone, S parameters.
struct FitAloneResult {
  std::vector<std::string> names;          ///< S
  Eigen::VectorXd value;                   ///< S, each in the unit of its parameter.
  Eigen::MatrixXd covariance;              ///< S x S, statistical.
  std::vector<std::optional<double>> t95;  ///< S, half the 95 % interval over the standard error; absent at a bound.
  SystematicParts systematic;
};

/// Estimates of S parameters from one recording alone, with the errors that can make recordings of one rig differ:
/// noise, parameters that are not constant, and clock and calibration if these differ between the recordings. The
/// errors of the rig are not included, because all recordings share them.
struct SeparateEstimates {
  std::size_t run = 0;             ///< Index of the recording.
  std::vector<std::string> names;  ///< S
  Eigen::VectorXd value;           ///< S, each in the unit of its parameter.
  Eigen::MatrixXd covariance;      ///< S x S, positive definite.
};

/// Names the clock and the calibration of a recording. Recordings with the same text share the errors of both.
/// `calibration`: its JSON text.
std::string SourcesText(double clock_scale, double clock_scale_std_dev, const std::string& calibration);

/// Whether clocks or calibrations differ between recordings, so that their errors cause differences. `sources`: the
/// SourcesText of each.
bool HaveOwnSources(const std::vector<std::string>& sources);

/// Width of a 95 % interval over its width for a normal distribution, at least 1. Student's t is wider: autocorrelated
/// residuals have few effective samples.
double IntervalFactor(double t95);

/// The part of the systematic covariance that differs between recordings of one rig (S x S): always that of parameters
/// that are not constant; that of clock and calibration if `own_sources`; never that of the rig.
Eigen::MatrixXd SystematicBetweenRuns(const SystematicParts& parts, const Eigen::VectorXd& value, bool own_sources);

/// The estimates for a comparison with other recordings. A parameter at its bound gets the largest interval factor of
/// the others. std::nullopt if a number is not finite or a variance is not positive.
std::optional<SeparateEstimates> EstimatesToCompare(const FitAloneResult& fit, bool own_sources);

}  // namespace pendulum
