// SPDX-License-Identifier: Apache-2.0
#include "tools/record_pendulum.h"

#include <algorithm>
#include <atomic>
#include <csignal>
#include <functional>
#include <iostream>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gflags/gflags.h>
#include <unistd.h>

#include "pendulum/acquisition/logger.h"
#include "pendulum/acquisition/serial_port.h"
#include "pendulum/base/format.h"
#include "pendulum/base/try.h"
#include "pendulum/model/motion_model.h"
#include "pendulum/recording/calibration/calibration_source.h"
#include "pendulum/report/summary_text.h"
#include "tools/fit_runs.h"
#include "tools/output.h"
#include "tools/record_pendulum_options.h"
#include "tools/record_run.h"
#include "tools/record_text.h"
#include "tools/run_tool.h"

namespace pendulum {
namespace {

constexpr const char* kUsage =
    "Records a swing from an Arduino with the sketch firmware/pendulum_logger into a CSV file.\n"
    "\n"
    "  record_pendulum --list\n"
    "  record_pendulum --port /dev/ttyACM0 --counts\n"
    "  record_pendulum --port /dev/ttyACM0 --store_calibration cal.json\n"
    "  record_pendulum --port /dev/ttyACM0 --out run.csv --seconds 60\n"
    "  record_pendulum --port /dev/ttyACM0 --out run.csv --until_rest --fit --rig rig.json --model coulomb\n"
    "\n"
    "Ctrl-C ends a recording normally. Until the end, the samples are in run.csv.part, which can be fitted already.\n"
    "Exit codes: 0 recorded (with --fit those of fit_pendulum), 1 recorded, but samples are missing or the logger was\n"
    "lost, 2 wrong flags, 3 no such port or file, 4 no logger answers, or a file cannot be read, 70 a bug, 73 an "
    "output\n"
    "cannot be written, 75 the port is in use, 130 interrupted before the time asked for.\n"
    "\n";

constexpr int kIncomplete = 1;

std::atomic<bool> stop = false;

void Stop(int) { stop = true; }

/// Sets the handler of all signals that end a recording, including a closed terminal: the recording must still be
/// written. SIG_DFL restores the default.
void OnSignals(void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) ::sigaction(signal, &action, nullptr);
}

using Flags = RecordPendulumFlags;

std::vector<ToolFlag<Flags>> FlagTable() {
  return {
      {"port", &Flags::port, "Serial port of the logger, such as /dev/ttyACM0; default the only port that there is."},
      {"out", &Flags::out, "Where to write the recording (CSV); - is standard output."},
      {"seconds", &Flags::seconds, "How long to record, s; default until Ctrl-C."},
      {"until_rest", &Flags::until_rest, "Stops when the pendulum has swung and come to rest. Default off."},
      {"overwrite", &Flags::overwrite, "Replaces the file of --out if it exists. Default off."},
      {"rate_hz", &Flags::rate_hz, "Samples per second; default 200."},
      {"oversample", &Flags::oversample, "Number of conversions that are averaged to one sample, 1 to 64; default 1."},
      {"baud", &Flags::baud, "Baud rate of the sketch; default 115200."},
      {"calibration", &Flags::calibration,
       "Calibration file (JSON) to write into the recording; default the calibration in the logger."},
      {"store_calibration", &Flags::store_calibration,
       "Instead of recording, stores this calibration file in the logger."},
      {"counts", &Flags::counts,
       "Instead of recording, prints the mean reading of one second in counts, for a calibration table. Default off."},
      {"info", &Flags::info, "Instead of recording, shows board, firmware and calibration of the logger. Default off."},
      {"list", &Flags::list, "Instead of recording, lists the serial ports. Default off."},
      {"fit", &Flags::fit, "Fits the finished recording as fit_pendulum does. Default off."},
      {"rig", &Flags::rig, "With --fit: rig file (JSON, SI units); default none."},
      {"model", &Flags::model,
       "With --fit: model of the motion; several separated by commas, to compare them; or all; default coulomb."},
  };
}

/// The requested port, or the only one available.
Result<std::string> ChoosePort(const std::string& asked) {
  if (!asked.empty()) return asked;
  std::vector<PortName> ports = ListSerialPorts();
  if (std::ranges::any_of(ports, &PortName::is_arduino)) std::erase_if(ports, std::not_fn(&PortName::is_arduino));
  if (ports.size() == 1) return ports.front().path;
  if (ports.empty()) {
    return Error(StatusCode::kNotFound,
                 "there is no USB serial port; check that the board is plugged in, or name another port with --port");
  }
  return Error(StatusCode::kInvalidArgument,
               "there are several ports; choose one with --port: " + ports.front().path + " to " + ports.back().path);
}

/// A recording cannot be repeated, so an existing one is not overwritten by accident.
Result<void> CheckOut(const RecordPendulumOptions& options) {
  RETURN_IF_ERROR(CheckOutputs(options.Outputs(), options.Inputs()));
  const PartFile part(options.out);
  if (options.overwrite || part.path().empty()) return {};
  if (part.Exists()) {
    return Error(
        StatusCode::kCannotWrite,
        part.path() + " holds an interrupted recording, which can be fitted as it is; rename it, or give --overwrite");
  }
  if (::access(options.out.c_str(), F_OK) == 0) {
    return Error(StatusCode::kCannotWrite, options.out + " exists already; name another file, or give --overwrite");
  }
  return {};
}

Result<std::optional<Calibration>> ReadGivenCalibration(const RecordPendulumOptions& options) {
  if (options.calibration.empty()) return std::nullopt;
  ASSIGN_OR_RETURN(auto calibration, CalibrationFromFile(options.calibration));
  if (calibration.input != "counts") {
    return Error(StatusCode::kDataLoss, options.calibration + " is of " + calibration.input +
                                            ", but a logger sends counts; calibrate in counts");
  }
  return calibration;
}

/// 1 if data is missing; 130 if a recording of given length was stopped early.
int ExitCodeOf(const RecordPendulumOptions& options, const RecordedRun& recorded) {
  if (!IsComplete(recorded)) return kIncomplete;
  const bool has_end = options.seconds.has_value() || options.until_rest;
  return has_end && recorded.end == RunEnd::kStopped ? kInterrupted : 0;
}

constexpr const char* kMore = "More: fit_pendulum with the recording and --details or --report.";

/// Fits the recording and prints the summary; returns the fit's exit code.
Result<int> Fit(FitPendulumOptions options) {
  ASSIGN_OR_RETURN(auto setup, ReadSetup(options));
  ASSIGN_OR_RETURN(const auto runs, FitAll(options, setup));
  const Result<Identification>& run = runs.front();
  if (!run) return tl::unexpected(run.error());
  const std::string text = "\n" + SummaryText(SummarizeResult(*run), kMore, TextStyleFor(STDOUT_FILENO));
  return WriteOutputs(std::vector<Output>{{"-", text}}).map([&] { return ExitCode(*run); });
}

/// Names the part file with the received data if the recording could not be written.
std::string PartRemark(const RecordPendulumOptions& options, const RecordedRun& recorded) {
  const PartFile part(options.out);
  if (!part.Exists()) return "";
  return recorded.part_file_error.empty() ? "; the recording is in " + part.path()
                                          : "; the beginning of the recording is in " + part.path();
}

/// Writes the recording, removes its part file, and prints a summary.
Result<void> SaveRecording(const RecordPendulumOptions& options, const RecordedRun& recorded) {
  if (auto written = WriteOutputs(std::vector<Output>{{options.out, recorded.Csv()}}); !written) {
    written.error().sentence += PartRemark(options, recorded);
    return written;
  }
  PartFile(options.out).Remove();
  const std::string text = RecordText(recorded, options.out);
  if (!IsStandardOutput(options.out)) return WriteOutputs(std::vector<Output>{{"-", text}});
  std::cerr << text;
  return {};
}

/// Refuses a fit without a calibration to angles, before the pendulum swings.
Result<void> CheckCalibrated(const RecordPendulumOptions& options, const std::optional<Calibration>& given,
                             const pendulum_logger::Info& info) {
  const auto needs_angle = [](const std::string& model) { return !FindMotionModel(model)->gravity.is_linear(); };
  if (!options.fit || given || info.has_calibration != 0) return {};
  if (std::ranges::none_of(options.fit->models, needs_angle)) return {};
  return Error(StatusCode::kDataLoss,
               "--fit needs angles, but the logger has no calibration; store one (--store_calibration), give one "
               "(--calibration), or fit with --model linear");
}

void WarnOfSlowLine(const RecordPendulumOptions& options) {
  const double capacity = LineCapacityHz(options.rate, options.baud);
  if (options.rate.Hz() <= capacity) return;
  PrintMessage(kRecordToolName, "warning: " + NumberText(options.rate.Hz(), 4) +
                                    " samples a second are more than the " + NumberText(capacity, 4) +
                                    " that a line of " + std::to_string(options.baud) +
                                    " baud carries; the remaining samples will be lost");
}

Result<int> Record(const RecordPendulumOptions& options, const std::optional<Calibration>& given,
                   const pendulum_logger::Info& info, Logger& logger) {
  RETURN_IF_ERROR(CheckCalibrated(options, given, info));
  WarnOfSlowLine(options);
  RETURN_IF_ERROR(logger.SetRate(options.rate));
  ASSIGN_OR_RETURN(const auto recorded,
                   RecordRun(options, info, given ? given : StoredCalibration(info), stop, logger));
  RETURN_IF_ERROR(SaveRecording(options, recorded));
  const int code = ExitCodeOf(options, recorded);
  if (!options.fit) return code;
  OnSignals(SIG_DFL);
  return Fit(*options.fit).map([code](int fit) { return fit != 0 ? fit : code; });
}

/// Prints the mean of one second of readings; nothing if readings are missing.
Result<int> PrintCounts(const RecordPendulumOptions& options, const pendulum_logger::Info& info, Logger& logger) {
  constexpr int kDigits = 6;
  RETURN_IF_ERROR(logger.SetRate(options.rate));
  ASSIGN_OR_RETURN(const auto recorded, RecordRun(options, info, std::nullopt, stop, logger));
  if (const int code = ExitCodeOf(options, recorded); code != 0) {
    PrintMessage(kRecordToolName, stop ? "interrupted before one second of readings was complete"
                                       : "samples are missing from the second of readings; try again");
    return code;
  }
  double sum = 0;
  for (std::size_t i = 0; i < recorded.run.size(); ++i) sum += recorded.run.Counts(i);
  const std::string mean = NumberText(sum / static_cast<double>(recorded.run.size()), kDigits) + "\n";
  return WriteOutputs(std::vector<Output>{{"-", mean}}).map([] { return 0; });
}

/// Runs the task with a connected logger.
Result<int> RunTask(const RecordPendulumOptions& options, const std::string& port,
                    const std::optional<Calibration>& given, Logger& logger) {
  auto info = logger.Connect();
  if (!info) return tl::unexpected(info.error());
  if (options.task == RecordTask::kRecord) return Record(options, given, *info, logger);
  if (options.task == RecordTask::kCounts) return PrintCounts(options, *info, logger);
  if (options.task == RecordTask::kStoreCalibration) {
    const auto line = StraightLineOf(*given);
    if (!line) return Within("--store_calibration", line.error());
    info = logger.StoreCalibration(*line);
    if (!info) return tl::unexpected(info.error());
  }
  return WriteOutputs(std::vector<Output>{{"-", LoggerText(*info, port)}}).map([] { return 0; });
}

Result<int> Work(const OpenPort& open, const Flags& flags) {
  ASSIGN_OR_RETURN(const auto options, MakeRecordPendulumOptions(flags));
  if (options.task == RecordTask::kList) {
    return WriteOutputs(std::vector<Output>{{"-", PortsText(ListSerialPorts())}}).map([] { return 0; });
  }
  ASSIGN_OR_RETURN(const auto given, ReadGivenCalibration(options));
  if (options.fit) {  // an unreadable rig must be reported before the pendulum swings
    FitPendulumOptions fit = *options.fit;
    RETURN_IF_ERROR(ReadSetup(fit));
  }
  RETURN_IF_ERROR(CheckOut(options));
  ASSIGN_OR_RETURN(const auto port, ChoosePort(options.port));
  OnSignals(Stop);
  ASSIGN_OR_RETURN(const auto opened, open(port, options.baud));
  Logger logger(*opened, stop);
  auto code = RunTask(options, port, given, logger);
  if (!code && code.error().code == StatusCode::kTryAgain && stop) {
    PrintMessage(kRecordToolName, code.error().message());
    return kInterrupted;
  }
  return code;
}

}  // namespace

int RecordPendulum(const OpenPort& open, int argc, char** argv) {
  const auto work = [&](const Flags& flags) { return Work(open, flags); };
  return RunTool(kRecordToolName, __FILE__, kUsage, FlagTable(), work, argc, argv);
}

}  // namespace pendulum
