// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/least_squares.h"

namespace pendulum {

double PriorSum(std::span<const PriorTerm> priors, std::span<const double> parameters) {
  double sum = 0;
  for (const PriorTerm& prior : priors) {
    const double r = (parameters[prior.parameter] - prior.mean) * prior.weight;
    sum += r * r;
  }
  return sum;
}

void AddPriors(std::span<const PriorTerm> priors, std::span<const double> parameters, Eigen::MatrixXd* sums) {
  const Eigen::Index residual = sums->rows() - 1;
  for (const PriorTerm& prior : priors) {
    const double r = (parameters[prior.parameter] - prior.mean) * prior.weight;
    (*sums)(prior.parameter, prior.parameter) += prior.weight * prior.weight;
    (*sums)(prior.parameter, residual) += prior.weight * r;
    (*sums)(residual, prior.parameter) += prior.weight * r;
    (*sums)(residual, residual) += r * r;
  }
}

}  // namespace pendulum
