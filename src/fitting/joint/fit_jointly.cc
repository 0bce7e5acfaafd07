// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/joint/fit_jointly.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "pendulum/base/format.h"
#include "pendulum/base/try.h"
#include "pendulum/fitting/fit/fit_description.h"
#include "pendulum/fitting/fit/fit_warnings.h"
#include "pendulum/fitting/fit/intervals.h"
#include "pendulum/fitting/fit/order_violation.h"
#include "pendulum/fitting/joint/joint_errors.h"
#include "pendulum/fitting/joint/joint_problem.h"
#include "pendulum/fitting/joint/solve_jointly.h"
#include "pendulum/fitting/residuals/residual_diagnostics.h"
#include "pendulum/fitting/solve/optimum.h"
#include "pendulum/fitting/uncertainty/profile.h"
#include "pendulum/fitting/uncertainty/standard_errors.h"

namespace pendulum {
namespace {

using Eigen::Index;

/// A joint solution and the intermediate results for its report.
struct JointState {
  JointProblem joint;
  Solution solution;
  Optimum optimum;
  std::vector<Optimum> own_optima;                // K: the optimum restricted to each recording
  std::vector<Description> descriptions;          // K
  std::vector<Autocorrelation> autocorrelations;  // K
  Errors errors;
  std::vector<SystematicCovariance> systematic;  // P x P, units of the restoring torque G
  bool from_posteriors = false;
};

/// The indices of a recording's free parameters among all free parameters.
std::vector<Index> RowsOf(const JointState& state, std::size_t k) {
  return state.joint.members[k].RowsAmong(state.optimum.free, state.own_optima[k].free);
}

void SetOwnOptima(JointState& state) {
  const Optimum& all = state.optimum;
  for (std::size_t k = 0; k < state.joint.members.size(); ++k) {
    const JointMember& member = state.joint.members[k];
    Optimum own;
    own.information = all.information(member.at, member.at);
    own.gradient = all.gradient(member.at);
    own.free = member.OwnIndices(all.free);
    own.at_bound = member.OwnIndices(all.at_bound);
    own.inverse.identifiable = all.inverse.identifiable;
    own.inverse.direction = member.OwnIndices(all.inverse.direction);
    state.own_optima.push_back(std::move(own));
    if (!all.inverse.identifiable) continue;
    const std::vector<Index> rows = RowsOf(state, k);
    state.own_optima[k].inverse.matrix = all.inverse.matrix(rows, rows);
  }
}

// ---- Termination ----------------------------------------------------------------------------------------------------

struct Ending {
  Termination termination = Termination::kNotConverged;
  std::string reason;
};

std::string NamesOf(const JointProblem& joint, const std::vector<int>& parameters) {
  std::vector<std::string> names;
  names.reserve(parameters.size());
  for (const int i : parameters) names.push_back(joint.NameOf(i));
  return NameList(names);
}

/// Lists the recordings that the joint trajectories do not explain, with the unexplained share of each.
std::string DescribeUnexplained(const JointState& state) {
  std::string left;
  for (std::size_t k = 0; k < state.joint.members.size(); ++k) {
    const JointMember& member = state.joint.members[k];
    const double share = member.problem->UnexplainedShare(member.solution.readings);
    if (share <= MaxUnexplainedShare(state.descriptions[k].correlated)) continue;
    left += (left.empty() ? "" : ", ") +
            (share < 1 ? std::to_string(std::lround(100 * share)) + " %" : std::string("all")) +
            " of the variance of recording " + std::to_string(k + 1);
  }
  return left;
}

/// Describes the first recording whose own fit has a second solution. The other recordings do not exclude it.
std::string DescribeAmbiguity(const JointState& state) {
  for (std::size_t k = 0; k < state.joint.members.size(); ++k) {
    const FitReport& alone = *state.joint.members[k].alone;
    if (alone.HasWarning("ambiguous_sensor")) return "recording " + std::to_string(k + 1) + ": " + alone.reason;
  }
  return "";
}

Ending DetermineEnding(const JointState& state) {
  if (const std::string left = DescribeUnexplained(state); !left.empty()) {
    const bool restricted = state.joint.members.front().problem->restricted;
    return {Termination::kNotConverged,
            std::string(restricted ? "the given values, bounds and priors do not fit, or " : "") +
                "these are not swings of one pendulum with one " + NameList(state.joint.shared) +
                ": the best joint trajectories leave " + left + " unexplained"};
  }
  const InformationInverse& inverse = state.optimum.inverse;
  if (!inverse.identifiable) {
    const std::string names = NamesOf(state.joint, inverse.direction);
    return {Termination::kNotIdentifiable,
            "the recordings together do not determine " + names + "; fix or share more parameters"};
  }
  for (const JointMember& member : state.joint.members) {
    const std::string violation = OrderViolation(*member.problem, member.solution.parameters);
    if (!violation.empty()) return {Termination::kNotIdentifiable, violation};
  }
  if (std::string why = DescribeAmbiguity(state); !why.empty()) return {Termination::kNotIdentifiable, std::move(why)};
  if (const double shift = RemainingShift(state.optimum); !(shift <= kLargestShift)) {
    return {Termination::kNotConverged, "the estimates are still " + NumberText(shift, 2) +
                                            " standard errors from the minimum; try shorter windows or another model"};
  }
  return {Termination::kConverged,
          "the estimates are within " + NumberText(kLargestShift, 1) + " standard errors of the minimum"};
}

// ---- Errors ---------------------------------------------------------------------------------------------------------

Errors ErrorsAt(const JointState& state, const Optimum& optimum) {
  std::vector<FittedRun> runs;
  for (std::size_t k = 0; k < state.joint.members.size(); ++k) {
    const JointMember& member = state.joint.members[k];
    runs.push_back({*member.problem, *member.cost, member.solution, state.autocorrelations[k], member.at});
  }
  return ComputeErrors(runs, state.joint.cost->priors(), optimum);
}

/// Whether the joint fit explains a recording as well as its own fit does, except for a small rise of the deviance that
/// shared parameters cause.
bool MatchesSeparateFit(const JointMember& member, bool correlated) {
  constexpr double kMaxRise = 10;  // of the deviance
  const FitReport& alone = *member.alone;
  const double rise = 2 * member.samples() * std::abs(std::log(member.solution.noise.sigma / alone.noise.sigma));
  const bool is_autocorrelated = alone.noise.autocorrelation.kind != Autocorrelation::Kind::kWhite;
  return alone.termination == Termination::kConverged && rise < kMaxRise && (is_autocorrelated || !correlated);
}

Errors OwnErrors(const JointState& state, std::size_t k) {
  const std::vector<Index> rows = RowsOf(state, k);
  return {state.errors.covariance(rows, rows), state.errors.t95(rows), {state.errors.runs[k]}};
}

// ---- Intervals ------------------------------------------------------------------------------------------------------

bool NeedsProfiles(const JointState& state) {
  const IntervalMethod method = state.joint.members.front().options.interval;
  if (method == IntervalMethod::kProfile) return true;
  return method == IntervalMethod::kAuto &&
         IsNearBound(state.joint.solve, state.optimum, state.solution.parameters, state.errors.covariance);
}

/// Profiles of the shared parameters, identical in every report.
void SetSharedProfiles(JointState& state, std::vector<FitReport>& reports) {
  const JointProblem& joint = state.joint;
  const ErrorsOf errors_of = [&](const Optimum& optimum) { return ErrorsAt(state, optimum); };
  if (!joint.cost->SumOfSquares(state.solution.parameters, &state.solution.sum)) return;
  for (int i = 0; i < static_cast<int>(joint.shared.size()); ++i) {
    if (joint.solve.fixed[static_cast<std::size_t>(i)]) continue;
    const ProfileInterval interval =
        ProfileParameter(*joint.cost, joint.solve, state.solution, state.optimum, errors_of, joint.samples(), i);
    for (std::size_t k = 0; k < reports.size(); ++k) {
      const auto own = std::ranges::find(joint.members[k].at, i) - joint.members[k].at.begin();
      SetProfileInterval(*joint.members[k].problem, static_cast<int>(own), interval, reports[k]);
    }
  }
  for (FitReport& report : reports) {
    report.interval_method =
        "profile likelihood of the shared parameters; for the other parameters: " + report.interval_method;
  }
}

// ---- Reports --------------------------------------------------------------------------------------------------------

/// The systematic covariances of one recording's parameters.
std::vector<SystematicCovariance> SystematicOf(const JointState& state, const JointMember& member) {
  std::vector<SystematicCovariance> own;
  for (const SystematicCovariance& all : state.systematic) {
    own.push_back({all.kind, all.of_estimates(member.at, member.at), all.of_ratios(member.at, member.at)});
  }
  return own;
}

FitReport ReportOf(const JointState& state, std::size_t k) {
  const JointMember& member = state.joint.members[k];
  FitReport report = state.descriptions[k].report;
  const Optimum& own = state.own_optima[k];
  const Errors errors = OwnErrors(state, k);
  report.noise.autocorrelation = state.autocorrelations[k];
  report.statistics.effective_samples = errors.runs[0].effective_samples;
  report.noise.sigma_std_error = errors.runs[0].sigma;
  SetParameters(*member.recording, member.options, *member.problem, own, member.solution, report);
  SetCovariance(*member.problem, own, errors, report);
  SetSystematicErrors(*member.problem, SystematicOf(state, member), report);
  SetCovarianceIntervals(*member.problem, member.solution, own, errors, report);
  if (state.from_posteriors) report.std_error_method = "posteriors of the separate recordings, combined as parabolas";
  return report;
}

/// Sets parameters, errors and intervals of all recordings.
void SetReports(JointState& state, JointFit& fit) {
  for (std::size_t k = 0; k < state.joint.members.size(); ++k) fit.runs.push_back(ReportOf(state, k));
  if (NeedsProfiles(state) && !state.from_posteriors) SetSharedProfiles(state, fit.runs);
  for (std::size_t k = 0; k < fit.runs.size(); ++k) {
    const JointMember& member = state.joint.members[k];
    SetDerived(*member.problem, state.own_optima[k], OwnErrors(state, k), SystematicOf(state, member), member.solution,
               fit.runs[k]);
    SetIdentifiability(*member.problem, state.own_optima[k], fit.runs[k]);
  }
}

/// Sets parameters without errors.
void SetReportsWithoutErrors(JointState& state, JointFit& fit) {
  for (std::size_t k = 0; k < state.joint.members.size(); ++k) {
    const JointMember& member = state.joint.members[k];
    FitReport report = state.descriptions[k].report;
    SetParameters(*member.recording, member.options, *member.problem, state.own_optima[k], member.solution, report);
    report.derived = DerivedQuantities(member.problem->infos, member.solution.parameters, nullptr, {});
    if (!state.optimum.inverse.identifiable) SetIdentifiability(*member.problem, state.own_optima[k], report);
    fit.runs.push_back(std::move(report));
  }
}

/// Number of free parameters and parameters at a bound other than 0, plus one σ for each recording.
int CountParameters(const JointState& state) {
  auto count = static_cast<int>(state.optimum.free.size() + state.joint.members.size());
  for (const int i : state.optimum.at_bound)
    count += state.solution.parameters[static_cast<std::size_t>(i)] == 0 ? 0 : 1;
  return count;
}

/// Copies the rows and columns of the shared parameters.
void CopyShared(const JointFit& fit, const std::vector<std::string>& names, const Eigen::MatrixXd& matrix,
                std::vector<std::string>& shared_names, Eigen::MatrixXd& shared) {
  std::vector<Index> rows;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!fit.IsShared(names[i])) continue;
    rows.push_back(static_cast<Index>(i));
    shared_names.push_back(names[i]);
  }
  shared = matrix(rows, rows);
}

/// The noise of the first recording with autocorrelated residuals, otherwise of the first recording.
const NoiseEstimate& RepresentativeNoise(const JointFit& fit) {
  const auto is_autocorrelated = std::ranges::find_if(
      fit.runs, [](const FitReport& run) { return run.noise.autocorrelation.kind != Autocorrelation::Kind::kWhite; });
  return (is_autocorrelated == fit.runs.end() ? fit.runs.front() : *is_autocorrelated).noise;
}

/// Copies the results for the shared parameters from the first recording's report.
void SetShared(JointFit& fit) {
  const FitReport& first = fit.runs.front();
  FitReport& whole = fit.whole;
  std::ranges::copy_if(first.parameters, std::back_inserter(whole.parameters),
                       [&](const ParameterEstimate& parameter) { return fit.IsShared(parameter.info.name); });
  for (ParameterEstimate& parameter : whole.parameters) parameter.closed_form.reset();
  const bool have_one_unit =
      std::ranges::all_of(fit.runs, [&](const FitReport& run) { return run.reading_unit == first.reading_unit; });
  whole.reading_unit = have_one_unit ? first.reading_unit : "";
  CopyShared(fit, first.covariance_names, first.covariance, whole.covariance_names, whole.covariance);
  CopyShared(fit, first.systematic_names, first.systematic_covariance, whole.systematic_names,
             whole.systematic_covariance);
  std::ranges::copy_if(first.profiles, std::back_inserter(whole.profiles),
                       [&](const ProfileCurve& curve) { return fit.IsShared(curve.name); });
  std::ranges::copy_if(first.identifiability, std::back_inserter(whole.identifiability),
                       [&](const Identifiability& known) { return fit.IsShared(known.parameter); });
  // The derived quantities depend on inertia and every friction parameter. They are common to all recordings only if
  // all these parameters are shared.
  if (fit.shared.size() == PhysicalParameters(whole.model).size()) whole.derived = first.derived;
  whole.interval_method = first.interval_method;
  whole.std_error_method = first.std_error_method;
  whole.noise = RepresentativeNoise(fit);
}

/// The result if no joint trajectory can be computed.
JointFit Failed(const JointProblem& joint, JointFit fit) {
  fit.whole.termination = Termination::kFailed;
  fit.whole.reason =
      "no joint motion can be computed: the recordings are too different, or friction with the fixed values holds the "
      "pendulum";
  for (const JointMember& member : joint.members) {
    fit.runs.push_back(InitializeReport(*member.recording, *member.problem, *member.cost, member.solution));
    SetParameters(*member.recording, member.options, *member.problem, Optimum{}, member.solution, fit.runs.back());
    fit.runs.back().termination = fit.whole.termination;
    fit.runs.back().reason = fit.whole.reason;
  }
  return fit;
}

void AddWarnings(const JointState& state, JointFit& fit) {
  for (std::size_t k = 0; k < fit.runs.size(); ++k) {
    const JointMember& member = state.joint.members[k];
    const Description& described = state.descriptions[k];
    fit.runs[k].warnings = FitWarnings(*member.recording, *member.problem, member.solution, described.trace,
                                       described.quantile_residuals, described.correlated, fit.runs[k]);
    fit.runs[k].suspicions =
        member.alone->suspicions;  // of the same readings; the joint fit is not checked for effects
  }
}

/// Describes the residuals of each recording at the solution.
void DescribeAll(JointState& state) {
  SetOwnOptima(state);
  for (std::size_t k = 0; k < state.joint.members.size(); ++k) {
    const JointMember& member = state.joint.members[k];
    state.descriptions.push_back(Describe(*member.recording, *member.problem, *member.cost, member.solution,
                                          static_cast<int>(state.own_optima[k].free.size())));
  }
}

/// Computes the autocorrelation of each recording's residuals, and the covariance of the parameters.
void FindErrors(JointState& state) {
  for (std::size_t k = 0; k < state.joint.members.size(); ++k) {
    const JointMember& member = state.joint.members[k];
    const Description& described = state.descriptions[k];
    state.autocorrelations.push_back(MatchesSeparateFit(member, described.correlated)
                                         ? member.alone->noise.autocorrelation
                                         : AutocorrelationOf(*member.problem, *member.cost, member.solution,
                                                             state.own_optima[k], described.quantile_residuals,
                                                             described.correlated));
  }
  state.errors = ErrorsAt(state, state.optimum);
  if (state.from_posteriors) state.errors.covariance = state.optimum.inverse.matrix;
}

/// Sets termination and reason in every report.
void SetEnding(JointState& state, FitReport& whole) {
  const auto [termination, reason] = DetermineEnding(state);
  whole.termination = termination;
  whole.reason = reason;
  for (Description& described : state.descriptions) {
    described.report.termination = termination;
    described.report.reason = reason;
  }
}

}  // namespace

bool JointFit::IsShared(std::string_view name) const { return std::ranges::find(shared, name) != shared.end(); }

double CountedSamples(const FitReport& fit) {
  return static_cast<double>(fit.residual.size()) - static_cast<double>(fit.noise.censored);
}

FitStatistics SumStatistics(std::span<const FitReport* const> fits, int parameters) {
  FitStatistics all;
  double squares = 0, counted = 0, samples = 0;
  for (const FitReport* const fit : fits) {
    const double own = CountedSamples(*fit);
    squares += own * fit->statistics.rms_residual * fit->statistics.rms_residual;
    counted += own;
    samples += static_cast<double>(fit->residual.size());
    all.log_likelihood += fit->statistics.log_likelihood;
    all.effective_samples += fit->statistics.effective_samples;
  }
  all.rms_residual = std::sqrt(squares / std::max(counted, 1.0));
  SetInformationCriteria(parameters, std::max(samples, 1.0), all);
  return all;
}

namespace {

/// The result is meaningless if a stop is requested during the fit.
Result<JointFit> SolveAndReport(std::span<const JointRun> runs, const std::vector<std::string>& shared) {
  ASSIGN_OR_RETURN(JointProblem joint, MakeJointProblem(runs, shared));
  JointState state;
  state.joint = std::move(joint);
  state.solution = SolveJointly(state.joint);
  JointFit fit;
  fit.shared = state.joint.shared;
  fit.whole.model = state.joint.members.front().problem->model;
  std::optional<Optimum> optimum = Linearize(state.joint.solve, *state.joint.cost, state.solution);
  fit.whole.solver = {state.solution.iterations, state.joint.cost->traces(), state.solution.message, {}};
  if (!optimum) return Failed(state.joint, std::move(fit));
  state.optimum = *std::move(optimum);
  // Computed first, because posteriors change σ, on which the optimum's information depends.
  state.systematic = JointSystematicCovariances(state.joint, state.solution, state.optimum);
  state.from_posteriors = HasPosteriors(state.joint) && UsePosteriors(state.joint, state.solution, state.optimum);
  DescribeAll(state);
  SetEnding(state, fit.whole);
  if (fit.whole.termination == Termination::kConverged) {
    FindErrors(state);
    SetReports(state, fit);
  } else {
    SetReportsWithoutErrors(state, fit);
  }
  AddWarnings(state, fit);
  fit.parameters = CountParameters(state);
  std::vector<const FitReport*> all;
  all.reserve(fit.runs.size());
  for (const FitReport& run : fit.runs) all.push_back(&run);
  fit.whole.statistics = SumStatistics(all, fit.parameters);
  SetShared(fit);
  fit.whole.solver.evaluations = state.joint.cost->traces();
  return fit;
}

bool IsStopped(std::span<const JointRun> runs) {
  return std::ranges::any_of(runs, [](const JointRun& run) { return run.options.stop.stop_requested(); });
}

}  // namespace

Result<JointFit> FitJointly(std::span<const JointRun> runs, const std::vector<std::string>& shared) {
  if (IsStopped(runs)) return FitStopped();
  Result<JointFit> fit = SolveAndReport(runs, shared);
  if (IsStopped(runs)) return FitStopped();
  return fit;
}

}  // namespace pendulum
