// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/coverage.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <utility>

#include "pendulum/analysis/cramer_rao.h"
#include "pendulum/analysis/fit_models.h"
#include "pendulum/base/distributions.h"
#include "pendulum/base/parallel.h"
#include "pendulum/base/try.h"
#include "pendulum/fitting/fit/fit.h"
#include "pendulum/fitting/fit/fit_jointly.h"
#include "pendulum/fitting/likelihood/edge_noise.h"

namespace pendulum {
namespace {

/// One parameter of one recording: the true value and the fit's result, in units of the report.
struct ParameterOutcome {
  double truth = 0;
  std::string unit;             ///< Unit in the report, if there is one.
  std::optional<double> bound;  ///< Cramér-Rao
  std::optional<double> estimate, std_error;
  bool has_interval = false;
  bool covered = false;
};

struct RunOutcome {
  std::vector<ParameterOutcome> parameters;  ///< P
  bool has_report = false;
  bool converged = false;
};

/// Factor from units of the true restoring torque G, or of true time, to the report's unit. A release time is on the
/// clock of the recording.
double ReportUnit(const CoverageScenario& scenario, const DrawnErrors& drawn, const ParameterInfo& info) {
  if (info.name == kReleaseTime.name) return 1 / drawn.clock;
  return scenario.fit.rig && info.scales_with_gravity() ? scenario.fit.rig->gravity_torque.value * drawn.torque : 1.0;
}

void AddEstimate(const ParameterEstimate& parameter, ParameterOutcome& outcome) {
  outcome.unit = parameter.unit;
  outcome.estimate = parameter.estimate;
  outcome.std_error = TotalStdError(parameter.std_error, parameter.systematic);
  outcome.has_interval = parameter.lower95.has_value() || parameter.upper95.has_value();
  const auto [lower, upper] = TotalInterval95(parameter);
  outcome.covered = outcome.has_interval && lower.value_or(-kUnbounded) <= outcome.truth &&
                    outcome.truth <= upper.value_or(kUnbounded);
}

/// The outcome of one recording, or of a set, for the parameters in `bounds`.
RunOutcome OutcomeOf(const CoverageScenario& scenario, const DrawnErrors& drawn, const std::vector<double>& truth,
                     const std::vector<std::optional<double>>& bounds, const FitReport* report) {
  const std::vector<ParameterInfo> infos = ParametersOf(scenario.run);
  RunOutcome outcome;
  outcome.has_report = report != nullptr;
  outcome.converged = report != nullptr && report->termination == Termination::kConverged;
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    const double unit = ReportUnit(scenario, drawn, infos[i]);
    ParameterOutcome parameter;
    parameter.truth = unit * truth[i];
    // The Cramér-Rao bound assumes that no parameter is fixed, and that noise is the only error.
    const bool has_bound = scenario.fit.fixed.empty() && std::isfinite(scenario.rule.largest_error);
    if (bounds[i] && has_bound) parameter.bound = unit * *bounds[i];
    const ParameterEstimate* found = outcome.converged ? report->Find(infos[i].name) : nullptr;
    if (found != nullptr) AddEstimate(*found, parameter);
    outcome.parameters.push_back(parameter);
  }
  return outcome;
}

/// The true values of recording k of a set; the recordings differ in release angle, or in the moving start.
SyntheticOptions RunOfSet(const CoverageScenario& scenario, std::uint64_t seed, int k, int runs) {
  constexpr double kSmallest = 0.7, kLargest = 1.3;
  const double factor = kSmallest + (kLargest - kSmallest) * k / (runs - 1);
  SyntheticOptions run = ScenarioRun(scenario, seed + static_cast<std::uint64_t>(k));
  run.release_angle *= factor;
  run.initial_angle *= factor;
  run.initial_rate *= factor;
  return run;
}

Result<RunOutcome> RunSet(const CoverageScenario& scenario, std::uint64_t seed, int runs) {
  std::vector<SimulatedRun> simulated;
  std::vector<Recording> recordings;
  std::vector<FitReport> alone;
  const DrawnErrors drawn = DrawErrors(scenario, seed);  // one rig, clock and calibration for the whole set
  for (int k = 0; k < runs; ++k) {
    SyntheticOptions run = RunOfSet(scenario, seed, k, runs);
    ASSIGN_OR_RETURN(Recording recording, SimulateRecording(run));
    simulated.push_back({std::move(run), recording.time});
    recordings.push_back(WithEdges(WithErrors(std::move(recording), scenario, drawn), scenario.fit.noise));
    if (Result<FitReport> fit = FitRecording(recordings.back(), scenario.fit)) alone.push_back(*std::move(fit));
  }
  const std::vector<double> truth = TrueParameters(simulated.front().truth);
  const std::vector<std::optional<double>> bounds = SharedCramerRaoBounds(simulated);
  if (alone.size() < recordings.size()) return OutcomeOf(scenario, drawn, truth, bounds, nullptr);
  std::vector<JointRun> joint;
  joint.reserve(alone.size());
  for (std::size_t k = 0; k < alone.size(); ++k) joint.push_back({recordings[k], alone[k], scenario.fit});
  const Result<JointFit> fit = FitJointly(joint, PhysicalNames({scenario.fit.model}));
  return OutcomeOf(scenario, drawn, truth, bounds, fit ? &fit->whole : nullptr);
}

Result<RunOutcome> RunOne(const CoverageScenario& scenario, std::uint64_t seed) {
  const SyntheticOptions run = ScenarioRun(scenario, seed);
  ASSIGN_OR_RETURN(const Recording recording, SimulateRecording(run));
  const DrawnErrors drawn = DrawErrors(scenario, seed);
  const Recording known = WithEdges(WithErrors(recording, scenario, drawn), scenario.fit.noise);
  const Result<FitReport> report = FitRecording(known, scenario.fit);
  const std::vector<std::optional<double>> bounds = CramerRaoBounds(run, recording.time);
  return OutcomeOf(scenario, drawn, TrueParameters(run), bounds, report ? &*report : nullptr);
}

/// Results of all recordings in the order of their seeds, independent of the thread. Each fit uses one thread, because
/// there are many fits.
std::vector<Result<RunOutcome>> RunAll(CoverageScenario scenario, const CoverageOptions& options) {
  scenario.fit.threads = 1;
  std::vector<Result<RunOutcome>> outcomes(static_cast<std::size_t>(options.count));
  std::mutex reporting;
  int done = 0;
  ParallelFor(options.count, options.threads, [&](int i) {
    const auto first = options.seed + static_cast<std::uint64_t>(i) * static_cast<std::uint64_t>(options.runs);
    outcomes[static_cast<std::size_t>(i)] =
        options.runs > 1 ? RunSet(scenario, first, options.runs) : RunOne(scenario, first);
    const std::lock_guard lock(reporting);
    ++done;
    if (options.progress) options.progress(done);
  });
  return outcomes;
}

/// Running mean; absent without values.
class Mean {
 public:
  void Add(double x) {
    sum_ += x;
    ++count_;
  }
  std::optional<double> value() const { return count_ == 0 ? std::nullopt : std::optional(sum_ / count_); }
  std::optional<double> root() const { return count_ == 0 ? std::nullopt : std::optional(std::sqrt(sum_ / count_)); }

 private:
  double sum_ = 0;
  int count_ = 0;
};

/// Statistics of parameter i over the recordings.
void Summarize(const std::vector<RunOutcome>& outcomes, std::size_t i, CoverageRow& row) {
  Mean square, normalized_square, std_error, square_with_std_error;
  for (const RunOutcome& outcome : outcomes) {
    const ParameterOutcome& parameter = outcome.parameters[i];
    row.covered += parameter.covered ? 1 : 0;
    row.without_interval += parameter.has_interval ? 0 : 1;
    if (!parameter.estimate) continue;
    const double error = *parameter.estimate - parameter.truth;
    square.Add(error * error);
    if (parameter.bound && !row.at_bound) normalized_square.Add(std::pow(error / *parameter.bound, 2));
    if (!parameter.std_error) continue;
    std_error.Add(*parameter.std_error);
    square_with_std_error.Add(error * error);
  }
  row.rms_error = square.root();
  row.error_over_bound = normalized_square.root();
  const std::optional<double> error = square_with_std_error.root();
  if (error && *error > 0) row.std_error_over_error = *std_error.value() / *error;
}

void ApplyRule(const CoverageScenario& scenario, int recordings, CoverageRow& row) {
  const CoverageRule& rule = row.at_bound ? kAtBoundRule : scenario.rule;
  const BinomialInterval interval = BinomialInterval95(row.covered, recordings);
  row.coverage = static_cast<double>(row.covered) / recordings;
  row.coverage_lower = interval.lower;
  row.coverage_upper = interval.upper;
  row.covers = interval.upper >= rule.lowest && interval.lower <= rule.highest;
  row.precise = !row.error_over_bound || *row.error_over_bound <= rule.largest_error;
}

CoverageRow MakeRow(const CoverageScenario& scenario, const std::vector<RunOutcome>& outcomes, std::size_t i) {
  const ParameterInfo info = ParametersOf(scenario.run)[i];
  const double truth = outcomes.front().parameters[i].truth;
  CoverageRow row;
  row.parameter = info.name;
  row.unit = scenario.fit.rig ? info.unit : info.relative_unit;
  for (const RunOutcome& outcome : outcomes) {
    if (const std::string& unit = outcome.parameters[i].unit; !unit.empty()) row.unit = unit;
  }
  row.at_bound = truth == info.lower || truth == info.upper;
  Summarize(outcomes, i, row);
  ApplyRule(scenario, static_cast<int>(outcomes.size()), row);
  return row;
}

}  // namespace

/// Each end is wrong in at most 2.5 % of the cases (C. J. Clopper and E. S. Pearson, Biometrika 26 (1934) 404).
BinomialInterval BinomialInterval95(int successes, int trials) {
  constexpr double kTail = 0.025;
  return {BinomialLowerLimit(successes, trials, kTail), BinomialUpperLimit(successes, trials, kTail)};
}

Result<CoverageStudy> StudyCoverage(const CoverageScenario& scenario, const CoverageOptions& options) {
  if (options.count < 1) {
    return Error(StatusCode::kInvalidArgument, "count is " + std::to_string(options.count) + "; it must be at least 1");
  }
  if (options.runs < 1) {
    return Error(StatusCode::kInvalidArgument, "runs is " + std::to_string(options.runs) + "; it must be at least 1");
  }
  if (options.threads < 0) {
    return Error(StatusCode::kInvalidArgument,
                 "threads is " + std::to_string(options.threads) + "; it must be 0 or more");
  }
  CoverageStudy study{scenario, options.count, options.runs, 0, 0, {}};
  std::vector<RunOutcome> outcomes;
  for (Result<RunOutcome>& outcome : RunAll(scenario, options)) {
    if (!outcome) return tl::unexpected(outcome.error());
    study.converged += outcome->converged ? 1 : 0;
    study.failed += outcome->has_report ? 0 : 1;
    outcomes.push_back(*std::move(outcome));
  }
  for (std::size_t i = 0; i < outcomes.front().parameters.size(); ++i) {
    CoverageRow row = MakeRow(scenario, outcomes, i);
    if (!scenario.fit.fixed.contains(row.parameter)) study.rows.push_back(std::move(row));
  }
  return study;
}

}  // namespace pendulum
