// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/solve/optimum.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace pendulum {

using Eigen::Index;

std::optional<Optimum> Linearize(const SolveOptions& options, const LeastSquares& cost, const Solution& solution) {
  Optimum optimum;
  Eigen::MatrixXd sums;
  if (!solution.usable || !cost.Sums(solution.parameters, &sums)) return std::nullopt;
  constexpr double kTiny = std::numeric_limits<double>::min();
  const Index size = sums.rows() - 1;
  optimum.information = sums.topLeftCorner(size, size);
  optimum.gradient = sums.col(size).head(size);
  for (int i = 0; i < static_cast<int>(size); ++i) {
    if (options.fixed[i]) continue;
    const int side = BoundSide(options, static_cast<std::size_t>(i), solution.parameters[i]);
    const double inwards = side * optimum.gradient[i] / std::sqrt(std::max(optimum.information(i, i), kTiny));
    const bool pushes_out = side != 0 && inwards <= NegligibleSlope(sums);
    (pushes_out ? optimum.at_bound : optimum.free).push_back(i);
  }
  optimum.inverse = InvertInformation(optimum.information, optimum.free);
  return optimum;
}

Optimum WithoutBounds(Optimum optimum, const Eigen::MatrixXd& information) {
  optimum.information = information;
  optimum.free.insert(optimum.free.end(), optimum.at_bound.begin(), optimum.at_bound.end());
  std::ranges::sort(optimum.free);
  optimum.at_bound.clear();
  optimum.inverse = InvertInformation(optimum.information, optimum.free);
  return optimum;
}

Eigen::MatrixXd FreeJacobian(const TrajectoryCost& cost, const Solution& solution, const Optimum& optimum) {
  Eigen::VectorXd readings;
  Eigen::MatrixXd jacobian;
  if (!cost.Readings(solution.parameters, &readings, &jacobian)) return {};
  return jacobian(Eigen::all, optimum.free);
}

double RemainingShift(const Optimum& optimum) {
  const Eigen::VectorXd gradient = optimum.gradient(optimum.free);
  return std::sqrt(gradient.dot(optimum.inverse.matrix * gradient));
}

}  // namespace pendulum
