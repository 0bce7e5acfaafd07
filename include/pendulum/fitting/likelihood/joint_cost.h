// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <ceres/cost_function.h>
#include <ceres/problem.h>

#include "pendulum/fitting/likelihood/least_squares.h"
#include "pendulum/fitting/likelihood/trajectory_cost.h"

namespace pendulum {

/// One recording of a JointCost.
struct JointTerm {
  TrajectoryCost* cost = nullptr;  ///< Not owned; without priors.
  std::vector<int> at;             ///< Indices of its P_k parameters among all P parameters.
};

/// The cost of several recordings of one rig: the sum of their costs and of the priors. Some parameters are shared. For
/// Ceres, each recording is a residual block over its own parameters.
class JointCost final : public LeastSquares {
 public:
  /// `parameters` is the total number P.
  JointCost(std::vector<JointTerm> terms, int parameters, std::vector<PriorTerm> priors);

  bool SumOfSquares(std::span<const double> parameters, double* sum) const override;
  bool Sums(std::span<const double> parameters, Eigen::MatrixXd* sums) const override;
  void AddTo(ceres::Problem& problem, const std::vector<double*>& parameters) override;
  int Reversals(std::span<const double> parameters) const override;
  bool ComesToRest(std::span<const double> parameters, double torque_change) const override;
  int traces() const override;
  int runs() const override { return static_cast<int>(terms_.size()); }
  bool is_stopped() const override;

  const std::vector<PriorTerm>& priors() const { return priors_; }

  /// The parameters of recording k.
  std::vector<double> OwnParameters(std::size_t k, std::span<const double> parameters) const;

 private:
  std::vector<JointTerm> terms_;
  int parameters_;
  std::vector<PriorTerm> priors_;
  std::vector<std::unique_ptr<ceres::CostFunction>> prior_costs_;
};

}  // namespace pendulum
