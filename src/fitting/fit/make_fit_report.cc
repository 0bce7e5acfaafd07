// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/fit/make_fit_report.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fitting/fit/fit_ending.h"
#include "pendulum/fitting/fit/fit_description.h"
#include "pendulum/fitting/fit/fit_warnings.h"
#include "pendulum/fitting/fit/intervals.h"
#include "pendulum/fitting/fit/plausibility.h"
#include "pendulum/fitting/uncertainty/derived.h"
#include "pendulum/fitting/uncertainty/standard_errors.h"

namespace pendulum {
namespace {

/// A fit while its reports are made.
struct FitState {
  SolvedFit fit;
  const SeparateFits* separate;           // nullptr for one recording
  Optimum optimum;                        // of all P parameters
  std::vector<Optimum> own;               // K, of each recording's parameters
  std::vector<Description> descriptions;  // K, with the reports
};

void SetEnding(const Ending& ending, FitState& state) {
  for (Description& described : state.descriptions) {
    described.report.termination = ending.termination;
    described.report.reason = ending.reason;
  }
}

/// The reports of a fit without a trajectory.
std::vector<FitReport> FailedReports(const SolvedFit& fit) {
  std::vector<FitReport> reports;
  for (const FittedRun& run : fit.runs) {
    FitReport& report = reports.emplace_back(InitializeReport(run));
    report.termination = Termination::kFailed;
    report.reason =
        fit.runs.size() > 1
            ? "no joint motion can be computed: the recordings are too different, or friction with the fixed values "
              "holds the pendulum"
            : "with the values from which the fit begins the pendulum does not swing: friction holds it, the release "
              "is outside the hold, or the period is impossible; check fixed values (--fix, --init) and units";
    SetParameters(run, Optimum{}, report);
  }
  return reports;
}

// ---- Errors ---------------------------------------------------------------------------------------------------------

/// Sets how far estimates are off by friction that the law does not have: what was named, what the readings
/// suggest, and what they do not exclude.
void SetOtherFriction(const FitProblem& problem, FitReport& report) {
  for (Eigen::Index i = 0; i < report.effects.unseen_friction.size(); ++i) {
    const auto index = static_cast<std::size_t>(i);
    const double unseen = problem.si_per_internal[index] * report.effects.unseen_friction[i];
    if (unseen > 0) report.parameters[index].unseen_friction = unseen;
    report.parameters[index].hidden_friction = problem.si_per_internal[index] * report.effects.hidden_friction[i];
    report.parameters[index].named_friction = problem.si_per_internal[index] * report.effects.named_friction[i];
  }
}

/// Estimates how the effects that the law does not have act on the fit to one recording, and returns the errors that
/// they and the rig, clock and calibration cause.
std::vector<SystematicCovariance> CheckEffectsOfOne(const Correction& corrected, FitState& state) {
  const FittedRun& run = state.fit.runs.front();
  FitReport& report = state.descriptions.front().report;
  report.effects = CheckEffects(run.recording, run.problem, run.cost, run.solution, state.optimum, corrected);
  report.suspicions = report.effects.suspicions;
  SetOtherFriction(run.problem, report);
  return SystematicCovariances(state.fit, {&report.effects}, state.optimum);
}

/// Whether the joint fit explains a recording as well as its own fit does, except for a small rise of the deviance that
/// shared parameters cause.
bool MatchesSeparateFit(const FittedRun& run, const FitReport& alone, bool correlated) {
  constexpr double kMaxRise = 10;  // of the deviance
  const double rise = 2 * run.samples() * std::abs(std::log(run.solution.noise.sigma / alone.noise.sigma));
  const bool is_autocorrelated = alone.noise.autocorrelation.kind != Autocorrelation::Kind::kWhite;
  return alone.termination == Termination::kConverged && rise < kMaxRise && (is_autocorrelated || !correlated);
}

/// The systematic covariances of one recording's parameters.
std::vector<SystematicCovariance> SystematicOf(const std::vector<SystematicCovariance>& all,
                                               const std::vector<int>& at) {
  std::vector<SystematicCovariance> own;
  for (const SystematicCovariance& source : all) {
    own.push_back({source.kind, source.of_estimates(at, at), source.of_ratios(at, at), source.lines});
    for (BudgetLine& line : own.back().lines) line.parts = Eigen::VectorXd(line.parts(at));
  }
  return own;
}

/// Sets the autocorrelations of the residuals, which are estimated here or known from the separate fits.
void SetAutocorrelations(FitState& state) {
  for (std::size_t k = 0; k < state.fit.runs.size(); ++k) {
    FittedRun& run = state.fit.runs[k];
    Description& described = state.descriptions[k];
    const FitReport* const alone = state.separate == nullptr ? nullptr : state.separate->alone[k];
    const bool is_known = alone != nullptr && MatchesSeparateFit(run, *alone, described.correlated);
    run.correlation = is_known ? alone->noise.autocorrelation : AutocorrelationOf(run, state.own[k], described);
    described.report.noise.autocorrelation = run.correlation;
  }
}

/// How many times larger the errors of all F free parameters are in a fit without bounds: at least 1, and 1 if such a
/// fit is not determined.
Eigen::VectorXd WideningWithoutBounds(const Optimum& optimum) {
  Eigen::VectorXd widening = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(optimum.free.size()));
  if (optimum.at_bound.empty()) return widening;
  const Optimum unbounded = WithoutBounds(optimum, optimum.information);
  if (!unbounded.inverse.identifiable) return widening;
  for (Eigen::Index row = 0; row < widening.size(); ++row) {
    const auto place = std::ranges::find(unbounded.free, optimum.free[static_cast<std::size_t>(row)]);
    const auto k = place - unbounded.free.begin();
    widening[row] = std::sqrt(std::max(unbounded.inverse.matrix(k, k) / optimum.inverse.matrix(row, row), 1.0));
  }
  return widening;
}

/// The elements for the free parameters of recording k.
Eigen::VectorXd OwnElements(const Eigen::VectorXd& of_all, std::size_t k, const FitState& state) {
  return of_all(RowsAmong(state.fit.runs[k].at, state.optimum.free, state.own[k].free));
}

void Enlarge(const Eigen::VectorXd& factors, Eigen::MatrixXd& covariance) {
  covariance = factors.asDiagonal() * covariance * factors.asDiagonal();
}

/// Sets the intervals by the method of the options. Profiles and bootstrap fits need a likelihood, which posteriors are
/// not. widening: WideningWithoutBounds.
void SetIntervals(const std::vector<Errors>& own_errors, const Errors& errors, const Eigen::VectorXd& widening,
                  FitState& state) {
  const SolvedFit& fit = state.fit;
  if (fit.runs.front().options.interval == IntervalMethod::kBootstrap) {
    Description& only = state.descriptions.front();
    return SetBootstrapIntervals(fit.runs.front(), state.optimum, only.quantile_residuals, only.report);
  }
  std::vector<FitReport*> reports;
  for (std::size_t k = 0; k < fit.runs.size(); ++k) {
    reports.push_back(&state.descriptions[k].report);
    Errors widened = own_errors[k];
    Enlarge(OwnElements(widening, k, state), widened.covariance);
    SetCovarianceIntervals(fit.runs[k], state.own[k], widened, *reports.back());
  }
  const bool is_likelihood = state.separate == nullptr || !state.separate->are_posteriors;
  if (is_likelihood && NeedsProfiles(fit, state.optimum, errors)) SetProfileIntervals(fit, state.optimum, reports);
}

/// The longer side of a parameter's interval over t; std::nullopt if an end is missing.
std::optional<double> ErrorOfInterval(const ParameterEstimate& parameter) {
  if (!parameter.lower95 || !parameter.upper95) return std::nullopt;
  return std::max(parameter.estimate - *parameter.lower95, *parameter.upper95 - parameter.estimate) / *parameter.t95;
}

/// Enlarges the errors of recording k where a parameter is at its bound: it may be anywhere inside, and the others with
/// it. Their errors are those of their intervals or, without an end, of a fit without bounds. widening:
/// WideningWithoutBounds.
void WidenByBounds(const Eigen::VectorXd& widening, std::size_t k, Errors& errors, FitState& state) {
  if (state.optimum.at_bound.empty()) return;
  const Optimum& own = state.own[k];
  FitReport& report = state.descriptions[k].report;
  Eigen::VectorXd factors = OwnElements(widening, k, state);
  for (std::size_t row = 0; row < own.free.size(); ++row) {
    ParameterEstimate& parameter = report.parameters[static_cast<std::size_t>(own.free[row])];
    const std::optional<double> error = ErrorOfInterval(parameter);
    double& factor = factors[static_cast<Eigen::Index>(row)];
    if (error) factor = std::max(*error / *parameter.std_error, 1.0);
    *parameter.std_error *= factor;
  }
  Enlarge(factors, errors.covariance);
}

/// Whether the readings show how friction falls from its static to its sliding value.
bool IsStictionSeen(const FitProblem& problem, const FitReport& report) {
  constexpr double kResolved = 0.25;
  const ParameterEstimate& rate = report.parameters[static_cast<std::size_t>(problem.solve.last_friction)];
  const bool is_narrow = rate.std_error && *rate.std_error <= kResolved * std::abs(rate.estimate);
  const bool is_closed = rate.lower95 && *rate.lower95 > rate.info.lower && rate.upper95;
  return rate.fixed || (is_narrow && is_closed);
}

/// Removes the errors of static friction and of its reference rate where no readings show how friction falls from one
/// to the other: the two then stand for any curve of the same slope, and an error would promise too much. A parameter
/// that all recordings share keeps its error if one of them shows it.
void WithdrawUnseenStiction(FitState& state) {
  const std::vector<FittedRun>& runs = state.fit.runs;
  if (runs.front().problem.solve.small_swing_parameters.empty()) return;
  std::vector<bool> seen;
  for (std::size_t k = 0; k < runs.size(); ++k) {
    seen.push_back(IsStictionSeen(runs[k].problem, state.descriptions[k].report));
  }
  const bool is_seen_in_any = std::ranges::find(seen, true) != seen.end();
  for (std::size_t k = 0; k < runs.size(); ++k) {
    FitReport& report = state.descriptions[k].report;
    for (const int i : runs[k].problem.solve.small_swing_parameters) {
      ParameterEstimate& parameter = report.parameters[static_cast<std::size_t>(i)];
      const bool is_shared = static_cast<std::size_t>(runs[k].at[static_cast<std::size_t>(i)]) < state.fit.shared;
      if (parameter.fixed || (is_shared ? is_seen_in_any : seen[k])) continue;
      parameter.std_error = parameter.lower95 = parameter.upper95 = std::nullopt;
      parameter.systematic = {};
      parameter.open_interval = OpenInterval::kClosed;
      parameter.reason = "the readings do not show at which rate friction falls to its sliding value";
      std::erase_if(report.profiles, [&](const ProfileCurve& curve) { return curve.name == parameter.info.name; });
    }
  }
}

/// Withdraws the errors of a converged fit whose residuals cannot test the model.
void RejectIfTooFewEffectiveSamples(FitState& state) {
  if (std::ranges::none_of(state.descriptions, &Description::correlated)) return;
  double effective = 0, unexplained = 0;
  for (std::size_t k = 0; k < state.fit.runs.size(); ++k) {
    const FitReport& report = state.descriptions[k].report;
    effective += report.statistics.effective_samples;
    unexplained = std::max(unexplained, state.fit.runs[k].problem.UnexplainedShare(report.fitted));
  }
  const std::string why = TooFewEffectiveSamples(effective, static_cast<int>(state.optimum.free.size()), unexplained);
  if (why.empty()) return;
  SetEnding({Termination::kNotConverged, why}, state);
  for (Description& described : state.descriptions) {
    WithdrawErrors("the fit does not describe the readings", described.report);
    described.report.identifiability.clear();
  }
}

/// Sets covariance and noise of recording k. errors: of its own parameters; systematic: likewise.
void SetOwnErrors(const FittedRun& run, const Optimum& own, const Errors& errors,
                  const std::vector<SystematicCovariance>& systematic, FitReport& report) {
  report.statistics.effective_samples = errors.runs[0].effective_samples;
  report.noise.sigma = run.solution.noise.sigma;
  report.noise.sigma_std_error = errors.runs[0].sigma;
  SetCovariance(run.problem, own, errors, report);
  SetSystematicErrors(run.problem, systematic, report);
}

/// Sets estimates, errors and intervals of a converged fit, and the quantities they are based on.
void SetErrors(const Correction& corrected, FitState& state) {
  const SolvedFit& fit = state.fit;
  const SeparateFits* const separate = state.separate;
  // Computed first, because a posterior changes σ, on which the optimum's information depends.
  const std::vector<SystematicCovariance> systematic =
      separate == nullptr ? CheckEffectsOfOne(corrected, state) : separate->systematic;
  SetAutocorrelations(state);
  Errors errors = ComputeErrors(fit, state.optimum);
  std::optional<Optimum> sampled;
  if (separate == nullptr) {
    sampled = UsePosterior(fit.runs.front(), state.optimum, errors, state.descriptions.front().report);
  } else if (separate->are_posteriors) {
    errors.covariance = state.optimum.inverse.matrix;
    for (NoiseErrors& run : errors.runs) run.method = "posteriors of the separate recordings, combined as parabolas";
  }
  const auto own_optimum = [&](std::size_t k) -> const Optimum& { return sampled ? *sampled : state.own[k]; };
  const Optimum& all = sampled ? *sampled : state.optimum;
  std::vector<Errors> own;
  std::vector<std::vector<SystematicCovariance>> own_systematic;
  for (std::size_t k = 0; k < fit.runs.size(); ++k) {
    own.push_back(OwnErrors(fit, k, own_optimum(k), all, errors));
    own_systematic.push_back(SystematicOf(systematic, fit.runs[k].at));
    SetOwnErrors(fit.runs[k], own_optimum(k), own[k], own_systematic[k], state.descriptions[k].report);
  }
  const Eigen::VectorXd widening = WideningWithoutBounds(state.optimum);
  if (!sampled) SetIntervals(own, errors, widening, state);
  for (std::size_t k = 0; k < fit.runs.size(); ++k) {
    FitReport& report = state.descriptions[k].report;
    if (!sampled) WidenByBounds(widening, k, own[k], state);
    SetDerived(fit.runs[k], own_optimum(k), own[k], own_systematic[k], report);
    // With the errors that are withdrawn below: a parameter without an error would count as identifiable.
    SetIdentifiability(fit.runs[k].problem, state.own[k], report);
  }
  WithdrawUnseenStiction(state);
  RejectIfTooFewEffectiveSamples(state);
}

/// Compares the solution with the readings of each recording.
FitState MakeState(const SolvedFit& fit, const Optimum& optimum, const SeparateFits* separate) {
  FitState state{fit, separate, optimum, {}, {}};
  for (const FittedRun& run : fit.runs) {
    const Optimum& own = state.own.emplace_back(OwnOptimum(run.at, optimum));
    state.descriptions.push_back(Describe(run, static_cast<int>(own.free.size())));
  }
  return state;
}

}  // namespace

std::vector<FitReport> MakeFitReports(const SolvedFit& fit, const Optimum* optimum, const SeparateFits* separate,
                                      const Correction& corrected) {
  if (optimum == nullptr) return FailedReports(fit);
  const std::vector<const FitReport*> alone = separate == nullptr ? std::vector<const FitReport*>() : separate->alone;
  FitState state = MakeState(fit, *optimum, separate);
  const Ending ending = EndingOf(fit, *optimum, state.descriptions, alone);
  SetEnding(ending, state);
  for (std::size_t k = 0; k < fit.runs.size(); ++k) {
    SetParameters(fit.runs[k], state.own[k], state.descriptions[k].report);
  }
  const bool is_converged = ending.termination == Termination::kConverged;
  const bool has_errors = is_converged && fit.runs.front().options.interval != IntervalMethod::kNone;
  if (has_errors) SetErrors(corrected, state);
  std::vector<FitReport> reports;
  for (std::size_t k = 0; k < fit.runs.size(); ++k) {
    const FittedRun& run = fit.runs[k];
    Description& described = state.descriptions[k];
    FitReport& report = described.report;
    if (!has_errors) {
      report.derived = DerivedQuantities(run.problem.infos, run.solution.parameters);
      const bool is_undetermined = !state.optimum.inverse.identifiable;
      if (is_converged || is_undetermined) SetIdentifiability(run.problem, state.own[k], report);
    }
    report.warnings = FitWarnings(run.recording, run.problem, run.solution, described);
    // The suspicions are of the same readings; a joint fit is not checked for effects.
    if (!alone.empty()) report.suspicions = alone[k]->suspicions;
    report.solver.evaluations = run.cost.traces();
    reports.push_back(std::move(report));
  }
  return reports;
}

FitReport MakeFitReport(const FittedRun& run, const Correction& corrected) {
  const SolvedFit fit = SolvedFitOf(run);
  const std::optional<Optimum> optimum = Linearize(fit.solve, fit.cost, fit.solution);
  return std::move(MakeFitReports(fit, optimum ? &*optimum : nullptr, nullptr, corrected).front());
}

}  // namespace pendulum
