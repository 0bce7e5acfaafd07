// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/swing/not_a_pendulum.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "pendulum/base/format.h"
#include "pendulum/base/physics.h"
#include "pendulum/closed_form/period.h"
#include "pendulum/recording/window.h"

namespace pendulum {
namespace {

/// rad/s
double NaturalFrequencyOf(const FitReport& report) {
  const auto found = std::ranges::find(report.derived, "natural_frequency", &DerivedQuantity::name);
  return found == report.derived.end() ? 0 : found->estimate;
}

/// The first and largest swings, with enough samples to identify a mode with a tenth of the period.
Recording FirstSwings(const Recording& recording, const FitReport& report) {
  constexpr Eigen::Index kMaxSamples = 3000;
  constexpr double kPerPeriod = 24;
  const double periods_per_second = NaturalFrequencyOf(report) * recording.clock_scale / (2 * kPi);
  return Excerpt(recording, kMaxSamples, std::max(kPerPeriod * periods_per_second, 1e-9), false);
}

/// A fit of the richest friction with one law of gravity. Returns std::nullopt if it fails.
std::optional<FitReport> FitRichest(const Recording& recording, Gravity gravity, const std::stop_token& stop) {
  FitOptions options;
  options.model = "drag";
  options.gravity = gravity;
  options.search.max_traces = 200;
  options.noise = NoiseFamily::kGaussian;
  options.interval = IntervalMethod::kCovariance;
  options.stop = stop;
  Result<FitReport> fit = FitRecording(recording, options);
  if (!fit || fit->termination == Termination::kFailed) return std::nullopt;
  return *std::move(fit);
}

std::string Percent(double share) { return NumberText(100 * share, 2) + " %"; }

/// "32 % longer", or "3.3 times as long".
std::string LongerText(double ratio) {
  constexpr double kTimes = 1.5;
  return ratio < kTimes ? Percent(ratio - 1) + " longer" : NumberText(ratio, 2) + " times as long";
}

bool DescribesAll(const FitReport& report) {
  return std::ranges::none_of(report.warnings, [](const Warning& warning) {
    return warning.code == "lack_of_fit" || warning.code == "correlated_residuals";
  });
}

/// The number of levels in a turn, if the levels of readings in rad are whole fractions of a turn: an encoder.
std::optional<double> LevelsInTurn(const Recording& recording) {
  constexpr double kMaxError = 0.02;  // of the number of levels, from the rounding of the printed readings
  constexpr double kFewest = 8, kMost = 20000;
  if (!(recording.resolution > 0)) return std::nullopt;
  const double first = recording.value[0];
  double step = recording.resolution;
  double error = 0;
  for (int pass = 0; pass < 4; ++pass) {  // the step found in the values is known from a few of them only
    const Eigen::ArrayXd level = ((recording.value.array() - first) / step).round();
    const double most = level.abs().maxCoeff();
    if (!(most > 1)) return std::nullopt;
    step = (level * (recording.value.array() - first)).sum() / level.square().sum();
    error = (recording.value.array() - first - step * level).abs().maxCoeff() / (most * step);
  }
  const double levels = 2 * kPi / step;
  const double levels_error = std::max(error * levels, 1e-9 * levels);
  if (levels < kFewest || levels > kMost || levels_error > kMaxError) return std::nullopt;
  return std::abs(levels - std::round(levels)) < levels_error ? std::optional(std::round(levels)) : std::nullopt;
}

/// The flags that a user may give for a linear oscillator.
std::string FlagsForLinear(const Recording& recording, double amplitude) {
  std::string spring = "give --gravity linear for a spring or wire (Pohl wheel, torsion pendulum)";
  if (ReasonForUnit(recording)) return spring;
  return spring +
         ", or correct the unit to deg (--unit deg, or in the column's name) if this is a pendulum with an "
         "amplitude of " +
         NumberText(amplitude, 3) + " deg";
}

/// Whether and why the motion is that of a linear oscillator, such as a mass on a spring, whose period is the same at
/// every amplitude. pendulum: a fit with sine gravity.
std::optional<LinearMotion> CompareWithLinear(const Recording& recording, const FitReport& pendulum,
                                              const std::stop_token& stop) {
  constexpr double kMinAmplitude = 0.2;  // rad; for smaller amplitudes the two models hardly differ
  constexpr double kMuchLess = 0.7;
  constexpr double kSurely = 30;
  if (recording.quantity != Quantity::kAngle) return std::nullopt;
  const double amplitude = 0.5 * (recording.value.maxCoeff() - recording.value.minCoeff());
  if (amplitude < kMinAmplitude) return std::nullopt;
  const std::optional<FitReport> linear = FitRichest(recording, Gravity::kLinear, stop);
  if (!linear) return std::nullopt;
  const double left = pendulum.statistics.rms_residual;
  const double ratio = linear->statistics.rms_residual / left;
  const double gain = -2 * static_cast<double>(recording.size()) * std::log(ratio);  // in -2 log L
  if (!(ratio < kMuchLess || (gain > kSurely && DescribesAll(*linear)))) return std::nullopt;
  constexpr double kNearTop = 3.1;
  return LinearMotion{"the period does not depend on the amplitude as in a pendulum, whose period is " +
                          LongerText(SineGravity::PeriodRatio(std::min(amplitude, kNearTop))) + " at " +
                          NumberText(amplitude, 3) + " rad: a linear oscillator leaves " +
                          NumberText(linear->statistics.rms_residual, 3) + " rad (rms), a pendulum " +
                          NumberText(left, 3) + " rad",
                      FlagsForLinear(recording, amplitude)};
}

/// A frequency and its share of the residuals.
struct Line {
  double frequency = 0;  // rad/s
  double share = 0;      // of their variance
};

/// The strongest line at frequencies up to ten times the pendulum's own. Uses Scargle's periodogram without its time
/// offset τ (Astrophys. J. 263:835, 1982). The share includes all lines within 20 % of the strongest line's frequency,
/// because a decaying mode is not a sharp line.
Line StrongestLine(const Eigen::VectorXd& time, const Eigen::VectorXd& residual, double natural) {
  constexpr int kMaxFrequencies = 1000;
  constexpr double kWidth = 0.2;
  const Eigen::ArrayXd t = time.array() - time[0];
  const Eigen::ArrayXd& r = residual.array();
  const Eigen::Index count = time.size();
  const double independent = 2 * kPi / t[count - 1];
  const double spacing = std::max(independent, 10 * natural / kMaxFrequencies);
  std::vector<Line> lines;
  // Above half the sampling rate there are only aliases.
  const double highest = std::min(10 * natural, 0.5 * independent * static_cast<double>(count - 1));
  for (double frequency = spacing; frequency < highest; frequency += spacing) {
    const Eigen::ArrayXd phase = frequency * t;
    const double power = std::pow((r * phase.cos()).sum(), 2) + std::pow((r * phase.sin()).sum(), 2);
    lines.push_back({frequency, 2 * power * spacing / (independent * static_cast<double>(count) * r.square().sum())});
  }
  Line strongest = *std::ranges::max_element(lines, {}, &Line::share);
  const double centre = strongest.frequency;
  strongest.share = 0;
  for (const Line& line : lines) {
    if (std::abs(line.frequency - centre) < kWidth * centre) strongest.share += line.share;
  }
  return strongest;
}

std::optional<std::string> ReasonIfTwoModes(const Recording& recording, const FitReport& report) {
  constexpr double kMinShare = 0.4;
  constexpr double kMinMisfit = 0.03;  // of the swing's rms
  const double natural = NaturalFrequencyOf(report);
  if (!(natural > 0)) return std::nullopt;
  const double swing = std::sqrt((recording.value.array() - recording.value.mean()).square().mean());
  if (!(report.statistics.rms_residual > kMinMisfit * swing)) return std::nullopt;
  const Line line = StrongestLine(recording.clock_scale * recording.time, report.residual, natural);
  const double ratio = line.frequency / natural;
  const bool own = ratio < 0.3 || (ratio > 0.8 && ratio < 1.15) || (ratio > 2.8 && ratio < 3.1);
  if (own || line.share < kMinShare) return std::nullopt;
  return Percent(line.share) + " of the residuals' variance is an oscillation with a period of " +
         NumberText(2 * kPi / line.frequency, 4) + " s beside the pendulum's " + NumberText(2 * kPi / natural, 4) +
         " s: two modes, of a second pendulum, a string or a loose support";
}

}  // namespace

std::optional<LinearMotion> FindLinearMotion(const Recording& recording, const FitReport& report,
                                             const std::stop_token& stop) {
  if (report.termination == Termination::kFailed || report.model.gravity.is_linear()) return std::nullopt;
  const Recording some = FirstSwings(recording, report);
  const std::optional<FitReport> richest = FitRichest(some, Gravity::kSine, stop);
  return richest ? CompareWithLinear(some, *richest, stop) : std::nullopt;
}

std::optional<std::string> ReasonForUnit(const Recording& recording) {
  if (recording.calibration) return "the calibration gives their unit";
  if (recording.arc) return "they follow from two coordinates";
  if (recording.is_unit_assumed) return std::nullopt;
  if (recording.unit == "deg") return "the file says deg, and in rad they would be several turns";
  const std::optional<double> levels = LevelsInTurn(recording);
  if (!levels) return std::nullopt;
  return "their levels are 1/" + NumberText(*levels) + " of a turn";
}

std::optional<std::string> TwoModesReason(const Recording& recording, const FitReport& report,
                                          const std::stop_token& stop) {
  if (report.termination == Termination::kFailed) return std::nullopt;
  const Recording some = FirstSwings(recording, report);
  const std::optional<FitReport> richest =
      FitRichest(some, recording.is_calibrated() ? report.model.gravity : Gravity::kLinear, stop);
  return richest ? ReasonIfTwoModes(some, *richest) : std::nullopt;
}

}  // namespace pendulum
