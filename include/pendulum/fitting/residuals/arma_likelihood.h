// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <stop_token>
#include <string>

#include <Eigen/Core>

#include "pendulum/fitting/residuals/autocorrelation.h"

namespace pendulum {

/// Residuals of a fit as y = J δ + z + e about its estimates: z Gaussian with memory, e the rounding's white noise.
struct CorrelatedResiduals {
  Eigen::VectorXd time;          ///< N x 1, s, increasing
  Eigen::VectorXd residual;      ///< N x 1, rad or rad/s
  Eigen::MatrixXd jacobian;      ///< N x F, derivatives of the readings by the parameters that may move, any units
  Eigen::VectorXd lowest;        ///< F, the least shift δ that bounds allow (<= 0); -infinity where there is none
  Eigen::VectorXd highest;       ///< F, likewise the largest (>= 0)
  double rounding_variance = 0;  ///< of e: resolution² / 12
};

/// The largest likelihood of such residuals over δ, the scale of z and its memory of a given kind and order.
struct CorrelatedLikelihood {
  double log_likelihood = 0;    ///< of densities, 1/rad or 1/(rad/s)
  Autocorrelation memory;       ///< of z
  double sigma = 0;             ///< standard deviation of z, same unit as the residuals
  Eigen::VectorXd shift;        ///< F, δ
  int parameters = 0;           ///< of memory and scale
  Eigen::MatrixXd information;  ///< F x F, of δ at that memory
};

/// Exact Gaussian likelihood by a Kalman filter (A. C. Harvey, Forecasting, structural time series models and the
/// Kalman filter, 1989, section 3.4; R. H. Jones, Technometrics 22:389, 1980, for gaps), maximised over memory and
/// scale, and by generalised least squares over δ in turn. `like` gives the kind and order of the memory, and where to
/// begin. Nothing when no number comes out, or a stop is requested. Cost: a few hundred passes over the samples.
std::optional<CorrelatedLikelihood> MaximizeCorrelatedLikelihood(const CorrelatedResiduals& data,
                                                                 const Autocorrelation& like,
                                                                 const std::stop_token& stop = {});

}  // namespace pendulum
