// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>
#include <span>
#include <stop_token>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <ceres/cost_function.h>

#include "pendulum/fitting/likelihood/least_squares.h"
#include "pendulum/fitting/likelihood/noise.h"
#include "pendulum/model/motion_model.h"
#include "pendulum/model/sensor_model.h"
#include "pendulum/recording/recording.h"
#include "pendulum/trajectory/trajectory.h"

namespace pendulum {

/// The samples that a trajectory is compared with. Times start at the first sample, so a clock with large numbers loses
/// no digits.
struct TrajectoryData {
  Quantity quantity = Quantity::kAngle;
  std::vector<double> time, value;  ///< N: s, increasing, time[0] = 0; rad or rad/s, or the unit of another sensor.
  SensorModel sensor;               ///< How readings depend on the motion.
  double natural_frequency = 0;     ///< rad/s, approximate; parameters with a very different time scale are rejected.
  double latest_release = 0;        ///< s; a release outside [0, latest_release] is rejected.
  /// N, or empty: the factors of one additional parameter in the readings. They are the times if the zero drifts, or
  /// minus the direction of each edge if edges lag.
  std::vector<double> zero_motion_factors;
  double scale = 1;      ///< rad or rad/s; roughly the noise, so Ceres' numbers are near 1.
  std::stop_token stop;  ///< After a stop request nothing more is evaluated.

  Eigen::Map<const Eigen::VectorXd> times() const { return {time.data(), static_cast<Eigen::Index>(time.size())}; }
  Eigen::Map<const Eigen::VectorXd> values() const { return {value.data(), static_cast<Eigen::Index>(value.size())}; }
};

/// The motion at N instants: angle [rad], rate [rad/s] and acceleration [rad/s²]. If requested, also their derivatives
/// (N x M each) with respect to the parameters before the zero.
struct MotionStates {
  std::array<Eigen::VectorXd, SensorModel::kStates> value;
  std::array<Eigen::MatrixXd, SensorModel::kStates> jacobian;
};

/// The cost of one trajectory as least squares: samples, sensitivities and likelihood. A fit evaluates it repeatedly.
///
/// Parameters p (P of them), in units of the restoring torque G, times from the first sample: inertia, friction, then
/// release_angle, release_time, zero or initial_angle, initial_rate, zero. The zero is zero_angle or rate_bias. If
/// data.zero_motion_factors is not empty, the zero's drift [unit of the reading per s] or the edges' lag [rad] follows.
/// If the sensor is not direct, the parameters of data.sensor replace the zero.
///
/// The squared residual of a sample is its deviance under the noise. For Gaussian noise (the default, with σ =
/// data.scale) that is ((value - model(p)) / σ)².
///
/// As a ceres::CostFunction it has P blocks of one parameter and P + 1 residuals instead of N: the square root R of J'J
/// (the observed information of the samples, MODEL.md eq. (5.2) and (7.3)), R^-T J' r, and the remainder of |r|. Cost
/// and gradient are exactly those of the N residuals. Without Jacobians it returns (0, ..., 0, |r|).
///
/// Every function returns false for parameters whose motion never begins, cannot be computed, or is released outside
/// [0, data.latest_release]. After a stop request every function returns false as well, even at a point that was
/// evaluated before. Output arguments are then unchanged or undefined, and the result of Trace is meaningless. The
/// object caches its last results: use it from one thread at a time.
class TrajectoryCost : public ceres::CostFunction, public LeastSquares {
 public:
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override;

  /// Model readings (N) and, unless null, their N x P derivatives, not scaled. Returns false on failure.
  virtual bool Readings(std::span<const double> parameters, Eigen::VectorXd* readings,
                        Eigen::MatrixXd* jacobian) const = 0;

  /// The motion at the samples, before the sensor is applied. Returns false on failure.
  virtual bool Motion(std::span<const double> parameters, bool with_jacobian, MotionStates* states) const = 0;

  virtual TraceSummary Trace(std::span<const double> parameters) const = 0;

  virtual void set_tolerance(double tolerance) = 0;      ///< Local tolerance of the trajectory [rad]; default 1e-10.
  virtual void set_used_samples(std::size_t count) = 0;  ///< Only the first `count` samples enter; default all.
  virtual void set_noise(const NoiseModel& noise) = 0;
  virtual void set_threads(int threads) = 0;  ///< For long recordings; default 1, 0: all cores. Changes no result.

  void set_priors(std::vector<PriorTerm> priors) { priors_ = std::move(priors); }
  const std::vector<PriorTerm>& priors() const { return priors_; }

  /// Contribution of the priors to |r|^2.
  double PriorSum(std::span<const double> parameters) const { return pendulum::PriorSum(priors_, parameters); }

  void AddTo(ceres::Problem& problem, const std::vector<double*>& parameters) override;
  int Reversals(std::span<const double> parameters) const override { return Trace(parameters).reversals; }
  int traces() const override { return traces_; }

 protected:
  explicit TrajectoryCost(int count);  ///< `count`: number of parameters.

  int count() const { return count_; }

  mutable int traces_ = 0;

 private:
  int count_;
  mutable int trials_since_step_ = 0;  // of the solver that calls Evaluate
  mutable Eigen::MatrixXd scratch_;
  std::vector<PriorTerm> priors_;
};

/// The cost of a model with its start. `data` must outlive it. Selects the code for friction and start once, here.
std::unique_ptr<TrajectoryCost> MakeTrajectoryCost(const MotionModel& model, StartKind start,
                                                   const TrajectoryData& data);

}  // namespace pendulum
