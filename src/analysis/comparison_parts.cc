// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/comparison_parts.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "pendulum/analysis/fitted_motion.h"
#include "pendulum/fitting/residuals/residual_diagnostics.h"

namespace pendulum {
namespace {

using Eigen::Index;

/// Autocorrelated noise below this many counts is neither Gaussian nor independent: its likelihood is not known.
constexpr double kSmallestSigma = 0.5;

/// A parameter at the bound 0 leaves a simpler law and is not counted; a parameter at another bound is counted.
bool IsCounted(const ParameterEstimate& parameter) {
  return !parameter.fixed && !(parameter.at_bound && parameter.estimate == 0);
}

/// Range of steps from a parameter's estimate within its bounds and the user's.
std::pair<double, double> AllowedSteps(const ParameterEstimate& parameter, const FitOptions& options) {
  double lower = parameter.info.lower;
  double upper = parameter.info.upper;
  if (const auto own = options.bounds.find(parameter.info.name); own != options.bounds.end()) {
    lower = std::max(lower, own->second.lower);
    upper = std::min(upper, own->second.upper);
  }
  return {std::min(lower - parameter.estimate, 0.0), std::max(upper - parameter.estimate, 0.0)};
}

bool IsNormal(const FitReport& best) {
  return best.noise.family == NoiseFamily::kGaussian || best.noise.family == NoiseFamily::kQuantized;
}

/// What keeps autocorrelated residuals from being Gaussian.
std::string NotGaussianReason(const FitReport& best) {
  if (best.noise.censored > 0) return "readings at an end of the sensor's range";
  if (IsNormal(best)) return "noise below half a count";
  if (best.noise.family == NoiseFamily::kEdges) return "rows only where the count changes";
  return best.noise.family == NoiseFamily::kAveraged ? "averaged counts" : "a robust loss";
}

}  // namespace

bool IsRounding(const FitReport& fit) { return fit.statistics.rms_residual <= fit.trace_error; }

ComparisonRow DescribeFit(const FitReport& fit) {
  ComparisonRow row;
  row.model = fit.model.name;
  row.judged = fit.termination == Termination::kConverged;
  if (!row.judged) row.reason = std::string(TerminationName(fit.termination)) + ": " + fit.reason;
  if (fit.termination == Termination::kFailed) return row;
  row.parameters = static_cast<int>(std::ranges::count_if(fit.parameters, IsCounted)) + 1;
  row.rms = fit.statistics.rms_residual;
  row.is_rounding = IsRounding(fit);
  row.lag1_correlation = fit.noise.lag1_correlation;
  row.ljung_box_p = fit.statistics.ljung_box_p;
  row.lack_of_fit = fit.HasWarning("lack_of_fit");
  return row;
}

const FitReport* BestFit(const std::vector<FitReport>& fits) {
  const FitReport* best = nullptr;
  for (const FitReport& fit : fits) {
    if (fit.termination != Termination::kConverged || !std::isfinite(fit.statistics.aicc)) continue;
    if (best == nullptr || fit.statistics.aicc < best->statistics.aicc) best = &fit;
  }
  return best;
}

std::optional<CorrelatedResiduals> ResidualsOf(const Recording& used, const FitReport& fit, const FitOptions& options,
                                               bool with_bounded) {
  const FittedMotion motion(used, fit, options.rig, options.stop);
  Eigen::MatrixXd jacobian;
  const auto readings = motion.Readings(motion.instants(), &jacobian);
  if (!readings) return std::nullopt;
  CorrelatedResiduals data{motion.instants(), fit.residual, {}, {}, {}, 0};
  std::vector<Index> columns;
  std::vector<double> lowest, highest;
  for (std::size_t i = 0; i < fit.parameters.size(); ++i) {
    if (fit.parameters[i].fixed || (fit.parameters[i].at_bound && !with_bounded)) continue;
    const auto [low, high] = AllowedSteps(fit.parameters[i], options);
    columns.push_back(static_cast<Index>(i));
    lowest.push_back(low);
    highest.push_back(high);
  }
  const auto free = static_cast<Index>(columns.size());
  data.jacobian = jacobian(Eigen::all, columns);
  data.lowest = Eigen::Map<const Eigen::VectorXd>(lowest.data(), free);
  data.highest = Eigen::Map<const Eigen::VectorXd>(highest.data(), free);
  data.rounding_variance = used.resolution * used.resolution / 12;
  return data;
}

double SumOfLogLevelWidths(const Recording& used) {
  return used.resolution > 0 ? static_cast<double>(used.size()) * std::log(used.resolution) : 0.0;
}

Autocorrelation SharedAutocorrelation(const FitReport& best) {
  constexpr std::size_t kMaxSharedOrder = 8;
  Autocorrelation autocorrelation = best.noise.autocorrelation;
  if (autocorrelation.autoregressive.size() > kMaxSharedOrder)
    autocorrelation.autoregressive.assign(kMaxSharedOrder, 0.0);
  return autocorrelation;
}

std::string DescribeLikelihood(Likelihood likelihood, const FitReport& best) {
  const std::string autocorrelation = SharedAutocorrelation(best).Name();
  switch (likelihood) {
    case Likelihood::kIndependent:
      return "likelihood of independent " + std::string(NoiseFamilyName(best.noise.family)) + " residuals";
    case Likelihood::kCorrelated:
      return "Gaussian likelihood of autocorrelated residuals, " + autocorrelation + " as for " +
             std::string(best.model.name) + ", with the variance of rounding added";
    case Likelihood::kScaled:
      return "likelihood of independent " + std::string(NoiseFamilyName(best.noise.family)) +
             " residuals, in which the readings count as the effective samples, because they are autocorrelated (" +
             autocorrelation + ") and with " + NotGaussianReason(best) + " no better likelihood is known";
    case Likelihood::kNone:
      return "none: the residuals of " + std::string(best.model.name) +
             ", the model nearest to the readings, are no larger than the error of its computed trajectory";
  }
  return "";
}

Likelihood ChooseLikelihood(const FitReport& best, double resolution) {
  if (IsRounding(best)) return Likelihood::kNone;
  if (best.noise.autocorrelation.kind == Autocorrelation::Kind::kWhite) return Likelihood::kIndependent;
  const bool exceeds_rounding = best.noise.sigma >= kSmallestSigma * resolution;
  return IsNormal(best) && exceeds_rounding && best.noise.censored == 0 ? Likelihood::kCorrelated : Likelihood::kScaled;
}

double ScaledLikelihood(const FitReport& fit, const FitReport& best, double samples) {
  return std::min(best.statistics.effective_samples / samples, 1.0) * fit.statistics.log_likelihood;
}

void SetCriteria(double samples, double effective_samples, ComparisonRow& row) {
  if (!row.log_likelihood) return;
  FitStatistics statistics;
  statistics.log_likelihood = *row.log_likelihood;
  SetInformationCriteria(row.parameters, effective_samples, statistics);
  row.bic = statistics.bic;
  SetInformationCriteria(row.parameters, samples, statistics);
  row.aic = statistics.aic;
  row.aicc = statistics.aicc;
}

void SetDifferences(std::vector<ComparisonRow>& rows) {
  double smallest_bic = kUnbounded, smallest_aicc = kUnbounded;
  for (const ComparisonRow& row : rows) {
    if (!row.bic) continue;
    smallest_bic = std::min(smallest_bic, *row.bic);
    smallest_aicc = std::min(smallest_aicc, *row.aicc);
  }
  double sum = 0;
  for (ComparisonRow& row : rows) {
    if (!row.bic) continue;
    row.delta_bic = *row.bic - smallest_bic;
    row.akaike_weight = std::exp(-0.5 * (*row.aicc - smallest_aicc));
    sum += *row.akaike_weight;
  }
  for (ComparisonRow& row : rows) {
    if (row.akaike_weight) *row.akaike_weight /= sum;
  }
}

}  // namespace pendulum
