// SPDX-License-Identifier: Apache-2.0
#include "pendulum/acquisition/run_csv.h"

#include <array>
#include <charconv>

#include "pendulum/acquisition/messages.h"
#include "pendulum/base/format.h"
#include "pendulum/base/json.h"
#include "pendulum/base/physics.h"
#include "pendulum/recording/calibration/calibrate.h"

namespace pendulum {
namespace {

/// The double with the shortest decimal text of the float: 0.1985, not 0.19850000739.
double AsWritten(float value) {
  constexpr std::size_t kLongest = 32;
  std::array<char, kLongest> text{};
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), value);
  double number = 0;
  std::from_chars(text.data(), end, number);
  return number;
}

std::string Line(const std::string& text) { return "# " + text + "\n"; }

std::string ClockLines(const DeviceClock& clock) {
  constexpr int kDigits = 9;  // for a scale near 1
  return Line(clock.is_measured
                  ? "the clock was compared with the host's; clock_scale is true seconds per second of the times below"
                  : "the clock was not measured: its error is that of a ceramic resonator") +
         Line("clock_scale: " + NumberText(clock.scale, kDigits)) +
         Line("clock_scale_std_dev: " + NumberText(clock.std_dev, 2));
}

}  // namespace

std::string RunHead(const RunDescription& description, const SamplingRate& rate) {
  const pendulum_logger::Info& logger = description.logger;
  std::string head = Line("pendulum_logger " + FirmwareVersion(logger) + ", " + BoardName(logger) +
                          ", reference: " + ReferenceName(logger)) +
                     Line("run " + std::to_string(description.run) + " of this logger, begun " + description.begun);
  if (rate.oversample > 1) head += Line("each row is the mean of " + std::to_string(rate.oversample) + " conversions");
  if (rate.oversample > 1) {
    // The time of a row is the mean of its conversions' times.
    const double half = 0.5 * static_cast<double>(rate.Ticks()) / pendulum_logger::kTickHz;
    head += Line("oversample: " + std::to_string(rate.oversample));
    head += Line("window_s: " + NumberText(-half) + "," + NumberText(half));
  }
  head += Line("sample_rate_hz: " + NumberText(rate.Hz()));
  head += Line("resolution: " + NumberText(1.0 / rate.oversample));
  head += Line("range: 0," + std::to_string(kFullScaleCounts));
  head += ClockLines(description.clock);
  if (const auto& losses = description.losses) {
    if (!losses->is_end_known) head += Line("the logger's message about the end of the run did not arrive");
    head += Line("lost_samples: " + std::to_string(losses->samples));
  } else {
    head += Line("part of a run: the number of lost samples is not known");
  }
  if (description.calibration) {
    head += Line("calibration: " + JsonText(CalibrationJson(*description.calibration)));
  }
  return head + "time_s,adc_counts\n";
}

std::string RunRow(const ReceivedRun& run, std::size_t sample) {
  return NumberText(run.Time(sample)) + "," + NumberText(run.Counts(sample)) + "\n";
}

std::optional<Calibration> StoredCalibration(const pendulum_logger::Info& info) {
  if (info.has_calibration == 0) return std::nullopt;
  const pendulum_logger::StraightLine& line = info.calibration;
  Calibration calibration;
  calibration.input = "counts";
  calibration.angle_unit = "deg";
  calibration.coefficients = {AsWritten(line.offset_deg), AsWritten(line.deg_per_count)};
  calibration.input_range = SensorRange{0, kFullScaleCounts};
  if (line.slope_variance > 0) {
    calibration.covariance.resize(2, 2);
    calibration.covariance << AsWritten(line.offset_variance), AsWritten(line.covariance), AsWritten(line.covariance),
        AsWritten(line.slope_variance);
  }
  return calibration;
}

Result<pendulum_logger::StraightLine> StraightLineOf(const Calibration& calibration) {
  if (calibration.input != "counts") {
    return Error(StatusCode::kInvalidArgument,
                 "the calibration is for " + calibration.input + ", but a logger sends counts");
  }
  if (calibration.coefficients.size() != 2) {
    return Error(StatusCode::kInvalidArgument,
                 "the calibration is a curve, but a logger stores only straight lines; give it to record_pendulum "
                 "--calibration for every recording");
  }
  const double deg = calibration.RadFromUnit() / kRadFromDeg;
  const auto single = [](double value) { return static_cast<float>(value); };
  pendulum_logger::StraightLine line{single(deg * calibration.coefficients[0]),
                                     single(deg * calibration.coefficients[1]), 0, 0, 0};
  if (calibration.covariance.size() > 0) {
    line.offset_variance = single(deg * deg * calibration.covariance(0, 0));
    line.covariance = single(deg * deg * calibration.covariance(0, 1));
    line.slope_variance = single(deg * deg * calibration.covariance(1, 1));
  }
  return line;
}

}  // namespace pendulum
