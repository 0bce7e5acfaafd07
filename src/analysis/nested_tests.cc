// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/nested_tests.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string_view>
#include <utility>

#include <Eigen/LU>

#include "pendulum/analysis/fitted_motion.h"
#include "pendulum/analysis/likelihood_ratio.h"
#include "pendulum/analysis/score_supremum.h"
#include "pendulum/base/physics.h"
#include "pendulum/model/nesting.h"

namespace pendulum {
namespace {

using Eigen::Index;

/// Of twice log L: where two searches of one optimum end.
constexpr double kRounding = 1e-3;

/// Correlation of the estimates of two parameters of a fit, those at a bound among them, were there no bounds.
double CorrelationOf(const FittedModels& fitted, const FitReport& fit, const FitOptions& options,
                     const std::vector<ParameterInfo>& two) {
  const FittedMotion motion(fitted.used, fit, options.rig);
  Eigen::MatrixXd jacobian;
  if (!motion.Readings(motion.instants(), &jacobian)) return 0;
  std::vector<Index> columns;
  std::vector<Index> rows;  // of the two
  for (std::size_t i = 0; i < fit.parameters.size(); ++i) {
    if (fit.parameters[i].fixed) continue;
    const bool asked = std::ranges::find(two, fit.parameters[i].info.name, &ParameterInfo::name) != two.end();
    if (asked) rows.push_back(static_cast<Index>(columns.size()));
    columns.push_back(static_cast<Index>(i));
  }
  if (rows.size() != 2) return 0;
  Eigen::MatrixXd free = jacobian(Eigen::all, columns);
  free.colwise().normalize();
  const Eigen::MatrixXd covariance = (free.transpose() * free).inverse();
  const double scale = std::sqrt(covariance(rows[0], rows[0]) * covariance(rows[1], rows[1]));
  const double correlation = covariance(rows[0], rows[1]) / scale;
  return std::isfinite(correlation) ? correlation : 0;
}

/// The richer law where it is the simpler one, at that value of the parameter which then has no meaning.
FitReport AtNull(const FitReport& simpler, FitReport richer, std::string_view unidentified, double value) {
  const OrderedPair order = OrderOf(richer.model);
  for (ParameterEstimate& parameter : richer.parameters) {
    const ParameterEstimate* const known = simpler.Find(parameter.info.name);
    parameter.estimate = known != nullptr ? known->estimate : parameter.info.name == unidentified ? value : 0;
  }
  if (order.larger >= 0) {
    richer.parameters[static_cast<std::size_t>(order.larger)].estimate =
        richer.parameters[static_cast<std::size_t>(order.smaller)].estimate;
  }
  return richer;
}

/// The largest rate of a fit's motion, roughly [rad/s].
double LargestRate(const FittedModels& fitted, const FitReport& fit, const FitOptions& options) {
  const double half_range = 0.5 * (fit.fitted.maxCoeff() - fit.fitted.minCoeff());
  if (fit.quantity == Quantity::kRate) return half_range;
  return half_range * 2 * kPi / FittedMotion(fitted.used, fit, options.rig).small_angle_period();
}

/// Derivatives of the readings at the null: by what the simpler law has free, and by the added term.
struct NullColumns {
  Eigen::MatrixXd nuisance;
  Eigen::VectorXd term;
};

std::optional<NullColumns> ColumnsAtNull(const FittedModels& fitted, const FitReport& simpler, const FitReport& null,
                                         std::string_view term, const FitOptions& options) {
  const FittedMotion motion(fitted.used, null, options.rig);
  Eigen::MatrixXd jacobian;
  if (!motion.Readings(motion.instants(), &jacobian)) return std::nullopt;
  const OrderedPair order = OrderOf(null.model);
  if (order.larger >= 0) jacobian.col(order.smaller) += jacobian.col(order.larger);  // they move together
  NullColumns columns;
  std::vector<Index> free;
  for (std::size_t i = 0; i < null.parameters.size(); ++i) {
    const std::string_view name = null.parameters[i].info.name;
    const ParameterEstimate* const known = simpler.Find(name);
    if (known != nullptr && !known->fixed && !known->at_bound) free.push_back(static_cast<Index>(i));
    if (name == term) columns.term = jacobian.col(static_cast<Index>(i));
  }
  columns.nuisance = jacobian(Eigen::all, free);
  return columns;
}

/// The test of a term whose rate has no meaning in the simpler law, over 24 rates from 1/50 to twice the largest.
void TestUnidentified(const FittedModels& fitted, const FitReport& simpler, const FitReport& richer,
                      const Nesting& nesting, const FitOptions& options, NestedTest& test) {
  constexpr int kRates = 24;
  const std::string_view rate = nesting.unidentified.front();
  const double largest = LargestRate(fitted, simpler, options);
  const std::string_view term = nesting.added.front().name;
  Eigen::MatrixXd nuisance, shapes(fitted.used.size(), kRates);
  for (int g = 0; g < kRates; ++g) {
    const double value = 0.02 * largest * std::pow(100.0, g / (kRates - 1.0));
    const auto columns = ColumnsAtNull(fitted, simpler, AtNull(simpler, richer, rate, value), term, options);
    if (!columns) {
      test.reason = "the motion of the simpler law cannot be traced";
      return;
    }
    nuisance = columns->nuisance;
    shapes.col(g) = columns->term;
  }
  test.p = SupremumTail(nuisance, shapes, test.statistic, options.seed);
  test.null = "simulated, for " + test.simpler + " has no " + std::string(rate);
}

/// Whether the user has said something of a parameter that the simpler law lacks: then it is no special case.
bool IsRestricted(const Nesting& nesting, const FitOptions& options) {
  return std::ranges::any_of(nesting.added, [&](const ParameterInfo& info) {
    return options.fixed.contains(info.name) || options.bounds.contains(info.name) ||
           options.priors.contains(info.name);
  });
}

void SetProbability(const FittedModels& fitted, const FitReport& simpler, const FitReport& richer,
                    const Nesting& nesting, const FitOptions& options, Likelihood likelihood, NestedTest& test) {
  if (test.statistic < -kRounding && nesting.unidentified.empty()) {
    test.reason = "the richer law's fit is the worse one: its search ended elsewhere";
  } else if (IsRestricted(nesting, options)) {
    test.reason = "--fix, --bounds or --prior name what is added";
  } else if (!nesting.unidentified.empty() && likelihood == Likelihood::kCorrelated) {
    test.reason = "its distribution is simulated for independent residuals only";
  } else if (nesting.unidentified.empty() && nesting.bounded <= 2) {
    const double correlation = nesting.bounded == 2 ? CorrelationOf(fitted, richer, options, nesting.added) : 0;
    const ChiBarWeights weights = WeightsAtBound(nesting.bounded, nesting.free, correlation);
    test.null = DescribeMixture(weights);
    test.p = ChiBarTail(weights, test.statistic);
  } else if (nesting.unidentified.size() == 1 && nesting.bounded == 1 && nesting.free == 0) {
    TestUnidentified(fitted, simpler, richer, nesting, options, test);
  } else {
    test.reason = "more than one parameter has no meaning in the simpler law, or none is at a bound there";
  }
}

}  // namespace

std::vector<NestedTest> TestNested(const FittedModels& fitted, const std::vector<ComparisonRow>& rows,
                                   const FitOptions& options, Likelihood likelihood) {
  std::vector<NestedTest> tests;
  for (std::size_t s = 0; s < rows.size(); ++s) {
    for (std::size_t r = 0; r < rows.size(); ++r) {
      if (!rows[s].log_likelihood || !rows[r].log_likelihood) continue;
      const FitReport& simpler = fitted.fits[s];
      const FitReport& richer = fitted.fits[r];
      const std::optional<Nesting> nesting = FindNesting(simpler.model, richer.model);
      if (!nesting) continue;
      // Two steps at once, of which one is tested alone, have no distribution that is known or soon simulated.
      if (!nesting->unidentified.empty() && RichestWithin(richer.model)->name != simpler.model.name) continue;
      NestedTest test;
      test.simpler = rows[s].model;
      test.richer = rows[r].model;
      for (const ParameterInfo& info : nesting->added) test.added.emplace_back(info.name);
      test.statistic = 2 * (*rows[r].log_likelihood - *rows[s].log_likelihood);
      if (std::abs(test.statistic) < kRounding) test.statistic = 0;
      SetProbability(fitted, simpler, richer, *nesting, options, likelihood, test);
      if (test.statistic < 0) test.statistic = 0;
      tests.push_back(std::move(test));
    }
  }
  return tests;
}

}  // namespace pendulum
