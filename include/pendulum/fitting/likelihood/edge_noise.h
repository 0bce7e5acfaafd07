// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "pendulum/fitting/likelihood/fit_parameters.h"
#include "pendulum/fitting/likelihood/noise.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

/// Converts an event-driven recording to its edges (ConvertToEdges) unless the user asks for another noise family.
/// Other recordings are returned unchanged.
Recording WithEdges(Recording recording, std::optional<NoiseFamily> noise);

/// Factors of the zero-motion parameter in the readings (N; TrajectoryData::zero_motion_factors). For a drift they are
/// the times [s, from the first sample]; for a lag, minus the direction of each edge. Empty if the zero does not move.
std::vector<double> ZeroMotionFactors(const Recording& recording, const Eigen::Ref<const Eigen::VectorXd>& times,
                                      ZeroMotion zero);

/// Rate dm/dt [rad/s] of the modelled readings m [rad] at N >= 3 increasing times [s], by central differences. Each
/// difference spans at least a thousandth of the mean sample interval.
Eigen::VectorXd RatesOf(const Eigen::Ref<const Eigen::VectorXd>& time,
                        const Eigen::Ref<const Eigen::VectorXd>& readings);

/// Standard deviation of a time stamp divided by the standard deviation of an edge [s/rad]. Both errors add to the
/// variance of a residual: σ² (1 + (ratio · rate)²). The estimate maximizes the likelihood of the differences between
/// successive residuals of edges, which a slow misfit does not affect (MODEL.md eq. (7.6)). Returns 0 if the estimated
/// variance of the time stamps is less than twice its standard error.
double MostLikelyStampRatio(const NoiseModel& noise, const Eigen::Ref<const Eigen::VectorXd>& value,
                            const Eigen::Ref<const Eigen::VectorXd>& readings, const Eigen::VectorXd& rates);

/// Sets stamp_ratio and spread of the noise of edges, from the modelled readings. All arrays N x 1, times in s.
void SetSpread(const Eigen::Ref<const Eigen::VectorXd>& time, const Eigen::Ref<const Eigen::VectorXd>& value,
               const Eigen::Ref<const Eigen::VectorXd>& readings, NoiseModel& noise);

}  // namespace pendulum
