// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/uncertainty/systematic.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "pendulum/base/format.h"
#include "pendulum/base/physics.h"
#include "pendulum/fitting/solve/fit_problem.h"
#include "pendulum/fitting/start/fit_options.h"

namespace pendulum {
namespace {

using Eigen::Index;

/// A line of a source. Its own covariance is that of some of the source's C numbers, times a share of the variance.
struct SourceLine {
  std::string name, origin;
  bool is_assumed = false;
  std::optional<double> std_dev;
  std::string unit = "1";
  std::vector<Index> columns = {0};
  double share = 1;
  EvaluationType type = EvaluationType::kB;
};

/// A source of systematic error, and its effect on a fit of P parameters.
struct SystematicSource {
  ErrorSource kind;
  std::string identity;        // Recordings with the same identity share the source and its error.
  Eigen::VectorXd powers;      // P, for a common factor (C = 1): its power in each parameter; otherwise empty.
  Eigen::MatrixXd pull;        // P x C, derivatives of the P scores with respect to the source's C numbers.
  Eigen::MatrixXd covariance;  // C x C, of these numbers; for a common factor, relative.
  std::vector<SourceLine> lines;
  std::size_t count = 1;  // number of recordings that share it
};

/// The power of the clock's scale in a parameter's estimate, if the readings do not depend on a clock.
int PowerOfTime(const ParameterInfo& info) {
  const auto is_one_of = [&](auto... infos) { return ((info.name == infos.name) || ...); };
  if (is_one_of(kZeroDrift, kBiasDrift, kInitialRate)) return -1;
  if (!info.scales_with_gravity()) return 0;
  return info.relative_unit == "s^2" ? 2 : info.relative_unit == "s" ? 1 : 0;
}

/// Derivatives of the scores (P) with respect to the calibration's K coefficients: Σ w ∇m ∂value/∂c.
Eigen::MatrixXd ScoresByCalibration(const Calibration& calibration, const FittedRun& run) {
  const FitProblem& problem = run.problem;
  const Solution& solution = run.solution;
  const auto size = static_cast<Index>(calibration.coefficients.size());
  Eigen::MatrixXd pull = Eigen::MatrixXd::Zero(static_cast<Index>(problem.infos.size()), size);
  Eigen::VectorXd readings;
  Eigen::MatrixXd jacobian;
  if (!run.cost.Readings(solution.parameters, &readings, &jacobian)) return pull;
  double input = 0;
  for (Index i = 0; i < readings.size(); ++i) {
    const double value = problem.data.value[static_cast<std::size_t>(i)];
    input = calibration.Reading(value, input);
    double power = solution.noise.ForSample(i).DevianceAt(value, readings[i]).weight * calibration.RadFromUnit();
    for (Index k = 0; k < size; ++k, power *= input) pull.col(k) += power * jacobian.row(i).transpose();
  }
  return pull;
}

/// Derivatives of the scores (P) with respect to the relative scale of the clock, for readings that are rates or
/// accelerations: -Σ w ∇m dm/dε, with the times and a release time multiplied by 1 + ε. The sensor has its own clock,
/// so the estimates are no powers of the scale.
Eigen::VectorXd ScoresByClock(const FittedRun& run) {
  const FitProblem& problem = run.problem;
  const Solution& solution = run.solution;
  constexpr double kStep = 1e-5;
  const auto size = static_cast<Index>(problem.infos.size());
  const auto readings_at = [&](double scale, Eigen::VectorXd* readings) {
    TrajectoryData data = problem.data;
    for (double& time : data.time) time *= scale;
    for (double& factor : data.zero_motion_factors) factor *= scale;  // the times of a drift
    data.latest_release *= scale;
    std::vector<double> parameters = solution.parameters;
    if (const auto release = problem.Find(kReleaseTime.name)) parameters[*release] *= scale;
    return MakeTrajectoryCost(problem.model, problem.start.start, data)->Readings(parameters, readings, nullptr);
  };
  Eigen::VectorXd readings, later, earlier;
  Eigen::MatrixXd jacobian;
  Eigen::VectorXd pull = Eigen::VectorXd::Zero(size);
  if (!run.cost.Readings(solution.parameters, &readings, &jacobian)) return pull;
  if (!readings_at(1 + kStep, &later) || !readings_at(1 - kStep, &earlier)) return pull;
  for (Index i = 0; i < readings.size(); ++i) {
    const double value = problem.data.value[static_cast<std::size_t>(i)];
    const double weight = solution.noise.ForSample(i).DevianceAt(value, readings[i]).weight;
    pull -= weight * (later[i] - earlier[i]) / (2 * kStep) * jacobian.row(i).transpose();
  }
  return pull;
}

/// Derivative of the scores with respect to ε if parameter i is multiplied by 1 + n_i ε: A n p, where A is the
/// information of the samples alone.
Eigen::VectorXd ScoresByScale(const Eigen::VectorXd& powers, const FittedRun& run) {
  const Index size = powers.size();
  const std::vector<double>& parameters = run.solution.parameters;
  Eigen::MatrixXd sums;
  if (!run.cost.Sums(parameters, &sums)) return Eigen::VectorXd::Zero(size);
  Eigen::MatrixXd priors = Eigen::MatrixXd::Zero(size + 1, size + 1);
  AddPriors(run.cost.priors(), parameters, &priors);
  const Eigen::Map<const Eigen::VectorXd> p(parameters.data(), size);
  return (sums - priors).topLeftCorner(size, size) * powers.cwiseProduct(p);
}

/// Change of the estimates with a scale factor common to all recordings: n_i p_i if all parameters are free. A value
/// that is fixed or has a prior in reported units does not scale, and it changes the other estimates as well.
Eigen::VectorXd EstimatesByScale(const Eigen::VectorXd& powers, const SolvedFit& fit, const Optimum& optimum) {
  const auto size = static_cast<Index>(fit.solution.parameters.size());
  const Eigen::Map<const Eigen::VectorXd> p(fit.solution.parameters.data(), size);
  const Eigen::VectorXd scaled = powers.cwiseProduct(p);
  Eigen::VectorXd follows = Eigen::VectorXd::Zero(size);
  Eigen::VectorXd pull = Eigen::VectorXd::Zero(size);
  for (Index i = 0; i < size; ++i) {
    if (!fit.solve.fixed[static_cast<std::size_t>(i)]) continue;
    pull -= optimum.information.col(i) * scaled[i];
  }
  for (const PriorTerm& prior : fit.priors) {
    const int k = prior.parameter;
    pull[k] += prior.weight * prior.weight * powers[k] * (2 * (p[k] - prior.mean) + prior.mean);
  }
  if (!optimum.free.empty()) follows(optimum.free) = -optimum.inverse.matrix * pull(optimum.free);
  for (const int i : optimum.free) follows[i] += scaled[i];
  return follows;
}

/// The size of the effect by which a cause acts in the sensor; nullptr for other causes.
const EffectSize* SizeOf(Cause cause, const SensorErrors& sensor) {
  switch (cause) {
    case Cause::kGain: return &sensor.Of(SensorEffect::kGain);
    case Cause::kNonlinearity: {
      const EffectSize& cubic = sensor.Of(SensorEffect::kCubic);
      const EffectSize& eccentric = sensor.Of(SensorEffect::kEccentricSine);
      return cubic.std_dev > eccentric.std_dev ? &cubic : &eccentric;
    }
    case Cause::kLag: return &sensor.Of(SensorEffect::kLag);
    case Cause::kBacklash: return &sensor.Of(SensorEffect::kBacklash);
    case Cause::kDrift: return &sensor.Of(SensorEffect::kDrift);
    default: return nullptr;
  }
}

/// The lines of the sensor, one for each cause. budget: the effects that are in the budget.
std::vector<SourceLine> SensorLines(const Recording& recording, const EffectCheck& effects,
                                    const std::vector<Index>& budget) {
  std::vector<SourceLine> lines;
  for (std::size_t k = 0; k < budget.size(); ++k) {
    const Cause cause = effects.causes[static_cast<std::size_t>(budget[k])];
    const std::string name(CauseName(cause));
    auto line = std::ranges::find(lines, name, &SourceLine::name);
    if (line == lines.end()) {
      const EffectSize* const size = SizeOf(cause, recording.sensor_errors);
      const bool has_size = size != nullptr && size->std_dev > 0;
      line = lines.insert(line, has_size ? SourceLine{name, size->SourceText(), size->is_assumed, size->std_dev,
                                                      UnitOf(cause, recording)}
                                         : SourceLine{name, "suggested by the readings", false, std::nullopt, ""});
      if (!has_size) line->type = EvaluationType::kA;
      line->columns.clear();
    }
    line->columns.push_back(static_cast<Index>(k));
  }
  return lines;
}

/// Recordings share the sensor if they have its kind, the same causes, and the same sizes as far as these are stated.
/// What is assumed may depend on the amplitude.
std::string IdentityOf(const SensorErrors& sensor, const EffectCheck& effects, const std::vector<Index>& budget) {
  std::string identity = "sensor " + sensor.kind;
  for (const EffectSize& size : sensor.sizes) identity += size.is_assumed ? " -" : " " + NumberText(size.std_dev);
  for (const Index k : budget) identity.append(" ").append(CauseName(effects.causes[static_cast<std::size_t>(k)]));
  return identity;
}

/// The effects of the error budget as one source. Recordings of one kind of sensor share it.
std::optional<SystematicSource> SensorSource(const Recording& recording, const EffectCheck& effects) {
  std::vector<Index> budget;
  for (Index k = 0; k < effects.second_moment.rows(); ++k) {
    if (effects.second_moment(k, k) > 0) budget.push_back(k);
  }
  if (budget.empty()) return std::nullopt;
  return SystematicSource{ErrorSource::kSensor,
                          IdentityOf(recording.sensor_errors, effects, budget),
                          {},
                          effects.pull(Eigen::all, budget),
                          effects.second_moment(budget, budget),
                          SensorLines(recording, effects, budget)};
}

SourceLine CalibrationLine(const Calibration& calibration) {
  SourceLine line{"calibration", "the covariance of its coefficients", false, std::nullopt, ""};
  line.columns.resize(calibration.coefficients.size());
  line.type = EvaluationType::kA;
  std::iota(line.columns.begin(), line.columns.end(), Index{0});
  return line;
}

/// The lines of the rig: its values, whose errors are independent.
std::vector<SourceLine> RigLines(const Rig& rig) {
  const double torque = rig.gravity_torque.std_dev / rig.gravity_torque.value;
  if (rig.errors.empty()) return {SourceLine{"gravity_torque", "stated", false, torque}};
  std::vector<SourceLine> lines;
  for (const RigError& error : rig.errors) {
    const RigKey& key = *std::ranges::find(RigKeys(), error.key, &RigKey::name);
    lines.push_back({std::string(error.key),
                     error.is_assumed ? "assumed for a nominal value" : "stated with the rig",
                     error.is_assumed,
                     error.std_dev,
                     std::string(key.unit),
                     {0},
                     std::pow(error.of_torque / torque, 2)});
  }
  return lines;
}

/// The rig's gravity torque is a common factor of inertia and friction. The clock's scale enters with the power of time
/// in each parameter. The calibration's coefficients change every reading.
std::vector<SystematicSource> SourcesOfRun(const FittedRun& run, const EffectCheck& effects) {
  const Recording& recording = run.recording;
  const auto size = static_cast<Index>(run.problem.infos.size());
  Eigen::VectorXd gravity = Eigen::VectorXd::Zero(size);
  Eigen::VectorXd time(size);
  for (Index i = 0; i < size; ++i) {
    const ParameterInfo& info = run.problem.infos[static_cast<std::size_t>(i)];
    time[i] = PowerOfTime(info);
    if (SiRig(run.options) && info.scales_with_gravity()) gravity[i] = 1;
  }
  std::vector<SystematicSource> sources;
  const auto add_scale = [&](ErrorSource kind, const std::string& identity, const Eigen::VectorXd& powers,
                             double relative, std::vector<SourceLine> lines) {
    if (!(relative > 0)) return;
    sources.push_back({kind, identity, powers, ScoresByScale(powers, run),
                       Eigen::MatrixXd::Constant(1, 1, relative * relative), std::move(lines)});
  };
  if (const Rig* rig = SiRig(run.options)) {
    add_scale(ErrorSource::kRig, "rig", gravity, rig->gravity_torque.std_dev / rig->gravity_torque.value,
              RigLines(*rig));
  }
  const SensorErrors& sensor = recording.sensor_errors;
  // A clock that was rebuilt from coarse stamps has the error of that beside its own; a stated one has no other.
  const EffectSize& of_clock = sensor.Of(SensorEffect::kClock);
  const double clock_error = std::hypot(of_clock.std_dev, recording.clock_scale_std_dev / recording.clock_scale);
  const std::vector<SourceLine> clock_lines = {{"clock", of_clock.SourceText(), of_clock.is_assumed, clock_error}};
  const std::string clock = "clock " + NumberText(recording.clock_scale) + " " + NumberText(clock_error);
  const bool has_own_clock = recording.quantity == Quantity::kRate || recording.quantity == Quantity::kAcceleration;
  if (!has_own_clock) {
    add_scale(ErrorSource::kClock, clock, time, clock_error, clock_lines);
  } else if (clock_error > 0) {
    sources.push_back({ErrorSource::kClock,
                       clock,
                       {},
                       ScoresByClock(run),
                       Eigen::MatrixXd::Constant(1, 1, clock_error * clock_error),
                       clock_lines});
  }
  const std::optional<Calibration>& calibration = recording.calibration;
  if (calibration && calibration->covariance.size() > 0) {
    sources.push_back({ErrorSource::kCalibration,
                       "calibration " + calibration->source.dump(),
                       {},
                       ScoresByCalibration(*calibration, run),
                       calibration->covariance,
                       {CalibrationLine(*calibration)}});
  }
  if (std::optional<SystematicSource> of_sensor = SensorSource(recording, effects)) {
    sources.push_back(*std::move(of_sensor));
  }
  return sources;
}

/// Adds a recording's powers to those of the common source. If recordings disagree on a power, or if the estimates of
/// one are no powers, the powers are removed and only the pulls are used.
void MergePowers(const SolvedFit& fit, const FittedRun& run, const Eigen::VectorXd& own, SystematicSource& common) {
  Eigen::VectorXd& powers = common.powers;
  if (own.size() == 0) powers.resize(0);
  if (powers.size() == 0) return;
  for (std::size_t i = 0; i < run.at.size(); ++i) {
    const double power = own[static_cast<Index>(i)];
    const bool is_shared = static_cast<std::size_t>(run.at[i]) < fit.shared;
    if (common.count > 1 && is_shared && powers[run.at[i]] != power) {
      powers.resize(0);
      return;
    }
    powers[run.at[i]] = power;
  }
}

/// The sources of all recordings. Those with the same identity are one source.
std::vector<SystematicSource> SourcesOf(const SolvedFit& fit, const std::vector<const EffectCheck*>& effects) {
  const auto size = static_cast<Index>(fit.solution.parameters.size());
  std::vector<SystematicSource> sources;
  for (std::size_t k = 0; k < fit.runs.size(); ++k) {
    const FittedRun& run = fit.runs[k];
    for (const SystematicSource& own : SourcesOfRun(run, *effects[k])) {
      auto common = std::ranges::find(sources, own.identity, &SystematicSource::identity);
      if (common == sources.end()) {
        common = sources.insert(sources.end(), own);
        common->powers = Eigen::VectorXd::Zero(own.powers.size() > 0 ? size : 0);
        common->pull = Eigen::MatrixXd::Zero(size, own.pull.cols());
      } else {
        ++common->count;
      }
      MergePowers(fit, run, own.powers, *common);
      common->pull(run.at, Eigen::all) += own.pull;
    }
  }
  return sources;
}

/// The covariance that a source causes. The inverse information of the optimum gives the change of the estimates.
SystematicCovariance CovarianceOfSource(const SystematicSource& source, const SolvedFit& fit, const Optimum& optimum) {
  const auto size = static_cast<Index>(fit.solution.parameters.size());
  const bool of_all = source.count == fit.runs.size();
  Eigen::MatrixXd moved = Eigen::MatrixXd::Zero(size, source.pull.cols());
  if (of_all && source.powers.size() > 0) {
    moved = EstimatesByScale(source.powers, fit, optimum);
  } else if (!optimum.free.empty()) {
    moved(optimum.free, Eigen::all) = optimum.inverse.matrix * source.pull(optimum.free, Eigen::all);
  }
  Eigen::MatrixXd ratios = moved;
  if (source.kind == ErrorSource::kRig) {
    const Eigen::Map<const Eigen::VectorXd> p(fit.solution.parameters.data(), size);
    ratios.col(0) -= source.powers.cwiseProduct(p);
  }
  std::vector<BudgetLine> lines;
  for (const SourceLine& line : source.lines) {
    const auto of_line = moved(Eigen::all, line.columns);
    const Eigen::VectorXd variance =
        (of_line * source.covariance(line.columns, line.columns) * of_line.transpose()).diagonal();
    lines.push_back({source.kind, line.type, line.name, line.origin, line.is_assumed, line.std_dev, line.unit,
                     (line.share * variance).cwiseMax(0).cwiseSqrt()});
  }
  return {source.kind, moved * source.covariance * moved.transpose(), ratios * source.covariance * ratios.transpose(),
          std::move(lines)};
}

/// Adds a line. Lines of several recordings that differ only in what they do to the estimates become one.
void AddLine(BudgetLine line, std::vector<BudgetLine>& lines) {
  const auto same = std::ranges::find_if(lines, [&](const BudgetLine& other) {
    return other.name == line.name && other.origin == line.origin && other.std_dev == line.std_dev;
  });
  if (same == lines.end()) {
    lines.push_back(std::move(line));
  } else {
    same->parts = (same->parts.cwiseAbs2() + line.parts.cwiseAbs2()).cwiseSqrt();
  }
}

/// Adds a covariance to that of its kind.
void AddOfKind(SystematicCovariance more, std::vector<SystematicCovariance>& covariances) {
  const auto known = std::ranges::find(covariances, more.kind, &SystematicCovariance::kind);
  if (known == covariances.end()) {
    covariances.push_back(std::move(more));
    return;
  }
  known->of_estimates += more.of_estimates;
  known->of_ratios += more.of_ratios;
  for (BudgetLine& line : more.lines) AddLine(std::move(line), known->lines);
}

}  // namespace

std::vector<SystematicCovariance> SystematicCovariances(const SolvedFit& fit,
                                                        const std::vector<const EffectCheck*>& effects,
                                                        const Optimum& optimum) {
  std::vector<SystematicCovariance> covariances;
  if (!optimum.inverse.identifiable) return covariances;
  for (const SystematicSource& source : SourcesOf(fit, effects)) {
    AddOfKind(CovarianceOfSource(source, fit, optimum), covariances);
  }
  return covariances;
}

}  // namespace pendulum
