// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <stop_token>
#include <vector>

#include <Eigen/Core>

#include "pendulum/closed_form/estimate.h"
#include "pendulum/closed_form/peaks.h"
#include "pendulum/model/motion_model.h"

namespace pendulum {

/// What the formulas of a linear pendulum with viscous friction make of two turning points n periods apart (MODEL.md
/// eq. (35)): they take small angles and friction b ω for granted. Units of G.
struct LogDecrement {
  std::size_t first = 0;       ///< The turning point the n periods begin with, in the table.
  int periods = 0;             ///< n >= 1
  Estimate damped_frequency;   ///< rad/s, ω_d = 2π n / (t_2n - t_0)
  Estimate log_decrement;      ///< a period, δ = log(x_0 / x_2n) / n
  Estimate damping_ratio;      ///< ζ = δ / sqrt(4π² + δ²)
  Estimate natural_frequency;  ///< rad/s, ω_n = ω_d / sqrt(1 - ζ²)
  Estimate inertia;            ///< s^2, 1 / ω_n²
  Estimate viscous;            ///< s, 2 ζ / ω_n
  /// s^2, the inertia with the period of each half swing divided by the elliptic integral's (MODEL.md eq. (20)).
  Estimate corrected_inertia;
  Eigen::MatrixXd gradient;  ///< 4 x 2 M, of (ζ, I, b, corrected I), as for CovarianceOf.
};

/// The formulas over the n periods from a turning point on; errors are propagated from times, values and zero.
/// Nothing where the turning points do not follow each other so far, or lie on the wrong side of the zero.
std::optional<LogDecrement> ApplyLogDecrement(const PeakTable& table, Gravity gravity, std::size_t first, int periods);

/// The same over that many periods of the longest run of turning points, from its beginning, that give the damping
/// ratio the smallest standard error. Nothing where no run has a whole period, or once a stop is requested.
std::optional<LogDecrement> ApplyLogDecrement(const PeakTable& table, Gravity gravity,
                                              const std::stop_token& stop = {});

/// A line of the table of turning points: damping ratios with the turning point a period later, and since the first.
struct DecayRow {
  std::size_t peak = 0;            ///< In the table.
  std::optional<Estimate> pair;    ///< ζ of this turning point and the next on its side.
  std::optional<Estimate> so_far;  ///< ζ of the first one on this side in its run and this one.
  int periods = 0;                 ///< Between those two.
};

/// One line for each turning point; not for all once a stop is requested.
std::vector<DecayRow> TabulateDecay(const PeakTable& table, const std::stop_token& stop = {});

}  // namespace pendulum
