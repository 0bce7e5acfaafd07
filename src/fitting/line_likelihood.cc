// SPDX-License-Identifier: Apache-2.0
#include "line_likelihood.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace pendulum {
namespace {

constexpr double kCertain = 8.5;   // σ within the edge: the probability is 1 to rounding
constexpr double kImprobable = 6;  // σ outside: seldom asked for
constexpr double kCellsPerSigma = 4;

}  // namespace

double DepthTable::Exactly(double depth) const {
  return GaussianInterval(-depth / sigma_, (width_ - depth) / sigma_).log;
}

void DepthTable::Build(double sigma) {
  sigma_ = sigma;
  first_ = -kImprobable * sigma;
  last_ = std::min(0.5 * width_, kCertain * sigma);
  const double length = last_ - first_;
  const auto cells = static_cast<std::size_t>(std::ceil(length / sigma * kCellsPerSigma));
  cells_per_length_ = static_cast<double>(cells) / length;
  cells_.resize(cells + 1);
  const double step = 1 / cells_per_length_;
  double log_before = 0;
  double slope_before = 0;
  for (std::size_t i = 0; i <= cells; ++i) {
    const double depth = first_ + static_cast<double>(i) * step;
    const IntervalProbability p = GaussianInterval(-depth / sigma, (width_ - depth) / sigma);
    const double slope = (p.lower - p.upper) / sigma * step;
    if (i > 0) {
      const double rise = p.log - log_before;
      cells_[i - 1] = {log_before, slope_before, 3 * rise - 2 * slope_before - slope, slope_before + slope - 2 * rise};
    }
    log_before = p.log;
    slope_before = slope;
  }
  cells_[cells] = {log_before, 0, 0, 0};  // where rounding puts a depth just short of the last
  end_ = log_before;
}

LevelSamples LevelSamples::Near(double depth, double reach) const {
  std::vector<std::pair<double, Eigen::Index>> near;
  LevelSamples selected;
  for (Eigen::Index i = 0; i < size(); ++i) {
    const double here = i < levels ? 0.5 - std::abs(position[i]) : position[i];
    const double least = here - reach * slope.row(i).norm();
    if (least >= depth) continue;
    near.emplace_back(least, i);
    if (i < levels) ++selected.levels;
  }
  const auto censored = near.begin() + selected.levels;
  std::sort(near.begin(), censored);
  std::sort(censored, near.end());
  std::vector<Eigen::Index> kept;
  for (const auto& [least, i] : near) kept.push_back(i);
  selected.position = position(kept);
  selected.slope = slope(kept, Eigen::all);
  selected.count = count(kept);
  return selected;
}

namespace {

/// Samples that stand for others, and for how many.
struct Merged {
  std::vector<Eigen::Index> sample;
  std::vector<double> count;
};

Merged MergeEqual(const Eigen::VectorXd& value, const Eigen::VectorXd& readings, const Eigen::MatrixXd& jacobian) {
  Merged merged;
  std::size_t run = 0;  // first of those with the last one's model
  for (Eigen::Index i = 0; i < value.size(); ++i) {
    const bool same = i > 0 && readings[i] == readings[i - 1] && jacobian.row(i) == jacobian.row(i - 1);
    if (!same) run = merged.sample.size();
    std::size_t k = run;
    while (k < merged.sample.size() && value[merged.sample[k]] != value[i]) ++k;
    if (k == merged.sample.size()) {
      merged.sample.push_back(i);
      merged.count.push_back(0);
    }
    ++merged.count[k];
  }
  return merged;
}

}  // namespace

LevelSamples MergeSamples(const NoiseModel& noise, const Eigen::VectorXd& value, const Eigen::VectorXd& readings,
                          const Eigen::MatrixXd& jacobian) {
  const Merged merged = MergeEqual(value, readings, jacobian);
  const auto n = static_cast<Eigen::Index>(merged.sample.size());
  LevelSamples samples{Eigen::VectorXd(n), Eigen::MatrixXd(n, jacobian.cols()), Eigen::VectorXd(n)};
  Eigen::Index row = 0;
  for (const bool censored : {false, true}) {
    for (std::size_t k = 0; k < merged.sample.size(); ++k) {
      const Eigen::Index i = merged.sample[k];
      if (noise.IsCensored(value[i]) != censored) continue;
      const bool low = value[i] <= noise.low;
      const double edge = !censored ? value[i] : low ? noise.low : noise.high;
      const double scale = (censored && low ? -1 : 1) / noise.resolution;
      samples.position[row] = scale * (readings[i] - edge);
      samples.slope.row(row) = scale * jacobian.row(i);
      samples.count[row++] = merged.count[k];
    }
    if (!censored) samples.levels = row;
  }
  return samples;
}

void LineLikelihood::SetSigma(double sigma) {
  if (sigma == sigma_) return;
  sigma_ = sigma;
  level_.Build(sigma);
  has_censored_table_ = false;
}

double LineLikelihood::Sum(const LevelSamples& samples, const Eigen::VectorXd& start, const Eigen::VectorXd& direction,
                           double step, double floor) {
  if (samples.levels < samples.size() && !has_censored_table_) {
    censored_.Build(sigma_);
    has_censored_table_ = true;
  }
  constexpr Eigen::Index kBlock = 128;
  double sum = 0;
  Eigen::Index i = 0;
  while (i < samples.levels && sum >= floor) {
    const Eigen::Index end = std::min(i + kBlock, samples.levels);
    work_ += static_cast<double>(end - i);
    for (; i < end; ++i) sum += samples.count[i] * level_(0.5 - std::abs(start[i] + step * direction[i]));
  }
  if (sum < floor) return sum;
  work_ += static_cast<double>(samples.size() - i);
  for (; i < samples.size(); ++i) sum += samples.count[i] * censored_(start[i] + step * direction[i]);
  return sum;
}

}  // namespace pendulum
