// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/solve/solved_fit.h"

#include <algorithm>
#include <functional>
#include <numeric>
#include <utility>

namespace pendulum {

using Eigen::Index;

std::vector<int> OwnIndices(const std::vector<int>& at, const std::vector<int>& of_all) {
  std::vector<int> own;
  for (std::size_t i = 0; i < at.size(); ++i) {
    if (std::ranges::find(of_all, at[i]) != of_all.end()) own.push_back(static_cast<int>(i));
  }
  return own;
}

std::vector<Index> RowsAmong(const std::vector<int>& at, const std::vector<int>& of_all, const std::vector<int>& own) {
  std::vector<Index> rows;
  rows.reserve(own.size());
  for (const int i : own) {
    rows.push_back(std::ranges::find(of_all, at[static_cast<std::size_t>(i)]) - of_all.begin());
  }
  return rows;
}

Optimum OwnOptimum(const std::vector<int>& at, const Optimum& all) {
  Optimum own;
  own.information = all.information(at, at);
  own.gradient = all.gradient(at);
  own.free = OwnIndices(at, all.free);
  own.at_bound = OwnIndices(at, all.at_bound);
  own.inverse.identifiable = all.inverse.identifiable;
  own.inverse.direction = OwnIndices(at, all.inverse.direction);
  if (!all.inverse.identifiable || own.free.empty()) return own;
  const std::vector<Index> rows = RowsAmong(at, all.free, own.free);
  own.inverse.matrix = all.inverse.matrix(rows, rows);
  return own;
}

double SolvedFit::samples() const {
  return std::transform_reduce(runs.begin(), runs.end(), 0.0, std::plus<>(),
                               [](const FittedRun& run) { return run.samples(); });
}

std::string SolvedFit::NameOf(int parameter) const {
  for (std::size_t k = 0; k < runs.size(); ++k) {
    const auto own = std::ranges::find(runs[k].at, parameter);
    if (own == runs[k].at.end()) continue;
    const std::string name(runs[k].problem.infos[static_cast<std::size_t>(own - runs[k].at.begin())].name);
    const bool is_shared = static_cast<std::size_t>(parameter) < shared;
    return is_shared ? name : name + " of recording " + std::to_string(k + 1);
  }
  return "";
}

SolvedFit SolvedFitOf(FittedRun run) {
  run.at.resize(run.problem.infos.size());
  std::iota(run.at.begin(), run.at.end(), 0);
  SolvedFit fit{{}, run.at.size(), run.cost, run.problem.solve, run.cost.priors(), run.solution};
  fit.runs.push_back(std::move(run));
  return fit;
}

}  // namespace pendulum
