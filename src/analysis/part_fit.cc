// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/part_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Cholesky>

#include "pendulum/analysis/fitted_motion.h"
#include "pendulum/analysis/linear_fit.h"
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

/// The search for a part's parameters begins at the whole fit's estimates and needs tens of trajectories. Only parts
/// that are not a free swing would need more.
constexpr int kMaxTraces = 200;

/// The options of the whole fit, without options of its start and without start values and priors, which all parts
/// would share.
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
  options.search.max_traces = std::min(options.search.max_traces, kMaxTraces);
  return options;
}

/// Whether a fit without convergence ended within a standard error of the optimum, so that one linearized step is
/// enough. Friction that moves on and off its bound causes such fits.
bool IsNear(const PartFit& part, const NoiseModel& noise, const FitOptions& options) {
  constexpr double kMaxUnexplained = 0.12;
  constexpr double kNear = 1;
  if (part.fit.termination != Termination::kNotConverged) return false;
  const VectorXd& value = part.part.value;
  const double variance = (value.array() - value.mean()).matrix().squaredNorm();
  if (part.fit.residual.squaredNorm() > kMaxUnexplained * variance) return false;
  const ReadingTerms terms = TermsOf(noise, value, part.fit.fitted);
  const std::optional<LinearFit> linear = LinearizeFit(part.part, part.fit, options.rig, terms, {}, true, options.stop);
  if (!linear) return false;
  const VectorXd gradient = linear->jacobian(Eigen::all, linear->free).transpose() * terms.score;
  return gradient.dot(linear->inverse * gradient) < kNear * kNear;
}

}  // namespace

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

PartFit Parts::Fit(double from, double to, const std::vector<std::string_view>& held) const {
  PartFit result;
  Result<Recording> part = SelectWindow(used_, from, to);
  if (!part) return {{}, 0, {}, part.error().message()};
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
    result.reason = fit.error().message();
    return result;
  }
  result.fit = *std::move(fit);
  const bool converged =
      result.fit.termination == Termination::kConverged || IsNear(result, NoiseOf(result.fit), options);
  if (!converged) result.reason = result.fit.reason;
  return result;
}

NoiseModel Parts::NoiseOf(const FitReport& fit) const { return NoiseOfFit(fit, low_, high_); }

NoiseModel Parts::PooledNoise(const std::vector<PartFit>& fits) const {
  double sum = 0, freedom = 0;
  for (const PartFit& part : fits) {
    const auto own = static_cast<double>(part.part.size() - static_cast<Index>(part.fit.covariance_names.size()));
    sum += own * part.fit.noise.sigma * part.fit.noise.sigma;
    freedom += own;
  }
  NoiseModel noise = NoiseOf(fit_);
  noise.sigma = std::sqrt(sum / freedom);
  return noise;
}

Autocorrelation Parts::PooledAutocorrelation(const NoiseModel& noise, const std::vector<PartFit>& fits,
                                             const std::vector<LinearFit>& linear) const {
  const Index first = fits.front().first;
  const Index count = fits.back().first + fits.back().part.size() - first;
  Index columns = 0;
  for (const LinearFit& part : linear) columns += part.influence.cols();
  MatrixXd jacobian = MatrixXd::Zero(count, columns);
  VectorXd readings = fit_.fitted.segment(first, count);
  columns = 0;
  for (std::size_t k = 0; k < fits.size(); ++k) {
    const Index begin = fits[k].first - first;
    readings.segment(begin, fits[k].part.size()) = fits[k].fit.fitted;
    jacobian.block(begin, columns, linear[k].jacobian.rows(), linear[k].influence.cols()) =
        linear[k].jacobian(Eigen::all, linear[k].free);
    columns += linear[k].influence.cols();
  }
  const bool is_white = fit_.noise.autocorrelation.kind == Autocorrelation::Kind::kWhite;
  return AutocorrelationOf(noise.From(first), used_.clock_scale * used_.time.segment(first, count),
                           used_.value.segment(first, count), readings, jacobian, options_.stop,
                           is_white ? Whiteness::kPossible : Whiteness::kExcluded);
}

double Parts::Amplitude(double time) const {
  if (!motion_) return 0;
  const double angle = motion_->Angle(Instant(time));
  const double rate = motion_->Rate(Instant(time));
  const double kinetic = inertia_ * rate * rate;  // twice the kinetic energy, in units of the restoring torque G
  const Gravity gravity = fit_.model.gravity;
  // By the chord: an arc cosine of the energy loses half the digits at small angles.
  return gravity.AngleOfChord(
      std::min(std::hypot(gravity.Chord(angle), std::sqrt(kinetic)), gravity.Chord(gravity.top())));
}

std::vector<std::size_t> CutEvenly(const std::vector<double>& ends, std::size_t parts, const Parts& fits) {
  std::vector<double> cumulative = {0};
  for (std::size_t i = 1; i < ends.size(); ++i)
    cumulative.push_back(cumulative.back() + std::pow(fits.Amplitude(0.5 * (ends[i - 1] + ends[i])), 2.0 / 3.0));
  std::vector<std::size_t> cuts = {0};
  for (std::size_t k = 1; k < parts; ++k) {
    const double target = cumulative.back() * static_cast<double>(k) / static_cast<double>(parts);
    const auto above = static_cast<std::size_t>(std::ranges::lower_bound(cumulative, target) - cumulative.begin());
    const std::size_t nearest =
        above > 0 && target - cumulative[above - 1] < cumulative[above] - target ? above - 1 : above;
    const std::size_t last = ends.size() - 1 - kMinHalfSwings * (parts - k);
    cuts.push_back(std::clamp(nearest, cuts.back() + kMinHalfSwings, last));
  }
  cuts.push_back(ends.size() - 1);
  return cuts;
}

std::string TooFewHalfSwings(const std::vector<double>& ends, const std::string& what, std::size_t needed) {
  return std::to_string(ends.size() - 1) + " half swings are too few for " + what + "; " + std::to_string(needed) +
         " are needed";
}

double NextDoubleAfter(double time) { return std::nextafter(time, std::numeric_limits<double>::infinity()); }

}  // namespace pendulum
