// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/likelihood/joint_cost.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include <ceres/normal_prior.h>

namespace pendulum {

JointCost::JointCost(std::vector<JointTerm> terms, int parameters, std::vector<PriorTerm> priors)
    : terms_(std::move(terms)), parameters_(parameters), priors_(std::move(priors)) {
  for (const PriorTerm& prior : priors_) {
    prior_costs_.push_back(std::make_unique<ceres::NormalPrior>(ceres::Matrix::Constant(1, 1, prior.weight),
                                                                ceres::Vector::Constant(1, prior.mean)));
  }
}

std::vector<double> JointCost::OwnParameters(std::size_t k, std::span<const double> parameters) const {
  std::vector<double> own;
  for (const int i : terms_[k].at) own.push_back(parameters[i]);
  return own;
}

bool JointCost::SumOfSquares(std::span<const double> parameters, double* sum) const {
  *sum = PriorSum(priors_, parameters);
  for (std::size_t k = 0; k < terms_.size(); ++k) {
    double own = 0;
    if (!terms_[k].cost->SumOfSquares(OwnParameters(k, parameters), &own)) return false;
    *sum += own;
  }
  return true;
}

bool JointCost::Sums(std::span<const double> parameters, Eigen::MatrixXd* sums) const {
  *sums = Eigen::MatrixXd::Zero(parameters_ + 1, parameters_ + 1);
  AddPriors(priors_, parameters, sums);
  for (std::size_t k = 0; k < terms_.size(); ++k) {
    Eigen::MatrixXd own;
    if (!terms_[k].cost->Sums(OwnParameters(k, parameters), &own)) return false;
    std::vector<int> at = terms_[k].at;
    at.push_back(parameters_);  // the residual's row
    (*sums)(at, at) += own;
  }
  return true;
}

void JointCost::AddTo(ceres::Problem& problem, const std::vector<double*>& parameters) {
  for (const JointTerm& term : terms_) {
    std::vector<double*> own;
    own.reserve(term.at.size());
    for (const int i : term.at) own.push_back(parameters[static_cast<std::size_t>(i)]);
    problem.AddResidualBlock(term.cost, nullptr, own);
  }
  for (std::size_t i = 0; i < priors_.size(); ++i) {
    problem.AddResidualBlock(prior_costs_[i].get(), nullptr,
                             parameters[static_cast<std::size_t>(priors_[i].parameter)]);
  }
}

int JointCost::Reversals(std::span<const double> parameters) const {
  int reversals = 0;
  for (std::size_t k = 0; k < terms_.size(); ++k) reversals += terms_[k].cost->Reversals(OwnParameters(k, parameters));
  return reversals;
}

bool JointCost::ComesToRest(std::span<const double> parameters, double torque_change) const {
  for (std::size_t k = 0; k < terms_.size(); ++k) {
    if (terms_[k].cost->ComesToRest(OwnParameters(k, parameters), torque_change)) return true;
  }
  return false;
}

bool JointCost::is_stopped() const {
  return std::ranges::any_of(terms_, [](const JointTerm& term) { return term.cost->is_stopped(); });
}

int JointCost::traces() const {
  return std::transform_reduce(terms_.begin(), terms_.end(), 0, std::plus<>(),
                               [](const JointTerm& term) { return term.cost->traces(); });
}

}  // namespace pendulum
