// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <stop_token>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "pendulum/fitting/fit/fit_report.h"
#include "pendulum/fitting/likelihood/noise.h"
#include "pendulum/fitting/residuals/autocorrelation.h"
#include "pendulum/fitting/residuals/estimate_autocorrelation.h"
#include "pendulum/fitting/start/fit_options.h"
#include "pendulum/model/parameter.h"
#include "pendulum/model/rig.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

/// Derivatives of each of N readings' log-likelihood l with respect to its modelled value m [rad or rad/s].
struct ReadingTerms {
  Eigen::VectorXd score;        ///< N, ∂l/∂m, 1 / unit of m
  Eigen::VectorXd information;  ///< N, -∂²l/∂m², 1 / unit of m²; for a robust family the mean over the readings
};

/// Terms of N measured values and N modelled readings, rad or rad/s.
ReadingTerms TermsOf(const NoiseModel& noise, const Eigen::VectorXd& value, const Eigen::VectorXd& readings);

/// The covariance of W'score for residuals with this noise and autocorrelation (MODEL.md eq. (7.7)). time N, weights N
/// x K.
Eigen::MatrixXd ScoreCovariance(const NoiseModel& noise, const Autocorrelation& autocorrelation,
                                const ReadingTerms& terms, const Eigen::VectorXd& time, const Eigen::MatrixXd& weights);

/// The autocorrelation of N residuals. time: true s; jacobian: N x K, derivatives with respect to all parameters fitted
/// to the residuals. The result is white if that is possible and the Ljung-Box test gives p > 0.05.
Autocorrelation AutocorrelationOf(const NoiseModel& noise, const Eigen::VectorXd& time, const Eigen::VectorXd& value,
                                  const Eigen::VectorXd& readings, const Eigen::MatrixXd& jacobian,
                                  const std::stop_token& stop = {}, Whiteness whiteness = Whiteness::kPossible);

/// Correction factor for a variance estimated from residuals. The fit of `free` parameters has reduced the expected sum
/// of squares by `lost` variances.
double Inflation(const NoiseModel& noise, Eigen::Index samples, Eigen::Index free, double lost);

/// A fit as a linear function of the readings' scores about its solution, over F parameters.
struct LinearFit {
  /// F parameters: neither fixed nor of the sensor nor, if `with_bounds`, at a bound.
  std::vector<Eigen::Index> free;
  Eigen::MatrixXd jacobian;   ///< N x P, of the readings with respect to the report's parameters.
  Eigen::MatrixXd inverse;    ///< F x F, inverse of the information: products of the report's units.
  Eigen::MatrixXd influence;  ///< N x F: its transpose times the scores is the estimates' change [report's units].
};

/// std::nullopt: the trajectory cannot be computed, the readings do not determine the F parameters, or a stop was
/// requested.
std::optional<LinearFit> LinearizeFit(const Recording& recording, const FitReport& fit, const std::optional<Rig>& rig,
                                      const ReadingTerms& terms, const ParameterPriors& priors, bool with_bounds,
                                      const std::stop_token& stop = {});

/// The noise of a fit whose readings are censored below `low` and above `high`.
NoiseModel NoiseOfFit(const FitReport& fit, double low, double high);

/// The noise of a fit, with the sensor's range.
NoiseModel NoiseOfFit(const Recording& used, const FitReport& fit, const FitOptions& options);

/// Inertia and friction estimated from the readings without bounds: K free parameters, in the report's units.
struct UnboundedEstimate {
  std::vector<std::string_view> names;    ///< K
  Eigen::VectorXd value;                  ///< K
  Eigen::MatrixXd covariance;             ///< K x K
  Eigen::MatrixXd likelihood_covariance;  ///< K x K, of the likelihood alone, without autocorrelation.
  double gain = 0;                        ///< By how much the step from the fit lowers the deviance.
};

/// One step from the fit to the maximum of the likelihood without bounds. std::nullopt as LinearizeFit.
std::optional<UnboundedEstimate> EstimateUnbounded(const Recording& part, const FitReport& fit, const NoiseModel& noise,
                                                   const std::optional<Rig>& rig, const std::stop_token& stop = {});

/// The same of a fit that is linearized already, without bounds and with these terms of its readings. noise,
/// autocorrelation: of its residuals.
UnboundedEstimate EstimateUnbounded(const Recording& part, const FitReport& fit, const NoiseModel& noise,
                                    const ReadingTerms& terms, const LinearFit& linear,
                                    const Autocorrelation& autocorrelation);

/// dᵀ C⁻¹ d, with C scaled to unit diagonal; NaN unless C is positive definite.
double SquaredLength(const Eigen::VectorXd& difference, const Eigen::MatrixXd& covariance);

}  // namespace pendulum
