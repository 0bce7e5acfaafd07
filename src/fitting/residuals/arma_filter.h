// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "pendulum/fitting/residuals/autocorrelation.h"

namespace pendulum {

/// Several processes are filtered in parallel lanes: their recursions are independent and fill vector registers.
inline constexpr int kLanes = 8;
using Lanes = std::array<double, kLanes>;

/// A stationary process plus white noise in the state space of A. C. Harvey (Forecasting, structural time series models
/// and the Kalman filter, 1989, section 3.3): a' = T a + R e with T = (φ | shift), reading = a_0 + noise.
struct FilteredProcess {
  std::vector<double> autoregressive;  // φ_1..φ_m, of m states
  std::vector<double> response;        // R, m: 1, θ, 0, ...
  double innovation_variance = 0;      // of e
  Eigen::MatrixXd stationary;          // m x m, covariance of a
  double white_variance = 0;           // of the noise
  double interval = 0;                 // s, of an even clock
  double decay_time = 0;               // s; > 0 for a continuous process, which needs no clock: then m = 1
};

/// Exact Kalman filters of up to kLanes processes of one kind and order in parallel, each over its own readings at the
/// same times. Costs O(m²) per sample until the prediction covariance has converged, then O(m). Call Advance between
/// two samples, and Update at each sample.
class ArmaFilter {
 public:
  explicit ArmaFilter(const std::vector<FilteredProcess>& processes);

  /// Moves to the next sample, `step` seconds later: by one interval, or over a gap in the clock.
  void Advance(double step);

  /// Updates the states by the reading of each lane at the current sample.
  void Update(const Lanes& value);

  /// Prediction error of the last reading, and its variance.
  const Lanes& innovation() const { return innovation_; }
  const Lanes& variance() const { return variance_; }

  /// Whether the variance has converged, so that it stays constant.
  bool is_settled() const { return is_settled_; }

 private:
  void Predict();
  void PredictCovariance();
  void Decay(double step);
  void Skip(double intervals);
  void Jump(double intervals);
  Lanes& covariance(std::size_t i, std::size_t j) { return covariance_[i * (order_ + 1) + j]; }

  std::vector<FilteredProcess> processes_;
  std::size_t order_;  // m; states beyond it are 0
  std::vector<Lanes> autoregression_, response_, state_, gain_, first_;
  std::vector<Lanes> covariance_;  // of the predicted state, its upper triangle
  Lanes white_{}, innovation_{}, variance_{};
  bool is_observed_ = false;  // since the last prediction
  bool is_settled_ = false;
};

// -----------------------------------------------------------------------------------------------------------------

inline ArmaFilter::ArmaFilter(const std::vector<FilteredProcess>& processes)
    : processes_(processes), order_(processes.front().autoregressive.size()) {
  processes_.resize(kLanes, processes.back());
  for (auto* column : {&autoregression_, &response_, &state_, &gain_, &first_}) column->resize(order_ + 1, Lanes{});
  covariance_.resize((order_ + 1) * (order_ + 1), Lanes{});
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    const FilteredProcess& process = processes_[lane];
    white_[lane] = process.white_variance;
    for (std::size_t i = 0; i < order_; ++i) {
      autoregression_[i][lane] = process.autoregressive[i];
      response_[i][lane] = std::sqrt(process.innovation_variance) * process.response[i];
      for (std::size_t j = i; j < order_; ++j) {
        covariance(i, j)[lane] = process.stationary(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
      }
    }
  }
}

inline void ArmaFilter::Update(const Lanes& value) {
  if (!is_settled_) {
    for (int lane = 0; lane < kLanes; ++lane) variance_[lane] = covariance_[0][lane] + white_[lane];
    for (std::size_t i = 0; i < order_; ++i) {
      for (int lane = 0; lane < kLanes; ++lane) gain_[i][lane] = covariance_[i][lane] / variance_[lane];
    }
  }
  for (int lane = 0; lane < kLanes; ++lane) innovation_[lane] = value[lane] - state_[0][lane];
  for (std::size_t i = 0; i < order_; ++i) {
    for (int lane = 0; lane < kLanes; ++lane) state_[i][lane] += gain_[i][lane] * innovation_[lane];
  }
  is_observed_ = true;
}

inline void ArmaFilter::Advance(double step) {
  if (processes_[0].decay_time > 0) return Decay(step);
  const double intervals = step / processes_[0].interval;
  Predict();
  if (intervals > kGapIntervals) Skip(std::round(intervals) - 1);
}

inline void ArmaFilter::Decay(double step) {
  for (int lane = 0; lane < kLanes; ++lane) {
    const double age = step / processes_[lane].decay_time;
    const double kept = std::exp(-age);
    const double known = covariance_[0][lane] * white_[lane] / variance_[lane];
    state_[0][lane] *= kept;
    covariance_[0][lane] = kept * kept * known - std::expm1(-2 * age) * processes_[lane].stationary(0, 0);
  }
}

inline void ArmaFilter::Predict() {
  const Lanes now = state_[0];
  for (std::size_t i = 0; i < order_; ++i) {
    for (int lane = 0; lane < kLanes; ++lane) {
      state_[i][lane] = autoregression_[i][lane] * now[lane] + state_[i + 1][lane];
    }
  }
  if (!is_settled_) PredictCovariance();
  is_observed_ = false;
}

/// Replaces P by T (P - P_0 P_0' / F) T' + R R', and checks whether P has stopped changing.
inline void ArmaFilter::PredictCovariance() {
  constexpr double kSame = 1e-12;  // of the variance
  Lanes kept, known, change{};     // kept: share of P_0 left after a reading; known: 1 / F
  for (int lane = 0; lane < kLanes; ++lane) {
    kept[lane] = is_observed_ ? white_[lane] / variance_[lane] : 1;
    known[lane] = is_observed_ ? 1 / variance_[lane] : 0;
  }
  for (std::size_t i = 0; i < order_; ++i) first_[i] = covariance_[i];
  for (std::size_t i = 0; i < order_; ++i) {
    for (std::size_t j = i; j < order_; ++j) {
      Lanes& here = covariance(i, j);
      const Lanes& next = covariance(i + 1, j + 1);
      const Lanes &a = first_[i + 1], &b = first_[j + 1];
      for (int lane = 0; lane < kLanes; ++lane) {
        const double phi_i = autoregression_[i][lane], phi_j = autoregression_[j][lane];
        const double after = kept[lane] * (phi_i * (phi_j * first_[0][lane] + b[lane]) + phi_j * a[lane]) +
                             (next[lane] - known[lane] * a[lane] * b[lane]) + response_[i][lane] * response_[j][lane];
        const double moved = std::abs(after - here[lane]);
        change[lane] = change[lane] < moved ? moved : change[lane];
        here[lane] = after;
      }
    }
  }
  is_settled_ = is_observed_;
  for (int lane = 0; lane < kLanes; ++lane) is_settled_ = is_settled_ && change[lane] <= kSame * variance_[lane];
}

/// Predicts over samples that are missing.
inline void ArmaFilter::Skip(double intervals) {
  constexpr double kMaxPropagated = 30;
  is_settled_ = false;
  if (intervals > kMaxPropagated) return Jump(intervals);
  for (double i = 0; i < intervals; ++i) Predict();
}

/// T to this power; 0 if it is negligible.
inline Eigen::MatrixXd TransitionPower(const std::vector<double>& autoregression, double power) {
  constexpr double kLongest = 1e12;
  constexpr double kForgotten = 1e-18;
  const auto order = static_cast<Eigen::Index>(autoregression.size());
  Eigen::MatrixXd factor = Eigen::MatrixXd::Zero(order, order);
  factor.col(0) = Eigen::Map<const Eigen::VectorXd>(autoregression.data(), order);
  factor.rightCols(order - 1).topRows(order - 1).setIdentity();
  Eigen::MatrixXd product = Eigen::MatrixXd::Identity(order, order);
  for (auto left = static_cast<long long>(std::min(power, kLongest)); left > 0; left /= 2) {
    if (left % 2 != 0) product = factor * product;
    if (left > 1) factor = factor * factor;
    if (!(factor.cwiseAbs().maxCoeff() > kForgotten)) return Eigen::MatrixXd::Zero(order, order);
  }
  return product;
}

/// Computes P = S + Tⁿ (P - S) T'ⁿ, where S is the stationary covariance.
inline void ArmaFilter::Jump(double intervals) {
  const auto order = static_cast<Eigen::Index>(order_);
  const auto at = [](Eigen::Index i) { return static_cast<std::size_t>(i); };
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    const FilteredProcess& process = processes_[lane];
    const Eigen::MatrixXd power = TransitionPower(process.autoregressive, intervals);
    Eigen::MatrixXd excess = -process.stationary;
    Eigen::VectorXd state(order);
    for (Eigen::Index i = 0; i < order; ++i) {
      state[i] = state_[at(i)][lane];
      for (Eigen::Index j = i; j < order; ++j) excess(j, i) = excess(i, j) += covariance(at(i), at(j))[lane];
    }
    state = power * state;
    const Eigen::MatrixXd after = process.stationary + power * excess * power.transpose();
    for (Eigen::Index i = 0; i < order; ++i) {
      state_[at(i)][lane] = state[i];
      for (Eigen::Index j = i; j < order; ++j) covariance(at(i), at(j))[lane] = after(i, j);
    }
  }
}

}  // namespace pendulum
