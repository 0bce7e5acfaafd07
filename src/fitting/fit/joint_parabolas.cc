// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/fit/joint_parabolas.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>

#include <Eigen/Cholesky>

#include "pendulum/fitting/fit/intervals.h"
#include "pendulum/fitting/likelihood/least_squares.h"
#include "pendulum/fitting/solve/covariance.h"

namespace pendulum {
namespace {

using Eigen::Index;

/// The log-likelihood of a recording near its own fit, without its priors, as a parabola in M of its parameters.
struct Parabola {
  std::vector<int> at;          // M, indices among all parameters
  Eigen::MatrixXd information;  // A, M x M
  Eigen::VectorXd pull;         // A p - gradient at the estimates p of its own fit
};

/// The parabola from the sums at the estimates of the recording's own fit. The member's cost has no priors.
Parabola ParabolaOfSums(const JointMember& member) {
  const std::vector<double>& own = member.alone_parameters;
  const auto size = static_cast<Index>(own.size());
  Parabola parabola{member.at, Eigen::MatrixXd::Zero(size, size), Eigen::VectorXd::Zero(size)};
  Eigen::MatrixXd sums;
  if (!member.cost->Sums(own, &sums)) return parabola;
  parabola.information = sums.topLeftCorner(size, size);
  parabola.pull =
      parabola.information * Eigen::Map<const Eigen::VectorXd>(own.data(), size) - sums.col(size).head(size);
  return parabola;
}

/// The parabola from the covariance of the recording's own fit, which needs no trajectory. If the fit has no
/// covariance, the parabola from the sums.
Parabola ParabolaOf(const JointMember& member) {
  const FitReport& alone = *member.alone;
  const auto count = static_cast<Index>(alone.covariance_names.size());
  std::vector<int> all(alone.covariance_names.size());
  std::iota(all.begin(), all.end(), 0);
  const InformationInverse inverse = InvertInformation(alone.covariance, all);
  if (count == 0 || !inverse.identifiable) return ParabolaOfSums(member);
  Parabola parabola;
  Eigen::VectorXd unit(count), estimates(count), prior = Eigen::VectorXd::Zero(count), mean = prior;
  for (Index row = 0; row < count; ++row) {
    const auto i = static_cast<std::size_t>(alone.Find(alone.covariance_names[static_cast<std::size_t>(row)]) -
                                            alone.parameters.data());
    parabola.at.push_back(member.at[i]);
    unit[row] = member.problem->si_per_internal[i];
    estimates[row] = member.alone_parameters[i];
    for (const PriorTerm& known : member.problem->priors) {
      if (known.parameter != static_cast<int>(i)) continue;
      prior[row] = known.weight * known.weight;
      mean[row] = known.mean;
    }
  }
  parabola.information = unit.asDiagonal() * inverse.matrix * unit.asDiagonal();
  parabola.pull = parabola.information * estimates - prior.cwiseProduct(mean);
  parabola.information.diagonal() -= prior;
  return parabola;
}

}  // namespace

CombinedParabolas CombineParabolas(const JointProblem& joint) {
  const auto size = static_cast<Index>(joint.solve.fixed.size());
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(size + 1, size + 1);
  std::vector<double> parameters = joint.SeparateParameters();
  const Eigen::VectorXd start = Eigen::Map<const Eigen::VectorXd>(parameters.data(), size);
  AddPriors(joint.cost->priors(), parameters, &sums);
  Eigen::VectorXd pull = -sums.col(size).head(size);
  for (const JointMember& member : joint.members) {
    const Parabola parabola = ParabolaOf(member);
    sums(parabola.at, parabola.at) += parabola.information;
    pull(parabola.at) += parabola.pull - parabola.information * start(parabola.at);
  }
  std::vector<int> free;
  for (int i = 0; i < static_cast<int>(size); ++i) {
    if (!joint.solve.fixed[static_cast<std::size_t>(i)] && sums(i, i) > 0) free.push_back(i);
  }
  const Eigen::VectorXd scale = sums.diagonal()(free).cwiseSqrt().cwiseInverse();
  const Eigen::LDLT<Eigen::MatrixXd> factor(scale.asDiagonal() * sums(free, free) * scale.asDiagonal());
  const Eigen::VectorXd step = scale.cwiseProduct(factor.solve(scale.cwiseProduct(pull(free))));
  for (std::size_t k = 0; k < free.size(); ++k) {
    const auto i = static_cast<std::size_t>(free[k]);
    const double moved = parameters[i] + step[static_cast<Index>(k)];
    if (std::isfinite(moved)) parameters[i] = std::clamp(moved, joint.solve.lower[i], joint.solve.upper[i]);
  }
  return {parameters, sums.topLeftCorner(size, size)};
}

bool HasPosteriors(const JointProblem& joint) {
  const auto is_posterior = [](const JointMember& m) { return m.alone->interval_method == kPosteriorIntervals; };
  const auto has_errors = [](const JointMember& m) { return !m.alone->covariance_names.empty(); };
  return std::ranges::any_of(joint.members, is_posterior) && std::ranges::all_of(joint.members, has_errors);
}

bool UsePosteriors(JointProblem& joint, Solution& solution, Optimum& known) {
  CombinedParabolas combined = CombineParabolas(joint);
  Optimum optimum = WithoutBounds(known, combined.information);
  double sum = 0;
  if (!optimum.inverse.identifiable || !joint.cost->SumOfSquares(combined.parameters, &sum)) return false;
  optimum.gradient.setZero();
  known = std::move(optimum);
  solution.parameters = std::move(combined.parameters);
  joint.Distribute(solution.parameters);
  for (JointMember& member : joint.members) {
    member.solution.noise.sigma = member.alone->noise.sigma;
    member.cost->Readings(member.solution.parameters, &member.solution.readings,
                          nullptr);  // computed before, so it fails only after a stop
  }
  return true;
}

}  // namespace pendulum
