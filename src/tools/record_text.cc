// SPDX-License-Identifier: Apache-2.0
#include "tools/record_text.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pendulum/acquisition/messages.h"
#include "pendulum/base/format.h"
#include "pendulum/base/physics.h"
#include "pendulum/report/layout.h"
#include "pendulum/report/text_parts.h"

namespace pendulum {
namespace {

/// Range of the readings of a recording [counts], and how many are saturated.
struct Readings {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  int saturated = 0;
};

Readings ReadingsOf(const RecordedRun& recorded) {
  Readings readings;
  for (std::size_t i = 0; i < recorded.run.size(); ++i) {
    readings.low = std::min(readings.low, recorded.run.Counts(i));
    readings.high = std::max(readings.high, recorded.run.Counts(i));
    readings.saturated += recorded.run.IsSaturated(i) ? 1 : 0;
  }
  return readings;
}

std::string Row(const std::string& name, const std::string& text) {
  constexpr std::size_t kNames = 11;
  return Paragraph(text, "    " + name + std::string(kNames - name.size(), ' '), kTextWidth);
}

std::string SamplesText(const RecordedRun& recorded) {
  const RunLosses losses = recorded.description.losses.value_or(RunLosses());
  const double seconds = static_cast<double>(recorded.run.size()) / recorded.run.rate().Hz();
  std::string text = std::to_string(recorded.run.size()) + " at " + NumberText(recorded.run.rate().Hz(), kTextDigits) +
                     " Hz, " + NumberText(seconds, kTextDigits) + " s";
  if (recorded.run.rate().oversample > 1) {
    text += ", each the mean of " + std::to_string(recorded.run.rate().oversample) + " conversions";
  }
  return text + "; " + (losses.samples == 0 ? "none lost" : std::to_string(losses.samples) + " lost");
}

std::string ReadingsText(const RecordedRun& recorded) {
  const Readings readings = ReadingsOf(recorded);
  std::string text = NumberText(readings.low, kTextDigits) + " to " + NumberText(readings.high, kTextDigits) +
                     " of 0 to " + std::to_string(kFullScaleCounts) + " counts";
  if (const auto& calibration = recorded.description.calibration) {
    const auto deg = [&](double counts) { return NumberText(calibration->Angle(counts) / kRadFromDeg, 4); };
    text += ", " + deg(readings.low) + " to " + deg(readings.high) + " deg";
  }
  return text;
}

std::string ClockText(const DeviceClock& clock) {
  constexpr double kMillion = 1e6;
  if (!clock.is_measured) {
    return "not compared with this computer's clock (that takes at least ten seconds): ± " +
           NumberText(100 * clock.std_dev, 2) + " %, as for any resonator";
  }
  const double ppm = (1 / clock.scale - 1) * kMillion;
  return std::to_string(std::lround(std::abs(ppm))) + " ± " + std::to_string(std::lround(clock.std_dev * kMillion)) +
         " ppm " + (ppm < 0 ? "slow" : "fast") + " compared with this computer's clock; # clock_scale corrects for it";
}

std::string EndText(const RecordedRun& recorded) {
  switch (recorded.end) {
    case RunEnd::kSeconds: return "after the time asked for";
    case RunEnd::kRest: return "at rest";
    case RunEnd::kStopped: return "by hand";
    case RunEnd::kLost: return "too early: " + recorded.loss_reason;
  }
  return "";
}

/// "1 sample is", "2 samples are"; `is` and `are` are the singular and the plural of the verb.
std::string Counted(std::int64_t count, const std::string& one, const std::string& is, const std::string& are) {
  return std::to_string(count) + " " + one + (count == 1 ? " " + is : "s " + are);
}

Warning LossWarning(const RunLosses& losses, int damaged_frames) {
  Warning warning{.code = "lost_samples", .finding = Counted(losses.samples, "sample", "is", "are") + " missing"};
  if (losses.dropped > 0) {
    warning.explanation += std::to_string(losses.dropped) +
                           " did not fit into the logger's memory, because the line is too slow for this rate; ";
    warning.advice = "lower --rate_hz";
    warning.flags = {"rate_hz"};
  }
  if (losses.on_line > 0) warning.explanation += std::to_string(losses.on_line) + " were damaged or lost on the line; ";
  if (damaged_frames > 0) warning.explanation += Counted(damaged_frames, "damaged frame", "came", "came") + "; ";
  if (losses.late > 0) warning.explanation += std::to_string(losses.late) + " conversions began too late; ";
  warning.explanation += "their rows are not in the file, and all other rows have correct times";
  return warning;
}

}  // namespace

bool IsComplete(const RecordedRun& recorded) {
  const RunLosses losses = recorded.description.losses.value_or(RunLosses());
  return recorded.end != RunEnd::kLost && losses.samples == 0 && losses.is_end_known;
}

std::vector<Warning> RecordWarnings(const RecordedRun& recorded) {
  const RunLosses losses = recorded.description.losses.value_or(RunLosses());
  std::vector<Warning> warnings;
  if (recorded.end == RunEnd::kLost)
    warnings.push_back({.code = "recording_interrupted",
                        .finding = recorded.loss_reason,
                        .explanation = "the samples before that are kept"});
  if (losses.samples > 0) warnings.push_back(LossWarning(losses, recorded.damaged_frames));
  if (!losses.is_end_known && recorded.end != RunEnd::kLost) {
    warnings.push_back({"end_message_missing",
                        "the logger did not report how many samples it had sent, so the last ones may be missing"});
  }
  if (losses.contradicting_frames > 0) {
    warnings.push_back(
        {"contradicting_frames", Counted(losses.contradicting_frames, "frame", "contradicted", "contradicted") +
                                     " the run and " + std::string(losses.contradicting_frames == 1 ? "was" : "were") +
                                     " ignored"});
  }
  if (const int saturated = ReadingsOf(recorded).saturated; saturated > 0) {
    warnings.push_back({.code = "saturated",
                        .finding = Counted(saturated, "reading", "is", "are") + " at an end of the converter's range",
                        .advice = "turn the potentiometer, or choose another reference"});
  }
  if (recorded.description.clock.is_implausible) {
    warnings.push_back(
        {.code = "clock_implausible",
         .finding =
             "the logger's clock and this computer's differ by more than any resonator explains, so the scale of "
             "the times was not measured",
         .advice = "check whether one of them pauses, as in a virtual machine"});
  }
  if (!recorded.part_file_error.empty()) {
    warnings.push_back({.code = "part_file_not_written",
                        .finding = recorded.part_file_error,
                        .explanation = "during the run the recording was only in memory"});
  }
  return warnings;
}

std::string RecordText(const RecordedRun& recorded, const std::string& path) {
  const pendulum_logger::Info& logger = recorded.description.logger;
  std::string text = Heading("Recording") + Row("file", Printable(path)) +
                     Row("logger", "pendulum_logger " + FirmwareVersion(logger) + ", " + BoardName(logger) + ", run " +
                                       std::to_string(recorded.description.run)) +
                     Row("samples", SamplesText(recorded));
  text += Row("readings", ReadingsText(recorded)) + Row("clock", ClockText(recorded.description.clock)) +
          Row("ended", EndText(recorded));
  const std::vector<Warning> warnings = RecordWarnings(recorded);
  if (!warnings.empty()) text += Heading("Warnings");
  for (const Warning& warning : warnings) text += Paragraph(Printable(MessageText(warning)), "  - ", kTextWidth);
  return text;
}

std::string LoggerText(const pendulum_logger::Info& info, const std::string& port) {
  std::string text = Heading("Logger") + Row("port", Printable(port)) +
                     Row("firmware", "pendulum_logger " + FirmwareVersion(info)) + Row("board", BoardName(info)) +
                     Row("reference", ReferenceName(info)) + Row("runs", std::to_string(info.run) + " so far");
  const auto calibration = StoredCalibration(info);
  if (!calibration) return text + Row("stored", "no calibration; calibrate_sensor makes one for --store_calibration");
  const double offset = calibration->coefficients[0], slope = calibration->coefficients[1];
  return text +
         Row("stored", "angle = " + NumberText(offset) + (slope < 0 ? " - " : " + ") + NumberText(std::abs(slope)) +
                           " x deg, x in counts" + (calibration->covariance.size() > 0 ? ", with its covariance" : ""));
}

std::string PortsText(const std::vector<PortName>& ports) {
  if (ports.empty())
    return "There is no USB serial port; check that the board is plugged in, with a cable that carries data.\n";
  std::string text;
  for (const PortName& port : ports) {
    text += port.path + (port.what.empty() ? "" : "  " + Printable(port.what)) +
            (port.is_arduino ? "  (a board's, by its USB vendor)" : "") + "\n";
  }
  return text;
}

}  // namespace pendulum
