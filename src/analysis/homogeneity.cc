// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/homogeneity.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Cholesky>

#include "pendulum/analysis/agreement.h"
#include "pendulum/analysis/amplitude_dependence.h"
#include "pendulum/analysis/homogeneity_text.h"
#include "pendulum/analysis/linear_fit.h"
#include "pendulum/analysis/part_fit.h"
#include "pendulum/analysis/separate_estimates.h"
#include "pendulum/base/distributions.h"
#include "pendulum/model/parameter.h"

namespace pendulum {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// ---- Estimates of each recording alone ------------------------------------------------------------------------------

/// Removes the priors, which all recordings share, from the estimates and their covariance. Returns false if no
/// information remains.
bool RemovePriors(const ParameterPriors& priors, SeparateEstimates& estimates) {
  if (priors.empty()) return true;
  const Index size = estimates.value.size();
  MatrixXd precision = estimates.covariance.ldlt().solve(MatrixXd::Identity(size, size));
  VectorXd pull = precision * estimates.value;
  for (Index i = 0; i < size; ++i) {
    const auto prior = priors.find(estimates.names[static_cast<std::size_t>(i)]);
    if (prior == priors.end()) continue;
    const double weight = 1 / (prior->second.std_dev * prior->second.std_dev);
    precision(i, i) -= weight;
    pull[i] -= weight * prior->second.mean;
  }
  const VectorXd scale = precision.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::LLT<MatrixXd> factor(scale.asDiagonal() * precision * scale.asDiagonal());
  if (!scale.allFinite() || factor.info() != Eigen::Success) return false;
  estimates.covariance = scale.asDiagonal() * factor.solve(MatrixXd(scale.asDiagonal()));
  estimates.value = estimates.covariance * pull;
  return true;
}

std::string SourcesOf(const RunAlone& run) {
  const Recording& used = run.used;
  return SourcesText(used.clock_scale, used.clock_scale_std_dev,
                     used.calibration ? used.calibration->source.dump() : "null");
}

/// The systematic errors of the named parameters.
SystematicParts SystematicOf(const FitReport& fit, const std::vector<std::string>& names) {
  const auto size = static_cast<Index>(names.size());
  SystematicParts parts{MatrixXd::Zero(size, size), VectorXd::Zero(size), VectorXd::Zero(size)};
  const std::vector<std::string>& known = fit.systematic_names;
  const auto row_of = [&](Index i) {
    return std::ranges::find(known, names[static_cast<std::size_t>(i)]) - known.begin();
  };
  const auto count = static_cast<std::ptrdiff_t>(known.size());
  for (Index i = 0; i < size; ++i) {
    const auto row = row_of(i);
    for (Index j = 0; j < size; ++j) {
      const auto column = row_of(j);
      if (row < count && column < count) parts.covariance(i, j) = fit.systematic_covariance(row, column);
    }
    const SystematicErrors& errors = fit.Find(names[static_cast<std::size_t>(i)])->systematic;
    parts.rig[i] = errors.Of(ErrorSource::kRig);
    parts.inconstancy[i] = errors.OfMotion();
  }
  return parts;
}

/// All free parameters of a recording as its fit reports them, without the priors. If a parameter is at a bound:
/// inertia and friction, estimated without bounds. std::nullopt if the readings do not determine them.
std::optional<SeparateEstimates> EstimateAllFree(const RunAlone& run) {
  const FitReport& fit = run.fit;
  if (std::ranges::any_of(fit.parameters, [](const ParameterEstimate& p) { return p.at_bound; })) {
    const auto unbounded =
        EstimateUnbounded(run.used, fit, NoiseOfFit(run.used, fit, run.options), run.options.rig, run.options.stop);
    if (!unbounded) return std::nullopt;
    return SeparateEstimates{
        0, {unbounded->names.begin(), unbounded->names.end()}, unbounded->value, unbounded->covariance};
  }
  SeparateEstimates estimates{0, fit.covariance_names, VectorXd(static_cast<Index>(fit.covariance_names.size())),
                              fit.covariance};
  for (Index i = 0; i < estimates.value.size(); ++i) {
    estimates.value[i] = fit.Find(estimates.names[static_cast<std::size_t>(i)])->estimate;
  }
  return RemovePriors(run.options.priors, estimates) ? std::optional(estimates) : std::nullopt;
}

/// The named parameters with all errors that can make recordings differ.
std::optional<SeparateEstimates> EstimateNamed(const RunAlone& run, const std::vector<std::string>& names,
                                               bool own_sources) {
  const FitReport& fit = run.fit;
  // With another local minimum of similar quality the estimate is not normally distributed.
  if (fit.termination != Termination::kConverged || fit.HasWarning("another_minimum")) return std::nullopt;
  const std::optional<SeparateEstimates> all = EstimateAllFree(run);
  if (!all) return std::nullopt;
  std::vector<Index> rows;
  for (const std::string& name : names) {
    const auto found = std::ranges::find(all->names, name);
    if (found == all->names.end()) return std::nullopt;
    rows.push_back(found - all->names.begin());
  }
  std::vector<std::optional<double>> t95;
  for (const std::string& name : names) t95.push_back(fit.Find(name)->t95);
  return EstimatesToCompare({names, all->value(rows), all->covariance(rows, rows), t95, SystematicOf(fit, names)},
                            own_sources);
}

/// The recordings that determine all of the named parameters alone.
std::vector<SeparateEstimates> EstimateSeparately(const std::vector<RunAlone>& runs,
                                                  const std::vector<std::string>& names) {
  std::vector<SeparateEstimates> estimates;
  if (names.empty()) return estimates;
  std::vector<std::string> sources;
  for (const RunAlone& run : runs) sources.push_back(SourcesOf(run));
  const bool own_sources = HaveOwnSources(sources);
  for (std::size_t k = 0; k < runs.size(); ++k) {
    std::optional<SeparateEstimates> one = EstimateNamed(runs[k], names, own_sources);
    if (!one) continue;
    one->run = k;
    estimates.push_back(*std::move(one));
  }
  return estimates;
}

// ---- Each parameter -------------------------------------------------------------------------------------------------

void SetDistances(SharedParameter& parameter) {
  for (RunEstimate& run : parameter.runs) {
    if (!run.value) continue;
    const double own = 1 / (*run.std_error * *run.std_error);
    const double all = 1 / (parameter.std_error * parameter.std_error);
    const double others = all - own;
    if (!(others > 1e-12 * all)) continue;
    const double mean_of_others = (all * parameter.mean - own * *run.value) / others;
    run.z = (*run.value - mean_of_others) / std::sqrt(1 / own + 1 / others);
  }
}

SharedParameter DescribeParameter(const ParameterEstimate& info, const std::vector<SeparateEstimates>& estimates,
                                  Index j, std::size_t runs) {
  SharedParameter parameter;
  parameter.name = info.info.name;
  parameter.unit = info.unit;
  parameter.runs.resize(runs);
  const auto count = static_cast<Index>(estimates.size());
  VectorXd value(count), error(count);
  for (Index i = 0; i < count; ++i) {
    const SeparateEstimates& one = estimates[static_cast<std::size_t>(i)];
    value[i] = one.value[j];
    error[i] = std::sqrt(one.covariance(j, j));
    parameter.runs[one.run] = {value[i], error[i], {}};
  }
  const VectorXd weight = error.cwiseAbs2().cwiseInverse();
  parameter.mean = weight.dot(value) / weight.sum();
  parameter.std_error = 1 / std::sqrt(weight.sum());
  parameter.statistic = weight.dot((value.array() - parameter.mean).square().matrix());
  parameter.dof = static_cast<int>(count) - 1;
  parameter.p = ChiSquareTail(parameter.statistic, parameter.dof);
  parameter.scatter = SummarizeScatter(value, error);
  SetDistances(parameter);
  return parameter;
}

std::vector<std::string> FreeNames(const FitReport& fit, const std::vector<std::string>& shared) {
  std::vector<std::string> names;
  for (const std::string& name : shared) {
    const ParameterEstimate* const parameter = fit.Find(name);
    if (parameter != nullptr && !parameter->fixed) names.push_back(name);
  }
  return names;
}

const FitReport& FirstWithParameters(const std::vector<RunAlone>& runs) {
  const auto found = std::ranges::find_if(runs, [](const RunAlone& run) { return !run.fit.parameters.empty(); });
  return (found == runs.end() ? runs.front() : *found).fit;
}

std::string NotTestedReason(const FitReport& example, const std::vector<std::string>& shared,
                            const std::vector<std::string>& free) {
  if (std::ranges::none_of(shared, [&](const std::string& name) { return example.Find(name) != nullptr; })) {
    return "the model has none of the shared parameters";
  }
  if (free.empty()) return "all shared parameters are fixed, so there is nothing to compare";
  return "fewer than two recordings determine all shared parameters on their own";
}

}  // namespace

bool AmplitudeDependence::explains() const { return p < Homogeneity::kDisagree && rest_p >= Homogeneity::kDisagree; }

double Homogeneity::ScatterOfRigs() const {
  constexpr double kOneRig = 0.05;
  const auto inertia = std::ranges::find(parameters, kInertia.name, &SharedParameter::name);
  if (agrees() || inertia == parameters.end()) return 0;
  const double share = inertia->scatter.between / std::abs(inertia->scatter.mean);
  return share > kOneRig ? share : 0;
}

bool Homogeneity::is_amplitude() const {
  bool some = false;
  for (const SharedParameter& parameter : parameters) {
    if (parameter.agrees()) continue;
    const auto own = std::ranges::find(amplitude_dependence, parameter.name, &AmplitudeDependence::name);
    if (own == amplitude_dependence.end() || !own->explains()) return false;
    some = true;
  }
  return some;
}

Homogeneity TestHomogeneity(const std::vector<RunAlone>& runs, const std::vector<std::string>& shared) {
  Homogeneity result;
  for (const RunAlone& run : runs) result.amplitudes.push_back(MeanAmplitude(run.used, run.fit, run.options));
  const FitReport& example = FirstWithParameters(runs);
  const std::vector<std::string> names = FreeNames(example, shared);
  const std::vector<SeparateEstimates> estimates = EstimateSeparately(runs, names);
  if (estimates.size() < 2) {
    result.reason = NotTestedReason(example, shared, names);
    result.verdict = "not tested: " + result.reason;
    return result;
  }
  const Agreement agreement = TestAgreement(estimates);
  result.statistic = agreement.statistic;
  result.dof = agreement.dof;
  result.p = agreement.p;
  if (!result.p) result.reason = "the recordings' covariances cannot be inverted";
  for (std::size_t j = 0; j < names.size(); ++j) {
    result.parameters.push_back(
        DescribeParameter(*example.Find(names[j]), estimates, static_cast<Index>(j), runs.size()));
    if (auto dependence = TestAmplitudeDependence(runs, result.parameters.back(), result.amplitudes)) {
      result.amplitude_dependence.push_back(*std::move(dependence));
    }
  }
  if (!result.agrees() && !result.is_amplitude()) {
    for (const std::size_t k : FindDisagreeing(estimates))
      result.disagreeing.push_back(static_cast<int>(estimates[k].run));
    std::ranges::sort(result.disagreeing);
  }
  result.verdict = result.p ? DescribeHomogeneity(result, runs) : "not tested: " + result.reason;
  return result;
}

}  // namespace pendulum
