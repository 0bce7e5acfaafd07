// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/swing/offset_steps.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>

#include "fitting/swing/step_regression.h"

namespace pendulum {
namespace {

using Eigen::Index;

/// Powers of time, scaled to -1 to 1, from the first degree on.
Eigen::MatrixXd Drift(const Bins& bins, int degree) {
  const Index size = bins.time.size();
  const Eigen::ArrayXd t = (bins.time.array() - bins.time[0]) / (bins.time[size - 1] - bins.time[0]) * 2 - 1;
  Eigen::MatrixXd drift(size, degree);
  for (int k = 0; k < degree; ++k) drift.col(k) = t.pow(k + 1);
  return drift;
}

/// Alternative explanations of an apparent step at a bin: a drifting zero, a spike, a kink, a touched pendulum, a clock
/// slip.
std::vector<Eigen::MatrixXd> AlternativeExplanations(const Bins& bins, Index bin) {
  const Index size = bins.time.size();
  const Eigen::ArrayXd t = bins.time.array() - bins.time[0];
  std::vector<Eigen::MatrixXd> alternatives = {Drift(bins, 3)};
  Eigen::MatrixXd spike = Eigen::MatrixXd::Zero(size, 2);
  spike(bin, 0) = spike(std::max<Index>(bin - 1, 0), 1) = 1;
  alternatives.push_back(spike);
  for (const Index kink : {bin - 1, bin}) alternatives.emplace_back((t - t[std::max<Index>(kink, 0)]).max(0).matrix());
  Eigen::MatrixXd touched = bins.jacobian.leftCols(bins.jacobian.cols() - 1);
  touched.topRows(bin).setZero();
  alternatives.push_back(touched);
  Eigen::VectorXd slipped = bins.rate;
  slipped.head(bin).setZero();
  alternatives.emplace_back(slipped);
  return alternatives;
}

/// The exact sample of a step that was found at a bin. Searches bins `bin` - 1 and `bin` for the sample at which the
/// residuals change from the mean of bin `bin` - 2 to this mean plus the step.
Index SampleOf(const FitResiduals& data, const Bins& bins, Index bin, double size) {
  const auto first = [&](Index k) {
    return bins.first[static_cast<std::size_t>(std::clamp<Index>(k, 0, bins.time.size()))];
  };
  const Index begin = first(bin - 1), end = first(bin + 1);
  if (end - begin <= 2 || bin < 2) return first(bin);
  const double before = bins.residual[bin - 2];
  double sum = 0;  // of squared residuals, relative to a step at `begin`
  double least = 0;
  Index best = begin;
  for (Index i = begin; i < end; ++i) {
    const double left = data.residual[i] - before;
    sum += left * left - (left - size) * (left - size);
    if (sum < least) least = sum, best = i + 1;
  }
  return best;
}

/// Searches for steps one after the other, with the remaining residuals of fit and steps.
class StepSearch {
 public:
  explicit StepSearch(const StepRegression& regression)
      : regression_(regression), now_(regression.Fit(regression.bins().jacobian)) {}

  std::size_t size() const { return places_.size(); }

  /// -2 log L plus the penalties for autocorrelation and steps.
  double criterion() const { return now_.criterion + kPerStep * static_cast<double>(size()); }

  /// Adds several steps at once if they leave white noise; otherwise returns false. Many steps hide each other: each
  /// alone looks like part of a slow autocorrelation.
  bool AddAll(int max_steps) {
    if (!AddAssumingWhiteNoise(max_steps)) return false;
    RemoveInsignificantSteps();
    RefinePlaces();
    return size() > 0 && now_.autoregression.empty() && ExplainsMoreThanDrift();
  }

  /// Adds the step that explains most of the residuals, if it is significant.
  bool Add() {
    const std::optional<Trial> best = BestTrial();
    if (!best) return false;
    const double gain = now_.criterion - best->regression.criterion;
    if (!(gain > kMinGain)) return false;
    if (!(gain > kMargin + BestAlternativeGain(best->place))) return false;
    places_.push_back(best->place);
    now_ = best->regression;
    RefinePlaces();
    return true;
  }

  std::vector<OffsetStep> Steps(const FitResiduals& data) const {
    std::vector<OffsetStep> steps;
    const Index first = regression_.bins().jacobian.cols();
    for (std::size_t k = 0; k < size(); ++k) {
      const Index column = first + static_cast<Index>(k);
      const Index sample = SampleOf(data, regression_.bins(), places_[k], now_.size[column]);
      steps.push_back({sample, now_.size[column], now_.std_error[column]});
    }
    return steps;
  }

 private:
  static constexpr double kMinGain = 36;  // in -2 log L
  static constexpr double kMargin = 10;   // in -2 log L
  static constexpr double kPerStep = 20;  // in -2 log L

  struct Trial {
    Index place = 0;
    Regression regression;
  };

  Eigen::MatrixXd Columns(const std::vector<Index>& places) const {
    const Index parameters = regression_.bins().jacobian.cols();
    Eigen::MatrixXd columns(regression_.size(), parameters + static_cast<Index>(places.size()));
    columns.leftCols(parameters) = regression_.bins().jacobian;
    for (std::size_t k = 0; k < places.size(); ++k) {
      columns.col(parameters + static_cast<Index>(k)) = StepAt(places[k], regression_.size());
    }
    return columns;
  }

  /// Adds steps one by one, each the one that explains most of the residuals. Returns false if `max_steps` steps are
  /// not enough.
  bool AddAssumingWhiteNoise(int max_steps) {
    Regression white = regression_.FitAsWhite(Columns(places_));
    while (static_cast<int>(size()) < max_steps) {
      const Index place = regression_.BestPlace(Columns(places_), {});
      if (place < 0) return true;
      places_.push_back(place);
      Regression next = regression_.FitAsWhite(Columns(places_));
      if (!(white.criterion - next.criterion > kMinGain)) {
        places_.pop_back();
        return true;
      }
      white = std::move(next);
    }
    return false;
  }

  /// Removes, one by one, steps that are not significant if the other steps are kept.
  void RemoveInsignificantSteps() {
    now_ = regression_.Fit(Columns(places_));
    while (size() > 0) {
      const auto steps = static_cast<Index>(size());
      Index least = 0;
      const Eigen::ArrayXd deviations = (now_.size.tail(steps).array() / now_.std_error.tail(steps).array()).abs();
      if (deviations.minCoeff(&least) > std::sqrt(kMinGain)) return;
      places_.erase(places_.begin() + least);
      now_ = regression_.Fit(Columns(places_));
    }
  }

  /// Whether all steps together explain more than a slowly drifting zero, which small steps imitate.
  bool ExplainsMoreThanDrift() const {
    constexpr int kDegree = 6;
    const Bins& bins = regression_.bins();
    const double drift = regression_.Fit(WithColumns(bins.jacobian, Drift(bins, kDegree))).criterion;
    const double each = std::log(static_cast<double>(regression_.size()));
    return criterion() + kMargin < drift + each * kDegree;
  }

  /// The gain of the best alternative explanation, with Schwarz's penalty relative to that of a step.
  double BestAlternativeGain(Index place) const {
    const Eigen::MatrixXd columns = Columns(places_);
    const double each = std::log(static_cast<double>(regression_.size()));
    double most = 0;
    for (const Eigen::MatrixXd& alternative : AlternativeExplanations(regression_.bins(), place)) {
      const double gain = now_.criterion - regression_.Fit(WithColumns(columns, alternative)).criterion;
      most = std::max(most, gain - each * static_cast<double>(alternative.cols() - 1));
    }
    return most;
  }

  /// The best additional step. Its place is searched twice: for independent residuals and for the present
  /// autocorrelation.
  std::optional<Trial> BestTrial() const {
    const Eigen::MatrixXd columns = Columns(places_);
    std::optional<Trial> best;
    for (const auto& autoregression : {std::vector<double>{}, now_.autoregression}) {
      const Index place = regression_.BestPlace(columns, autoregression);
      if (place < 0) continue;
      Regression with = regression_.Fit(WithColumns(columns, StepAt(place, regression_.size())));
      if (!best || with.criterion < best->regression.criterion) best = {place, std::move(with)};
    }
    return best;
  }

  /// Moves steps one by one to better places, with the other steps unchanged, until no step moves or kMaxPasses passes
  /// are done.
  void RefinePlaces() {
    constexpr int kMaxPasses = 3;
    for (int pass = 0; pass < kMaxPasses; ++pass) {
      std::ranges::sort(places_);
      bool moved = false;
      for (std::size_t k = 0; k < size(); ++k) moved = Move(k) || moved;
      if (!moved) break;
    }
    now_ = regression_.Fit(Columns(places_));
  }

  bool Move(std::size_t k) {
    std::vector<Index> others = places_;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
    const Index place = regression_.BestPlace(Columns(others), now_.autoregression);
    if (place < 0 || place == places_[k]) return false;
    std::vector<Index> moved = places_;
    moved[k] = place;
    Regression with = regression_.Fit(Columns(moved));
    if (!(with.criterion < now_.criterion)) return false;
    places_ = std::move(moved);
    now_ = std::move(with);
    return true;
  }

  const StepRegression& regression_;
  std::vector<Index> places_;  // bins
  Regression now_;
};

}  // namespace

std::vector<OffsetStep> FindOffsetSteps(const FitResiduals& residuals, int max_steps, const std::stop_token& stop) {
  const StepRegression regression(residuals);
  if (!regression.IsEnough()) return {};
  StepSearch search(regression);
  while (static_cast<int>(search.size()) < max_steps && !stop.stop_requested() && search.Add()) {
  }
  constexpr int kMaxAtOnce = 24;
  StepSearch all(regression);
  const bool better = all.AddAll(std::min(max_steps, kMaxAtOnce)) && all.criterion() < search.criterion();
  return (better ? all : search).Steps(residuals);
}

}  // namespace pendulum
