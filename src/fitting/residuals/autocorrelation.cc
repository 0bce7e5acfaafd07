// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/residuals/autocorrelation.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numeric>

#include "pendulum/base/physics.h"

namespace pendulum {

std::string Autocorrelation::Name() const {
  switch (kind) {
    case Kind::kAutoregressive: return "AR(" + std::to_string(autoregressive.size()) + ")";
    case Kind::kMixed: return "ARMA(1,1)";
    case Kind::kContinuous: return white_share > 0 ? "continuous AR(1) + white" : "continuous AR(1)";
    case Kind::kWhite: break;
  }
  return "white";
}

double Autocorrelation::VarianceInflation() const {
  if (kind == Kind::kWhite) return 1;
  if (kind == Kind::kContinuous) {
    return 1 + 2 * (1 - white_share) / std::expm1(interval / decay_time);  // a geometric series
  }
  // The spectrum at frequency 0.
  const double autoregression = std::accumulate(autoregressive.begin(), autoregressive.end(), 0.0);
  return innovation_variance * std::pow((1 + moving_average) / (1 - autoregression), 2);
}

double Autocorrelation::SquaredInflation() const {
  if (kind == Kind::kWhite) return 1;
  if (kind == Kind::kContinuous) {
    return 1 + 2 * std::pow(1 - white_share, 2) / std::expm1(2 * interval / decay_time);
  }
  // The mean square of the spectrum (Parseval), by the midpoint rule over half a turn.
  constexpr int kFrequencies = 1 << 13;
  double sum = 0;
  for (int i = 0; i < kFrequencies; ++i) {
    const std::complex<double> back = std::polar(1.0, -kPi * (i + 0.5) / kFrequencies);
    std::complex<double> autoregression = 0;
    for (std::size_t j = autoregressive.size(); j-- > 0;) autoregression = back * (autoregression + autoregressive[j]);
    sum += std::pow(innovation_variance * std::norm(1.0 + moving_average * back) / std::norm(1.0 - autoregression), 2);
  }
  return sum / kFrequencies;
}

namespace {

/// Computes Σ_k g_k g_k' of the responses g_k = w_k + θ w_{k+1} + Σ φ_j g_{k+j}, from the last sample backwards. g_k is
/// the derivative of W'z with respect to the innovation e_k, so this is the transpose of the process's filter. R is
/// never formed, and the sum is positive semidefinite. In gaps, rounded to whole intervals, the weights are 0.
class BackwardFilter {
 public:
  BackwardFilter(const Autocorrelation& correlation, Eigen::Index columns)
      : order_(static_cast<Eigen::Index>(correlation.autoregressive.size())),
        moving_average_(correlation.moving_average),
        head_(kBlock),
        autoregression_(Eigen::Map<const Eigen::VectorXd>(correlation.autoregressive.data(), order_)),
        response_(Eigen::MatrixXd::Zero(columns, kBlock + order_)),
        later_(Eigen::VectorXd::Zero(columns)),
        sum_(Eigen::MatrixXd::Zero(columns, columns)) {}

  void Step(const Eigen::VectorXd& weight) {
    if (head_ == 0) Flush();
    --head_;
    response_.col(head_).noalias() = weight + moving_average_ * later_;
    response_.col(head_).noalias() += response_.middleCols(head_ + 1, order_) * autoregression_;
    later_ = weight;
  }

  /// Processes `count` missing samples, or fewer if the filter's response decays to rounding error earlier.
  void Skip(double count) {
    const Eigen::VectorXd nothing = Eigen::VectorXd::Zero(later_.size());
    while (count > 0) {
      const double steps = std::min(count, static_cast<double>(kBlock));
      for (double i = 0; i < steps; ++i) Step(nothing);
      count -= steps;
      if (HasDecayed()) break;
    }
    if (count > 0) response_.setZero();
  }

  /// The sum over all innovations so far.
  Eigen::MatrixXd Sum() {
    Flush();
    return sum_;
  }

 private:
  static constexpr Eigen::Index kBlock = 256;

  /// Adds the completed responses and moves those still needed to the end of the buffer.
  void Flush() {
    const auto complete = response_.middleCols(head_, kBlock - head_);
    sum_.noalias() += complete * complete.transpose();
    const Eigen::MatrixXd needed = response_.middleCols(head_, order_);
    response_.rightCols(order_) = needed;
    head_ = kBlock;
  }

  bool HasDecayed() {
    constexpr double kNegligible = 1e-24;
    Flush();
    const Eigen::VectorXd left = response_.rightCols(order_).rowwise().squaredNorm();
    return (left.array() <= kNegligible * sum_.diagonal().array()).all();
  }

  Eigen::Index order_;
  double moving_average_;
  Eigen::Index head_;               // column of the newest response; older ones follow
  Eigen::VectorXd autoregression_;  // φ
  Eigen::MatrixXd response_;        // K x (kBlock + p)
  Eigen::VectorXd later_;           // w_{k+1}
  Eigen::MatrixXd sum_;
};

Eigen::MatrixXd EvenSum(const Autocorrelation& correlation, const Eigen::VectorXd& time,
                        const Eigen::MatrixXd& weights) {
  constexpr double kLongest = 1e7;  // innovations before the first sample, for a process that never decays
  BackwardFilter filter(correlation, weights.cols());
  for (Eigen::Index k = time.size() - 1; k >= 0; --k) {
    filter.Step(weights.row(k).transpose());
    const double steps = k > 0 ? (time[k] - time[k - 1]) / correlation.interval : kLongest;
    if (steps > kGapIntervals) filter.Skip(std::min(std::round(steps) - 1, kLongest));
  }
  return correlation.innovation_variance * filter.Sum();
}

/// z_k = q_k z_{k-1} + sqrt(1 - q_k²) e_k with q_k = exp(-Δt_k / τ), plus white noise.
Eigen::MatrixXd ContinuousSum(const Autocorrelation& correlation, const Eigen::VectorXd& time,
                              const Eigen::MatrixXd& weights) {
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(weights.cols(), weights.cols());
  Eigen::VectorXd response = Eigen::VectorXd::Zero(weights.cols());
  for (Eigen::Index k = time.size() - 1; k >= 0; --k) {
    response += weights.row(k).transpose();
    const double step = k > 0 ? (time[k] - time[k - 1]) / correlation.decay_time : INFINITY;
    sum.noalias() -= std::expm1(-2 * step) * response * response.transpose();
    response *= std::exp(-step);
  }
  return (1 - correlation.white_share) * sum + correlation.white_share * weights.transpose() * weights;
}

}  // namespace

Eigen::MatrixXd CorrelatedSum(const Autocorrelation& correlation, const Eigen::VectorXd& time,
                              const Eigen::MatrixXd& weights) {
  if (weights.cols() == 0) return {};
  switch (correlation.kind) {
    case Autocorrelation::Kind::kAutoregressive:
    case Autocorrelation::Kind::kMixed: return EvenSum(correlation, time, weights);
    case Autocorrelation::Kind::kContinuous: return ContinuousSum(correlation, time, weights);
    case Autocorrelation::Kind::kWhite: break;
  }
  return weights.transpose() * weights;
}

}  // namespace pendulum
