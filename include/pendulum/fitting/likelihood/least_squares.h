// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>
#include <ceres/problem.h>

namespace pendulum {

/// What is known of a parameter beside the recording, as a residual (p - mean) · weight beside those of the samples.
struct PriorTerm {
  int parameter = 0;
  double mean = 0, weight = 0;  ///< In the cost's units; one over the standard deviation.
};

/// Σ of the priors' squared residuals.
double PriorSum(std::span<const PriorTerm> priors, std::span<const double> parameters);

/// Adds the priors' part to the (P + 1) x (P + 1) sums of LeastSquares::Sums.
void AddPriors(std::span<const PriorTerm> priors, std::span<const double> parameters, Eigen::MatrixXd* sums);

/// The most parameters of one recording's cost.
inline constexpr int kMostCompressed = 16;

/// From such sums the residuals and derivatives of P + 1 equations of the same cost and gradient, P <= kMostCompressed:
/// R, R^-T J'r and the rest of |r| (MODEL.md eq. (19)), as ceres::CostFunction::Evaluate returns them. Allocates
/// nothing.
void CompressResiduals(const Eigen::MatrixXd& sums, double* residuals, double** jacobians);

/// What a solver minimises over P parameters: |r|², the deviance of samples and priors. Every function returns false
/// where some motion cannot be traced.
class LeastSquares {
 public:
  LeastSquares() = default;
  LeastSquares(const LeastSquares&) = delete;
  LeastSquares& operator=(const LeastSquares&) = delete;
  LeastSquares(LeastSquares&&) = delete;
  LeastSquares& operator=(LeastSquares&&) = delete;
  virtual ~LeastSquares() = default;

  virtual bool SumOfSquares(std::span<const double> parameters, double* sum) const = 0;

  /// The (P + 1) x (P + 1) symmetric matrix of sums [J'J, J'r; r'J, r'r], J = dr/dp: information, minus the gradient of
  /// the log-likelihood, and the deviance.
  virtual bool Sums(std::span<const double> parameters, Eigen::MatrixXd* sums) const = 0;

  /// Adds its residuals to a problem, which owns neither them nor the P parameters, each a block of its own.
  virtual void AddTo(ceres::Problem& problem, const std::vector<double*>& parameters) = 0;

  /// Reversals of direction, over all recordings.
  virtual int Reversals(std::span<const double> parameters) const = 0;

  /// Whether the pendulum comes to rest before the end of some recording, or might if the torque that dry friction
  /// holds it with were another by so much, in units of G.
  virtual bool ComesToRest(std::span<const double> parameters, double torque_change) const = 0;

  /// Trajectories traced so far, with and without derivatives, for whatever purpose.
  virtual int traces() const = 0;

  /// Recordings: what a search may cost goes by them.
  virtual int runs() const { return 1; }

  /// Whether a stop was requested, so that every function returns false: there is nothing to be solved any more.
  virtual bool is_stopped() const { return false; }
};

}  // namespace pendulum
