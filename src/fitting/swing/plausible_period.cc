// SPDX-License-Identifier: Apache-2.0
#include "fitting/swing/plausible_period.h"

#include "fitting/swing/aliases.h"
#include "pendulum/base/format.h"
#include "pendulum/closed_form/turning_point_view.h"
#include "pendulum/closed_form/turning_points.h"
#include "pendulum/recording/window.h"

namespace pendulum {
namespace {

constexpr double kShortestPeriod = 0.1, kLongestPeriod = 20;  // s: from 2.5 mm to 100 m of string

/// s, on the recording's clock; 0 if the window shows no three turning points.
double HalfPeriodOf(const Recording& recording, const FreeSwing& swing) {
  if (swing.half_period > 0) return swing.half_period;
  const Result<Recording> window = SelectWindow(recording, swing.from, swing.to);
  return window ? FindAllTurningPoints(TurningPointView(*window)).half_period : 0;
}

std::string WrongUnitText(double period) {
  if (period < kShortestPeriod) return "If the times are in seconds, say so with --time_column NAME:s";
  return "If the times are milliseconds or microseconds, say so with --time_column NAME:ms or NAME:us";
}

/// A sampling rate that is too low makes a swing look slower than it is.
std::string SlowSamplingText(const Recording& recording, double period) {
  const double rate = SampleRateOf(recording);
  constexpr double kSlowestHz = 0.2;  // slower pendulums are not suspected
  const double faster = rate - 1 / period;
  if (period < kLongestPeriod || faster < kSlowestHz || faster > kFastestHz) return "";
  return "If the pendulum swings at about " + Hz(faster) + ", sample faster than " + Hz(rate) + ". ";
}

}  // namespace

std::optional<std::string> ImplausiblePeriodReason(const Recording& recording, const FreeSwing& swing,
                                                   const FitOptions& options) {
  const bool is_inertia_known = options.rig && options.rig->known_inertia;
  if (swing.undersampled || IsFrequencyKnown(options) || is_inertia_known || IsLinear(options)) return std::nullopt;
  const double period = 2 * HalfPeriodOf(recording, swing) * recording.clock_scale;
  if (!(period > 0) || (period >= kShortestPeriod && period <= kLongestPeriod)) return std::nullopt;
  return "the period is " + NumberText(period, 3) + " s, but the periods of pendulums are " +
         NumberText(kShortestPeriod) + " s to " + NumberText(kLongestPeriod) + " s. " + WrongUnitText(period) + ". " +
         SlowSamplingText(recording, period) +
         "If the times are right, this is another oscillator, such as a torsion balance: give --gravity linear, or "
         "the inertia in --rig or with --bounds";
}

}  // namespace pendulum
