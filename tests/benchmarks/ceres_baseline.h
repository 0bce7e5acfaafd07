// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <benchmark/benchmark.h>
#include <ceres/cost_function.h>
#include <ceres/solver.h>

#include "reference_run.h"

/// Timing and accuracy of baselines that pass N residuals to Ceres, for any trajectory. Their cost functions describe
/// the reference run, measured - modelled [rad], with one block of six parameters.
namespace pendulum::benchmarks {

/// A start that a user could guess from the rig's geometry and the plot.
inline constexpr Parameters kGuess = {0.0762, 0.0036, 0.001, 0.41, 1.93, 0.002};

/// The start values that this library estimates from the reference run.
Parameters OurStartValues();

/// Ceres' solution from a start with DENSE_QR and default tolerances, and its counters.
struct CeresSolution {
  Parameters parameters;
  ceres::Solver::Summary summary;
};

CeresSolution SolveByCeres(ceres::CostFunction& cost, const Parameters& start);

/// Largest error of the trajectory at these parameters [rad].
double MaxTrajectoryError(const ceres::CostFunction& cost, const Parameters& parameters);

/// Times residuals, and derivatives if requested, at the true parameters. Counters: max_error_rad, max_jacobian_error
/// (as MaxJacobianError), samples.
void TimeEvaluation(benchmark::State& state, const ceres::CostFunction& cost, bool with_jacobian);

/// Times a solve. Counters: std_errors_from_optimum, max_error_rad, iterations, samples.
void TimeSolve(benchmark::State& state, ceres::CostFunction& cost, const Parameters& start);

}  // namespace pendulum::benchmarks
