// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/inconstancy.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "pendulum/analysis/random_effects.h"
#include "pendulum/base/format.h"

namespace pendulum {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// What K parts of a recording say of one parameter.
struct Estimates {
  std::string_view name;
  VectorXd value, std_error;  // K
};

/// Those of the windows; where there are none, of the halves.
std::vector<Estimates> EstimatesOfParts(const Constancy& constancy) {
  std::vector<Estimates> all;
  const auto count = static_cast<Index>(constancy.windows.size());
  for (const AmplitudeTrend& trend : constancy.trends) {
    const bool is_inertia = trend.name == kInertia.name;
    Estimates& own = all.emplace_back(Estimates{trend.name, VectorXd(count), VectorXd(count)});
    for (Index w = 0; w < count; ++w) {
      const AmplitudeRow& row = constancy.windows[static_cast<std::size_t>(w)];
      own.value[w] = is_inertia ? row.inertia : row.friction;
      own.std_error[w] = is_inertia ? row.inertia_std_error : row.friction_std_error;
    }
  }
  if (!all.empty()) return all;
  for (const HalvesRow& row : constancy.halves) {
    all.push_back(
        {row.name, Eigen::Vector2d(row.first, row.second), Eigen::Vector2d(row.first_std_error, row.second_std_error)});
  }
  return all;
}

/// Whether these parts, or the trend with amplitude, say that this parameter by itself is no constant.
bool Differs(const Constancy& constancy, const Estimates& parts) {
  const auto trend = std::ranges::find(constancy.trends, parts.name, &AmplitudeTrend::name);
  return ScatterP(parts.value, parts.std_error) < kNotConstant ||
         (trend != constancy.trends.end() && trend->p < kNotConstant);
}

/// Adds a variance of the parameter that nothing else shares.
void AddSystematic(ParameterEstimate& parameter, double std_dev, FitReport& fit) {
  parameter.systematic_std_error = std::hypot(parameter.systematic_std_error.value_or(0), std_dev);
  auto place = std::ranges::find(fit.systematic_names, parameter.info.name);
  const Index row = place - fit.systematic_names.begin();
  if (place == fit.systematic_names.end()) {
    fit.systematic_names.emplace_back(parameter.info.name);
    fit.systematic_covariance.conservativeResizeLike(Eigen::MatrixXd::Zero(row + 1, row + 1));
  }
  fit.systematic_covariance(row, row) += std_dev * std_dev;
}

}  // namespace

void CountInconstancy(const Constancy& constancy, FitReport& fit) {
  if (constancy.constant()) return;
  std::string scatter;
  for (const Estimates& parts : EstimatesOfParts(constancy)) {
    const auto parameter = std::ranges::find(fit.parameters, parts.name,
                                             [](const ParameterEstimate& candidate) { return candidate.info.name; });
    if (!Differs(constancy, parts) || parameter == fit.parameters.end()) continue;
    const double about = ScatterAbout(parameter->estimate, parts.value, parts.std_error);
    if (!(about > 0) || !std::isfinite(about)) continue;
    AddSystematic(*parameter, about, fit);
    scatter += (scatter.empty() ? "" : " and ") + std::string(parts.name) + " by " + NumberText(about, 2) +
               (parameter->unit == "1" ? "" : " " + parameter->unit);
  }
  if (scatter.empty()) return;
  const std::string parts = constancy.trends.empty() ? "halves" : "windows";
  const std::string which = "beyond the errors " + parts + " differ from the whole in " + scatter;
  fit.warnings.push_back({"not_constant", "not constant over this recording: " + which +
                                              ", and runs of other amplitudes will by no less; the systematic errors "
                                              "count that, standard errors and intervals do not"});
}

}  // namespace pendulum
