// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/separate_estimates.h"

#include <algorithm>
#include <cmath>

#include "pendulum/base/distributions.h"
#include "pendulum/base/format.h"

namespace pendulum {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

std::string SourcesText(double clock_scale, double clock_scale_std_dev, const std::string& calibration) {
  return NumberText(clock_scale) + " " + NumberText(clock_scale_std_dev) + " " + calibration;
}

bool HaveOwnSources(const std::vector<std::string>& sources) {
  return std::ranges::any_of(sources, [&](const std::string& one) { return one != sources.front(); });
}

double IntervalFactor(double t95) { return std::max(t95 / kNormal95, 1.0); }

MatrixXd SystematicBetweenRuns(const SystematicParts& parts, const VectorXd& value, bool own_sources) {
  MatrixXd inconstancy = parts.inconstancy.cwiseAbs2().asDiagonal();
  if (!own_sources) return inconstancy;
  // The rig's error is a common factor of the estimates, so it has the sign of each.
  VectorXd rig = parts.rig;
  for (Index i = 0; i < rig.size(); ++i) rig[i] = std::copysign(rig[i], value[i]);
  MatrixXd covariance = parts.covariance - rig * rig.transpose();
  covariance.diagonal() = covariance.diagonal().cwiseMax(inconstancy.diagonal());
  return covariance;
}

std::optional<SeparateEstimates> EstimatesToCompare(const FitAloneResult& fit, bool own_sources) {
  double largest = kNormal95;
  for (const std::optional<double>& t95 : fit.t95) largest = std::max(largest, t95.value_or(kNormal95));
  VectorXd wider(fit.value.size());
  for (Index i = 0; i < wider.size(); ++i) {
    wider[i] = IntervalFactor(fit.t95[static_cast<std::size_t>(i)].value_or(largest));
  }
  const SeparateEstimates estimates{0, fit.names, fit.value,
                                    wider.asDiagonal() * fit.covariance * wider.asDiagonal() +
                                        SystematicBetweenRuns(fit.systematic, fit.value, own_sources)};
  const bool is_valid =
      estimates.value.allFinite() && estimates.covariance.allFinite() && estimates.covariance.diagonal().minCoeff() > 0;
  return is_valid ? std::optional(estimates) : std::nullopt;
}

}  // namespace pendulum
