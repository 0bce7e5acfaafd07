// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <stop_token>
#include <string>

#include <Eigen/Core>

#include "pendulum/fitting/residuals/autocorrelation.h"

namespace pendulum {

/// Residuals of a fit near its estimates: y = J δ + z + e. z is Gaussian and autocorrelated, e is the white noise of
/// rounding.
struct CorrelatedResiduals {
  Eigen::VectorXd time;          ///< N x 1, s, increasing
  Eigen::VectorXd residual;      ///< N x 1, rad or rad/s
  Eigen::MatrixXd jacobian;      ///< N x F, of the readings, with respect to the parameters that may change, any units
  Eigen::VectorXd lowest;        ///< F, the smallest shift δ within the bounds (<= 0); -infinity without a bound
  Eigen::VectorXd highest;       ///< F, the largest shift δ within the bounds (>= 0)
  double rounding_variance = 0;  ///< of e: resolution² / 12
};

/// Maximum likelihood of CorrelatedResiduals over δ, the scale of z and its autocorrelation, for a given kind and
/// order.
struct CorrelatedLikelihood {
  double log_likelihood = 0;        ///< of densities, 1/rad or 1/(rad/s)
  Autocorrelation autocorrelation;  ///< of z
  double sigma = 0;                 ///< standard deviation of z, same unit as the residuals
  Eigen::VectorXd shift;            ///< F, δ
  int parameters = 0;               ///< number of parameters of autocorrelation and scale
  Eigen::MatrixXd information;      ///< F x F, of δ, for this autocorrelation and scale
};

/// Exact Gaussian likelihood by a Kalman filter (A. C. Harvey, Forecasting, structural time series models and the
/// Kalman filter, 1989, section 3.4; for gaps R. H. Jones, Technometrics 22:389, 1980). It is maximized in turn over
/// autocorrelation and scale, and over δ by generalized least squares. `like` gives kind, order and start of the
/// autocorrelation. Returns std::nullopt if the result is not finite or a stop is requested. Cost: a few hundred passes
/// over the samples.
std::optional<CorrelatedLikelihood> MaximizeCorrelatedLikelihood(const CorrelatedResiduals& data,
                                                                 const Autocorrelation& like,
                                                                 const std::stop_token& stop = {});

}  // namespace pendulum
