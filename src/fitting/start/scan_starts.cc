// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/start/scan_starts.h"

#include <iterator>
#include <utility>

#include "pendulum/closed_form/turning_point_view.h"
#include "pendulum/fitting/start/sensor_start.h"

namespace pendulum {
namespace {

/// The range of the natural frequency, if the readings oscillate at `frequency` [rad/s]: a large swing is slower.
FrequencyRange RangeAbout(double frequency) {
  constexpr double kSlower = 0.93, kFaster = 1.2;
  return {kSlower * frequency, kFaster * frequency};
}

/// Start values for one interpretation of the readings; empty after a stop request.
std::vector<StartValues> BestOfScan(const SensorModel& sensor, const SensorStart& start, const MotionModel& model,
                                    const FrequencyRange& range, const std::stop_token& stop) {
  std::vector<StartValues> scanned = ScanFrequencies(start.view, model, range, stop);
  if (scanned.size() > 1) scanned.resize(1);
  for (StartValues& values : scanned) AppendSensorParameters(sensor, start, values);
  return scanned;
}

}  // namespace

Result<std::vector<StartValues>> ScanStarts(const Recording& recording, const MotionModel& model,
                                            const FrequencyRange& range, const FitOptions& options) {
  const SensorModel sensor = SensorOf(recording, model.gravity);
  if (recording.quantity == Quantity::kAcceleration && IsAlongRod(recording)) {
    return Error(StatusCode::kFailedPrecondition,
                 "an acceleration along the rod swings twice in each period of the pendulum, and it is sampled too "
                 "slowly to show that; choose the axis across the rod with --value_column, or sample faster");
  }
  const Recording view = TurningPointView(recording);
  if (sensor.kind == SensorKind::kDirect) return ScanFrequencies(view, model, range, options.stop);
  if (sensor.kind == SensorKind::kArc) {
    std::vector<StartValues> starts = ScanFrequencies(recording, model, range, options.stop);
    const SensorStart start = SensorStarts(recording, sensor, options, Oscillation{}).front();
    for (StartValues& values : starts) AppendSensorParameters(sensor, start, values);
    return starts;
  }
  std::vector<StartValues> starts;
  for (const Oscillation& oscillation : ScanOscillations(view, range, options.stop)) {
    for (const SensorStart& start : SensorStarts(recording, sensor, options, oscillation)) {
      std::vector<StartValues> best = BestOfScan(sensor, start, model, RangeAbout(oscillation.frequency), options.stop);
      std::move(best.begin(), best.end(), std::back_inserter(starts));
    }
  }
  return starts;
}

}  // namespace pendulum
