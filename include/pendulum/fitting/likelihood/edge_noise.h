// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "pendulum/fitting/likelihood/fit_parameters.h"
#include "pendulum/fitting/likelihood/noise.h"
#include "pendulum/recording/recording.h"

namespace pendulum {

/// The edges of an event-driven recording (TakeEdges), unless another noise family is asked for; others unchanged.
Recording WithEdges(Recording recording, std::optional<NoiseFamily> noise);

/// What the parameter of a zero's motion multiplies in the readings (N; TrajectoryData::moves): the times [s, from the
/// first sample], or minus the direction of each edge; none of a zero that has no motion.
std::vector<double> Moves(const Recording& recording, const Eigen::Ref<const Eigen::VectorXd>& times, ZeroMotion zero);

/// dm/dt of the modelled readings m [rad] at N >= 3 increasing times [s], between the neighbours of each, or those of
/// these where they are a thousandth of a mean interval apart; rad/s.
Eigen::VectorXd RatesOf(const Eigen::Ref<const Eigen::VectorXd>& time,
                        const Eigen::Ref<const Eigen::VectorXd>& readings);

/// Standard deviation of the stamps over that of the edges [s/rad]: of what both add to the variance of a residual,
/// σ² (1 + (ratio · rate)²), the likeliest for the differences of successive residuals of edges, which a slow misfit
/// leaves alone (MODEL.md eq. (83)). 0 where the stamps' part is within two of its standard errors.
double LikeliestStampRatio(const NoiseModel& noise, const Eigen::Ref<const Eigen::VectorXd>& value,
                           const Eigen::Ref<const Eigen::VectorXd>& readings, const Eigen::VectorXd& rates);

/// Tells the noise of edges its stamp_ratio and spread at the modelled readings; all N each, times in s.
void SetSpread(const Eigen::Ref<const Eigen::VectorXd>& time, const Eigen::Ref<const Eigen::VectorXd>& value,
               const Eigen::Ref<const Eigen::VectorXd>& readings, NoiseModel& noise);

}  // namespace pendulum
