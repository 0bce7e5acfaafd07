// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/QR>

#include "fitting/residuals/burg.h"
#include "pendulum/fitting/swing/offset_steps.h"

namespace pendulum {

/// Means over bins of neighbouring samples, about a hundred bins per period. M bins.
struct Bins {
  std::vector<Eigen::Index> first;       // M + 1: bin i has samples first[i]..first[i + 1] - 1
  Eigen::VectorXd time, residual, rate;  // M, as in FitResiduals
  Eigen::MatrixXd jacobian;              // M x P
  std::vector<GapFreeSpan> spans;        // of bins, without gaps in time
};

/// Divides the samples into bins, and groups the bins into spans without a gap in time.
inline Bins DivideIntoBins(const FitResiduals& data) {
  constexpr double kPerPeriod = 100;
  constexpr double kGap = 0.25;  // of a period
  const Eigen::Index count = data.time.size();
  const double samples_per_second = static_cast<double>(count - 1) / (data.time[count - 1] - data.time[0]);
  const Eigen::Index width =
      std::max<Eigen::Index>(static_cast<Eigen::Index>(samples_per_second * data.period / kPerPeriod), 1);
  Bins bins;
  for (Eigen::Index i = 0; i < count; ++i) {
    const bool gap = i == 0 || data.time[i] - data.time[i - 1] > kGap * data.period;
    if (!gap && i < bins.first.back() + width) continue;
    if (gap) bins.spans.push_back({static_cast<Eigen::Index>(bins.first.size()), 0});
    ++bins.spans.back().size;
    bins.first.push_back(i);
  }
  bins.first.push_back(count);
  return bins;
}

inline Bins MakeBins(const FitResiduals& data) {
  Bins bins = DivideIntoBins(data);
  const auto size = static_cast<Eigen::Index>(bins.first.size()) - 1;
  for (Eigen::VectorXd* const column : {&bins.time, &bins.residual, &bins.rate}) column->resize(size);
  bins.jacobian.resize(size, data.jacobian.cols());
  for (Eigen::Index i = 0; i < size; ++i) {
    const Eigen::Index begin = bins.first[static_cast<std::size_t>(i)];
    const Eigen::Index length = bins.first[static_cast<std::size_t>(i) + 1] - begin;
    bins.time[i] = data.time.segment(begin, length).mean();
    bins.residual[i] = data.residual.segment(begin, length).mean();
    bins.rate[i] = data.rate.segment(begin, length).mean();
    bins.jacobian.row(i) = data.jacobian.middleRows(begin, length).colwise().mean();
  }
  return bins;
}

inline Eigen::VectorXd StepAt(Eigen::Index bin, Eigen::Index size) {
  Eigen::VectorXd step = Eigen::VectorXd::Zero(size);
  step.tail(size - bin).setOnes();
  return step;
}

inline Eigen::MatrixXd WithColumns(const Eigen::MatrixXd& columns, const Eigen::MatrixXd& more) {
  Eigen::MatrixXd all(columns.rows(), columns.cols() + more.cols());
  all << columns, more;
  return all;
}

/// The result of a regression of residuals on K columns with an autoregression.
struct Regression {
  std::vector<double> autoregression;  // φ_1..φ_p
  Eigen::MatrixXd basis;               // M x K, orthonormal: spans the whitened columns
  Eigen::VectorXd rest;                // M, whitened remaining residuals; 0 in bins where kept_ is 0
  Eigen::VectorXd size, std_error;     // K
  double sigma = 0;                    // of `rest`
  double criterion = 0;                // -2 log L plus the penalty for the order
};

/// Generalized least squares with the residuals' own autocorrelation.
class StepRegression {
 public:
  explicit StepRegression(const FitResiduals& data) : bins_(MakeBins(data)) {
    const auto samples = static_cast<double>(size());
    longest_ = static_cast<int>(std::min({30.0, samples / 20, 10 * std::log10(samples)}));
    kept_ = Eigen::VectorXd::Zero(size());
    for (const GapFreeSpan& span : bins_.spans) {
      for (Eigen::Index i = longest_; i < span.size; ++i) kept_[span.begin + i] = 1;
    }
  }

  Eigen::Index size() const { return bins_.time.size(); }

  /// Whether there are enough samples to distinguish parameters, autocorrelation and a step.
  bool IsEnough() const { return kept_.sum() > 5.0 * static_cast<double>(bins_.jacobian.cols() + 1); }

  const Bins& bins() const { return bins_; }

  Regression Fit(const Eigen::MatrixXd& columns) const {
    Regression regression;
    Eigen::VectorXd left = bins_.residual - columns * columns.colPivHouseholderQr().solve(bins_.residual);
    for (int pass = 0; pass < 2; ++pass) {
      regression.autoregression = FitAutoregression(left);
      Regress(columns, &regression);
      left = bins_.residual - columns * regression.size;
    }
    const double kept = kept_.sum();
    regression.criterion =
        2 * kept * std::log(regression.sigma) + static_cast<double>(regression.autoregression.size()) * std::log(kept);
    return regression;
  }

  /// The regression for residuals that are assumed to have no autocorrelation.
  Regression FitAsWhite(const Eigen::MatrixXd& columns) const {
    Regression regression;
    Regress(columns, &regression);
    regression.criterion = 2 * kept_.sum() * std::log(regression.sigma);
    return regression;
  }

  /// The bin where one additional step explains most of the residuals, for the given autocorrelation; -1: none.
  Eigen::Index BestPlace(const Eigen::MatrixXd& columns, std::vector<double> autoregression) const {
    constexpr Eigen::Index kEdge = 3;           // excluded bins at either end of the recording
    constexpr double kMinDistinctShare = 1e-6;  // share of a step that the columns do not explain
    constexpr double kMargin = 6;               // in -2 log L
    Regression regression;
    regression.autoregression = std::move(autoregression);
    Regress(columns, &regression);
    const std::vector<double> response = StepResponse(regression.autoregression);
    const Eigen::VectorXd product = CorrelateWithResponse(response, regression.rest);
    std::vector<double> squares = response;
    for (double& value : squares) value *= value;
    Eigen::VectorXd norm = CorrelateWithResponse(squares, kept_);
    const Eigen::VectorXd smallest = kMinDistinctShare * norm;
    for (Eigen::Index k = 0; k < regression.basis.cols(); ++k)
      norm -= CorrelateWithResponse(response, regression.basis.col(k)).cwiseAbs2();
    Eigen::Index best = -1;
    double most = 0;
    for (Eigen::Index i = kEdge; i + kEdge <= size(); ++i) {
      if (!(norm[i] > smallest[i]) || !(product[i] * product[i] > most * norm[i])) continue;
      most = product[i] * product[i] / norm[i];
      best = i;
    }
    // Counts are often lost in gaps, together with samples. The first bin after a gap is therefore preferred, unless
    // another bin is clearly better.
    for (const GapFreeSpan& span : bins_.spans) {
      const Eigen::Index i = span.begin;
      const bool holds_best = i >= kEdge && i < best && best < i + span.size;
      if (!holds_best || !(norm[i] > smallest[i])) continue;
      if (most - product[i] * product[i] / norm[i] < kMargin * regression.sigma * regression.sigma) best = i;
    }
    return best;
  }

 private:
  /// The autoregression with the smallest Schwarz criterion, by Burg's method.
  std::vector<double> FitAutoregression(const Eigen::VectorXd& residual) const {
    const std::vector<double> reflection = ReflectionCoefficients(residual, bins_.spans, longest_);
    const double samples = kept_.sum();
    double criterion = 0;
    double least = 0;
    std::size_t best = 0;
    for (std::size_t order = 1; order <= reflection.size(); ++order) {
      criterion += samples * std::log1p(-reflection[order - 1] * reflection[order - 1]) + std::log(samples);
      if (criterion < least) least = criterion, best = order;
    }
    return CoefficientsFromReflection({reflection.begin(), reflection.begin() + static_cast<std::ptrdiff_t>(best)});
  }

  Eigen::MatrixXd Whiten(const Eigen::MatrixXd& columns, const std::vector<double>& autoregression) const {
    Eigen::MatrixXd white = columns;
    for (std::size_t j = 0; j < autoregression.size(); ++j) {
      const auto lag = static_cast<Eigen::Index>(j) + 1;
      white.bottomRows(size() - lag) -= autoregression[j] * columns.topRows(size() - lag);
    }
    return kept_.asDiagonal() * white;
  }

  void Regress(const Eigen::MatrixXd& columns, Regression* regression) const {
    const Eigen::MatrixXd white = Whiten(columns, regression->autoregression);
    const Eigen::VectorXd value = Whiten(bins_.residual, regression->autoregression);
    const Eigen::VectorXd scale = white.colwise().norm().cwiseMax(1e-300);
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(white * scale.cwiseInverse().asDiagonal());
    regression->basis = qr.householderQ() * Eigen::MatrixXd::Identity(size(), qr.rank());
    regression->rest = value - regression->basis * (regression->basis.transpose() * value);
    regression->size = qr.solve(value).cwiseQuotient(scale);
    regression->sigma =
        regression->rest.norm() / std::sqrt(std::max(kept_.sum() - static_cast<double>(qr.rank()), 1.0));
    regression->std_error = regression->sigma * RootVariances(qr).cwiseQuotient(scale);
  }

  /// Standard errors of the coefficients for unit variance; infinite if a column depends on the others.
  static Eigen::VectorXd RootVariances(const Eigen::ColPivHouseholderQR<Eigen::MatrixXd>& qr) {
    const Eigen::Index rank = qr.rank();
    const Eigen::MatrixXd root = qr.matrixR().topLeftCorner(rank, rank).triangularView<Eigen::Upper>();
    const Eigen::MatrixXd inverse = root.triangularView<Eigen::Upper>().solve(Eigen::MatrixXd::Identity(rank, rank));
    Eigen::VectorXd errors = Eigen::VectorXd::Constant(qr.cols(), std::numeric_limits<double>::infinity());
    for (Eigen::Index k = 0; k < rank; ++k) errors[qr.colsPermutation().indices()[k]] = inverse.row(k).norm();
    return errors;
  }

  /// The whitened step of an autoregression: 1, 1 - φ_1, 1 - φ_1 - φ_2, ...
  static std::vector<double> StepResponse(const std::vector<double>& autoregression) {
    std::vector<double> response = {1};
    for (const double phi : autoregression) response.push_back(response.back() - phi);
    return response;
  }

  /// Σ_t response(t - i) value_t for each i. After its end, the response stays at its last value.
  Eigen::VectorXd CorrelateWithResponse(const std::vector<double>& response, const Eigen::VectorXd& value) const {
    Eigen::VectorXd sum(size());
    double after = 0;
    const auto length = static_cast<Eigen::Index>(response.size()) - 1;
    for (Eigen::Index i = size() - 1; i >= 0; --i) {
      if (i + length < size()) after += value[i + length];
      sum[i] = response.back() * after;
      for (Eigen::Index k = 0; k < std::min(length, size() - i); ++k)
        sum[i] += response[static_cast<std::size_t>(k)] * value[i + k];
    }
    return sum;
  }

  Bins bins_;
  int longest_ = 0;       // highest order of an autoregression
  Eigen::VectorXd kept_;  // M: 0 in the first longest_ bins of each span, which have too few predecessors; otherwise 1
};

}  // namespace pendulum
