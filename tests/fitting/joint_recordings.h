// SPDX-License-Identifier: Apache-2.0
// Several recordings of the textbook's rig, and joint fits that must succeed.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include "pendulum/fitting/fit/fit_jointly.h"
#include "pendulum/fitting/fit/joint_problem.h"
#include "tests/fitting/fit_support.h"

namespace pendulum {

using Recordings = std::vector<Recording>;

inline const std::vector<std::string> kPhysical = {"inertia", "viscous", "coulomb"};

inline Rig RigOfTorque(double std_dev = 0) {
  Rig rig;
  rig.gravity_torque = {kTextbookTorque, std_dev};
  return rig;
}

/// Options in SI units, with intervals from covariances.
inline FitOptions RigOptions() {
  FitOptions options = ModelOptions("coulomb");
  options.rig = RigOfTorque();
  options.interval = IntervalMethod::kCovariance;
  return options;
}

inline std::vector<FitReport> FitAlone(const Recordings& recordings, const FitOptions& options) {
  std::vector<FitReport> alone;
  for (const Recording& recording : recordings) alone.push_back(Fit(recording, options));
  return alone;
}

inline Result<JointFit> TryJointly(const Recordings& recordings, const std::vector<FitReport>& alone,
                                   const FitOptions& options, const std::vector<std::string>& shared = kPhysical) {
  std::vector<JointRun> runs;
  for (std::size_t k = 0; k < recordings.size(); ++k) runs.push_back({recordings[k], alone[k], options});
  return FitJointly(runs, shared);
}

inline JointFit FitAllJointly(const Recordings& recordings, const FitOptions& options,
                              const std::vector<std::string>& shared = kPhysical) {
  return Must(TryJointly(recordings, FitAlone(recordings, options), options, shared));
}

inline void ExpectConverged(const JointFit& fit) {
  EXPECT_EQ(fit.whole.termination, Termination::kConverged) << fit.whole.reason;
  for (const FitReport& run : fit.runs) EXPECT_EQ(run.termination, Termination::kConverged) << run.reason;
}

/// True values in SI (fit_support.h): kg m², N m s/rad, N m.
inline const std::vector<double> kTruthInSi = {0.079, 0.003, 0.004};

/// 10 s of the rig, released at `angle`.
inline SyntheticOptions Released(double angle, std::uint64_t seed) {
  SyntheticOptions run = NoisyRun("coulomb", seed);
  run.release_angle = angle;
  return run;
}

/// An accurate angle, a coarse angle at another sample rate, and a gyro's rate from a start in motion. The noise is
/// larger than one count.
inline Recordings MixedRecordings(std::uint64_t seed = 1) {
  SyntheticOptions coarse = Released(0.8, seed + 1);
  coarse.sample_rate = 60;
  coarse.resolution = kCount;
  coarse.noise = 2.5 * kCount;
  SyntheticOptions gyro = MovingRun("coulomb");
  gyro.quantity = Quantity::kRate;
  gyro.noise = 0.01;
  gyro.duration = 12;
  gyro.seed = seed + 2;
  return {Must(SimulateRecording(Released(0.5, seed))), Must(SimulateRecording(coarse)), Must(SimulateRecording(gyro))};
}

/// Two recordings with their separate fits. The result of Problem() refers to them.
struct TwoRuns {
  FitOptions options;
  Recordings recordings = {Must(SimulateRecording(Released(0.3, 1))), Must(SimulateRecording(Released(0.6, 2)))};
  std::vector<FitReport> alone;

  explicit TwoRuns(FitOptions given = RigOptions()) : options(given), alone(FitAlone(recordings, given)) {}

  JointProblem Problem(const std::vector<std::string>& shared = kPhysical) const {
    const std::vector<JointRun> runs = {{recordings[0], alone[0], options}, {recordings[1], alone[1], options}};
    return Must(MakeJointProblem(runs, shared));
  }
};

/// Estimates of some parameters and their covariance.
struct Estimates {
  Eigen::VectorXd value;
  Eigen::MatrixXd covariance;
};

inline Estimates EstimatesOf(const FitReport& fit, const std::vector<std::string>& names) {
  std::vector<Eigen::Index> rows;
  Eigen::VectorXd value(static_cast<Eigen::Index>(names.size()));
  for (std::size_t i = 0; i < names.size(); ++i) {
    value[static_cast<Eigen::Index>(i)] = fit.Find(names[i])->estimate;
    rows.push_back(std::ranges::find(fit.covariance_names, names[i]) - fit.covariance_names.begin());
  }
  return {value, fit.covariance(rows, rows)};
}

/// The best linear unbiased combination of independent estimates p with covariances C: the estimate (Σ C⁻¹)⁻¹ Σ C⁻¹ p
/// with the covariance (Σ C⁻¹)⁻¹.
inline Estimates Combine(const std::vector<Estimates>& parts) {
  Eigen::MatrixXd precision = Eigen::MatrixXd::Zero(parts[0].value.size(), parts[0].value.size());
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(parts[0].value.size());
  for (const Estimates& part : parts) {
    precision += part.covariance.inverse();
    sum += part.covariance.inverse() * part.value;
  }
  return {precision.inverse() * sum, precision.inverse()};
}

}  // namespace pendulum
