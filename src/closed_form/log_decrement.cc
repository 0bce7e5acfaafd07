// SPDX-License-Identifier: Apache-2.0
#include "pendulum/closed_form/log_decrement.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "pendulum/base/physics.h"
#include "pendulum/closed_form/locate_turning_points.h"
#include "pendulum/closed_form/period.h"

namespace pendulum {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kFormulas = 7;  // the number of formulas in LogDecrement, in its order

/// The n periods to which the formulas are applied.
struct PeriodSpan {
  const TurningPointTable& table;
  Gravity gravity;
  std::size_t first;
  int periods;

  std::size_t last() const { return first + 2 * static_cast<std::size_t>(periods); }
  const TurningPoint& from() const { return table.points[first]; }
  const TurningPoint& to() const { return table.points[last()]; }
};

/// Inputs of the formulas: two times [s], two readings relative to the zero, and the mean period ratio: the period of
/// each half swing divided by the period of a small swing, averaged over the half swings.
using Inputs = Eigen::Matrix<double, 5, 1>;
using Outputs = Eigen::Matrix<double, kFormulas, 1>;

Outputs Formulas(const Inputs& inputs, int periods) {
  const double damped = 2 * kPi * periods / (inputs[1] - inputs[0]);
  const double decrement = std::log(inputs[2] / inputs[3]) / periods;
  const double ratio = decrement / std::sqrt(4 * kPi * kPi + decrement * decrement);
  const double natural = damped / std::sqrt(1 - ratio * ratio);
  const double inertia = 1 / (natural * natural);
  Outputs outputs;
  outputs << damped, decrement, ratio, natural, inertia, 2 * ratio / natural, inertia / (inputs[4] * inputs[4]);
  return outputs;
}

/// The mean period ratio and its derivatives (M) with respect to the values of the turning points.
double MeanPeriodRatio(const PeriodSpan& span, VectorXd& gradient) {
  gradient = VectorXd::Zero(static_cast<Index>(span.table.points.size()));
  if (span.gravity.is_linear()) return 1;
  constexpr double kStep = 1e-4;  // of the amplitude
  const double share = 1 / (2.0 * span.periods);
  const double frequency = kPi / span.table.half_period;
  const auto ratio_at = [&](double amplitude) {
    return span.gravity.PeriodRatio(AngleAmplitude(span.table.quantity, amplitude, frequency, span.gravity));
  };
  double sum = 0;
  for (std::size_t i = span.first; i < span.last(); ++i) {
    const double amplitude = 0.5 * (span.table.Amplitude(i) + span.table.Amplitude(i + 1));
    sum += share * ratio_at(amplitude);
    const double step = kStep * amplitude;
    const double slope = (ratio_at(amplitude + step) - ratio_at(amplitude - step)) / (2 * step);
    for (const std::size_t k : {i, i + 1}) {
      gradient[static_cast<Index>(k)] += 0.5 * share * slope * span.table.Side(k);
    }
  }
  return sum;
}

/// Derivatives (kFormulas x 2 M) with respect to the turning points. The zero also depends on their values.
MatrixXd Gradient(const PeriodSpan& span, const Inputs& inputs, const VectorXd& ratio_gradient) {
  constexpr double kStep = 1e-6;
  Eigen::Matrix<double, kFormulas, 5> slopes;
  for (Index k = 0; k < 5; ++k) {
    const double step = kStep * (k < 2 ? inputs[1] - inputs[0] : inputs[k]);
    const Inputs change = step * Inputs::Unit(k);
    slopes.col(k) = (Formulas(inputs + change, span.periods) - Formulas(inputs - change, span.periods)) / (2 * step);
  }
  const Index count = ratio_gradient.size();
  MatrixXd by_value = slopes.col(4) * ratio_gradient.transpose();
  by_value -= (slopes.col(2) + slopes.col(3)) * span.table.ZeroWeights().transpose();
  by_value.col(static_cast<Index>(span.first)) += slopes.col(2);
  by_value.col(static_cast<Index>(span.last())) += slopes.col(3);
  MatrixXd gradient = MatrixXd::Zero(kFormulas, 2 * count);
  gradient.col(2 * static_cast<Index>(span.first)) = slopes.col(0);
  gradient.col(2 * static_cast<Index>(span.last())) = slopes.col(1);
  for (Index i = 0; i < count; ++i) gradient.col(2 * i + 1) = by_value.col(i);
  return gradient;
}

/// Whether the turning points `first` and n periods later belong to one run and lie on the same side of the zero.
bool Reaches(const TurningPointTable& table, std::size_t first, int periods) {
  const std::size_t last = first + 2 * static_cast<std::size_t>(periods);
  if (periods < 1 || last >= table.points.size()) return false;
  for (std::size_t i = first + 1; i <= last; ++i) {
    if (!table.points[i].continues) return false;
  }
  return table.Side(first) == table.Side(last);
}

/// ζ of two turning points n periods apart and its error, without the other formulas. zero_weights are the table's.
std::optional<Estimate> DampingRatio(const TurningPointTable& table, const VectorXd& zero_weights, std::size_t first,
                                     int periods) {
  if (!Reaches(table, first, periods)) return std::nullopt;
  const std::size_t last = first + 2 * static_cast<std::size_t>(periods);
  const double before = table.Amplitude(first);
  const double after = table.Amplitude(last);
  const double decrement = std::log(before / after) / periods;
  const double square = 4 * kPi * kPi + decrement * decrement;
  // The amplitudes are relative to the zero, which depends on all values, including these two.
  const double by_zero = table.Side(first) * (1 / after - 1 / before);
  double variance = std::pow(by_zero * table.zero.std_error, 2);
  for (const auto& [point, slope] : {std::pair(first, 1 / before), std::pair(last, -1 / after)}) {
    const double own = table.Side(first) * slope;
    const double through_zero = by_zero * zero_weights[static_cast<Index>(point)];
    variance += own * (own + 2 * through_zero) * table.points[point].covariance(1, 1);
  }
  const double slope = 4 * kPi * kPi / (square * std::sqrt(square));
  return Estimate{decrement / std::sqrt(square), slope * std::sqrt(variance) / periods};
}

}  // namespace

std::optional<LogDecrement> ApplyLogDecrement(const TurningPointTable& table, Gravity gravity, std::size_t first,
                                              int periods) {
  if (!Reaches(table, first, periods)) return std::nullopt;
  const PeriodSpan span{table, gravity, first, periods};
  VectorXd ratio_gradient;
  const double ratio = MeanPeriodRatio(span, ratio_gradient);
  const double zero = table.zero.value;
  Inputs inputs;
  inputs << span.from().time, span.to().time, span.from().value - zero, span.to().value - zero, ratio;
  const Outputs value = Formulas(inputs, periods);
  const MatrixXd gradient = Gradient(span, inputs, ratio_gradient);
  const VectorXd error = CovarianceOf(table, gradient).diagonal().cwiseSqrt();
  if (!value.allFinite() || !error.allFinite()) return std::nullopt;
  const auto estimate = [&](Index k) { return Estimate{value[k], error[k]}; };
  LogDecrement result{first,       periods,     estimate(0), estimate(1), estimate(2),
                      estimate(3), estimate(4), estimate(5), estimate(6), {}};
  result.gradient = gradient.bottomRows(kFormulas - 2)(std::vector<Index>{0, 2, 3, 4}, Eigen::all);
  return result;
}

std::optional<LogDecrement> ApplyLogDecrement(const TurningPointTable& table, Gravity gravity,
                                              const std::stop_token& stop) {
  const std::vector<TurningPointRun> runs = table.Runs();
  const auto longest =
      std::ranges::max_element(runs, {}, [](const TurningPointRun& run) { return run.last - run.first; });
  if (longest == runs.end()) return std::nullopt;
  const VectorXd weights = table.ZeroWeights();
  int best = 0;
  double smallest = 0;
  for (int n = 1; Reaches(table, longest->first, n); ++n) {
    if (stop.stop_requested()) return std::nullopt;
    const double error = DampingRatio(table, weights, longest->first, n)->std_error;
    if (best == 0 || error < smallest) best = n, smallest = error;
  }
  return ApplyLogDecrement(table, gravity, longest->first, best);
}

std::vector<DecayRow> TabulateDecay(const TurningPointTable& table, const std::stop_token& stop) {
  const VectorXd weights = table.ZeroWeights();
  std::vector<DecayRow> rows;
  std::size_t start = 0;
  for (std::size_t i = 0; i < table.points.size() && !stop.stop_requested(); ++i) {
    if (!table.points[i].continues) start = i;
    DecayRow row{i, DampingRatio(table, weights, i, 1), std::nullopt, static_cast<int>((i - start) / 2)};
    row.so_far = DampingRatio(table, weights, start + (i - start) % 2, row.periods);
    rows.push_back(row);
  }
  return rows;
}

}  // namespace pendulum
