// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/random_effects.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include <boost/math/tools/toms748_solve.hpp>

#include "pendulum/base/distributions.h"

namespace pendulum {
namespace {

using Eigen::VectorXd;

/// K runs, each with its own variance. A further variance between runs is common to all of them.
struct Scatter {
  VectorXd value, variance;                     // K
  std::optional<double> center = std::nullopt;  // Center of all runs, if it is known.

  VectorXd Weights(double between) const { return (variance.array() + between).inverse(); }

  double Mean(double between) const {
    if (center) return *center;
    const VectorXd weights = Weights(between);
    return weights.dot(value) / weights.sum();
  }

  /// Σ w (value - mean)²; it decreases as the variance between runs grows.
  double Statistic(double between) const {
    return Weights(between).dot((value.array() - Mean(between)).square().matrix());
  }

  /// The variance between runs at which the statistic has this value; 0 if it never gets so large.
  double BetweenAt(double statistic) const {
    if (!(Statistic(0) > statistic)) return 0;
    double highest = (value.array() - center.value_or(value.mean())).square().sum() / statistic;
    while (Statistic(highest) >= statistic) highest *= 2;  // needed because of rounding if errors are nearly 0
    std::uintmax_t most_steps = 200;
    const auto [low, high] =
        boost::math::tools::toms748_solve([&](double between) { return Statistic(between) - statistic; }, 0.0, highest,
                                          boost::math::tools::eps_tolerance<double>(40), most_steps);
    return 0.5 * (low + high);
  }
};

}  // namespace

RandomEffects SummarizeScatter(const VectorXd& value, const VectorXd& std_error) {
  const Scatter scatter{value, std_error.cwiseAbs2()};
  const auto freedom = static_cast<double>(value.size() - 1);
  const double between = scatter.BetweenAt(freedom);
  RandomEffects effects;
  effects.mean = scatter.Mean(between);
  effects.between = std::sqrt(between);
  const double ratio = std::max(scatter.Statistic(between) / freedom, 1.0);
  effects.std_error = std::sqrt(ratio / scatter.Weights(between).sum());
  const double length = effects.std_error * StudentQuantile(0.975, freedom);
  effects.lower95 = effects.mean - length;
  effects.upper95 = effects.mean + length;
  effects.between_lower95 = std::sqrt(scatter.BetweenAt(ChiSquareQuantile(0.975, freedom)));
  const double upper = scatter.BetweenAt(ChiSquareQuantile(0.025, freedom));
  effects.between_upper95 = upper > 0 ? std::sqrt(upper) : std::numeric_limits<double>::quiet_NaN();
  return effects;
}

double ScatterP(const VectorXd& value, const VectorXd& std_error) {
  const double statistic = Scatter{value, std_error.cwiseAbs2()}.Statistic(0);
  if (!std::isfinite(statistic)) return std::numeric_limits<double>::quiet_NaN();
  return ChiSquareTail(statistic, static_cast<double>(value.size() - 1));
}

double ScatterAbout(double center, const VectorXd& value, const VectorXd& std_error) {
  return std::sqrt(Scatter{value, std_error.cwiseAbs2(), center}.BetweenAt(static_cast<double>(value.size() - 1)));
}

}  // namespace pendulum
