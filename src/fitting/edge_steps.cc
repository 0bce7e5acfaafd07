// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/edge_steps.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include <Eigen/QR>

#include "pendulum/base/median.h"
#include "pendulum/recording/ticks.h"

namespace pendulum {
namespace {

using Eigen::Index;

/// Successive edges in one direction.
struct Run {
  std::vector<Index> edges;
  double direction = 0;
  double zero = 0;  // unit of the residuals
};

/// Whether rows were missed between edges i - 1 and i of those: it took far longer than before and behind.
bool IsGap(const Eigen::VectorXd& time, const std::vector<Index>& edges, std::size_t i) {
  constexpr double kLonger = 1.6;
  if (i < 2 || i + 1 >= edges.size()) return false;
  const auto interval = [&](std::size_t k) { return time[edges[k]] - time[edges[k - 1]]; };
  return interval(i) > kLonger * std::max(interval(i - 1), interval(i + 1));
}

std::vector<Run> RunsOf(const Recording& recording) {
  constexpr std::size_t kFewest = 3;  // edges that tell a zero of their own
  const Eigen::VectorXd directions = EdgeDirections(recording);
  std::vector<Index> edges;
  for (Index i = 0; i < directions.size(); ++i) {
    if (directions[i] != 0) edges.push_back(i);
  }
  std::vector<Run> runs;
  for (std::size_t k = 0; k < edges.size(); ++k) {
    const double direction = directions[edges[k]];
    const double step = k == 0 ? 0 : recording.value[edges[k]] - recording.value[edges[k - 1]];
    const bool follows = k > 0 && std::round(2 * direction * step / recording.resolution) == 2;
    if (!follows || runs.back().direction != direction || IsGap(recording.time, edges, k))
      runs.push_back({{}, direction, 0});
    runs.back().edges.push_back(edges[k]);
  }
  std::erase_if(runs, [](const Run& run) { return run.edges.size() < kFewest; });
  return runs;
}

RunRegression Regress(const FitResiduals& data, const std::vector<Run>& runs) {
  Index size = 0;
  for (const Run& run : runs) size += static_cast<Index>(run.edges.size());
  Eigen::MatrixXd within(size, data.jacobian.cols());
  Eigen::VectorXd residual(size);
  Index first = 0;
  for (const Run& run : runs) {
    const auto length = static_cast<Index>(run.edges.size());
    const Eigen::MatrixXd rows = data.jacobian(run.edges, Eigen::all);
    within.middleRows(first, length) = rows.rowwise() - rows.colwise().mean();
    const Eigen::VectorXd own = data.residual(run.edges);
    residual.segment(first, length) = own.array() - own.mean();
    first += length;
  }
  const Eigen::VectorXd scale = data.jacobian.colwise().norm().cwiseMax(1e-300);  // the zero's own column vanishes
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(within.rows(), within.cols());
  qr.setThreshold(1e-9);
  qr.compute(within * scale.cwiseInverse().asDiagonal());
  return {qr.solve(residual).cwiseQuotient(scale), residual.norm() / std::sqrt(static_cast<double>(size))};
}

/// Each run's mean of the residuals, once the parameters explain what they can of what differs within runs.
void FindZeros(const FitResiduals& data, std::vector<Run>& runs) {
  const Eigen::VectorXd change = Regress(data, runs).change;
  for (Run& run : runs) {
    run.zero = data.residual(run.edges).mean() - data.jacobian(run.edges, Eigen::all).colwise().mean().dot(change);
  }
}

/// How far zeros of runs upwards stand above those downwards: the median over turning points, most of which lose none.
double LagOf(const std::vector<Run>& runs) {
  std::vector<double> lags;
  for (std::size_t k = 1; k < runs.size(); ++k) {
    const double turn = runs[k].direction - runs[k - 1].direction;
    if (turn != 0) lags.push_back((runs[k].zero - runs[k - 1].zero) / turn);
  }
  return lags.empty() ? 0 : Median(std::move(lags));
}

}  // namespace

RunRegression RegressWithinRuns(const FitResiduals& residuals, const Recording& edges) {
  const std::vector<Run> runs = RunsOf(edges);
  if (runs.empty()) return {Eigen::VectorXd::Zero(residuals.jacobian.cols()), 0};
  return Regress(residuals, runs);
}

std::vector<ZeroStep> FindEdgeSteps(const FitResiduals& residuals, const Recording& edges) {
  constexpr double kWithin = 0.35;   // counts
  constexpr double kStdError = 0.1;  // counts, of what is not within that
  std::vector<Run> runs = RunsOf(edges);
  if (runs.size() < 2) return {};
  FindZeros(residuals, runs);
  const double lag = LagOf(runs);
  std::vector<ZeroStep> steps;
  for (std::size_t k = 1; k < runs.size(); ++k) {
    const double turn = runs[k].direction - runs[k - 1].direction;
    const double counts = (runs[k].zero - runs[k - 1].zero - lag * turn) / edges.resolution;
    const double whole = std::round(counts);
    const bool is_whole = std::abs(counts - whole) < kWithin;
    if (is_whole && whole == 0) continue;
    steps.push_back(
        {runs[k].edges.front(), edges.resolution * (is_whole ? whole : counts), kStdError * edges.resolution});
  }
  return steps;
}

}  // namespace pendulum
