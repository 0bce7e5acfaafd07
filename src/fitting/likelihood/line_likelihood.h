// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "fitting/likelihood/averaged_counts.h"
#include "fitting/likelihood/depth_table.h"
#include "pendulum/fitting/likelihood/noise.h"

namespace pendulum {

/// Quantized samples under a linear model with parameters w: position + slope · w, in units of the resolution. Equal
/// samples are merged and counted. Means of readings (kAveraged) are all levels, in units of a count.
struct LevelSamples {
  /// n x 1, modelled minus measured; for censored readings, the depth within the interval; for means, the modelled
  /// value from a level.
  Eigen::VectorXd position;
  Eigen::MatrixXd slope;    ///< n x F
  Eigen::VectorXd count;    ///< n x 1
  Eigen::Index levels = 0;  ///< The first `levels` samples are levels; the remaining ones are censored readings.
  std::vector<CountSum> sums = {};  ///< n for means, otherwise empty.

  Eigen::Index size() const { return position.size(); }

  /// The samples that come closer than `depth` to an edge, or leave their interval, for some w with norm up to `reach`.
  /// Sorted, the closest first: this helps branch prediction, and a small sum is detected early.
  LevelSamples Near(double depth, double reach) const;
};

/// Merges N values and readings and an N x F Jacobian. Only consecutive equal samples are merged, as in a hold or at
/// rest.
LevelSamples MergeSamples(const NoiseModel& noise, const Eigen::VectorXd& value, const Eigen::VectorXd& readings,
                          const Eigen::MatrixXd& jacobian);

/// Log-likelihood of such samples at one σ, along lines.
class LineLikelihood {
 public:
  /// σ in units of the resolution.
  void SetSigma(double sigma);

  /// Σ l for positions start + step · direction (n x 1 each). As soon as the sum is certain to be less than `floor`, it
  /// returns some number below `floor`. Adds the number of samples evaluated to `work`.
  double Sum(const LevelSamples& samples, const Eigen::VectorXd& start, const Eigen::VectorXd& direction, double step,
             double floor);

  double work() const { return work_; }

 private:
  double SumOfMeans(const LevelSamples& samples, const Eigen::VectorXd& start, const Eigen::VectorXd& direction,
                    double step, double floor);

  DepthTable level_{1};
  DepthTable censored_{std::numeric_limits<double>::infinity()};
  double sigma_ = 0;
  bool has_censored_table_ = false;
  double work_ = 0;
};

// -----------------------------------------------------------------------------------------------------------------

inline LevelSamples LevelSamples::Near(double depth, double reach) const {
  std::vector<std::pair<double, Eigen::Index>> near;
  LevelSamples selected;
  for (Eigen::Index i = 0; i < size(); ++i) {
    const double here = !sums.empty() ? CountSumMargin(sums[static_cast<std::size_t>(i)], position[i])
                        : i < levels  ? 0.5 - std::abs(position[i])
                                      : position[i];
    const double least = here - reach * slope.row(i).norm();
    if (least >= depth) continue;
    near.emplace_back(least, i);
    if (i < levels) ++selected.levels;
  }
  const auto censored = near.begin() + selected.levels;
  std::sort(near.begin(), censored);
  std::sort(censored, near.end());
  std::vector<Eigen::Index> kept;
  kept.reserve(near.size());
  for (const auto& [least, i] : near) kept.push_back(i);
  selected.position = position(kept);
  selected.slope = slope(kept, Eigen::all);
  selected.count = count(kept);
  for (const Eigen::Index i : kept) {
    if (!sums.empty()) selected.sums.push_back(sums[static_cast<std::size_t>(i)]);
  }
  return selected;
}

/// Representatives of equal samples, and how many samples each represents.
struct Merged {
  std::vector<Eigen::Index> sample;
  std::vector<double> count;
};

inline Merged MergeEqual(const Eigen::VectorXd& value, const Eigen::VectorXd& readings,
                         const Eigen::MatrixXd& jacobian) {
  Merged merged;
  std::size_t run = 0;  // first representative of the run of samples with the same model
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

/// Means of readings, in counts.
inline LevelSamples MergeMeans(const NoiseModel& noise, const Eigen::VectorXd& value, const Eigen::VectorXd& readings,
                               const Eigen::MatrixXd& jacobian) {
  const Merged merged = MergeEqual(value, readings, jacobian);
  const auto n = static_cast<Eigen::Index>(merged.sample.size());
  LevelSamples samples{Eigen::VectorXd(n), Eigen::MatrixXd(n, jacobian.cols()), Eigen::VectorXd(n), n, {}};
  for (Eigen::Index row = 0; row < n; ++row) {
    const auto k = static_cast<std::size_t>(row);
    const Eigen::Index i = merged.sample[k];
    samples.sums.push_back(CountSumOf(noise.ForSample(i), value[i]));
    samples.position[row] = InCounts(noise, readings[i]);
    samples.slope.row(row) = jacobian.row(i) / noise.averaging.count;
    samples.count[row] = merged.count[k];
  }
  return samples;
}

inline LevelSamples MergeSamples(const NoiseModel& noise, const Eigen::VectorXd& value, const Eigen::VectorXd& readings,
                                 const Eigen::MatrixXd& jacobian) {
  if (noise.family == NoiseFamily::kAveraged) return MergeMeans(noise, value, readings, jacobian);
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

inline void LineLikelihood::SetSigma(double sigma) {
  if (sigma == sigma_) return;
  sigma_ = sigma;
  level_.Build(sigma);
  has_censored_table_ = false;
}

inline double LineLikelihood::SumOfMeans(const LevelSamples& samples, const Eigen::VectorXd& start,
                                         const Eigen::VectorXd& direction, double step, double floor) {
  constexpr double kWork = 20;  // evaluations of a level that one of a mean costs
  double sum = 0;
  for (Eigen::Index i = 0; i < samples.levels && sum >= floor; ++i) {
    const CountSum& mean = samples.sums[static_cast<std::size_t>(i)];
    sum += samples.count[i] * CountSumLog(mean, start[i] + step * direction[i], sigma_);
    work_ += kWork;
  }
  return sum;
}

inline double LineLikelihood::Sum(const LevelSamples& samples, const Eigen::VectorXd& start,
                                  const Eigen::VectorXd& direction, double step, double floor) {
  if (!samples.sums.empty()) return SumOfMeans(samples, start, direction, step, floor);
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
