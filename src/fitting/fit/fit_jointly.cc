// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/fit/fit_jointly.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "pendulum/base/try.h"
#include "pendulum/fitting/fit/joint_parabolas.h"
#include "pendulum/fitting/fit/joint_problem.h"
#include "pendulum/fitting/fit/make_fit_report.h"
#include "pendulum/fitting/fit/solve_jointly.h"
#include "pendulum/fitting/residuals/residual_diagnostics.h"
#include "pendulum/fitting/solve/optimum.h"

namespace pendulum {
namespace {

using Eigen::Index;

/// Number of free parameters and parameters at a bound other than 0, plus one σ for each recording.
int CountParameters(const SolvedFit& fit, const Optimum& optimum) {
  auto count = static_cast<int>(optimum.free.size() + fit.runs.size());
  for (const int i : optimum.at_bound) count += fit.solution.parameters[static_cast<std::size_t>(i)] == 0 ? 0 : 1;
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

/// Sets the results of the whole: the statistics of all recordings, and those for the shared parameters, which are the
/// same in each report.
void SetWhole(JointFit& fit) {
  const FitReport& first = fit.runs.front();
  FitReport& whole = fit.whole;
  std::vector<const FitReport*> all;
  all.reserve(fit.runs.size());
  for (const FitReport& run : fit.runs) all.push_back(&run);
  whole.statistics = SumStatistics(all, fit.parameters);
  std::ranges::copy_if(first.parameters, std::back_inserter(whole.parameters),
                       [&](const ParameterEstimate& parameter) { return fit.IsShared(parameter.info.name); });
  for (ParameterEstimate& parameter : whole.parameters) parameter.closed_form.reset();
  const bool have_one_unit =
      std::ranges::all_of(fit.runs, [&](const FitReport& run) { return run.reading_unit == first.reading_unit; });
  whole.reading_unit = have_one_unit ? first.reading_unit : "";
  CopyShared(fit, first.covariance_names, first.covariance, whole.covariance_names, whole.covariance);
  CopyShared(fit, first.systematic_names, first.systematic_covariance, whole.systematic_names,
             whole.systematic_covariance);
  std::vector<Index> rows;
  for (std::size_t i = 0; i < first.parameters.size(); ++i) {
    if (fit.IsShared(first.parameters[i].info.name)) rows.push_back(static_cast<Index>(i));
  }
  whole.budget = first.budget;
  for (BudgetLine& line : whole.budget) line.parts = Eigen::VectorXd(line.parts(rows));
  std::ranges::copy_if(first.profiles, std::back_inserter(whole.profiles),
                       [&](const ProfileCurve& curve) { return fit.IsShared(curve.name); });
  std::ranges::copy_if(first.identifiability, std::back_inserter(whole.identifiability),
                       [&](const Identifiability& known) { return fit.IsShared(known.parameter); });
  // The derived quantities depend on inertia and every friction parameter. They are common to all recordings only if
  // all these parameters are shared.
  if (fit.shared.size() == PhysicalParameters(whole.model).size()) {
    std::ranges::copy_if(first.derived, std::back_inserter(whole.derived),
                         [](const DerivedQuantity& quantity) { return !quantity.is_of_recording; });
  }
  for (DerivedQuantity& quantity : whole.derived) {
    if (quantity.gradient.size() > 0) quantity.gradient = Eigen::VectorXd(quantity.gradient(rows));
  }
  whole.interval_method = first.interval_method;
  whole.std_error_method = first.std_error_method;
  whole.noise = RepresentativeNoise(fit);
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

/// What the separate fits say of the joint fit. If they are posteriors, they replace its solution and optimum.
SeparateFits UseSeparateFits(JointProblem& joint, Solution& solution, Optimum& optimum) {
  SeparateFits separate;
  std::vector<const EffectCheck*> effects;
  for (const JointMember& member : joint.members) {
    separate.alone.push_back(member.alone);
    effects.push_back(&member.alone->effects);
  }
  // Computed first, because posteriors change σ, on which the optimum's information depends.
  separate.systematic = SystematicCovariances(joint.SolvedAt(solution), effects, optimum);
  separate.are_posteriors = HasPosteriors(joint) && UsePosteriors(joint, solution, optimum);
  return separate;
}

bool IsStopped(std::span<const JointRun> runs) {
  return std::ranges::any_of(runs, [](const JointRun& run) { return run.options.stop.stop_requested(); });
}

}  // namespace

Result<JointFit> FitJointly(std::span<const JointRun> runs, const std::vector<std::string>& shared) {
  if (IsStopped(runs)) return FitStopped();
  ASSIGN_OR_RETURN(JointProblem joint, MakeJointProblem(runs, shared));
  Solution solution = SolveJointly(joint);
  std::optional<Optimum> optimum = Linearize(joint.solve, *joint.cost, solution);
  SeparateFits separate;
  if (optimum) separate = UseSeparateFits(joint, solution, *optimum);
  const SolvedFit solved = joint.SolvedAt(solution);
  JointFit fit;
  fit.shared = joint.shared;
  fit.runs = MakeFitReports(solved, optimum ? &*optimum : nullptr, &separate);
  const FitReport& first = fit.runs.front();
  fit.whole.model = first.model;
  fit.whole.termination = first.termination;
  fit.whole.reason = first.reason;
  fit.whole.solver = {solution.iterations, joint.cost->traces(), solution.message, {}};
  if (optimum) {
    fit.parameters = CountParameters(solved, *optimum);
    SetWhole(fit);
  }
  if (IsStopped(runs)) return FitStopped();  // a fit that was stopped is meaningless
  return fit;
}

}  // namespace pendulum
