// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/likelihood/edge_noise.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/LU>

#include "pendulum/recording/encoder_edges.h"

namespace pendulum {
namespace {

using Eigen::Index;

/// Squared differences of successive residuals. Their expected value is `edges` times the variance of an edge plus
/// `stamps` times the variance of a time stamp.
struct Differences {
  Eigen::ArrayXd square;
  Eigen::ArrayXd edges;   // always 2
  Eigen::ArrayXd stamps;  // sum of the squared rates
};

Differences DifferencesOf(const NoiseModel& noise, const Eigen::Ref<const Eigen::VectorXd>& value,
                          const Eigen::Ref<const Eigen::VectorXd>& readings, const Eigen::VectorXd& rates) {
  std::vector<double> square, stamps;
  for (Index i = 1; i < value.size(); ++i) {
    if (noise.IsInterval(value[i]) || noise.IsInterval(value[i - 1])) continue;
    const double difference = value[i] - readings[i] - value[i - 1] + readings[i - 1];
    square.push_back(difference * difference);
    stamps.push_back(rates[i] * rates[i] + rates[i - 1] * rates[i - 1]);
  }
  const auto count = static_cast<Index>(square.size());
  return {Eigen::Map<const Eigen::ArrayXd>(square.data(), count), Eigen::ArrayXd::Constant(count, 2),
          Eigen::Map<const Eigen::ArrayXd>(stamps.data(), count)};
}

}  // namespace

Recording WithEdges(Recording recording, std::optional<NoiseFamily> noise) {
  const bool wanted = noise.value_or(NoiseFamily::kEdges) == NoiseFamily::kEdges;
  return wanted && !recording.edge && IsEventDriven(recording) ? ConvertToEdges(std::move(recording)) : recording;
}

std::vector<double> ZeroMotionFactors(const Recording& recording, const Eigen::Ref<const Eigen::VectorXd>& times,
                                      ZeroMotion zero) {
  if (zero == ZeroMotion::kNone) return {};
  if (zero == ZeroMotion::kDrifts) return {times.begin(), times.end()};
  const Eigen::VectorXd against = -EdgeDirections(recording);
  return {against.begin(), against.end()};
}

Eigen::VectorXd RatesOf(const Eigen::Ref<const Eigen::VectorXd>& time,
                        const Eigen::Ref<const Eigen::VectorXd>& readings) {
  const Index last = time.size() - 1;
  Eigen::VectorXd rates(time.size());
  // Two nearly equal time stamps do not give a usable rate.
  const double least = 1e-3 * (time[last] - time[0]) / static_cast<double>(last);
  for (Index i = 0; i <= last; ++i) {
    Index from = std::max<Index>(i - 1, 0);
    Index to = std::min(i + 1, last);
    while (time[to] - time[from] < least) {
      from = std::max<Index>(from - 1, 0);
      to = std::min(to + 1, last);
    }
    rates[i] = (readings[to] - readings[from]) / (time[to] - time[from]);
  }
  return rates;
}

/// Fisher scoring of the squared differences. A difference is normal with variance v, so its square has variance 2 v².
double MostLikelyStampRatio(const NoiseModel& noise, const Eigen::Ref<const Eigen::VectorXd>& value,
                            const Eigen::Ref<const Eigen::VectorXd>& readings, const Eigen::VectorXd& rates) {
  constexpr int kSteps = 30;
  constexpr Index kMinEdges = 20;
  constexpr double kMinShare = 1e-4;  // smallest share of the variance left to an edge
  constexpr double kSure = 2;
  const Differences of = DifferencesOf(noise, value, readings, rates);
  if (of.square.size() < kMinEdges || !(of.square.sum() > 0) || !(of.stamps.sum() > 0)) return 0;
  const double all = of.square.mean() / 2;
  Eigen::Vector2d variance(all, 0);  // of an edge, of a stamp
  double error = 0;                  // standard error of the variance of a stamp
  for (int step = 0; step < kSteps; ++step) {
    const Eigen::ArrayXd v = variance[0] * of.edges + variance[1] * of.stamps;
    const Eigen::ArrayXd weight = v.square().inverse();
    Eigen::Matrix2d information;
    information << (weight * of.edges.square()).sum(), (weight * of.edges * of.stamps).sum(),
        (weight * of.edges * of.stamps).sum(), (weight * of.stamps.square()).sum();
    const Eigen::Vector2d target((weight * of.edges * of.square).sum(), (weight * of.stamps * of.square).sum());
    const Eigen::Matrix2d inverse = information.inverse();
    if (!inverse.allFinite()) return 0;
    variance = inverse * target;
    if (variance[1] < 0) variance = {target[0] / information(0, 0), 0};
    variance[0] = std::max(variance[0], kMinShare * all);
    error = std::sqrt(2 * inverse(1, 1));
  }
  return variance[1] > kSure * error ? std::sqrt(variance[1] / variance[0]) : 0;
}

void SetSpread(const Eigen::Ref<const Eigen::VectorXd>& time, const Eigen::Ref<const Eigen::VectorXd>& value,
               const Eigen::Ref<const Eigen::VectorXd>& readings, NoiseModel& noise) {
  const Eigen::VectorXd rates = RatesOf(time, readings);
  noise.stamp_ratio = MostLikelyStampRatio(noise, value, readings, rates);
  noise.spread = nullptr;
  if (noise.stamp_ratio == 0) return;
  const Eigen::ArrayXd spread = (1 + (noise.stamp_ratio * rates.array()).square()).sqrt();
  noise.spread = std::make_shared<const std::vector<double>>(spread.begin(), spread.end());
}

}  // namespace pendulum
