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

/// The samples of the reference run, at 100 Hz; it lasts 20 s at any number of samples.
inline constexpr int kSamples = 2000;

/// inertia [kg m^2], viscous [N m s/rad], coulomb [N m], release_angle [rad], release_time [s], zero_angle [rad].
using Parameters = std::array<double, 6>;

/// What the reference run is simulated from.
inline constexpr Parameters kTruth = {0.079, 0.003, 0.001, 0.423, 1.9, 0.012};

/// The value of a result of the library; ends the program when there is none, which would be a bug of the benchmark.
template <typename T>
T Expect(Result<T> result) {
  if (result) return *std::move(result);
  throw std::runtime_error(result.error().message);
}

/// The rig of the Control Tutorials' activity: a bob of 0.380 kg on a rod of 0.095 kg and 0.43 m.
const Rig& ReferenceRig();

/// The reference run: Coulomb friction, white noise of one count, or so many, rounded to counts of 0.1985 deg.
Recording ReferenceRecording(int samples = kSamples, double counts = 1);

/// That recording as a CSV file's text.
std::string ReferenceCsv();

/// A recording ready for one model, and parameters at which its trajectory is to be evaluated: the truth of those the
/// reference run has, the start values found in the data for others. Units are TrajectoryCost's.
struct EvaluationPoint {
  FitProblem problem;
  std::vector<double> parameters;
};

/// kMoving leaves out what comes before the release.
EvaluationPoint MakeEvaluationPoint(std::string_view model, StartKind start, int samples = kSamples);

/// Largest difference of readings [rad] to those of the trajectory at a local tolerance of 1e-17.
double MaxReadingError(const EvaluationPoint& point, const Eigen::VectorXd& readings);

/// Largest difference of derivatives of the readings by the parameters in SI (N x 6) to those of that trajectory, as a
/// share of the largest in their column.
double MaxJacobianError(const EvaluationPoint& point, const Eigen::MatrixXd& jacobian);

/// Largest distance of estimates from the least-squares optimum of the reference run, in standard errors. The optimum
/// is that of the trajectory at a local tolerance of 1e-17, with no step left to make.
double DistanceFromOptimum(const Parameters& estimates);

}  // namespace pendulum::benchmarks
