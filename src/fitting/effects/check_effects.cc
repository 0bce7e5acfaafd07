// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/effects/check_effects.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include <Eigen/Cholesky>

#include "fitting/effects/effect_estimates.h"
#include "fitting/likelihood/level_likelihoods.h"
#include "pendulum/base/physics.h"
#include "pendulum/fitting/effects/effect_columns.h"
#include "pendulum/fitting/residuals/autocorrelation.h"
#include "pendulum/fitting/residuals/estimate_autocorrelation.h"

namespace pendulum {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

/// Successive samples taken together, so that long recordings take no longer: each bin has the motion of its middle
/// sample.
struct Bins {
  std::vector<Index> middle;  // B, of the samples
  Index length = 1;
};

/// At most about a thousand bins, but enough in a period that the motion hardly changes within one.
Bins MakeBins(const FitProblem& problem) {
  constexpr double kMost = 800, kPerPeriod = 40;
  const auto samples = static_cast<Index>(problem.data.time.size());
  const double period = 2 * kPi / problem.data.natural_frequency;
  const double in_period = static_cast<double>(samples) * period / problem.data.time.back();
  const double length = std::min(static_cast<double>(samples) / kMost, in_period / kPerPeriod);
  Bins bins{{}, std::max<Index>(static_cast<Index>(length), 1)};
  for (Index i = bins.length / 2; i < samples; i += bins.length) bins.middle.push_back(i);
  return bins;
}

std::vector<Index> AllSamples(const FitProblem& problem) {
  std::vector<Index> all(problem.data.time.size());
  std::iota(all.begin(), all.end(), Index{0});
  return all;
}

/// The readings linearized in parameters and effects, each row divided by its standard deviation.
struct WeightedRows {
  VectorXd time;       // B, s
  MatrixXd columns;    // B x (F + E)
  VectorXd residual;   // B
  VectorXd deviation;  // B, 1 / standard deviation of the reading
};

/// Score and weight of each sample, summed over its bin.
void SetResiduals(const FitProblem& problem, const Solution& solution, const Bins& bins, WeightedRows& rows) {
  const auto values = problem.data.values();
  const LevelLikelihoods likelihoods(solution.noise, values.size());
  const bool is_quantized = solution.noise.family == NoiseFamily::kQuantized;
  VectorXd score = VectorXd::Zero(rows.time.size()), weight = score;
  for (Index i = 0; i < values.size(); ++i) {
    const Index bin = std::min(i / bins.length, rows.time.size() - 1);
    if (is_quantized) {
      const NoiseLikelihood sample = likelihoods.At(values[i], solution.readings[i], i);
      score[bin] += sample.score;
      weight[bin] += std::max(sample.information, 0.0);
    } else {
      const SampleLikelihood sample = solution.noise.ForSample(i).DevianceAt(values[i], solution.readings[i]);
      score[bin] += sample.score;
      weight[bin] += sample.weight;
    }
  }
  rows.deviation = weight.cwiseSqrt();
  rows.residual = (weight.array() > 0).select(score.array() / rows.deviation.array(), 0.0);
}

WeightedRows RowsOf(const FitProblem& problem, const Solution& solution, const Bins& bins, const MatrixXd& jacobian,
                    const MatrixXd& effects) {
  WeightedRows rows;
  rows.time = problem.data.times()(bins.middle);
  SetResiduals(problem, solution, bins, rows);
  rows.columns.resize(rows.time.size(), jacobian.cols() + effects.cols());
  rows.columns << rows.deviation.asDiagonal() * jacobian, rows.deviation.asDiagonal() * effects;
  return rows;
}

/// The residuals that no parameter and no effect explains, in standard deviations.
VectorXd UnexplainedResiduals(const WeightedRows& rows, const MatrixXd& information, const VectorXd& score) {
  const VectorXd scale = information.diagonal().unaryExpr([](double d) { return d > 0 ? 1 / std::sqrt(d) : 0.0; });
  MatrixXd scaled = scale.asDiagonal() * information * scale.asDiagonal();
  scaled.diagonal().array() += 1e-10;
  return rows.residual - rows.columns * (scale.asDiagonal() * scaled.ldlt().solve(scale.asDiagonal() * score));
}

void AddPriorsOfParameters(const std::vector<PriorTerm>& priors, const Solution& solution, const Optimum& optimum,
                           EffectSums& sums) {
  for (const PriorTerm& prior : priors) {
    const Index k = std::ranges::find(optimum.free, prior.parameter) - optimum.free.begin();
    if (k >= sums.parameters) continue;
    const double precision = prior.weight * prior.weight;
    sums.information(k, k) += precision;
    sums.meat(k, k) += precision;
    sums.score[k] -= precision * (solution.parameters[static_cast<std::size_t>(prior.parameter)] - prior.mean);
  }
}

/// The sums of all rows, and the priors of parameters.
EffectSums SumsOf(const FitProblem& problem, const TrajectoryCost& cost, const Solution& solution,
                  const WeightedRows& rows, const Optimum& optimum) {
  EffectSums sums;
  sums.parameters = static_cast<Index>(optimum.free.size());
  sums.information = rows.columns.transpose() * rows.columns;
  sums.score = rows.columns.transpose() * rows.residual;
  const VectorXd left = UnexplainedResiduals(rows, sums.information, sums.score);
  const double freedom = std::max(static_cast<double>(left.size() - rows.columns.cols()), 1.0);
  const double variance = left.squaredNorm() / freedom;
  const VectorXd standardized = left / std::sqrt(std::max(variance, 1e-300));
  Autocorrelation correlation;
  if (MayBeCorrelated(standardized)) {
    // The restricted likelihood with so many columns would take longer than the fit.
    const MatrixXd without_parameters(left.size(), 0);
    correlation = EstimateAutocorrelation(rows.time, standardized, without_parameters, problem.data.stop);
  }
  sums.meat = variance * (correlation.kind == Autocorrelation::Kind::kWhite
                              ? sums.information
                              : CorrelatedSum(correlation, rows.time, rows.columns));
  AddPriorsOfParameters(cost.priors(), solution, optimum, sums);
  return sums;
}

/// The effects of a fit and what is known of them.
class EffectTests {
 public:
  EffectTests(const EffectColumns& effects, const EffectSums& sums, const Correction& known)
      : effects_(effects), sums_(sums), applied_(VectorXd::Zero(effects.columns.cols())), corrected_(known.causes) {
    if (known.sizes.size() == applied_.size()) applied_ = known.sizes;
  }

  /// Columns of the effects of one of these causes.
  std::vector<Index> ColumnsOf(const std::vector<Cause>& causes) const {
    return ColumnsWhere([&](const Effect& effect) { return std::ranges::find(causes, effect.cause) != causes.end(); });
  }

  /// Columns of the effects in the error budget: those with a plausible size, and suspected ones of the hand.
  std::vector<Index> BudgetColumns(const std::vector<Suspicion>& suspicions) const {
    return ColumnsWhere([&](const Effect& effect) {
      const bool is_suspected = std::ranges::find(suspicions, effect.cause, &Suspicion::cause) != suspicions.end();
      return effect.std_dev > 0 || (is_suspected && IsCorrectable(effect.cause));
    });
  }

  /// Columns of friction that the law does not have.
  std::vector<Index> UnseenColumns() const {
    return ColumnsWhere([](const Effect& effect) { return effect.unseen_std_dev > 0; });
  }

  /// Indices of the effects in these columns.
  std::vector<Index> EffectsAt(std::vector<Index> columns) const {
    for (Index& column : columns) column -= sums_.parameters;
    return columns;
  }

  /// The changes of the effects in these columns from what is already corrected.
  EffectSizes Estimate(const std::vector<Index>& columns) const {
    EffectPriors priors{VectorXd(static_cast<Index>(columns.size())), -applied_(EffectsAt(columns))};
    for (std::size_t k = 0; k < columns.size(); ++k) {
      const double std_dev = EffectOf(columns[k]).std_dev;
      priors.precision[static_cast<Index>(k)] = std_dev > 0 ? 1 / (std_dev * std_dev) : 0;
    }
    return EstimateEffects(sums_, columns, priors);
  }

  /// The fall of -2 log of the posterior, less the price of the added effects (Schwarz's criterion).
  double Evidence(const EffectTest& test, const std::vector<Index>& columns, double samples) const {
    const VectorXd mean = Estimate(columns).mean;
    double improbable = 0;
    for (std::size_t k = 0; k < columns.size(); ++k) {
      const double std_dev = EffectOf(columns[k]).std_dev;
      if (std_dev > 0) improbable += std::pow(mean[static_cast<Index>(k)] / std_dev, 2);
    }
    return test.chi_square - improbable - test.freedom * std::log(samples);
  }

  /// Whether the sensor may have a curve as large as the readings suggest. What exceeds the plausible size by far is
  /// something else that looks like it, such as a clock that drifts or friction of another law.
  bool IsPlausible(Cause cause) const {
    constexpr double kMost = 4;  // standard deviations
    if (cause != Cause::kGain && cause != Cause::kNonlinearity) return true;
    const std::vector<Index> columns = ColumnsOf({cause});
    const VectorXd size = Estimate(columns).mean + applied_(EffectsAt(columns));
    for (std::size_t k = 0; k < columns.size(); ++k) {
      const double std_dev = EffectOf(columns[k]).std_dev;
      if (std_dev > 0 && std::abs(size[static_cast<Index>(k)]) > kMost * std_dev) return false;
    }
    return true;
  }

  /// Names causes one after another, each time the one with the strongest evidence beside those named before.
  std::vector<std::pair<Cause, EffectTest>> NameCauses(double samples) const {
    constexpr std::size_t kMost = 3;
    std::vector<std::pair<Cause, EffectTest>> named;
    std::vector<Cause> beside = corrected_;
    while (named.size() < kMost) {
      std::optional<std::pair<Cause, EffectTest>> best;
      double strongest = 0;
      for (const Cause cause : kCauses) {
        if (std::ranges::find(beside, cause) != beside.end()) continue;
        const std::vector<Index> columns = ColumnsOf({cause});
        if (columns.empty()) continue;
        const EffectTest test = TestEffects(sums_, ColumnsOf(beside), columns);
        if (test.significance < kSuspicious) continue;
        const double evidence = Evidence(test, columns, samples);
        if (evidence > strongest) {
          strongest = evidence;
          best = {cause, test};
        }
      }
      if (!best) break;
      named.push_back(*best);
      beside.push_back(best->first);
    }
    return named;
  }

  const Effect& EffectOf(Index column) const {
    return effects_.effects[static_cast<std::size_t>(column - sums_.parameters)];
  }

  const VectorXd& applied() const { return applied_; }
  Index parameters() const { return sums_.parameters; }

 private:
  template <typename Condition>
  std::vector<Index> ColumnsWhere(const Condition& condition) const {
    std::vector<Index> columns;
    for (std::size_t k = 0; k < effects_.effects.size(); ++k) {
      if (condition(effects_.effects[k])) columns.push_back(sums_.parameters + static_cast<Index>(k));
    }
    return columns;
  }

  const EffectColumns& effects_;
  const EffectSums& sums_;
  VectorXd applied_;  // E
  std::vector<Cause> corrected_;
};

/// What the F free parameters take up of each effect, F x E: (J'J)^-1 J'C. All of it is from the same rows: the
/// information of all samples is a little different, so that a lag would not be taken up by the release time alone.
MatrixXd TakenUp(const EffectSums& sums) {
  const Index parameters = sums.parameters, effects = sums.information.cols() - parameters;
  return sums.information.topLeftCorner(parameters, parameters)
      .ldlt()
      .solve(sums.information.topRightCorner(parameters, effects));
}

/// The size of a single effect, or the largest change of the readings by several without what the parameters take up.
void SetSize(const EffectTests& tests, const EffectSums& sums, const MatrixXd& taken, const WeightedRows& rows,
             const std::vector<Index>& columns, Suspicion& suspicion) {
  const EffectSizes sizes = tests.Estimate(columns);
  // Of a play the first effect is its width, the other where in it the hold was.
  if ((columns.size() == 1 && suspicion.cause != Cause::kFrictionLaw) || suspicion.cause == Cause::kBacklash) {
    suspicion.size = sizes.mean[0] + tests.applied()[columns[0] - sums.parameters];
    suspicion.std_error = std::sqrt(std::max(sizes.covariance(0, 0), 0.0));
    return;
  }
  const MatrixXd left = rows.columns(Eigen::all, columns) -
                        rows.columns.leftCols(sums.parameters) * taken(Eigen::all, tests.EffectsAt(columns));
  const VectorXd total = sizes.mean + tests.applied()(tests.EffectsAt(columns));
  const VectorXd change = left * total;
  Index at = 0;
  change.cwiseAbs().maxCoeff(&at);
  if (!(rows.deviation[at] > 0)) return;
  suspicion.size = std::abs(change[at]) / rows.deviation[at];
  suspicion.std_error =
      std::sqrt(std::max(left.row(at).dot(sizes.covariance * left.row(at).transpose()), 0.0)) / rows.deviation[at];
}

/// What friction of these columns does to the estimates.
struct FrictionPull {
  VectorXd shift;    // P
  VectorXd std_dev;  // P
};

/// taken: TakenUp. Before the recording, each term has the standard deviation unseen_std_dev; nothing is known if that
/// is 0.
FrictionPull PullOf(const std::vector<Index>& columns, const EffectTests& tests, const EffectSums& sums,
                    const MatrixXd& taken, const Optimum& optimum) {
  FrictionPull pull{VectorXd::Zero(optimum.gradient.size()), VectorXd::Zero(optimum.gradient.size())};
  if (columns.empty()) return pull;
  const auto count = static_cast<Index>(columns.size());
  EffectPriors priors{VectorXd::Zero(count), VectorXd::Zero(count)};
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const double std_dev = tests.EffectOf(columns[k]).unseen_std_dev;
    if (std_dev > 0) priors.precision[static_cast<Index>(k)] = 1 / (std_dev * std_dev);
  }
  const EffectSizes sizes = EstimateEffects(sums, columns, priors);
  const MatrixXd moved = taken(Eigen::all, tests.EffectsAt(columns));
  pull.shift(optimum.free) = moved * sizes.mean;
  pull.std_dev(optimum.free) = (moved * sizes.covariance * moved.transpose()).diagonal().cwiseMax(0).cwiseSqrt();
  return pull;
}

/// How far the estimates are off by the friction with the strongest evidence among what was named. What is named beside
/// it only improves the description, and compensates for viscous and dry friction almost at will.
VectorXd NamedFriction(const std::vector<Suspicion>& suspicions, const EffectTests& tests, const EffectSums& sums,
                       const MatrixXd& taken, const Optimum& optimum) {
  const auto strongest = std::ranges::find_if_not(suspicions, IsCorrectable, &Suspicion::cause);
  const std::vector<Cause> named =
      strongest == suspicions.end() ? std::vector<Cause>{} : std::vector<Cause>{strongest->cause};
  const FrictionPull pull = PullOf(tests.ColumnsOf(named), tests, sums, taken, optimum);
  return (pull.shift.cwiseAbs2() + pull.std_dev.cwiseAbs2()).cwiseSqrt();
}

/// Whether readings stay valid if a small angle is subtracted from each: not if they are compared with fixed levels or
/// with the ends of a range.
bool MayCorrect(const FitProblem& problem, const NoiseModel& noise) {
  return problem.censored == 0 && noise.family != NoiseFamily::kEdges && noise.family != NoiseFamily::kAveraged;
}

/// Whether residuals are smooth enough for tests: with hardly any noise they are rounding errors of a smooth curve. The
/// readings of a mean are rounded to counts, which are coarser than the levels of means.
bool MayTest(const NoiseModel& noise, double resolution) {
  constexpr double kSmooth = 0.12;
  return noise.family == NoiseFamily::kEdges || noise.sigma > kSmooth * std::max(resolution, noise.averaging.count);
}

/// The correction by the named and the former causes together.
Correction CorrectionOf(const EffectTests& tests, const Correction& known, const std::vector<Suspicion>& suspicions) {
  Correction correction{known.causes, tests.applied(), {}, 0};
  for (const Suspicion& suspicion : suspicions) {
    const bool is_new = IsCorrectable(suspicion.cause) && !suspicion.is_corrected;
    if (is_new && tests.IsPlausible(suspicion.cause)) correction.causes.push_back(suspicion.cause);
  }
  const std::vector<Index> columns = tests.ColumnsOf(correction.causes);
  if (columns.empty()) return correction;
  const VectorXd change = tests.Estimate(columns).mean;
  for (std::size_t k = 0; k < columns.size(); ++k) {
    double& size = correction.sizes[columns[k] - tests.parameters()];
    size += change[static_cast<Index>(k)];
    if (tests.EffectOf(columns[k]).cause == Cause::kBacklash && correction.play == 0) correction.play = std::abs(size);
  }
  return correction;
}

}  // namespace

std::string UnitOf(Cause cause, const Recording& recording) {
  if (cause == Cause::kGain) return "1";
  if (cause == Cause::kLag) return "s";
  if (cause == Cause::kPush) return "rad/s";
  return recording.value_unit();
}

EffectCheck CheckEffects(const Recording& recording, const FitProblem& problem, const TrajectoryCost& cost,
                         const Solution& solution, const Optimum& optimum, const Correction& known) {
  EffectCheck check;
  VectorXd readings;
  MatrixXd jacobian;
  const Bins bins = MakeBins(problem);
  const auto effects_at = [&](const std::vector<Index>& samples, double play) {
    return EffectColumnsAt(recording.sensor_errors, problem, cost, solution, samples, play);
  };
  const EffectColumns effects = effects_at(bins.middle, known.play);
  if (effects.effects.empty() || !optimum.inverse.identifiable || optimum.free.empty()) return check;
  if (!cost.Readings(solution.parameters, &readings, &jacobian)) return check;
  jacobian = MatrixXd(jacobian(bins.middle, Eigen::all));
  const WeightedRows rows = RowsOf(problem, solution, bins, jacobian(Eigen::all, optimum.free), effects.columns);
  const EffectSums sums = SumsOf(problem, cost, solution, rows, optimum);
  const MatrixXd taken = TakenUp(sums);
  const EffectTests tests(effects, sums, known);

  for (const Cause cause : known.causes) {
    check.suspicions.push_back({cause, 0, 0, UnitOf(cause, recording), 0, true});
    SetSize(tests, sums, taken, rows, tests.ColumnsOf({cause}), check.suspicions.back());
  }
  // Beside the causes that were named after it, a former one may have become superfluous.
  std::erase_if(check.suspicions, [](const Suspicion& one) { return std::abs(one.size) < 2 * one.std_error; });
  if (MayTest(solution.noise, problem.resolution)) {
    for (const auto& [cause, test] : tests.NameCauses(static_cast<double>(problem.data.time.size()))) {
      check.suspicions.push_back({cause, 0, 0, UnitOf(cause, recording), test.significance, false});
      SetSize(tests, sums, taken, rows, tests.ColumnsOf({cause}), check.suspicions.back());
    }
    if (MayCorrect(problem, solution.noise)) check.correction = CorrectionOf(tests, known, check.suspicions);
    if (!check.correction.causes.empty()) {
      const EffectColumns of_all = effects_at(AllSamples(problem), check.correction.play);
      // Samples may show a motion that bins do not show; then they have other effects.
      if (of_all.columns.cols() == check.correction.sizes.size()) {
        check.correction.readings = of_all.columns * check.correction.sizes;
      } else {
        check.correction = known;
      }
    }
  }

  const FrictionPull unseen = PullOf(tests.UnseenColumns(), tests, sums, taken, optimum);
  check.unseen_friction = unseen.std_dev;
  check.hidden_friction = (unseen.shift.cwiseAbs2() - unseen.std_dev.cwiseAbs2()).cwiseMax(0).cwiseSqrt();
  check.named_friction = NamedFriction(check.suspicions, tests, sums, taken, optimum);
  const Index count = effects.columns.cols();
  for (const Effect& effect : effects.effects) check.causes.push_back(effect.cause);
  check.pull = (rows.deviation.asDiagonal() * jacobian).transpose() * rows.columns.rightCols(count);
  check.pull(optimum.free, Eigen::all) = optimum.information(optimum.free, optimum.free) * taken;
  check.second_moment = MatrixXd::Zero(count, count);
  const std::vector<Index> budget = tests.BudgetColumns(check.suspicions);
  if (budget.empty()) return check;
  const EffectSizes sizes = tests.Estimate(budget);
  const std::vector<Index> at = tests.EffectsAt(budget);
  check.second_moment(at, at) = sizes.covariance + sizes.mean * sizes.mean.transpose();
  return check;
}

}  // namespace pendulum
