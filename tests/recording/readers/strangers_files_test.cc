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
enum class TimeForm { kNumber, kEpoch, kDays, kClock, kIso, kDotted, kAmPm };

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
    TimeStyle{"Date", 1.0 / 86400, TimeForm::kDays},
    TimeStyle{"Zeit", 1.0 / 86400, TimeForm::kDays},
    TimeStyle{"Timestamp", 1, TimeForm::kClock},
    TimeStyle{"Uhrzeit", 1, TimeForm::kClock},
    TimeStyle{"time", 1, TimeForm::kClock},
    TimeStyle{"timestamp", 1, TimeForm::kIso},
    TimeStyle{"datetime", 1, TimeForm::kIso},
    TimeStyle{"Datum", 1, TimeForm::kDotted},
    TimeStyle{"Zeit", 1, TimeForm::kDotted},
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

/// Text below the table.
constexpr std::array<std::string_view, 6> kFooters = {"",     "", "", "End of measurement\n", "\nMean;0.5\nStd;3.5\n",
                                                      "---\n"};

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
std::string ClockText(double seconds, TimeForm form, bool has_comma) {
  const auto whole = static_cast<long>(std::floor(seconds + 5e-7));
  const long day = whole / 86400, hour = whole / 3600 % 24;
  const double second = seconds - static_cast<double>(whole - whole % 60);
  std::array<char, 64> text{};
  switch (form) {
    case TimeForm::kIso:
      std::snprintf(text.data(), text.size(), "2024-03-%02ld %02ld:%02ld:%09.6f", 1 + day, hour, whole / 60 % 60,
                    second);
      break;
    case TimeForm::kDotted:
      std::snprintf(text.data(), text.size(), "%02ld.03.2024 %02ld:%02ld:%09.6f", 1 + day, hour, whole / 60 % 60,
                    second);
      break;
    case TimeForm::kAmPm:
      std::snprintf(text.data(), text.size(), "%ld:%02ld:%09.6f %s", hour % 12 == 0 ? 12 : hour % 12, whole / 60 % 60,
                    second, hour < 12 ? "AM" : "PM");
      break;
    default: std::snprintf(text.data(), text.size(), "%02ld:%02ld:%09.6f", hour, whole / 60 % 60, second);
  }
  std::string written = text.data();
  if (has_comma) written[written.rfind('.')] = ',';
  return written;
}

/// Where the names of the columns stand.
enum class Header { kPlain, kComment, kNone };

/// How a file is written.
struct FileStyle {
  TimeStyle time;
  ValueStyle value;
  std::string separator, preamble, footer;
  std::string line_end = "\n";
  Header header = Header::kPlain;
  bool has_decimal_comma = false, has_units_row = false, has_rule = false;
  bool has_axes = false;  // A gyro's x, y and z, of which z swings.
  Other first = Other::kNone, last = Other::kNone;
  int time_decimals = 6, value_decimals = 5;
  double begin = 0;   // The first time, s.
  double offset = 0;  // Of a voltage, V.

  double ValuePerSi() const { return has_axes ? 1 : value.per_si; }
  std::string Join(const std::vector<std::string>& fields) const {
    std::string line;
    for (std::size_t i = 0; i < fields.size(); ++i) line += (i == 0 ? "" : separator) + fields[i];
    return line + line_end;
  }
};

double BeginOf(TimeForm form, Random& random) {
  if (form == TimeForm::kEpoch) return 1709308800.25;
  if (form == TimeForm::kDays) return 45352.25 * 86400;
  if (form != TimeForm::kNumber) return Chance(0.3, random) ? 86395.5 : 57871.273;  // The first one passes midnight.
  return Chance(0.3, random) ? Uniform(0, 10, random) : 0;
}

FileStyle PickStyle(Random& random) {
  FileStyle style;
  style.time = Pick(kTimes, random);
  style.value = Pick(kValues, random);
  style.separator = Pick(kSeparators, random);
  style.preamble = Pick(kPreambles, random);
  if (style.preamble == "sep=") style.preamble += style.separator.substr(0, 1) + "\n";
  style.footer = Pick(kFooters, random);
  style.has_decimal_comma = style.separator[0] != ',' && Chance(0.3, random);
  style.has_units_row = Chance(0.1, random);
  style.has_rule = Chance(0.1, random);
  if (Chance(0.2, random)) style.line_end = Chance(0.2, random) ? "\r" : "\r\n";
  if (Chance(0.5, random)) style.first = Pick(kOthers, random);
  style.last = Pick(kOthers, random);
  style.has_axes = style.value.is_gyro && Chance(0.5, random);
  style.begin = BeginOf(style.time.form, random);
  style.offset = Uniform(0, 1, random);
  const bool is_since_1970 = style.time.form == TimeForm::kEpoch;
  style.time_decimals = style.time.per_second == 1 ? 6 : style.time.per_second == 1e3 ? (is_since_1970 ? 2 : 3) : 0;
  if (style.time.form == TimeForm::kDays) style.time_decimals = 10;
  const double per_si = style.value.per_si;
  style.value_decimals = style.value.unit == "counts" ? 0 : per_si >= 1e3 ? 2 : per_si > 1 ? 3 : 5;
  return style;
}

/// Names in a comment, or none at all. Without names the unit of the times is one of s, ms and us, and the unit of the
/// values one that can be seen.
FileStyle PickStyleWithoutHeader(Random& random) {
  FileStyle style = PickStyle(random);
  style.header = Chance(0.5, random) ? Header::kComment : Header::kNone;
  style.has_units_row = style.has_rule = false;
  style.preamble = "";
  if (style.header == Header::kComment) return style;
  style.first = style.last = Other::kNone;
  style.has_axes = false;
  style.value = Chance(0.5, random) ? ValueStyle{"", "rad", 1 / kDeg} : ValueStyle{"", "counts", 1};
  style.value_decimals = style.value.unit == "counts" ? 0 : 3;
  return style;
}

std::string NameOf(Other other) {
  switch (other) {
    case Other::kIndex: return "index";
    case Other::kText: return "comment";
    case Other::kTemperature: return "Temperature (\u00B0C)";
    case Other::kSetpoint: return "angle_setpoint";
    default: return "";
  }
}

std::string FieldOf(Other other, std::size_t row, bool has_decimal_comma, Random& random) {
  switch (other) {
    case Other::kIndex: return std::to_string(row);
    case Other::kText: return row % 7 == 0 ? "ok" : "fine";
    case Other::kTemperature: return Number(Uniform(20.9, 21.1, random), 2, has_decimal_comma);
    case Other::kSetpoint: return Number(0, 1, has_decimal_comma);
    default: return "";
  }
}

/// Removes a unit in brackets from a name and returns it.
std::string CutUnit(std::string& name) {
  const std::size_t bracket = name.find_first_of("([");
  if (bracket == std::string::npos || bracket == 0) return "";
  std::string unit = name.substr(bracket);
  name.resize(name.find_last_not_of(' ', bracket - 1) + 1);
  return unit;
}

std::string HeaderOf(const FileStyle& style) {
  std::vector<std::string> names, units;
  const auto add = [&](std::string name, bool has_unit) {
    units.push_back(has_unit && style.has_units_row ? CutUnit(name) : "");
    names.push_back(std::move(name));
  };
  if (style.first != Other::kNone) add(NameOf(style.first), false);
  add(std::string(style.time.name), true);
  if (style.has_axes) {
    for (const char* axis : {"x", "y", "z"}) add("Rotation " + std::string(axis) + " (rad/s)", false);
  } else {
    add(std::string(style.value.name), true);
  }
  if (style.last != Other::kNone) add(NameOf(style.last), false);
  std::string header = style.preamble;
  if (style.header != Header::kNone) header += (style.header == Header::kComment ? "# " : "") + style.Join(names);
  const bool has_units = std::ranges::any_of(units, [](const std::string& unit) { return !unit.empty(); });
  if (has_units) header += style.Join(units);
  if (style.has_rule) header += "-----------------" + style.line_end;
  return header;
}

/// A file, and what a reader must find in it.
struct StrangersFile {
  std::string text, description;
  std::vector<double> time, value;  // s, from any start; SI, volts or counts.
  double time_step = 0, value_step = 0;
  std::string unit;
};

/// What the sensor shows: rad, rad/s, volts or counts.
double ReadingOf(const FileStyle& style, double angle, double rate, double noise) {
  const double reading = (style.value.unit == "rad/s" ? rate : angle) + noise;
  if (style.value.unit == "volts") return 2.5 + style.offset + 0.6 * reading;
  if (style.value.unit == "counts") return std::round(512 + 200 * reading);
  return reading;
}

StrangersFile FileOf(const FileStyle& style, const Swing& swing, Random& random) {
  StrangersFile file;
  file.unit = style.value.unit;
  std::normal_distribution<double> noise(0, 0.001);
  const bool is_number = style.time.form <= TimeForm::kDays;
  std::string rows;
  for (std::size_t i = 0; i < swing.time.size(); ++i) {
    std::vector<std::string> fields;
    if (style.first != Other::kNone) fields.push_back(FieldOf(style.first, i, style.has_decimal_comma, random));
    const double seconds = style.begin + swing.time[i];
    fields.push_back(is_number ? Number(seconds * style.time.per_second, style.time_decimals, style.has_decimal_comma)
                               : ClockText(seconds, style.time.form, style.has_decimal_comma));
    for (int axis = 0; axis < 2 && style.has_axes; ++axis) {
      fields.push_back(Number(noise(random), 5, style.has_decimal_comma));
    }
    const double reading = ReadingOf(style, swing.angle[i], swing.rate[i], noise(random));
    fields.push_back(Number(reading * style.ValuePerSi(), style.value_decimals, style.has_decimal_comma));
    if (style.last != Other::kNone) fields.push_back(FieldOf(style.last, i, style.has_decimal_comma, random));
    rows += style.Join(fields);
    file.time.push_back(swing.time[i]);
    file.value.push_back(reading);
  }
  const std::string header = HeaderOf(style);
  file.text = header + rows + style.footer;
  if (style.line_end == "\r") std::ranges::replace(file.text, '\n', '\r');
  file.description = header + rows.substr(0, rows.find('\n') + 1);
  file.time_step = std::max(1e-6, std::pow(10, -style.time_decimals) / style.time.per_second);
  file.value_step = std::pow(10, -style.value_decimals) / style.ValuePerSi();
  return file;
}

StrangersFile MakeFile(Random& random) {
  const FileStyle style = Chance(0.2, random) ? PickStyleWithoutHeader(random) : PickStyle(random);
  const double rate = Uniform(25, 120, random);
  return FileOf(style, SimulatedSwing(Uniform(0.2, 1.2, random), rate, Uniform(10, 20, random), Uniform(0, 2, random)),
                random);
}

/// A file that can be read in several ways: two pendulums of the same size side by side, with or without units, or a
/// table without times, or both. Of four successive numbers, two have no times and three have two pendulums.
std::string AmbiguousText(int number, Random& random) {
  const bool has_time = number % 2 == 0, has_two = number % 4 != 3, has_unit = Chance(0.5, random);
  const double rate = Uniform(25, 120, random), amplitude = Uniform(0.3, 0.55, random);
  const Swing one = SimulatedSwing(amplitude, rate, 15, 0), two = SimulatedSwing(amplitude, rate, 15, 0.7);
  FileStyle style;
  style.separator = Pick(kSeparators, random);
  const std::string unit = has_unit ? "_rad" : "";
  const auto row = [&](const std::string& time, const std::string& first, const std::string& second) {
    std::vector<std::string> fields;
    if (has_time) fields.push_back(time);
    fields.push_back(first);
    if (has_two) fields.push_back(second);
    return style.Join(fields);
  };
  std::string text = row("time_s", "upper" + unit, "lower" + unit);
  for (std::size_t i = 0; i < one.time.size(); ++i) {
    text += row(Number(one.time[i], 6, false), Number(one.angle[i], 5, false), Number(two.angle[i], 5, false));
  }
  return text;
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

/// The flags of a refusal, with a rate if it asks for one, of which it cannot give an example.
std::vector<std::string> AnswersTo(const Status& refusal) {
  std::vector<std::string> flags = refusal.try_flags;
  if (refusal.sentence.find("give the rate of the rows") != std::string::npos) flags.push_back("--sample_rate_hz 100");
  return flags;
}

/// Whether flags are examples, because only the user knows the unit or the rate.
bool NeedKnowledge(const std::vector<std::string>& flags) {
  return std::ranges::any_of(flags, [](const std::string& flag) {
    return flag.starts_with("--unit ") || flag.starts_with("--sample_rate_hz ");
  });
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
      for (const Warning& warning : recording->warnings) warnings += MessageText(warning) + "\n";
      std::printf("file %d is read wrongly:\n%s%s", i, file.description.c_str(), warnings.c_str());
      continue;
    }
    const Status& status = recording.error();
    const Result<Recording> again = ParseRecording(file.text, "run.csv", WithFlags({}, AnswersTo(status)));
    const bool is_answer = again && (NeedKnowledge(AnswersTo(status)) || IsRight(*again, file));
    const bool helps = !AnswersTo(status).empty() && is_answer;
    useless += helps ? 0 : 1;
    std::string flags;
    for (const std::string& flag : status.try_flags) flags += " " + flag;
    std::printf("file %d is refused:\n%s%s; try%s%s%s\n", i, file.description.c_str(), status.message().c_str(),
                flags.c_str(), helps ? "" : ", which does not work: ", again ? "" : again.error().message().c_str());
  }
  std::printf("%d of %d files are read, %d wrongly with a warning\n", read, kFiles, warned);
  EXPECT_EQ(wrong, 0);
  EXPECT_EQ(useless, 0);
  EXPECT_LE(warned, kFiles / 1000);
  EXPECT_GE(read, kFiles * 98 / 100);
}

/// All that is missing is said at once, so that the flags of the first refusal are enough.
TEST(StrangersFiles, ThatAreAmbiguousAreRefusedWithFlagsThatWork) {
  Random random(29);
  for (int i = 0; i < 200; ++i) {
    const std::string text = AmbiguousText(i, random);
    const Result<Recording> recording = ParseRecording(text, "run.csv");
    ASSERT_FALSE(recording) << text.substr(0, 200);
    const Result<Recording> again = ParseRecording(text, "run.csv", WithFlags({}, AnswersTo(recording.error())));
    EXPECT_TRUE(again) << text.substr(0, 200) << recording.error().message() << "\n"
                       << (again ? "" : again.error().message());
  }
}

}  // namespace
}  // namespace pendulum::strangers_files_test
