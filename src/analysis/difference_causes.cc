// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/difference_causes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <utility>

#include "pendulum/base/format.h"
#include "pendulum/base/physics.h"

namespace pendulum {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

Recording WithReadings(const Recording& used, const VectorXd& time, const VectorXd& value) {
  Recording recording;
  recording.quantity = used.quantity;
  recording.unit = used.unit;
  recording.calibration = used.calibration;
  recording.time = time;
  recording.value = value;
  return recording;
}

/// Rounds readings to the levels of the recording's own readings, within the sensor's range.
VectorXd OnLevels(const Recording& used, VectorXd readings) {
  const double q = used.resolution;
  for (double& reading : readings) {
    if (q > 0) reading = used.value[0] + q * std::round((reading - used.value[0]) / q);
    if (used.range) reading = std::clamp(reading, used.range->low, used.range->high);
  }
  return readings;
}

std::string Signed(double value, const std::string& unit) {
  constexpr int kDigits = 3;
  std::string text = value < 0 ? "" : "+";
  text.append(NumberText(value, kDigits));
  return unit == "1" ? text : text.append(" ").append(unit);
}

}  // namespace

std::optional<FormulaStages> ApplyInStages(const FittedMotion& motion, const Recording& used, Gravity gravity,
                                           const FormulaValues& formulas) {
  constexpr double kPerPeriod = 200;
  constexpr double kMaxSamples = 200'000;
  const VectorXd& own = motion.instants();
  const double end = own[own.size() - 1];
  const double wanted = kPerPeriod * end / motion.small_angle_period();
  const auto count = static_cast<Index>(std::clamp(wanted, 100.0, kMaxSamples));
  const VectorXd fine = VectorXd::LinSpaced(count, 0, end);
  const FittedMotion linear = motion.WithGravity(Gravity::kLinear);
  const auto small = linear.WithoutDrift().Readings(fine);
  const auto drifting = linear.Readings(fine);
  const auto swing = motion.Readings(fine);
  const auto sampled = motion.Readings(own);
  if (!small || !drifting || !swing || !sampled) return std::nullopt;
  Recording levels = WithReadings(used, own, OnLevels(used, *sampled));
  levels.resolution = used.resolution;
  levels.range = used.range;
  const auto at_small_angles = formulas(WithReadings(used, fine, *small), Gravity::kLinear);
  const auto at_drift =
      motion.drifts() ? formulas(WithReadings(used, fine, *drifting), Gravity::kLinear) : at_small_angles;
  const auto at_own_gravity = formulas(WithReadings(used, fine, *swing), gravity);
  const auto at_own_instants = formulas(WithReadings(used, own, *sampled), gravity);
  const auto at_own_levels = formulas(levels, gravity);
  if (!at_small_angles || !at_drift || !at_own_gravity || !at_own_instants || !at_own_levels) return std::nullopt;
  return FormulaStages{*at_small_angles, *at_drift, *at_own_gravity, *at_own_instants, *at_own_levels};
}

DifferenceCauses SplitDifference(const FormulaStages& stages, Index k, double scale, double closed_form, double fit) {
  DifferenceCauses causes;
  causes.formula = scale * stages.small_angles[k] - fit;
  causes.drift = scale * (stages.drifting[k] - stages.small_angles[k]);
  causes.amplitude = scale * (stages.own_gravity[k] - stages.drifting[k]);
  causes.sampling = scale * (stages.own_instants[k] - stages.own_gravity[k]);
  causes.resolution = scale * (stages.own_levels[k] - stages.own_instants[k]);
  causes.recording = closed_form - scale * stages.own_levels[k];
  return causes;
}

DifferenceCause DifferenceCauses::Largest() const {
  using enum DifferenceCause;
  const std::array parts = {std::pair{formula, kFormula},       std::pair{drift, kDrift},
                            std::pair{amplitude, kAmplitude},   std::pair{sampling, kSampling},
                            std::pair{resolution, kResolution}, std::pair{recording, kRecording}};
  return std::ranges::max_element(parts, {}, [](const auto& part) { return std::abs(part.first); })->second;
}

std::string DescribeCauses(const DifferenceCauses& causes, double std_dev, const std::string& unit,
                           const CauseNames& names) {
  constexpr double kNoise = 3;
  constexpr double kMinShare = 0.2;
  const bool noise = std::abs(causes.recording) < kNoise * std_dev;
  std::vector<std::pair<double, std::string>> parts = {
      {causes.formula, names.formula},
      {causes.drift, "the drift of the zero, which the formula ignores"},
      {causes.amplitude, names.amplitude},
      {causes.sampling, "too few samples around the turning points"},
      {causes.resolution, "the sensor's resolution"},
      {causes.recording, noise ? "noise" : names.misfit}};
  std::ranges::stable_sort(parts, [](const auto& a, const auto& b) { return std::abs(a.first) > std::abs(b.first); });
  const double total = causes.total();
  std::string text;
  for (const auto& [part, cause] : parts) {
    if (std::abs(part) < kMinShare * std::abs(total)) continue;
    text.append(text.empty() ? ": " : "; ").append(Signed(part, "1")).append(" by ").append(cause);
  }
  return "differs by " + Signed(total, unit) + text;
}

}  // namespace pendulum
