// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <stop_token>
#include <vector>

#include <Eigen/Core>

#include "pendulum/closed_form/estimate.h"
#include "pendulum/closed_form/turning_points.h"
#include "pendulum/model/motion_model.h"

namespace pendulum {

/// The formulas of a linear pendulum with viscous friction, applied to two turning points n periods apart (MODEL.md
/// eq. (6.9)). They assume small angles and friction b ω. Inertia and friction are divided by G.
struct LogDecrement {
  std::size_t first = 0;       ///< Index in the table of the turning point at which the n periods begin.
  int periods = 0;             ///< n >= 1
  Estimate damped_frequency;   ///< rad/s, ω_d = 2π n / (t_2n - t_0)
  Estimate log_decrement;      ///< per period, δ = log(x_0 / x_2n) / n
  Estimate damping_ratio;      ///< ζ = δ / sqrt(4π² + δ²)
  Estimate natural_frequency;  ///< rad/s, ω_n = ω_d / sqrt(1 - ζ²)
  Estimate inertia;            ///< s^2, 1 / ω_n²
  Estimate viscous;            ///< s, 2 ζ / ω_n
  /// s^2, the inertia after dividing the period of each half swing by the ratio of the elliptic integral (MODEL.md eq.
  /// (6.1)).
  Estimate corrected_inertia;
  Eigen::MatrixXd gradient;  ///< 4 x 2 M, of (ζ, I, b, corrected I), as for CovarianceOf.
};

/// Applies the formulas to the n periods that follow a turning point. Errors are propagated from times, values and
/// zero. Returns std::nullopt if the turning points do not follow each other for n periods, or one lies on the wrong
/// side of the zero.
std::optional<LogDecrement> ApplyLogDecrement(const TurningPointTable& table, Gravity gravity, std::size_t first,
                                              int periods);

/// The same from the beginning of the longest run of turning points, over the number of periods that gives the damping
/// ratio the smallest standard error. Returns std::nullopt if no run has a whole period, or once a stop is requested.
std::optional<LogDecrement> ApplyLogDecrement(const TurningPointTable& table, Gravity gravity,
                                              const std::stop_token& stop = {});

/// A line of the table of turning points: two damping ratios, from a turning point and the next one on its side, and
/// from the same turning point and the first one on its side in its run.
struct DecayRow {
  std::size_t point = 0;           ///< Index in the table.
  std::optional<Estimate> pair;    ///< ζ from this turning point and the next on its side.
  std::optional<Estimate> so_far;  ///< ζ from this turning point and the first on its side in its run.
  int periods = 0;                 ///< Number of periods in `so_far`.
};

/// One line for each turning point; fewer once a stop is requested.
std::vector<DecayRow> TabulateDecay(const TurningPointTable& table, const std::stop_token& stop = {});

}  // namespace pendulum
