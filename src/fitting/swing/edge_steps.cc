// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/swing/edge_steps.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

#include <Eigen/QR>

#include "pendulum/base/median.h"
#include "pendulum/recording/encoder_edges.h"

namespace pendulum {
namespace {

using Eigen::Index;

/// Successive edges in one direction.
struct Run {
  std::vector<Index> edges;
  double direction = 0;
  double offset = 0;  // unit of the residuals
};

/// Whether rows are missing between edges i - 1 and i: the interval is far longer than its two neighbours.
bool IsGap(const Eigen::VectorXd& time, const std::vector<Index>& edges, std::size_t i) {
  constexpr double kLonger = 1.6;
  if (i < 2 || i + 1 >= edges.size()) return false;
  const auto interval = [&](std::size_t k) { return time[edges[k]] - time[edges[k - 1]]; };
  return interval(i) > kLonger * std::max(interval(i - 1), interval(i + 1));
}

std::vector<Run> RunsOf(const Recording& recording) {
  constexpr std::size_t kMinEdges = 3;  // edges needed to determine a zero
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
  std::erase_if(runs, [](const Run& run) { return run.edges.size() < kMinEdges; });
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
  const Eigen::VectorXd scale = data.jacobian.colwise().norm().cwiseMax(1e-300);  // the column of the zero is 0
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(within.rows(), within.cols());
  qr.setThreshold(1e-9);
  qr.compute(within * scale.cwiseInverse().asDiagonal());
  return {qr.solve(residual).cwiseQuotient(scale), residual.norm() / std::sqrt(static_cast<double>(size))};
}

/// The mean residual of each run, after the parameters are fitted to the differences within runs.
void FindRunOffsets(const FitResiduals& data, std::vector<Run>& runs) {
  const Eigen::VectorXd change = Regress(data, runs).change;
  for (Run& run : runs) {
    run.offset = data.residual(run.edges).mean() - data.jacobian(run.edges, Eigen::all).colwise().mean().dot(change);
  }
}

/// The step between the zeros of two successive runs, in counts.
struct Step {
  double turn = 0;        // change of direction: 2, -2, or 0 if both runs have the same direction
  double difference = 0;  // between the zeros
  double lag = 0;         // of the encoder
  double whole = 0;       // the difference without the lag, rounded to whole counts

  double Remainder() const { return difference - turn * lag - whole; }
};

/// The lag near each step: half of the difference between the zeros of upward and downward runs, minus the lost counts.
/// If the law does not fit exactly, the modelled motion lags the readings, so the estimated lag changes slowly.
void EstimateLags(std::size_t near, bool by_mean, std::vector<Step>& steps) {
  std::vector<double> lags(steps.size(), 0);
  for (std::size_t k = 0; k < steps.size(); ++k) {
    std::vector<double> around;
    for (std::size_t j = std::max(k, near) - near; j < std::min(k + near + 1, steps.size()); ++j) {
      if (steps[j].turn != 0) around.push_back((steps[j].difference - steps[j].whole) / steps[j].turn);
    }
    if (around.empty()) continue;
    const double sum = std::accumulate(around.begin(), around.end(), 0.0);
    lags[k] = by_mean ? sum / static_cast<double>(around.size()) : Median(std::move(around));
  }
  for (std::size_t k = 0; k < steps.size(); ++k) steps[k].lag = lags[k];
}

/// Finds the whole counts of each step. The first pass estimates lags by medians, because most turning points lose no
/// counts. Later passes use means after the whole counts of the previous pass are subtracted.
std::vector<Step> CountSteps(const std::vector<Run>& runs, double resolution) {
  constexpr std::size_t kNear = 12, kNearer = 4;  // steps to either side
  constexpr int kPasses = 4;
  std::vector<Step> steps;
  for (std::size_t k = 1; k < runs.size(); ++k) {
    steps.push_back({runs[k].direction - runs[k - 1].direction, (runs[k].offset - runs[k - 1].offset) / resolution});
  }
  for (int pass = 0; pass < kPasses; ++pass) {
    EstimateLags(pass == 0 ? kNear : kNearer, pass > 0, steps);
    for (Step& step : steps) step.whole = std::round(step.difference - step.turn * step.lag);
  }
  return steps;
}

}  // namespace

RunRegression RegressWithinRuns(const FitResiduals& residuals, const Recording& edges) {
  const std::vector<Run> runs = RunsOf(edges);
  if (runs.empty()) return {Eigen::VectorXd::Zero(residuals.jacobian.cols()), 0};
  return Regress(residuals, runs);
}

std::vector<OffsetStep> FindEdgeSteps(const FitResiduals& residuals, const Recording& edges) {
  constexpr double kWithin = 0.35;   // counts
  constexpr double kStdError = 0.1;  // counts, for steps that are not within kWithin
  std::vector<Run> runs = RunsOf(edges);
  if (runs.size() < 2) return {};
  FindRunOffsets(residuals, runs);
  const std::vector<Step> counted = CountSteps(runs, edges.resolution);
  std::vector<OffsetStep> steps;
  for (std::size_t k = 0; k < counted.size(); ++k) {
    const Step& step = counted[k];
    const bool is_whole = std::abs(step.Remainder()) < kWithin;
    if (is_whole && step.whole == 0) continue;
    const double counts = is_whole ? step.whole : step.whole + step.Remainder();
    steps.push_back({runs[k + 1].edges.front(), edges.resolution * counts, kStdError * edges.resolution});
  }
  return steps;
}

}  // namespace pendulum
