// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/nested_tests.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string_view>
#include <utility>

#include <Eigen/LU>
#include <Eigen/QR>

#include "pendulum/analysis/fitted_motion.h"
#include "pendulum/analysis/likelihood_ratio.h"
#include "pendulum/analysis/score_supremum.h"
#include "pendulum/base/physics.h"
#include "pendulum/model/nesting.h"

namespace pendulum {
namespace {

using Eigen::Index;

/// Difference in 2 log L between two searches that find the same optimum.
constexpr double kRounding = 1e-3;

/// Residual of the columns after a least-squares fit of `explained`.
Eigen::MatrixXd ResidualAfter(const Eigen::MatrixXd& explained, const Eigen::MatrixXd& columns) {
  if (explained.cols() == 0) return columns;
  Eigen::MatrixXd basis = explained;
  for (Index k = 0; k < basis.cols(); ++k) basis.col(k) /= std::max(basis.col(k).norm(), 1e-300);
  return columns - basis * basis.colPivHouseholderQr().solve(columns);
}

void Append(const Eigen::MatrixXd& rows, Eigen::MatrixXd& matrix) {
  const Index before = matrix.rows();
  matrix.conservativeResize(before + rows.rows(), rows.cols());
  matrix.bottomRows(rows.rows()) = rows;
}

bool IsIn(const std::vector<std::string>& names, std::string_view name) {
  return std::ranges::find(names, name) != names.end();
}

double SigmaOf(const FitReport& fit) { return fit.noise.sigma > 0 ? fit.noise.sigma : 1.0; }

/// Correlation of the estimates of two shared parameters of a fit, without bounds; parameters at a bound are included.
double CorrelationOf(const ComparedRuns& compared, std::size_t index, const FitOptions& options,
                     const std::vector<ParameterInfo>& two) {
  Eigen::MatrixXd shared;
  std::vector<Index> rows;  // rows of the two parameters
  for (const ComparedRun& run : compared.runs) {
    const FitReport& fit = *run.fits[index];
    const FittedMotion motion(run.used, fit, options.rig, options.stop);
    Eigen::MatrixXd jacobian;
    if (!motion.Readings(motion.instants(), &jacobian)) return 0;
    std::vector<Index> own, common;
    rows.clear();
    for (std::size_t i = 0; i < fit.parameters.size(); ++i) {
      const std::string_view name = fit.parameters[i].info.name;
      if (fit.parameters[i].fixed) continue;
      if (std::ranges::find(two, name, &ParameterInfo::name) != two.end())
        rows.push_back(static_cast<Index>(common.size()));
      (IsIn(compared.shared, name) ? common : own).push_back(static_cast<Index>(i));
    }
    Append(ResidualAfter(jacobian(Eigen::all, own), jacobian(Eigen::all, common)) / SigmaOf(fit), shared);
  }
  if (rows.size() != 2) return 0;
  shared.colwise().normalize();
  const Eigen::MatrixXd covariance = (shared.transpose() * shared).inverse();
  const double scale = std::sqrt(covariance(rows[0], rows[0]) * covariance(rows[1], rows[1]));
  const double correlation = covariance(rows[0], rows[1]) / scale;
  return std::isfinite(correlation) ? correlation : 0;
}

/// The richer law with the simpler law's estimates: its added terms are 0, and the parameter `unidentified`, which has
/// no meaning in the simpler law, has the given value.
FitReport AtNull(const FitReport& simpler, FitReport richer, std::string_view unidentified, double value) {
  const OrderedPair order = FindOrderedPair(richer.model);
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
double LargestRate(const ComparedRun& run, const FitReport& fit, const FitOptions& options) {
  const double half_range = 0.5 * (fit.fitted.maxCoeff() - fit.fitted.minCoeff());
  if (fit.quantity == Quantity::kRate) return half_range;
  return half_range * 2 * kPi / FittedMotion(run.used, fit, options.rig).small_angle_period();
}

/// Derivatives of one recording's readings at the null with respect to the free parameters of the simpler law, shared
/// and own, and to the added term.
struct NullColumns {
  Eigen::MatrixXd shared, own;
  Eigen::VectorXd term;
};

std::optional<NullColumns> ColumnsAtNull(const ComparedRun& run, const std::vector<std::string>& shared,
                                         const FitReport& simpler, const FitReport& null, std::string_view term,
                                         const FitOptions& options) {
  const FittedMotion motion(run.used, null, options.rig, options.stop);
  Eigen::MatrixXd jacobian;
  if (!motion.Readings(motion.instants(), &jacobian)) return std::nullopt;
  const OrderedPair order = FindOrderedPair(null.model);
  // At the null the two ordered parameters are equal and change together.
  if (order.larger >= 0) jacobian.col(order.smaller) += jacobian.col(order.larger);
  NullColumns columns;
  std::vector<Index> common, own;
  for (std::size_t i = 0; i < null.parameters.size(); ++i) {
    const std::string_view name = null.parameters[i].info.name;
    const ParameterEstimate* const known = simpler.Find(name);
    const bool is_free = known != nullptr && !known->fixed && !known->at_bound;
    if (is_free) (IsIn(shared, name) ? common : own).push_back(static_cast<Index>(i));
    if (name == term) columns.term = jacobian.col(static_cast<Index>(i));
  }
  columns.shared = jacobian(Eigen::all, common);
  columns.own = jacobian(Eigen::all, own);
  return columns;
}

/// Tests a term whose rate has no meaning in the simpler law, over 24 rates from 1/50 of the largest rate to twice that
/// rate. The effect of the parameters that each recording has alone is first removed from the columns.
void TestUnidentified(const ComparedRuns& compared, std::size_t simpler, std::size_t richer, const Nesting& nesting,
                      const FitOptions& options, NestedTest& test) {
  constexpr int kRates = 24;
  const std::string_view rate = nesting.unidentified.front();
  const std::string_view term = nesting.added.front().name;
  double largest = 0;
  for (const ComparedRun& run : compared.runs)
    largest = std::max(largest, LargestRate(run, *run.fits[simpler], options));
  Eigen::MatrixXd nuisance, shapes;
  for (const ComparedRun& run : compared.runs) {
    const FitReport& simple = *run.fits[simpler];
    Eigen::MatrixXd own_shapes(run.used.size(), kRates);
    std::optional<NullColumns> columns;
    for (int g = 0; g < kRates; ++g) {
      const double value = 0.02 * largest * std::pow(100.0, g / (kRates - 1.0));
      const FitReport null = AtNull(simple, *run.fits[richer], rate, value);
      columns = ColumnsAtNull(run, compared.shared, simple, null, term, options);
      if (!columns) {
        test.reason = "the motion with the simpler law cannot be computed";
        return;
      }
      own_shapes.col(g) = columns->term;
    }
    Append(ResidualAfter(columns->own, columns->shared) / SigmaOf(simple), nuisance);
    Append(ResidualAfter(columns->own, own_shapes) / SigmaOf(simple), shapes);
  }
  test.p = SupremumTail(nuisance, shapes, test.statistic, options.seed);
  test.null = "simulated, because " + test.simpler + " has no " + std::string(rate);
}

/// Whether the user restricted a parameter that the simpler law lacks. The simpler law is then no special case of the
/// richer one.
bool IsRestricted(const Nesting& nesting, const FitOptions& options) {
  return std::ranges::any_of(nesting.added, [&](const ParameterInfo& info) {
    return options.fixed.contains(info.name) || options.bounds.contains(info.name) ||
           options.priors.contains(info.name);
  });
}

void SetProbability(const ComparedRuns& compared, std::size_t simpler, std::size_t richer, const Nesting& nesting,
                    const FitOptions& options, Likelihood likelihood, NestedTest& test) {
  if (test.statistic < -kRounding && nesting.unidentified.empty()) {
    test.reason = "the richer law fits worse, so its search ended in another local minimum";
  } else if (!std::ranges::all_of(nesting.added,
                                  [&](const ParameterInfo& info) { return IsIn(compared.shared, info.name); })) {
    test.reason = "the added parameters are not shared: each recording has its own";
  } else if (IsRestricted(nesting, options)) {
    test.reason = "--fix, --bounds or --prior name an added parameter";
  } else if (!nesting.unidentified.empty() && likelihood != Likelihood::kIndependent) {
    test.reason = "its distribution is simulated for independent residuals only";
  } else if (nesting.unidentified.empty() && nesting.bounded <= 2) {
    const double correlation = nesting.bounded == 2 ? CorrelationOf(compared, richer, options, nesting.added) : 0;
    const ChiBarWeights weights = WeightsAtBound(nesting.bounded, nesting.free, correlation);
    test.null = DescribeMixture(weights);
    test.p = ChiBarTail(weights, test.statistic);
  } else if (nesting.unidentified.size() == 1 && nesting.bounded == 1 && nesting.free == 0) {
    TestUnidentified(compared, simpler, richer, nesting, options, test);
  } else {
    test.reason = "in the simpler law more than one parameter has no meaning, or none is at a bound";
  }
}

}  // namespace

std::vector<NestedTest> TestNested(const ComparedRuns& compared, const std::vector<ComparisonRow>& rows,
                                   const FitOptions& options, Likelihood likelihood) {
  std::vector<NestedTest> tests;
  for (std::size_t s = 0; s < rows.size(); ++s) {
    for (std::size_t r = 0; r < rows.size(); ++r) {
      if (!rows[s].log_likelihood || !rows[r].log_likelihood) continue;
      const MotionModel& simpler = compared.runs.front().fits[s]->model;
      const MotionModel& richer = compared.runs.front().fits[r]->model;
      const std::optional<Nesting> nesting = FindNesting(simpler, richer);
      if (!nesting) continue;
      // If the richer law adds another term besides the term with the unidentified parameter, the statistic has no
      // known distribution, and a simulation would take long.
      if (!nesting->unidentified.empty() && LargestNestedModel(richer)->name != simpler.name) continue;
      NestedTest test;
      test.simpler = rows[s].model;
      test.richer = rows[r].model;
      for (const ParameterInfo& info : nesting->added) test.added.emplace_back(info.name);
      test.statistic = 2 * (*rows[r].log_likelihood - *rows[s].log_likelihood);
      if (std::abs(test.statistic) < kRounding) test.statistic = 0;
      SetProbability(compared, s, r, *nesting, options, likelihood, test);
      test.statistic = std::max(test.statistic, 0.0);
      tests.push_back(std::move(test));
    }
  }
  return tests;
}

}  // namespace pendulum
