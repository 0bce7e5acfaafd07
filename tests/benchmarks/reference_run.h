// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "pendulum/base/status.h"
#include "pendulum/fitting/fit/fit.h"
#include "pendulum/fitting/likelihood/trajectory_cost.h"
#include "pendulum/fitting/solve/fit_problem.h"
#include "pendulum/model/rig.h"
#include "pendulum/recording/recording.h"

namespace pendulum::benchmarks {

/// Number of samples of the reference run, at 100 Hz; for other numbers it still lasts 20 s.
inline constexpr int kSamples = 2000;

/// inertia [kg m^2], viscous [N m s/rad], coulomb [N m], release_angle [rad], release_time [s], zero_angle [rad].
using Parameters = std::array<double, 6>;

/// True parameters of the simulated reference run.
inline constexpr Parameters kTruth = {0.079, 0.003, 0.001, 0.423, 1.9, 0.012};

/// The value of a library result. Ends the program if there is none, which would be a bug of the benchmark.
template <typename T>
T Expect(Result<T> result) {
  if (result) return *std::move(result);
  throw std::runtime_error(result.error().message());
}

/// The rig of the Control Tutorials' activity: a bob of 0.380 kg on a rod of 0.095 kg and 0.43 m.
const Rig& ReferenceRig();

/// The reference run: Coulomb friction, white noise of `counts` counts, rounded to counts of 0.1985 deg.
Recording ReferenceRecording(int samples = kSamples, double counts = 1);

/// The reference run as the text of a CSV file.
std::string ReferenceCsv();

/// A recording prepared for one model, and parameters at which its trajectory is evaluated. Parameters of the reference
/// run have their true values, others the start values estimated from the data. Units are TrajectoryCost's.
struct EvaluationPoint {
  FitProblem problem;
  std::vector<double> parameters;
};

/// With kMoving, the samples before the release are left out.
EvaluationPoint MakeEvaluationPoint(std::string_view model, StartKind start, int samples = kSamples);

/// Largest difference [rad] between `readings` and the readings of a trajectory computed at a local tolerance of 1e-17.
double MaxReadingError(const EvaluationPoint& point, const Eigen::VectorXd& readings);

/// Largest difference between `jacobian`, the derivatives of the readings with respect to the parameters in SI (N x 6),
/// and the derivatives of that trajectory, relative to the largest entry of the column.
double MaxJacobianError(const EvaluationPoint& point, const Eigen::MatrixXd& jacobian);

/// Largest distance of estimates from the least-squares optimum of the reference run, in standard errors. The optimum
/// is fully converged and belongs to a trajectory computed at a local tolerance of 1e-17.
double DistanceFromOptimum(const Parameters& estimates);

}  // namespace pendulum::benchmarks
