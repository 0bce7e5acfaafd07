// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/joint/fit_jointly.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "pendulum/base/format.h"
#include "pendulum/fitting/fit/broken_order.h"
#include "pendulum/fitting/fit/fit_description.h"
#include "pendulum/fitting/fit/fit_warnings.h"
#include "pendulum/fitting/fit/intervals.h"
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
struct Work {
  JointProblem joint;
  Solution solution;
  Optimum optimum;
  std::vector<Optimum> own_optima;        // K: the optimum restricted to each recording
  std::vector<Description> descriptions;  // K
  std::vector<Autocorrelation> memories;  // K
  Errors errors;
  Eigen::MatrixXd systematic;  // P x P, units of G
  bool from_posteriors = false;
};

/// The indices of a recording's free parameters among all free parameters.
std::vector<Index> RowsOf(const Work& work, std::size_t k) {
  return work.joint.members[k].RowsAmong(work.optimum.free, work.own_optima[k].free);
}

void SeeOwn(Work& work) {
  const Optimum& all = work.optimum;
  for (std::size_t k = 0; k < work.joint.members.size(); ++k) {
    const JointMember& member = work.joint.members[k];
    Optimum own;
    own.information = all.information(member.at, member.at);
    own.gradient = all.gradient(member.at);
    own.free = member.Own(all.free);
    own.at_bound = member.Own(all.at_bound);
    own.inverse.identifiable = all.inverse.identifiable;
    own.inverse.direction = member.Own(all.inverse.direction);
    work.own_optima.push_back(std::move(own));
    if (!all.inverse.identifiable) continue;
    const std::vector<Index> rows = RowsOf(work, k);
    work.own_optima[k].inverse.matrix = all.inverse.matrix(rows, rows);
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

/// The recordings that the joint trajectories do not explain.
std::string Unexplained(const Work& work) {
  std::string left;
  for (std::size_t k = 0; k < work.joint.members.size(); ++k) {
    const JointMember& member = work.joint.members[k];
    const double share = member.problem->UnexplainedShare(member.solution.readings);
    if (share <= MostUnexplained(work.descriptions[k].correlated)) continue;
    left += (left.empty() ? "" : ", ") +
            (share < 1 ? std::to_string(std::lround(100 * share)) + " %" : std::string("all")) +
            " of the variance of recording " + std::to_string(k + 1);
  }
  return left;
}

/// The first recording that has a second solution by itself, which the other recordings do not exclude.
std::string Ambiguous(const Work& work) {
  for (std::size_t k = 0; k < work.joint.members.size(); ++k) {
    const FitReport& alone = *work.joint.members[k].alone;
    if (alone.Warns("ambiguous_sensor")) return "recording " + std::to_string(k + 1) + ": " + alone.reason;
  }
  return "";
}

Ending EndOf(const Work& work) {
  if (const std::string left = Unexplained(work); !left.empty()) {
    const bool restricted = work.joint.members.front().problem->restricted;
    return {Termination::kNotConverged,
            std::string(restricted ? "not with the values, bounds and priors that were given, or " : "") +
                "these are not swings of one pendulum with one " + NameList(work.joint.shared) +
                ": the best joint trajectories leave " + left + " unexplained"};
  }
  const InformationInverse& inverse = work.optimum.inverse;
  if (!inverse.identifiable) {
    const std::string names = NamesOf(work.joint, inverse.direction);
    return {Termination::kNotIdentifiable, "the recordings together do not tell " + names + "; fix or share more"};
  }
  for (const JointMember& member : work.joint.members) {
    const std::string broken = BrokenOrder(*member.problem, member.solution.parameters);
    if (!broken.empty()) return {Termination::kNotIdentifiable, broken};
  }
  if (std::string why = Ambiguous(work); !why.empty()) return {Termination::kNotIdentifiable, std::move(why)};
  if (const double shift = RemainingShift(work.optimum); !(shift <= kLargestShift)) {
    return {Termination::kNotConverged, "a step of " + NumberText(shift, 2) +
                                            " standard errors is left to make; shorter windows or another model may "
                                            "converge"};
  }
  return {Termination::kConverged,
          "the step left to make is below " + NumberText(kLargestShift, 1) + " standard errors"};
}

// ---- Errors ---------------------------------------------------------------------------------------------------------

Errors ErrorsAt(const Work& work, const Optimum& optimum) {
  std::vector<FittedRun> runs;
  for (std::size_t k = 0; k < work.joint.members.size(); ++k) {
    const JointMember& member = work.joint.members[k];
    runs.push_back({*member.problem, *member.cost, member.solution, work.memories[k], member.at});
  }
  return ComputeErrors(runs, work.joint.cost->priors(), optimum);
}

/// Whether the joint residuals of a recording equal those of its own fit, apart from the cost of shared parameters.
bool IsAsAlone(const JointMember& member, bool correlated) {
  constexpr double kFew = 10;  // of the deviance
  const FitReport& alone = *member.alone;
  const double rise = 2 * member.samples() * std::abs(std::log(member.solution.noise.sigma / alone.noise.sigma));
  const bool remembers = alone.noise.memory.kind != Autocorrelation::Kind::kWhite;
  return alone.termination == Termination::kConverged && rise < kFew && (remembers || !correlated);
}

Errors OwnErrors(const Work& work, std::size_t k) {
  const std::vector<Index> rows = RowsOf(work, k);
  return {work.errors.covariance(rows, rows), work.errors.t95(rows), {work.errors.runs[k]}};
}

// ---- Intervals ------------------------------------------------------------------------------------------------------

bool WantsProfiles(const Work& work) {
  const IntervalMethod method = work.joint.members.front().options.interval;
  if (method == IntervalMethod::kProfile) return true;
  return method == IntervalMethod::kAuto &&
         IsNearBound(work.joint.solve, work.optimum, work.solution.parameters, work.errors.covariance);
}

/// Profiles of the shared parameters, identical in every report.
void SetSharedProfiles(Work& work, std::vector<FitReport>& reports) {
  const JointProblem& joint = work.joint;
  const ErrorsOf errors_of = [&](const Optimum& optimum) { return ErrorsAt(work, optimum); };
  if (!joint.cost->SumOfSquares(work.solution.parameters, &work.solution.sum)) return;
  for (int i = 0; i < static_cast<int>(joint.shared.size()); ++i) {
    if (joint.solve.fixed[static_cast<std::size_t>(i)]) continue;
    const ProfileInterval interval =
        ProfileParameter(*joint.cost, joint.solve, work.solution, work.optimum, errors_of, joint.samples(), i);
    for (std::size_t k = 0; k < reports.size(); ++k) {
      const auto own = std::ranges::find(joint.members[k].at, i) - joint.members[k].at.begin();
      SetProfileInterval(*joint.members[k].problem, static_cast<int>(own), interval, reports[k]);
    }
  }
  for (FitReport& report : reports) {
    report.interval_method = "profile likelihood of what is shared; of the others " + report.interval_method;
  }
}

// ---- Reports --------------------------------------------------------------------------------------------------------

FitReport ReportOf(const Work& work, std::size_t k) {
  const JointMember& member = work.joint.members[k];
  FitReport report = work.descriptions[k].report;
  const Optimum& own = work.own_optima[k];
  const Errors errors = OwnErrors(work, k);
  report.noise.memory = work.memories[k];
  report.statistics.effective_samples = errors.runs[0].effective_samples;
  report.noise.sigma_std_error = errors.runs[0].sigma;
  SetParameters(*member.recording, member.options, *member.problem, own, member.solution, report);
  SetCovariance(*member.problem, own, errors, report);
  SetSystematicErrors(*member.problem, work.systematic(member.at, member.at), report);
  SetCovarianceIntervals(*member.problem, member.solution, own, errors, report);
  if (work.from_posteriors) report.std_error_method = "posteriors of the recordings alone, combined as parabolas";
  return report;
}

/// Sets parameters, errors and intervals of all recordings.
void SetReports(Work& work, JointFit& fit) {
  for (std::size_t k = 0; k < work.joint.members.size(); ++k) fit.runs.push_back(ReportOf(work, k));
  if (WantsProfiles(work) && !work.from_posteriors) SetSharedProfiles(work, fit.runs);
  for (std::size_t k = 0; k < fit.runs.size(); ++k) {
    const JointMember& member = work.joint.members[k];
    SetDerived(*member.problem, work.own_optima[k], OwnErrors(work, k), member.solution, fit.runs[k]);
    SetIdentifiability(*member.problem, work.own_optima[k], fit.runs[k]);
  }
}

/// Sets parameters without errors.
void SetReportsWithoutErrors(Work& work, JointFit& fit) {
  for (std::size_t k = 0; k < work.joint.members.size(); ++k) {
    const JointMember& member = work.joint.members[k];
    FitReport report = work.descriptions[k].report;
    SetParameters(*member.recording, member.options, *member.problem, work.own_optima[k], member.solution, report);
    report.derived = DerivedQuantities(member.problem->infos, member.solution.parameters, nullptr, {});
    if (!work.optimum.inverse.identifiable) SetIdentifiability(*member.problem, work.own_optima[k], report);
    fit.runs.push_back(std::move(report));
  }
}

/// Number of free parameters, of those at a bound other than 0, and one σ for each recording.
int CountParameters(const Work& work) {
  auto count = static_cast<int>(work.optimum.free.size() + work.joint.members.size());
  for (const int i : work.optimum.at_bound) count += work.solution.parameters[static_cast<std::size_t>(i)] == 0 ? 0 : 1;
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
const NoiseEstimate& ExampleOfNoise(const JointFit& fit) {
  const auto remembers = std::ranges::find_if(
      fit.runs, [](const FitReport& run) { return run.noise.memory.kind != Autocorrelation::Kind::kWhite; });
  return (remembers == fit.runs.end() ? fit.runs.front() : *remembers).noise;
}

/// Copies the results for the shared parameters from the first recording's report.
void SetShared(JointFit& fit) {
  const FitReport& first = fit.runs.front();
  FitReport& whole = fit.whole;
  std::ranges::copy_if(first.parameters, std::back_inserter(whole.parameters),
                       [&](const ParameterEstimate& parameter) { return fit.IsShared(parameter.info.name); });
  for (ParameterEstimate& parameter : whole.parameters) parameter.closed_form.reset();
  CopyShared(fit, first.covariance_names, first.covariance, whole.covariance_names, whole.covariance);
  CopyShared(fit, first.systematic_names, first.systematic_covariance, whole.systematic_names,
             whole.systematic_covariance);
  std::ranges::copy_if(first.profiles, std::back_inserter(whole.profiles),
                       [&](const ProfileCurve& curve) { return fit.IsShared(curve.name); });
  std::ranges::copy_if(first.identifiability, std::back_inserter(whole.identifiability),
                       [&](const Identifiability& known) { return fit.IsShared(known.parameter); });
  // Each derived quantity needs inertia and at most one friction parameter, so all of them need all these parameters.
  if (fit.shared.size() == PhysicalParameters(whole.model).size()) whole.derived = first.derived;
  whole.interval_method = first.interval_method;
  whole.std_error_method = first.std_error_method;
  whole.noise = ExampleOfNoise(fit);
}

/// The result if no joint trajectory can be computed.
JointFit Failed(const JointProblem& joint, JointFit fit) {
  fit.whole.termination = Termination::kFailed;
  fit.whole.reason = "no joint trajectory can be traced: the recordings are too different, or what is fixed holds them";
  for (const JointMember& member : joint.members) {
    fit.runs.push_back(IntroduceFit(*member.recording, *member.problem, *member.cost, member.solution));
    SetParameters(*member.recording, member.options, *member.problem, Optimum{}, member.solution, fit.runs.back());
    fit.runs.back().termination = fit.whole.termination;
    fit.runs.back().reason = fit.whole.reason;
  }
  return fit;
}

void AddWarnings(const Work& work, JointFit& fit) {
  for (std::size_t k = 0; k < fit.runs.size(); ++k) {
    const JointMember& member = work.joint.members[k];
    const Description& described = work.descriptions[k];
    fit.runs[k].warnings = FitWarnings(*member.recording, *member.problem, member.solution, described.trace,
                                       described.quantile_residuals, described.correlated, fit.runs[k]);
  }
}

/// Describes the residuals of each recording at the solution.
void DescribeAll(Work& work) {
  SeeOwn(work);
  for (std::size_t k = 0; k < work.joint.members.size(); ++k) {
    const JointMember& member = work.joint.members[k];
    work.descriptions.push_back(Describe(*member.recording, *member.problem, *member.cost, member.solution,
                                         static_cast<int>(work.own_optima[k].free.size())));
  }
}

/// Computes the autocorrelation of each recording's residuals, and the covariance of the parameters.
void FindErrors(Work& work) {
  for (std::size_t k = 0; k < work.joint.members.size(); ++k) {
    const JointMember& member = work.joint.members[k];
    const Description& described = work.descriptions[k];
    work.memories.push_back(IsAsAlone(member, described.correlated)
                                ? member.alone->noise.memory
                                : AutocorrelationOf(*member.problem, *member.cost, member.solution, work.own_optima[k],
                                                    described.quantile_residuals, described.correlated));
  }
  work.errors = ErrorsAt(work, work.optimum);
  if (work.from_posteriors) work.errors.covariance = work.optimum.inverse.matrix;
}

/// Sets termination and reason in every report.
void SetEnding(Work& work, FitReport& whole) {
  const auto [termination, reason] = EndOf(work);
  whole.termination = termination;
  whole.reason = reason;
  for (Description& described : work.descriptions) {
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

/// The result is meaningless if a stop was requested meanwhile.
Result<JointFit> FitUnlessStopped(std::span<const JointRun> runs, const std::vector<std::string>& shared) {
  Result<JointProblem> joint = MakeJointProblem(runs, shared);
  if (!joint) return tl::unexpected(joint.error());
  Work work;
  work.joint = *std::move(joint);
  work.solution = SolveJointly(work.joint);
  JointFit fit;
  fit.shared = work.joint.shared;
  fit.whole.model = work.joint.members.front().problem->model;
  std::optional<Optimum> optimum = Linearize(work.joint.solve, *work.joint.cost, work.solution);
  fit.whole.solver = {work.solution.iterations, work.joint.cost->traces(), work.solution.message, {}};
  if (!optimum) return Failed(work.joint, std::move(fit));
  work.optimum = *std::move(optimum);
  // Computed first, because posteriors change σ, on which the optimum's information depends.
  work.systematic = SystematicErrors(work.joint, work.solution, work.optimum);
  work.from_posteriors = HasPosteriors(work.joint) && UsePosteriors(work.joint, work.solution, work.optimum);
  DescribeAll(work);
  SetEnding(work, fit.whole);
  if (fit.whole.termination == Termination::kConverged) {
    FindErrors(work);
    SetReports(work, fit);
  } else {
    SetReportsWithoutErrors(work, fit);
  }
  AddWarnings(work, fit);
  fit.parameters = CountParameters(work);
  std::vector<const FitReport*> all;
  all.reserve(fit.runs.size());
  for (const FitReport& run : fit.runs) all.push_back(&run);
  fit.whole.statistics = SumStatistics(all, fit.parameters);
  SetShared(fit);
  fit.whole.solver.evaluations = work.joint.cost->traces();
  return fit;
}

bool IsStopped(std::span<const JointRun> runs) {
  return std::ranges::any_of(runs, [](const JointRun& run) { return run.options.stop.stop_requested(); });
}

}  // namespace

Result<JointFit> FitJointly(std::span<const JointRun> runs, const std::vector<std::string>& shared) {
  if (IsStopped(runs)) return FitStopped();
  Result<JointFit> fit = FitUnlessStopped(runs, shared);
  if (IsStopped(runs)) return FitStopped();
  return fit;
}

}  // namespace pendulum
