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

/// What a trajectory is compared with. Times are from the first sample: a clock of large numbers costs no digits.
struct TrajectoryData {
  Quantity quantity = Quantity::kAngle;
  std::vector<double> time, value;  ///< N: s, increasing, time[0] = 0; rad or rad/s, or the unit of another sensor.
  SensorModel sensor;               ///< How readings follow from the motion.
  double natural_frequency = 0;     ///< rad/s, roughly; a trial of a very different time scale is refused.
  double latest_release = 0;        ///< s; a trial released outside [0, latest_release] is refused.
  /// N, or none: what one parameter more multiplies. Of a zero that drifts the times, of edges that lag minus the
  /// direction of each.
  std::vector<double> moves;
  double scale = 1;      ///< rad or rad/s; roughly the noise, so that Ceres' numbers are near 1.
  std::stop_token stop;  ///< Once it is requested, nothing is evaluated any more.

  Eigen::Map<const Eigen::VectorXd> times() const { return {time.data(), static_cast<Eigen::Index>(time.size())}; }
  Eigen::Map<const Eigen::VectorXd> values() const { return {value.data(), static_cast<Eigen::Index>(value.size())}; }
};

/// The motion at N instants: angle [rad], rate [rad/s] and acceleration [rad/s²], and unless they are not wanted their
/// derivatives (N x M each) by the parameters before the zero.
struct MotionStates {
  std::array<Eigen::VectorXd, SensorModel::kStates> value;
  std::array<Eigen::MatrixXd, SensorModel::kStates> jacobian;
};

/// Samples, sensitivities and the likelihood of one trajectory as least squares: the part of a fit that is repeated.
/// Parameters p, P of them: inertia, friction, then release_angle, release_time, zero or initial_angle, initial_rate,
/// zero (in units of G; times from the first sample; zero is zero_angle or rate_bias), and the zero's drift [unit of
/// the reading per s] or the edges' lag [rad] where the data say what it moves; instead of the zero the parameters of
/// data.sensor unless it is direct. The squared residual of a sample is its deviance under the noise,
/// ((value - model(p)) / σ)² when that is Gaussian (the default, with σ = data.scale). As a ceres::CostFunction it has
/// P blocks of one parameter and P + 1 residuals instead of N: the square root R of J'J (the observed information of
/// the samples, MODEL.md eq. (19) and (28)), R^-T J' r, and what is left of |r|. Cost and gradient are exactly those of
/// the N residuals. Asked for residuals alone it returns (0, ..., 0, |r|). A trial that never moves, that cannot be
/// traced or is released outside the data makes every function return false. So does, from one call to the next, a stop
/// of the data: where a trajectory was traced before, it cannot be taken for granted. What they would have set is left
/// as it is, or without meaning; Trace then says nothing of the motion. It remembers what it was asked last: one thread
/// at a time.
class TrajectoryCost : public ceres::CostFunction, public LeastSquares {
 public:
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override;

  /// Model readings (N) and, unless null, their N x P derivatives, not scaled; or false.
  virtual bool Readings(std::span<const double> parameters, Eigen::VectorXd* readings,
                        Eigen::MatrixXd* jacobian) const = 0;

  /// The motion at the samples, whatever sees it; or false.
  virtual bool Motion(std::span<const double> parameters, bool with_jacobian, MotionStates* states) const = 0;

  virtual TraceSummary Trace(std::span<const double> parameters) const = 0;

  virtual void set_tolerance(double tolerance) = 0;      ///< Local tolerance of the trajectory [rad]; default 1e-10.
  virtual void set_used_samples(std::size_t count) = 0;  ///< Only the first `count` samples enter; default all.
  virtual void set_noise(const NoiseModel& noise) = 0;
  virtual void set_threads(int threads) = 0;  ///< For long recordings; default 1, 0: all cores. Changes no bit.

  void set_priors(std::vector<PriorTerm> priors) { priors_ = std::move(priors); }
  const std::vector<PriorTerm>& priors() const { return priors_; }

  /// The priors' part of |r|^2.
  double PriorSum(std::span<const double> parameters) const { return pendulum::PriorSum(priors_, parameters); }

  void AddTo(ceres::Problem& problem, const std::vector<double*>& parameters) override;
  int Reversals(std::span<const double> parameters) const override { return Trace(parameters).reversals; }
  int traces() const override { return traces_; }

 protected:
  explicit TrajectoryCost(int count);  ///< Of parameters.

  int count() const { return count_; }

  mutable int traces_ = 0;

 private:
  int count_;
  mutable int trials_since_step_ = 0;  // of the solver that calls Evaluate
  mutable Eigen::MatrixXd scratch_;
  std::vector<PriorTerm> priors_;
};

/// The cost of a model with its start. `data` must outlive it. Friction and start are resolved here, once.
std::unique_ptr<TrajectoryCost> MakeTrajectoryCost(const MotionModel& model, StartKind start,
                                                   const TrajectoryData& data);

}  // namespace pendulum
