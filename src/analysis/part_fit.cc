// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/part_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Cholesky>

#include "pendulum/analysis/fitted_motion.h"
#include "pendulum/fitting/residuals/estimate_autocorrelation.h"
#include "pendulum/fitting/solve/covariance.h"
#include "pendulum/fitting/solve/fit_problem.h"
#include "pendulum/recording/window.h"

namespace pendulum {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

bool IsStart(std::string_view name) {
  return name == kReleaseAngle.name || name == kReleaseTime.name || name == kInitialAngle.name ||
         name == kInitialRate.name;
}

bool IsZero(std::string_view name) { return name == kZeroAngle.name || name == kRateBias.name; }

/// A part starts at the whole fit's estimates and needs tens of trajectories. More would be spent only on parts that
/// are not a free swing.
constexpr int kMostTraces = 200;

/// The options of the whole fit, without those of its start and without values that both halves would share.
FitOptions OptionsOfParts(const FitReport& fit, FitOptions options) {
  options = OptionsLike(fit, std::move(options));
  options.start = StartKind::kMoving;
  options.search.start_values.reset();
  options.initial.clear();
  options.priors.clear();
  std::erase_if(options.fixed, [](const auto& entry) { return IsStart(entry.first); });
  std::erase_if(options.bounds, [](const auto& entry) { return IsStart(entry.first); });
  options.interval = IntervalMethod::kCovariance;
  options.progress = nullptr;
  options.search.max_traces = std::min(options.search.max_traces, kMostTraces);
  return options;
}

/// The noise of a fit with this range of the sensor.
NoiseModel NoiseBetween(const FitReport& fit, double low, double high) {
  const NoiseEstimate& noise = fit.noise;
  return {noise.family, noise.sigma,       noise.resolution, low,         high,
          noise.edge,   noise.stamp_ratio, noise.lag,        noise.spread};
}

/// Whether a fit without convergence ended within a standard error of the optimum, so that one linearized step is
/// enough. Friction that moves on and off its bound causes such fits.
bool IsNear(const PartFit& part, const NoiseModel& noise, const FitOptions& options) {
  constexpr double kMostUnexplained = 0.12;
  constexpr double kNear = 1;
  if (part.fit.termination != Termination::kNotConverged) return false;
  const VectorXd& value = part.part.value;
  const double variance = (value.array() - value.mean()).matrix().squaredNorm();
  if (part.fit.residual.squaredNorm() > kMostUnexplained * variance) return false;
  const ReadingTerms terms = TermsOf(noise, value, part.fit.fitted);
  const std::optional<LinearFit> linear = Linearize(part.part, part.fit, options.rig, terms, {}, true, options.stop);
  if (!linear) return false;
  const VectorXd gradient = linear->jacobian(Eigen::all, linear->free).transpose() * terms.score;
  return gradient.dot(linear->inverse * gradient) < kNear * kNear;
}

/// The covariance of all free parameters, with the residuals' own variance and autocorrelation (MODEL.md eq. (29)).
MatrixXd CovarianceOf(const Recording& part, const FitReport& fit, const LinearFit& linear, const NoiseModel& noise,
                      const ReadingTerms& terms, const std::stop_token& stop) {
  const VectorXd time = part.clock_scale * part.time;
  const bool converged = fit.termination == Termination::kConverged;
  const Autocorrelation memory =
      converged ? fit.noise.memory
                : MemoryOf(time, part.value, noise, fit.fitted, linear.jacobian(Eigen::all, linear.free), stop);
  const MatrixXd covariance = ScoreCovariance(noise, memory, terms, time, linear.influence);
  const double lost = linear.inverse.ldlt().solve(covariance).trace();
  return covariance * Inflation(noise, time.size(), linear.influence.cols(), lost);
}

}  // namespace

bool IsDrift(std::string_view name) { return name == kZeroDrift.name || name == kBiasDrift.name; }

ReadingTerms TermsOf(const NoiseModel& noise, const VectorXd& value, const VectorXd& readings) {
  ReadingTerms terms{VectorXd(value.size()), VectorXd(value.size())};
  for (Index i = 0; i < value.size(); ++i) {
    const NoiseLikelihood l = noise.ForSample(i).LikelihoodAt(value[i], readings[i]);
    terms.score[i] = l.score;
    terms.information[i] = l.information;
  }
  if (noise.IsRobust()) terms.information.setConstant(terms.information.mean());
  return terms;
}

MatrixXd ScoreCovariance(const NoiseModel& noise, const Autocorrelation& memory, const ReadingTerms& terms,
                         const VectorXd& time, const MatrixXd& weights) {
  if (noise.family == NoiseFamily::kEdges)
    return CorrelatedSum(memory, time, terms.information.cwiseSqrt().asDiagonal() * weights);
  const MatrixXd correlated = CorrelatedSum(memory, time, weights);
  if (noise.IsRobust()) return terms.score.squaredNorm() / static_cast<double>(time.size()) * correlated;
  const double variance = noise.sigma * noise.sigma;
  const VectorXd lost = 1 - variance * terms.information.array();
  return (correlated - weights.transpose() * lost.asDiagonal() * weights) / variance;
}

std::optional<LinearFit> Linearize(const Recording& recording, const FitReport& fit, const std::optional<Rig>& rig,
                                   const ReadingTerms& terms, const ParameterPriors& priors, bool with_bounds,
                                   const std::stop_token& stop) {
  LinearFit linear;
  const FittedMotion motion(recording, fit, rig, stop);
  if (!motion.Readings(motion.instants(), &linear.jacobian)) return std::nullopt;
  const MatrixXd weighted = terms.information.asDiagonal() * linear.jacobian;
  MatrixXd information = linear.jacobian.transpose() * weighted;
  std::vector<int> free;
  for (std::size_t i = 0; i < fit.parameters.size(); ++i) {
    const ParameterEstimate& parameter = fit.parameters[i];
    const auto k = static_cast<Index>(i);
    if (const auto prior = priors.find(parameter.info.name); prior != priors.end())
      information(k, k) += 1 / (prior->second.std_dev * prior->second.std_dev);
    // Comparisons of parts hold the sensor's parameters fixed, because these may rest on priors alone.
    if (parameter.fixed || IsSensorParameter(parameter.info.name) || (with_bounds && parameter.at_bound)) continue;
    linear.free.push_back(k);
    free.push_back(static_cast<int>(i));
  }
  const InformationInverse inverse = InvertInformation(information, free);
  if (!inverse.identifiable) return std::nullopt;
  linear.inverse = inverse.matrix;
  linear.influence = linear.jacobian(Eigen::all, linear.free) * linear.inverse;
  return linear;
}

Parts::Parts(const Recording& used, const FitReport& fit, const FitOptions& options)
    : used_(used),
      fit_(fit),
      options_(OptionsOfParts(fit, options)),
      motion_(FittedMotion(used, fit, options.rig).Trace()) {
  const double gravity_torque = options.rig ? options.rig->gravity_torque.value : 1.0;
  inertia_ = fit.parameters[0].estimate / gravity_torque;
  const NoiseModel noise = NoiseOfFit(used, fit, options);
  low_ = noise.low;
  high_ = noise.high;
}

NoiseModel NoiseOfFit(const Recording& used, const FitReport& fit, const FitOptions& options) {
  NoiseModel noise = NoiseBetween(fit, -kInfinity, kInfinity);
  if (fit.noise.censored == 0) return noise;
  if (const Result<FitProblem> problem = MakeFitProblem(used, options)) {
    noise.low = problem->noise.low;
    noise.high = problem->noise.high;
  }
  return noise;
}

PartFit Parts::Fit(double from, double to, const std::vector<std::string_view>& held) const {
  PartFit result;
  Result<Recording> part = SelectWindow(used_, from, to);
  if (!part) return {{}, 0, {}, part.error().message};
  result.part = *std::move(part);
  result.first = std::ranges::lower_bound(used_.time, result.part.time[0]) - used_.time.begin();
  FitOptions options = options_;
  const double instant = Instant(result.part.time[0]);
  for (const ParameterEstimate& parameter : fit_.parameters) {
    const std::string_view name = parameter.info.name;
    if (IsStart(name)) continue;
    double value = parameter.estimate;
    // The value of a drifting zero refers to the first sample.
    if (const ParameterEstimate& last = fit_.parameters.back(); IsZero(name) && IsDrift(last.info.name))
      value += last.estimate * instant;
    // Sensor parameters shared by both parts would make the parts agree.
    const bool hold = parameter.fixed || IsSensorParameter(name) || std::ranges::find(held, name) != held.end();
    (hold ? options.fixed : options.initial).insert_or_assign(std::string(name), value);
  }
  if (motion_) {
    options.initial.insert_or_assign(std::string(kInitialAngle.name), motion_->Angle(instant));
    options.initial.insert_or_assign(std::string(kInitialRate.name), motion_->Rate(instant));
  }
  Result<FitReport> fit = FitRecording(result.part, options);
  if (!fit) {
    result.reason = fit.error().message;
    return result;
  }
  result.fit = *std::move(fit);
  const bool converged =
      result.fit.termination == Termination::kConverged || IsNear(result, NoiseOf(result.fit), options);
  if (!converged) result.reason = result.fit.reason;
  return result;
}

NoiseModel Parts::NoiseOf(const FitReport& fit) const { return NoiseBetween(fit, low_, high_); }

double Parts::Amplitude(double time) const {
  if (!motion_) return 0;
  const double angle = motion_->Angle(Instant(time));
  const double rate = motion_->Rate(Instant(time));
  const double kinetic = inertia_ * rate * rate;  // twice the kinetic energy, in units of G
  if (fit_.model.gravity == Gravity::kLinear) return std::sqrt(kinetic + angle * angle);
  return std::acos(std::clamp(std::cos(angle) - 0.5 * kinetic, -1.0, 1.0));
}

std::vector<std::size_t> CutEvenly(const std::vector<double>& ends, std::size_t parts, const Parts& fits) {
  std::vector<double> told = {0};
  for (std::size_t i = 1; i < ends.size(); ++i)
    told.push_back(told.back() + std::pow(fits.Amplitude(0.5 * (ends[i - 1] + ends[i])), 2.0 / 3.0));
  std::vector<std::size_t> cuts = {0};
  for (std::size_t k = 1; k < parts; ++k) {
    const double wanted = told.back() * static_cast<double>(k) / static_cast<double>(parts);
    const auto above = static_cast<std::size_t>(std::ranges::lower_bound(told, wanted) - told.begin());
    const std::size_t nearest = above > 0 && wanted - told[above - 1] < told[above] - wanted ? above - 1 : above;
    const std::size_t last = ends.size() - 1 - kFewestHalfSwings * (parts - k);
    cuts.push_back(std::clamp(nearest, cuts.back() + kFewestHalfSwings, last));
  }
  cuts.push_back(ends.size() - 1);
  return cuts;
}

std::string TooShort(const std::vector<double>& ends, const std::string& what, std::size_t needed) {
  return std::to_string(ends.size() - 1) + " half swings are too few for " + what + "; " + std::to_string(needed) +
         " are needed";
}

double After(double time) { return std::nextafter(time, std::numeric_limits<double>::infinity()); }

double TwoSidedP(double z) { return std::erfc(std::abs(z) / std::sqrt(2.0)); }

Autocorrelation MemoryOf(const VectorXd& time, const VectorXd& value, const NoiseModel& noise, const VectorXd& readings,
                         const MatrixXd& jacobian, const std::stop_token& stop) {
  constexpr double kDoubtful = 0.05;
  const VectorXd z = QuantileResiduals(noise, value, readings);
  if (LjungBoxP(z) > kDoubtful) return {};
  const VectorXd weight = noise.Deviations(jacobian.rows()).cwiseInverse();
  return EstimateAutocorrelation(time, z, weight.asDiagonal() * jacobian, stop);
}

double Inflation(const NoiseModel& noise, Index samples, Index free, double lost) {
  const auto count = static_cast<double>(samples);
  const double known = noise.IsPlain() ? static_cast<double>(free) : 0;  // already corrected in σ
  return (count - known) / std::max(count - lost, 1.0);
}

/// One step to the maximum of the likelihood without bounds. An estimate cut off at a bound is not normally
/// distributed, and the other estimates depend on it.
std::optional<UnboundedEstimate> EstimateUnbounded(const Recording& part, const FitReport& fit, const NoiseModel& noise,
                                                   const std::optional<Rig>& rig, const std::stop_token& stop) {
  const ReadingTerms terms = TermsOf(noise, part.value, fit.fitted);
  const std::optional<LinearFit> linear = Linearize(part, fit, rig, terms, {}, false, stop);
  if (!linear) return std::nullopt;
  const VectorXd step = linear->influence.transpose() * terms.score;
  const MatrixXd covariance = CovarianceOf(part, fit, *linear, noise, terms, stop);
  UnboundedEstimate estimate;
  const auto physical = static_cast<Index>(PhysicalParameters(fit.model).size());
  std::vector<double> values;
  for (std::size_t i = 0; i < linear->free.size() && linear->free[i] < physical; ++i) {
    const ParameterEstimate& parameter = fit.parameters[static_cast<std::size_t>(linear->free[i])];
    estimate.names.push_back(parameter.info.name);
    values.push_back(parameter.estimate + step[static_cast<Index>(i)]);
  }
  const auto size = static_cast<Index>(values.size());
  estimate.value = Eigen::Map<const VectorXd>(values.data(), size);
  estimate.covariance = covariance.topLeftCorner(size, size);
  return estimate;
}

/// dᵀ C⁻¹ d, with C scaled to unit diagonal; NaN unless C is positive.
double SquaredLength(const VectorXd& difference, const MatrixXd& covariance) {
  const VectorXd scale = covariance.diagonal().cwiseSqrt().cwiseInverse();
  const VectorXd scaled = scale.asDiagonal() * difference;
  const MatrixXd correlation = scale.asDiagonal() * covariance * scale.asDiagonal();
  const auto factors = correlation.ldlt();
  return factors.isPositive() ? scaled.dot(factors.solve(scaled)) : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace pendulum
