// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>
#include <ceres/problem.h>

namespace pendulum {

/// Prior knowledge of one parameter. It adds the residual (p - mean) · weight to the residuals of the samples.
struct PriorTerm {
  int parameter = 0;
  double mean = 0, weight = 0;  ///< In the cost's units; weight is one over the standard deviation.
};

/// Σ of the priors' squared residuals.
double PriorSum(std::span<const PriorTerm> priors, std::span<const double> parameters);

/// Adds the contribution of the priors to the (P + 1) x (P + 1) sums of LeastSquares::Sums.
void AddPriors(std::span<const PriorTerm> priors, std::span<const double> parameters, Eigen::MatrixXd* sums);

/// Maximum number of parameters of one recording's cost.
inline constexpr int kMaxCompressed = 16;

/// Replaces the N residuals by P + 1 equations with the same cost and gradient, P <= kMaxCompressed. The new Jacobian
/// is R, a square root of J'J. The new residuals are R^-T J'r and the remainder of |r| (MODEL.md eq. (5.2)). They are
/// computed from the sums and laid out as ceres::CostFunction::Evaluate returns them. Allocates no memory.
void CompressResiduals(const Eigen::MatrixXd& sums, double* residuals, double** jacobians);

/// The cost that a solver minimizes over P parameters: |r|², the deviance of samples and priors. Every function returns
/// false if a trajectory cannot be computed.
class LeastSquares {
 public:
  LeastSquares() = default;
  LeastSquares(const LeastSquares&) = delete;
  LeastSquares& operator=(const LeastSquares&) = delete;
  LeastSquares(LeastSquares&&) = delete;
  LeastSquares& operator=(LeastSquares&&) = delete;
  virtual ~LeastSquares() = default;

  virtual bool SumOfSquares(std::span<const double> parameters, double* sum) const = 0;

  /// The (P + 1) x (P + 1) symmetric matrix of sums [J'J, J'r; r'J, r'r], J = dr/dp. The blocks are the information,
  /// minus the gradient of the log-likelihood, and the deviance.
  virtual bool Sums(std::span<const double> parameters, Eigen::MatrixXd* sums) const = 0;

  /// Adds the residuals to a Ceres problem. Each of the P parameters is a block of its own; the problem owns neither
  /// the residuals nor the parameters.
  virtual void AddTo(ceres::Problem& problem, const std::vector<double*>& parameters) = 0;

  /// Number of reversals of direction in all recordings together.
  virtual int Reversals(std::span<const double> parameters) const = 0;

  /// Whether the pendulum comes to rest before the end of some recording, or might do so if the torque of dry friction
  /// at rest changed by `torque_change` (in units of the restoring torque G).
  virtual bool ComesToRest(std::span<const double> parameters, double torque_change) const = 0;

  /// Number of trajectories computed so far, with and without derivatives.
  virtual int traces() const = 0;

  /// Number of recordings. Several recordings permit more trajectories and use the sparse solver.
  virtual int runs() const { return 1; }

  /// Whether a stop was requested. Then every function returns false.
  virtual bool is_stopped() const { return false; }
};

}  // namespace pendulum
