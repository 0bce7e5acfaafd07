// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/zero_steps.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>

#include <Eigen/QR>

#include "burg.h"

namespace pendulum {
namespace {

using Eigen::Index;

/// Means over bins of neighbouring samples, about a hundred in a period. For M bins.
struct Bins {
  std::vector<Index> first;              // M + 1: bin i has samples first[i]..first[i + 1] - 1
  Eigen::VectorXd time, residual, rate;  // M, as in FitResiduals
  Eigen::MatrixXd jacobian;              // M x P
  std::vector<Stretch> stretches;        // of bins, without gaps in time
};

/// Where bins begin, and which of them follow each other without a gap in time.
Bins DivideIntoBins(const FitResiduals& data) {
  constexpr double kPerPeriod = 100;
  constexpr double kGap = 0.25;  // of a period
  const Index count = data.time.size();
  const double samples_per_second = static_cast<double>(count - 1) / (data.time[count - 1] - data.time[0]);
  const Index width = std::max<Index>(static_cast<Index>(samples_per_second * data.period / kPerPeriod), 1);
  Bins bins;
  for (Index i = 0; i < count; ++i) {
    const bool gap = i == 0 || data.time[i] - data.time[i - 1] > kGap * data.period;
    if (!gap && i < bins.first.back() + width) continue;
    if (gap) bins.stretches.push_back({static_cast<Index>(bins.first.size()), 0});
    ++bins.stretches.back().size;
    bins.first.push_back(i);
  }
  bins.first.push_back(count);
  return bins;
}

Bins MakeBins(const FitResiduals& data) {
  Bins bins = DivideIntoBins(data);
  const auto size = static_cast<Index>(bins.first.size()) - 1;
  for (Eigen::VectorXd* const column : {&bins.time, &bins.residual, &bins.rate}) column->resize(size);
  bins.jacobian.resize(size, data.jacobian.cols());
  for (Index i = 0; i < size; ++i) {
    const Index begin = bins.first[static_cast<std::size_t>(i)];
    const Index length = bins.first[static_cast<std::size_t>(i) + 1] - begin;
    bins.time[i] = data.time.segment(begin, length).mean();
    bins.residual[i] = data.residual.segment(begin, length).mean();
    bins.rate[i] = data.rate.segment(begin, length).mean();
    bins.jacobian.row(i) = data.jacobian.middleRows(begin, length).colwise().mean();
  }
  return bins;
}

Eigen::VectorXd StepAt(Index bin, Index size) {
  Eigen::VectorXd step = Eigen::VectorXd::Zero(size);
  step.tail(size - bin).setOnes();
  return step;
}

Eigen::MatrixXd WithColumns(const Eigen::MatrixXd& columns, const Eigen::MatrixXd& more) {
  Eigen::MatrixXd all(columns.rows(), columns.cols() + more.cols());
  all << columns, more;
  return all;
}

/// Residuals explained by K columns and an autoregression.
struct Explained {
  std::vector<double> memory;       // φ_1..φ_p
  Eigen::MatrixXd basis;            // M x K, orthonormal: spans the whitened columns
  Eigen::VectorXd rest;             // M, whitened, what these leave; 0 where a stretch begins
  Eigen::VectorXd size, std_error;  // K
  double sigma = 0;                 // of `rest`
  double criterion = 0;             // -2 log L and what the order costs
};

/// Generalised least squares with the residuals' own memory.
class Search {
 public:
  explicit Search(const FitResiduals& data) : bins_(MakeBins(data)) {
    const auto samples = static_cast<double>(size());
    longest_ = static_cast<int>(std::min({30.0, samples / 20, 10 * std::log10(samples)}));
    kept_ = Eigen::VectorXd::Zero(size());
    for (const Stretch& stretch : bins_.stretches) {
      for (Index i = longest_; i < stretch.size; ++i) kept_[stretch.begin + i] = 1;
    }
  }

  Index size() const { return bins_.time.size(); }

  /// Whether there are samples to tell parameters, memory and a step from.
  bool IsEnough() const { return kept_.sum() > 5.0 * static_cast<double>(bins_.jacobian.cols() + 1); }

  const Bins& bins() const { return bins_; }

  Explained Explain(const Eigen::MatrixXd& columns) const {
    Explained explained;
    Eigen::VectorXd left = bins_.residual - columns * columns.colPivHouseholderQr().solve(bins_.residual);
    for (int pass = 0; pass < 2; ++pass) {
      explained.memory = BestMemory(left);
      Regress(columns, &explained);
      left = bins_.residual - columns * explained.size;
    }
    const double kept = kept_.sum();
    explained.criterion =
        2 * kept * std::log(explained.sigma) + static_cast<double>(explained.memory.size()) * std::log(kept);
    return explained;
  }

  /// The bin where one step more explains most, with that memory; -1: none.
  Index BestPlace(const Eigen::MatrixXd& columns, std::vector<double> memory) const {
    constexpr Index kEdge = 3;           // bins on either side
    constexpr double kToldApart = 1e-6;  // of a step, beside the columns
    Explained explained;
    explained.memory = std::move(memory);
    Regress(columns, &explained);
    const std::vector<double> rise = Rise(explained.memory);
    const Eigen::VectorXd product = Along(rise, explained.rest);
    std::vector<double> squares = rise;
    for (double& value : squares) value *= value;
    Eigen::VectorXd norm = Along(squares, kept_);
    const Eigen::VectorXd smallest = kToldApart * norm;
    for (Index k = 0; k < explained.basis.cols(); ++k) norm -= Along(rise, explained.basis.col(k)).cwiseAbs2();
    Index best = -1;
    double most = 0;
    for (const Stretch& stretch : bins_.stretches) {
      for (Index i = stretch.begin + kEdge; i + kEdge <= stretch.begin + stretch.size; ++i) {
        if (!(norm[i] > smallest[i]) || !(product[i] * product[i] > most * norm[i])) continue;
        most = product[i] * product[i] / norm[i];
        best = i;
      }
    }
    return best;
  }

 private:
  /// The order of least Schwarz criterion, by Burg's method.
  std::vector<double> BestMemory(const Eigen::VectorXd& residual) const {
    const std::vector<double> reflection = ReflectionCoefficients(residual, bins_.stretches, longest_);
    const double samples = kept_.sum();
    double criterion = 0;
    double least = 0;
    std::size_t best = 0;
    for (std::size_t order = 1; order <= reflection.size(); ++order) {
      criterion += samples * std::log1p(-reflection[order - 1] * reflection[order - 1]) + std::log(samples);
      if (criterion < least) least = criterion, best = order;
    }
    return FromReflection({reflection.begin(), reflection.begin() + static_cast<std::ptrdiff_t>(best)});
  }

  Eigen::MatrixXd Whiten(const Eigen::MatrixXd& columns, const std::vector<double>& memory) const {
    Eigen::MatrixXd white = columns;
    for (std::size_t j = 0; j < memory.size(); ++j) {
      const auto lag = static_cast<Index>(j) + 1;
      white.bottomRows(size() - lag) -= memory[j] * columns.topRows(size() - lag);
    }
    return kept_.asDiagonal() * white;
  }

  void Regress(const Eigen::MatrixXd& columns, Explained* explained) const {
    const Eigen::MatrixXd white = Whiten(columns, explained->memory);
    const Eigen::VectorXd value = Whiten(bins_.residual, explained->memory);
    const Eigen::VectorXd scale = white.colwise().norm().cwiseMax(1e-300);
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(white * scale.cwiseInverse().asDiagonal());
    explained->basis = qr.householderQ() * Eigen::MatrixXd::Identity(size(), qr.rank());
    explained->rest = value - explained->basis * (explained->basis.transpose() * value);
    explained->size = qr.solve(value).cwiseQuotient(scale);
    explained->sigma = explained->rest.norm() / std::sqrt(std::max(kept_.sum() - static_cast<double>(qr.rank()), 1.0));
    explained->std_error = explained->sigma * RootVariances(qr).cwiseQuotient(scale);
  }

  /// Standard errors of the coefficients at unit variance; infinite where a column tells nothing beside the others.
  static Eigen::VectorXd RootVariances(const Eigen::ColPivHouseholderQR<Eigen::MatrixXd>& qr) {
    const Index rank = qr.rank();
    const Eigen::MatrixXd root = qr.matrixR().topLeftCorner(rank, rank).triangularView<Eigen::Upper>();
    const Eigen::MatrixXd inverse = root.triangularView<Eigen::Upper>().solve(Eigen::MatrixXd::Identity(rank, rank));
    Eigen::VectorXd errors = Eigen::VectorXd::Constant(qr.cols(), std::numeric_limits<double>::infinity());
    for (Index k = 0; k < rank; ++k) errors[qr.colsPermutation().indices()[k]] = inverse.row(k).norm();
    return errors;
  }

  /// What the memory makes of a step: 1, 1 - φ_1, 1 - φ_1 - φ_2, ...
  static std::vector<double> Rise(const std::vector<double>& memory) {
    std::vector<double> rise = {1};
    for (const double phi : memory) rise.push_back(rise.back() - phi);
    return rise;
  }

  /// Σ_t rise(t - i) value_t for each i, the rise staying as it ends.
  Eigen::VectorXd Along(const std::vector<double>& rise, const Eigen::VectorXd& value) const {
    Eigen::VectorXd sum(size());
    double after = 0;
    const auto length = static_cast<Index>(rise.size()) - 1;
    for (Index i = size() - 1; i >= 0; --i) {
      if (i + length < size()) after += value[i + length];
      sum[i] = rise.back() * after;
      for (Index k = 0; k < std::min(length, size() - i); ++k)
        sum[i] += rise[static_cast<std::size_t>(k)] * value[i + k];
    }
    return sum;
  }

  Bins bins_;
  int longest_ = 0;
  Eigen::VectorXd kept_;  // M: 1, or 0 where a stretch begins
};

/// Other explanations of what looks like a step at a bin: a zero that drifts, a spike, a kink, a pendulum that was
/// touched then, a clock that slipped.
std::vector<Eigen::MatrixXd> Rivals(const Bins& bins, Index bin) {
  const Index size = bins.time.size();
  const Eigen::ArrayXd t = (bins.time.array() - bins.time[0]) / (bins.time[size - 1] - bins.time[0]) * 2 - 1;
  std::vector<Eigen::MatrixXd> rivals;
  Eigen::MatrixXd drift(size, 3);
  drift << t, t.square(), t.cube();
  rivals.push_back(drift);
  Eigen::MatrixXd spike = Eigen::MatrixXd::Zero(size, 2);
  spike(bin, 0) = spike(std::max<Index>(bin - 1, 0), 1) = 1;
  rivals.push_back(spike);
  for (const Index kink : {bin - 1, bin}) rivals.emplace_back((t - t[std::max<Index>(kink, 0)]).max(0).matrix());
  Eigen::MatrixXd touched = bins.jacobian.leftCols(bins.jacobian.cols() - 1);
  touched.topRows(bin).setZero();
  rivals.push_back(touched);
  Eigen::VectorXd slipped = bins.rate;
  slipped.head(bin).setZero();
  rivals.emplace_back(slipped);
  return rivals;
}

/// Steps found one after the other, and what they and the fit's parameters leave.
class Pursuit {
 public:
  explicit Pursuit(const Search& search) : search_(search), now_(search.Explain(search.bins().jacobian)) {}

  std::size_t size() const { return places_.size(); }

  /// Adds the step that explains most, if it is one.
  bool Add() {
    constexpr double kSure = 36;     // in -2 log L
    constexpr double kClearly = 10;  // likewise
    const std::optional<Trial> best = BestTrial();
    if (!best) return false;
    const double gain = now_.criterion - best->explained.criterion;
    if (!(gain > kSure)) return false;
    if (!(gain > kClearly + BestRival(best->place))) return false;
    places_.push_back(best->place);
    now_ = best->explained;
    Settle();
    return true;
  }

  std::vector<ZeroStep> Steps() const {
    std::vector<ZeroStep> steps;
    const Index first = search_.bins().jacobian.cols();
    for (std::size_t k = 0; k < size(); ++k) {
      const Index column = first + static_cast<Index>(k);
      steps.push_back(
          {search_.bins().first[static_cast<std::size_t>(places_[k])], now_.size[column], now_.std_error[column]});
    }
    return steps;
  }

 private:
  struct Trial {
    Index place = 0;
    Explained explained;
  };

  Eigen::MatrixXd Columns(const std::vector<Index>& places) const {
    const Index parameters = search_.bins().jacobian.cols();
    Eigen::MatrixXd columns(search_.size(), parameters + static_cast<Index>(places.size()));
    columns.leftCols(parameters) = search_.bins().jacobian;
    for (std::size_t k = 0; k < places.size(); ++k) {
      columns.col(parameters + static_cast<Index>(k)) = StepAt(places[k], search_.size());
    }
    return columns;
  }

  /// What the best of the other explanations gains, by Schwarz's criterion beside a step's.
  double BestRival(Index place) const {
    const Eigen::MatrixXd columns = Columns(places_);
    const double each = std::log(static_cast<double>(search_.size()));
    double most = 0;
    for (const Eigen::MatrixXd& rival : Rivals(search_.bins(), place)) {
      const double gain = now_.criterion - search_.Explain(WithColumns(columns, rival)).criterion;
      most = std::max(most, gain - each * static_cast<double>(rival.cols() - 1));
    }
    return most;
  }

  /// One step more, at the best place for independent residuals or for those with the memory that is left now.
  std::optional<Trial> BestTrial() const {
    const Eigen::MatrixXd columns = Columns(places_);
    std::optional<Trial> best;
    for (const auto& memory : {std::vector<double>{}, now_.memory}) {
      const Index place = search_.BestPlace(columns, memory);
      if (place < 0) continue;
      Explained with = search_.Explain(WithColumns(columns, StepAt(place, search_.size())));
      if (!best || with.criterion < best->explained.criterion) best = {place, std::move(with)};
    }
    return best;
  }

  /// Moves the newest step and its neighbours where they explain most beside the others.
  void Settle() {
    constexpr int kMostPasses = 3;
    for (int pass = 0; pass < kMostPasses; ++pass) {
      std::ranges::sort(places_);
      bool moved = false;
      for (std::size_t k = 0; k < size(); ++k) moved = Move(k) || moved;
      if (!moved) break;
    }
    now_ = search_.Explain(Columns(places_));
  }

  bool Move(std::size_t k) {
    std::vector<Index> others = places_;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
    const Index place = search_.BestPlace(Columns(others), now_.memory);
    if (place < 0 || place == places_[k]) return false;
    std::vector<Index> moved = places_;
    moved[k] = place;
    Explained with = search_.Explain(Columns(moved));
    if (!(with.criterion < now_.criterion)) return false;
    places_ = std::move(moved);
    now_ = std::move(with);
    return true;
  }

  const Search& search_;
  std::vector<Index> places_;  // bins
  Explained now_;
};

}  // namespace

std::vector<ZeroStep> FindZeroSteps(const FitResiduals& residuals, int most, const std::stop_token& stop) {
  const Search search(residuals);
  if (!search.IsEnough()) return {};
  Pursuit pursuit(search);
  while (static_cast<int>(pursuit.size()) < most && !stop.stop_requested() && pursuit.Add()) {
  }
  return pursuit.Steps();
}

}  // namespace pendulum
