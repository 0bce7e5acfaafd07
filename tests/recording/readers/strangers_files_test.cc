// SPDX-License-Identifier: Apache-2.0
/// Files as strangers write them: thousands of combinations of headers, languages, units, separators, lines above the
/// table and stamps. The readings are those of a simulated swing, so the right answer is known.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include <gtest/gtest.h>

#include "pendulum/recording/readers/read_recording.h"

namespace pendulum::strangers_files_test {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kDeg = kPi / 180;

using Random = std::mt19937_64;

/// A random element.
template <typename T, std::size_t N>
const T& Pick(const std::array<T, N>& items, Random& random) {
  return items.at(std::uniform_int_distribution<std::size_t>(0, N - 1)(random));
}

bool Chance(double probability, Random& random) { return std::bernoulli_distribution(probability)(random); }

double Uniform(double low, double high, Random& random) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

/// A free swing: θ'' = -24 sin θ - 0.05 θ' - 0.12 sgn θ' [1/s^2], held for a while, by the classical Runge-Kutta
/// method.
struct Swing {
  std::vector<double> time, angle, rate;  // s, rad, rad/s
};

Swing SimulatedSwing(double amplitude, double rate_hz, double seconds, double hold) {
  constexpr int kSteps = 8;
  const auto acceleration = [](double angle, double rate) {
    const double friction = rate == 0 ? 0 : std::copysign(0.12, rate);
    return -24 * std::sin(angle) - 0.05 * rate - friction;
  };
  Swing swing;
  double angle = amplitude, rate = 0;
  for (int i = 0; static_cast<double>(i) < seconds * rate_hz; ++i) {
    const double time = i / rate_hz;
    swing.time.push_back(time);
    swing.angle.push_back(angle);
    swing.rate.push_back(rate);
    if (time < hold) continue;
    const double h = 1 / rate_hz / kSteps;
    for (int step = 0; step < kSteps; ++step) {
      const double a1 = acceleration(angle, rate), r1 = rate;
      const double a2 = acceleration(angle + h / 2 * r1, rate + h / 2 * a1), r2 = rate + h / 2 * a1;
      const double a3 = acceleration(angle + h / 2 * r2, rate + h / 2 * a2), r3 = rate + h / 2 * a2;
      const double a4 = acceleration(angle + h * r3, rate + h * a3), r4 = rate + h * a3;
      angle += h / 6 * (r1 + 2 * r2 + 2 * r3 + r4);
      rate += h / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
    }
  }
  return swing;
}

/// How a time is named and written.
enum class TimeForm { kNumber, kEpoch, kClock, kIso, kAmPm };

struct TimeStyle {
  std::string_view name;
  double per_second;
  TimeForm form = TimeForm::kNumber;
};

constexpr std::array kTimes = {
    TimeStyle{"t", 1},
    TimeStyle{"time", 1},
    TimeStyle{"Time", 1},
    TimeStyle{"time_s", 1},
    TimeStyle{"t [s]", 1},
    TimeStyle{"t/s", 1},
    TimeStyle{"t / s", 1},
    TimeStyle{"t in s", 1},
    TimeStyle{"Time (s)", 1},
    TimeStyle{"elapsed", 1},
    TimeStyle{"Time_Elapsed(s)", 1},
    TimeStyle{"seconds_elapsed", 1},
    TimeStyle{"Elapsed Time (sec)", 1},
    TimeStyle{"seconds", 1},
    TimeStyle{"Zeit", 1},
    TimeStyle{"Zeit [s]", 1},
    TimeStyle{"Zeit in Sekunden", 1},
    TimeStyle{"Tempo (s)", 1},
    TimeStyle{"Temps", 1},
    TimeStyle{"Tiempo (s)", 1},
    TimeStyle{"tiempo", 1},
    TimeStyle{"czas", 1},
    TimeStyle{"t", 1e3},
    TimeStyle{"Time", 1e3},
    TimeStyle{"timestamp", 1e3},
    TimeStyle{"Time_ms", 1e3},
    TimeStyle{"t [ms]", 1e3},
    TimeStyle{"millis", 1e3},
    TimeStyle{"timeMs", 1e3},
    TimeStyle{"Zeit (ms)", 1e3},
    TimeStyle{"t", 1e6},
    TimeStyle{"micros", 1e6},
    TimeStyle{"time (\u00B5s)", 1e6},
    TimeStyle{"timestamp_us", 1e6},
    TimeStyle{"timestamp", 1, TimeForm::kEpoch},
    TimeStyle{"timestamp", 1e3, TimeForm::kEpoch},
    TimeStyle{"Timestamp", 1, TimeForm::kClock},
    TimeStyle{"Uhrzeit", 1, TimeForm::kClock},
    TimeStyle{"time", 1, TimeForm::kClock},
    TimeStyle{"timestamp", 1, TimeForm::kIso},
    TimeStyle{"datetime", 1, TimeForm::kIso},
    TimeStyle{"Time", 1, TimeForm::kAmPm},
};

/// How a quantity is named, and its unit: reading per rad, rad/s, volt or count.
struct ValueStyle {
  std::string_view name;
  std::string_view unit;  // As in Recording::unit after conversion to SI: rad, rad/s, volts, counts.
  double per_si;
  bool is_gyro = false;  // Has three axes.
};

constexpr std::array kValues = {
    ValueStyle{"angle_deg", "rad", 1 / kDeg},
    ValueStyle{"theta", "rad", 1 / kDeg},
    ValueStyle{"theta", "rad", 1},
    ValueStyle{"theta1_deg", "rad", 1 / kDeg},
    ValueStyle{"phi/deg", "rad", 1 / kDeg},
    ValueStyle{"phi [rad]", "rad", 1},
    ValueStyle{"\u03B8 (\u00B0)", "rad", 1 / kDeg},
    ValueStyle{"\u03C6/rad", "rad", 1},
    ValueStyle{"angle in deg", "rad", 1 / kDeg},
    ValueStyle{"Angle(deg)", "rad", 1 / kDeg},
    ValueStyle{"Angle (degrees)", "rad", 1 / kDeg},
    ValueStyle{"degrees", "rad", 1 / kDeg},
    ValueStyle{"position", "rad", 1 / kDeg},
    ValueStyle{"Position (rad)", "rad", 1},
    ValueStyle{"pitch", "rad", 1 / kDeg},
    ValueStyle{"yaw_deg", "rad", 1 / kDeg},
    ValueStyle{"Winkel", "rad", 1 / kDeg},
    ValueStyle{"Winkel (Grad)", "rad", 1 / kDeg},
    ValueStyle{"Winkel w / rad", "rad", 1},
    ValueStyle{"Angolo (gradi)", "rad", 1 / kDeg},
    ValueStyle{"\u00C1ngulo (grados)", "rad", 1 / kDeg},
    ValueStyle{"angle (mrad)", "rad", 1e3},
    ValueStyle{"angleDeg", "rad", 1 / kDeg},
    ValueStyle{"encoder", "rad", 1 / kDeg},
    ValueStyle{"measurement", "rad", 1 / kDeg},
    ValueStyle{"Voltage (V)", "volts", 1},
    ValueStyle{"Voltage ( V )", "volts", 1},
    ValueStyle{"Spannung U / V", "volts", 1},
    ValueStyle{"CH1 (mV)", "volts", 1e3},
    ValueStyle{"pot_volts", "volts", 1},
    ValueStyle{"counts", "counts", 1},
    ValueStyle{"adc", "counts", 1},
    ValueStyle{"Encoder (counts)", "counts", 1},
    ValueStyle{"gyro_rad_s", "rad/s", 1, true},
    ValueStyle{"Gyroscope (rad/s)", "rad/s", 1, true},
    ValueStyle{"Rotation (deg/s)", "rad/s", 1 / kDeg, true},
    ValueStyle{"omega (rad/s)", "rad/s", 1},
    ValueStyle{"gyro", "rad/s", 1 / kDeg},
    ValueStyle{"Winkelgeschwindigkeit (rad/s)", "rad/s", 1},
    ValueStyle{"Gyro [\u00B0/s]", "rad/s", 1 / kDeg},
};

constexpr std::array<std::string_view, 4> kSeparators = {",", ";", "\t", ", "};

constexpr std::array<std::string_view, 7> kPreambles = {
    "",
    "Pendulum 3\nMeasured by the second group\n",
    "Device: logger\nDate: 2024-03-01 16:04\nSamples: 2000\n\n",
    "# a comment\n",
    "MIN=0\t-2\nMAX=20\t2\nDEC=1\t4\n",
    "sep=",
    "\xEF\xBB\xBF",
};

/// Other columns beside the two that count.
enum class Other { kNone, kIndex, kText, kTemperature, kSetpoint, kEmpty };
constexpr std::array kOthers = {Other::kNone, Other::kNone,        Other::kNone,     Other::kIndex,
                                Other::kText, Other::kTemperature, Other::kSetpoint, Other::kEmpty};

std::string Number(double number, int decimals, bool has_comma) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.*f", decimals, number);
  std::string written = text.data();
  if (has_comma) {
    if (const std::size_t point = written.find('.'); point != std::string::npos) written[point] = ',';
  }
  return written;
}

/// 16:04:31.273, with a date or AM and PM.
std::string ClockText(double seconds, TimeForm form) {
  const auto whole = static_cast<long>(std::floor(seconds + 5e-7));
  const long day = whole / 86400, hour = whole / 3600 % 24;
  const double second = seconds - static_cast<double>(whole - whole % 60);
  std::array<char, 64> text{};
  switch (form) {
    case TimeForm::kIso:
      std::snprintf(text.data(), text.size(), "2024-03-%02ld %02ld:%02ld:%09.6f", 1 + day, hour, whole / 60 % 60,
                    second);
      break;
    case TimeForm::kAmPm:
      std::snprintf(text.data(), text.size(), "%ld:%02ld:%09.6f %s", hour % 12 == 0 ? 12 : hour % 12, whole / 60 % 60,
                    second, hour < 12 ? "AM" : "PM");
      break;
    default: std::snprintf(text.data(), text.size(), "%02ld:%02ld:%09.6f", hour, whole / 60 % 60, second);
  }
  return text.data();
}

/// A file, and what a reader must find in it.
struct StrangersFile {
  std::string text, description;
  std::vector<double> time, value;  // s, from any start; SI, volts or counts.
  double time_step = 0, value_step = 0;
  std::string unit;
};

StrangersFile MakeFile(Random& random) {
  const TimeStyle& time = Pick(kTimes, random);
  const ValueStyle& value = Pick(kValues, random);
  const std::string_view separator = Pick(kSeparators, random);
  const std::string_view preamble = Pick(kPreambles, random);
  const bool has_comma = separator[0] != ',' && Chance(0.3, random);
  const bool has_units_row = Chance(0.1, random), has_rule = Chance(0.1, random), has_cr = Chance(0.2, random);
  const Other first = Chance(0.5, random) ? Pick(kOthers, random) : Other::kNone;
  const Other last = Pick(kOthers, random);
  const bool has_axes = value.is_gyro && Chance(0.5, random);
  const double rate = Uniform(25, 120, random);
  const double offset = Uniform(0, 1, random);
  const Swing swing = SimulatedSwing(Uniform(0.2, 1.2, random), rate, Uniform(10, 20, random), Uniform(0, 2, random));

  // Whole counts for counts; otherwise enough digits.
  const bool is_counts = value.unit == "counts";
  const bool is_volts = value.unit == "volts";
  const int value_decimals = is_counts ? 0 : value.per_si >= 1e3 ? 2 : value.per_si > 1 ? 3 : 5;
  const bool is_since_1970 = time.form == TimeForm::kEpoch;
  const int time_decimals = time.per_second == 1 ? 6 : time.per_second == 1e3 ? (is_since_1970 ? 2 : 3) : 0;
  const double begin = is_since_1970                    ? 1709308800.25
                       : time.form != TimeForm::kNumber ? (Chance(0.3, random) ? 86395.5 : 57871.273)
                       : Chance(0.3, random)            ? Uniform(0, 10, random)
                                                        : 0;

  StrangersFile file;
  file.unit = value.unit;
  const std::string end = has_cr ? "\r\n" : "\n";
  std::vector<std::string> names, units;
  const auto add_name = [&](std::string name, std::string unit) {
    names.push_back(std::move(name));
    units.push_back(std::move(unit));
  };
  const auto add_other = [&](Other other) {
    if (other == Other::kIndex) add_name("index", "");
    if (other == Other::kText) add_name("comment", "");
    if (other == Other::kTemperature) add_name("Temperature (\u00B0C)", "");
    if (other == Other::kSetpoint) add_name("angle_setpoint", "");
    if (other == Other::kEmpty) add_name("", "");
  };
  add_other(first);
  std::string time_name(time.name), value_name(value.name);
  const auto move_unit = [&](std::string& name) {
    const std::size_t bracket = name.find_first_of("([");
    if (!has_units_row || bracket == std::string::npos || bracket == 0) return std::string();
    std::string unit = name.substr(bracket);
    name = name.substr(0, bracket);
    while (name.ends_with(' ')) name.pop_back();
    return unit;
  };
  const std::string time_unit = move_unit(time_name);
  add_name(time_name, time_unit);
  const std::string value_unit = move_unit(value_name);
  for (const char* axis : {" x", " y"}) {
    if (has_axes) add_name("Rotation" + std::string(axis) + " (rad/s)", "");
  }
  std::string own_name = value_name;
  if (has_axes) own_name = "Rotation z (rad/s)";
  const double per_si = has_axes ? 1 : value.per_si;
  add_name(own_name, has_axes ? "" : value_unit);
  add_other(last);

  std::string header;
  const auto add_line = [&](const std::vector<std::string>& fields) {
    for (std::size_t i = 0; i < fields.size(); ++i) header += (i == 0 ? "" : std::string(separator)) + fields[i];
    header += end;
  };
  if (preamble == "sep=") {
    header += "sep=" + std::string(separator.substr(0, 1)) + end;
  } else {
    header += preamble;
  }
  add_line(names);
  if (!time_unit.empty() || (!value_unit.empty() && !has_axes)) add_line(units);
  if (has_rule) header += "-----------------" + end;

  std::normal_distribution<double> noise(0, 1);
  std::string rows;
  for (std::size_t i = 0; i < swing.time.size(); ++i) {
    std::vector<std::string> fields;
    const auto write_other = [&](Other other) {
      if (other == Other::kIndex) fields.push_back(std::to_string(i));
      if (other == Other::kText) fields.emplace_back(i % 7 == 0 ? "ok" : "fine");
      if (other == Other::kTemperature) fields.push_back(Number(21 + 0.01 * noise(random), 2, has_comma));
      if (other == Other::kSetpoint) fields.push_back(Number(0, 1, has_comma));
      if (other == Other::kEmpty) fields.emplace_back();
    };
    write_other(first);
    const double seconds = begin + swing.time[i];
    fields.push_back(time.form == TimeForm::kNumber || is_since_1970
                         ? Number(seconds * time.per_second, time_decimals, has_comma)
                         : ClockText(seconds, time.form));
    const bool is_rate = value.unit == "rad/s";
    double reading = is_rate ? swing.rate[i] : swing.angle[i];
    reading += 0.001 * noise(random);
    if (is_volts) reading = 2.5 + offset + 0.6 * reading;
    if (is_counts) reading = std::round(512 + 200 * reading);
    for (int axis = 0; axis < 2 && has_axes; ++axis) fields.push_back(Number(0.001 * noise(random), 5, has_comma));
    fields.push_back(Number(reading * per_si, value_decimals, has_comma));
    write_other(last);
    for (std::size_t j = 0; j < fields.size(); ++j) rows += (j == 0 ? "" : std::string(separator)) + fields[j];
    rows += end;
    file.time.push_back(swing.time[i]);
    file.value.push_back(reading);
  }
  file.text = header + rows;
  file.description = header + rows.substr(0, rows.find('\n') + 1);
  file.time_step = std::max(1e-6, std::pow(10, -time_decimals) / time.per_second);
  file.value_step = std::pow(10, -value_decimals) / per_si;
  return file;
}

/// Whether a recording has the file's times, from any start, and its values.
bool IsRight(const Recording& recording, const StrangersFile& file) {
  const auto rows = static_cast<Eigen::Index>(file.time.size());
  const bool is_same_unit =
      recording.quantity == (file.unit == "rad/s" ? Quantity::kRate : Quantity::kAngle) &&
      (file.unit == "volts" || file.unit == "counts" ? recording.unit == file.unit : recording.is_calibrated());
  if (recording.size() != rows || !is_same_unit) return false;
  for (Eigen::Index i = 0; i < rows; ++i) {
    const double time = recording.time[i] - recording.time[0];
    if (std::abs(time - file.time[i]) > 2 * file.time_step) return false;
    if (std::abs(recording.value[i] - file.value[i]) > 0.6 * file.value_step) return false;
  }
  return true;
}

/// The options with the flags that an error proposes.
ReadOptions WithFlags(ReadOptions options, const std::vector<std::string>& flags) {
  for (const std::string& flag : flags) {
    const std::size_t blank = flag.find(' ');
    const std::string name = flag.substr(0, blank), value = flag.substr(blank + 1);
    if (name == "--time_column") options.time_column = value;
    if (name == "--value_column") options.value_column = value;
    if (name == "--unit") options.unit = value;
    if (name == "--sample_rate_hz") options.sample_rate_hz = std::stod(value);
  }
  return options;
}

TEST(StrangersFiles, AreReadWithoutFlagsOrSayWhichFlagsWork) {
  constexpr int kFiles = 2400;
  Random random(28);
  int read = 0, wrong = 0, warned = 0, useless = 0;
  for (int i = 0; i < kFiles; ++i) {
    const StrangersFile file = MakeFile(random);
    const Result<Recording> recording = ParseRecording(file.text, "run.csv");
    if (recording) {
      const bool is_right = IsRight(*recording, file);
      read += is_right ? 1 : 0;
      if (is_right) continue;
      warned += recording->warnings.empty() ? 0 : 1;
      wrong += recording->warnings.empty() ? 1 : 0;
      std::string warnings;
      for (const Warning& warning : recording->warnings) warnings += warning.message + "\n";
      std::printf("file %d is read wrongly:\n%s%s", i, file.description.c_str(), warnings.c_str());
      continue;
    }
    const Status& status = recording.error();
    const Result<Recording> again = ParseRecording(file.text, "run.csv", WithFlags({}, status.try_flags));
    const bool helps = !status.try_flags.empty() && again.has_value();
    useless += helps ? 0 : 1;
    std::string flags;
    for (const std::string& flag : status.try_flags) flags += " " + flag;
    std::printf("file %d is refused:\n%s%s; try%s%s%s\n", i, file.description.c_str(), status.message.c_str(),
                flags.c_str(), helps ? "" : ", which does not work: ", again ? "" : again.error().message.c_str());
  }
  std::printf("%d of %d files are read, %d wrongly with a warning\n", read, kFiles, warned);
  EXPECT_EQ(wrong, 0);
  EXPECT_EQ(useless, 0);
  EXPECT_LE(warned, kFiles / 1000);
  EXPECT_GE(read, kFiles * 98 / 100);
}

}  // namespace
}  // namespace pendulum::strangers_files_test
