// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/fit/order_violation.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "pendulum/base/format.h"
#include "pendulum/model/nesting.h"

namespace pendulum {
namespace {

/// Removes the options for parameters that the model does not have.
template <typename Map>
void KeepKnown(const std::vector<ParameterInfo>& infos, Map& map) {
  std::erase_if(map, [&](const auto& entry) {
    return std::ranges::find(infos, entry.first, &ParameterInfo::name) == infos.end();
  });
}

/// The start values of the richer law without the parameters that the simpler law does not have.
StartValues StartOf(const MotionModel& simpler, const FitProblem& problem) {
  StartValues start = problem.start;
  const std::vector<ParameterInfo> kept = PhysicalParameters(simpler);
  const std::vector<ParameterInfo> all = PhysicalParameters(problem.model);
  std::vector<double> parameters;
  std::vector<int> terms;  // of friction
  for (std::size_t i = 0; i < start.parameters.size(); ++i) {
    const bool left_out = i < all.size() && std::ranges::find(kept, all[i].name, &ParameterInfo::name) == kept.end();
    if (left_out) continue;
    parameters.push_back(start.parameters[i]);
    if (i > 0 && i < all.size()) terms.push_back(static_cast<int>(i) - 1);
  }
  start.parameters = std::move(parameters);
  start.energy_balance = {start.energy_balance.normal(terms, terms), start.energy_balance.right(terms), 0};
  start.other_balances.clear();
  return start;
}

/// The parameters of the richer law. Parameters of the simpler law have the values of its fit. The larger parameter of
/// the ordered pair, if the simpler law does not have it, gets the value of the smaller one. All others get their start
/// values.
std::vector<ParameterEstimate> Embed(const FitReport& simpler, const FitProblem& problem, const OrderedPair& order) {
  std::vector<ParameterEstimate> parameters;
  for (std::size_t i = 0; i < problem.infos.size(); ++i) {
    const ParameterInfo& info = problem.infos[i];
    if (const ParameterEstimate* known = simpler.Find(info.name)) {
      parameters.push_back(*known);
      continue;
    }
    const ParameterEstimate* smaller = simpler.Find(problem.infos[static_cast<std::size_t>(order.smaller)].name);
    const bool is_larger = static_cast<int>(i) == order.larger && smaller != nullptr;
    ParameterEstimate parameter = is_larger ? *smaller : ParameterEstimate();
    parameter.info = info;
    parameter.fixed = parameter.at_bound = false;
    parameter.closed_form = std::nullopt;
    if (!is_larger) {
      parameter.unit = info.unit;
      parameter.estimate = problem.Reported(i, problem.first_guess[i]);
    }
    parameters.push_back(std::move(parameter));
  }
  return parameters;
}

}  // namespace

std::string OrderViolation(const FitProblem& problem, const std::vector<double>& parameters) {
  const OrderedPair order = FindOrderedPair(problem.model);
  if (order.larger < 0) return "";
  const auto larger = static_cast<std::size_t>(order.larger);
  const auto smaller = static_cast<std::size_t>(order.smaller);
  if (parameters[larger] >= parameters[smaller]) return "";
  const std::string above(problem.infos[larger].name);
  const std::string below(problem.infos[smaller].name);
  return "the best fit has " + above + " " + NumberText(problem.Reported(larger, parameters[larger]), 4) + ", below " +
         below + " " + NumberText(problem.Reported(smaller, parameters[smaller]), 4) +
         ", which is impossible; with equal values the law reduces to a simpler one, so use a simpler law";
}

Result<FitReport> ReportSimplerLaw(const Recording& recording, const FitOptions& options, const FitProblem& problem,
                                   const std::string& reason) {
  const std::optional<MotionModel> simpler = LargestNestedModel(problem.model);
  if (!simpler) return Error(StatusCode::kInternal, "a law with ordered parameters contains no simpler law");
  FitOptions narrowed = options;
  narrowed.model = simpler->name;
  if (options.search.start_values) narrowed.search.start_values = StartOf(*simpler, problem);
  const std::vector<ParameterInfo> known = FitParameters(*FindMotionModel(narrowed.model), problem.start.start,
                                                         recording.quantity, problem.zero_motion, problem.data.sensor);
  KeepKnown(known, narrowed.fixed);
  KeepKnown(known, narrowed.initial);
  KeepKnown(known, narrowed.bounds);
  KeepKnown(known, narrowed.priors);
  Result<FitReport> report = FitRecording(recording, narrowed);
  if (!report) return report;
  report->parameters = Embed(*report, problem, FindOrderedPair(problem.model));
  report->model = problem.model;
  report->start_values = problem.start;
  if (report->termination == Termination::kFailed) return report;
  report->identifiability.clear();
  Reject(Termination::kNotIdentifiable, reason, "not identifiable: " + reason, *report);
  return report;
}

}  // namespace pendulum
