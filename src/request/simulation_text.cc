// SPDX-License-Identifier: Apache-2.0
#include "pendulum/request/simulation_text.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

#include <nlohmann/json.hpp>

#include "pendulum/base/format.h"
#include "pendulum/base/try.h"
#include "pendulum/base/version.h"

namespace pendulum {
namespace {

/// The number of decimals that `value` needs without an exponent.
int Decimals(double value) {
  std::array<char, 512> text{};
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed);
  const char* point = std::find(text.data(), end, '.');
  return point == end ? 0 : static_cast<int>(end - point) - 1;
}

/// The double nearest to `value` rounded to `decimals` (at most 22), so its shortest text has no more decimals.
double RoundedTo(int decimals, double value) {
  constexpr double kMaxExact = 9007199254740992;  // 2^53: larger doubles are farther apart than these decimals
  double power = 1;                               // exact like the numerator, so the quotient is the nearest double
  for (int i = 0; i < decimals; ++i) power *= 10;
  const double numerator = std::round(value * power);
  return std::abs(numerator) < kMaxExact ? numerator / power + 0.0 : value;  // avoids -0
}

/// Converts readings from SI to the file's unit.
class FileUnit {
 public:
  explicit FileUnit(const Simulation& simulation)
      : simulation_(simulation), low_(simulation.range ? simulation.range->low : 0.0) {
    decimals_ = std::max(Decimals(simulation.resolution), Decimals(low_));
  }

  double operator()(double si) const {
    if (simulation_.resolution > 0) return Level(si);
    if (simulation_.range && si == simulation_.synthetic.range->low) return simulation_.range->low;
    if (simulation_.range && si == simulation_.synthetic.range->high) return simulation_.range->high;
    return si / simulation_.unit.si;
  }

 private:
  /// With at most this many decimals a sum of two decimals can be rounded correctly to the last one.
  static constexpr int kMaxDecimals = 10;

  double Level(double si) const {
    const double step = simulation_.resolution / simulation_.synthetic.oversample;
    const double level = std::round((si / simulation_.unit.si - low_) / step);
    const double value = low_ + step * level;
    if (simulation_.synthetic.oversample > 1) return value;
    return decimals_ <= kMaxDecimals ? RoundedTo(decimals_, value) : value;
  }

  const Simulation& simulation_;
  double low_;
  int decimals_;
};

/// The shortest text that reads back exactly, without an exponent for numbers of ordinary size.
void AppendNumber(double value, std::string& text) {
  std::array<char, 32> buffer{};  // 17 digits, sign, point and five zeros; with an exponent at most 24 characters
  const double size = std::abs(value);
  const bool is_plain = size == 0 || (size >= 1e-6 && size < 1e15);
  const auto format = is_plain ? std::chars_format::fixed : std::chars_format::scientific;
  const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value, format);
  text.append(buffer.data(), end);
}

std::string Head(const Simulation& simulation, std::uint64_t seed) {
  const MotionModel& model = simulation.synthetic.model;
  std::string text = "# simulate_pendulum " + std::string(kVersion) + ", model " + std::string(model.name) +
                     ", gravity " + std::string(model.gravity.name()) + ", seed " + std::to_string(seed) + "\n";
  const int oversample = simulation.synthetic.oversample;
  const double resolution = simulation.resolution / oversample;
  if (oversample > 1) {
    const double half = 0.5 * simulation.synthetic.averaging_window;
    text += "# oversample: " + std::to_string(oversample) + "\n";
    if (half > 0) text += "# window_s: " + NumberText(-half) + "," + NumberText(half) + "\n";
    if (half == 0) text += "# window_s: 0\n";
  }
  if (resolution > 0) text += "# resolution: " + NumberText(resolution) + "\n";
  if (simulation.range) {
    text += "# range: " + NumberText(simulation.range->low) + "," + NumberText(simulation.range->high) + "\n";
  }
  text += "# sensor: {\"kind\":\"ideal\"}\n";
  return text + "time_s," + std::string(simulation.unit.column) + "\n";
}

}  // namespace

namespace {

/// The header, and columns in SI next to the times.
std::string Csv(const Simulation& simulation, std::uint64_t seed, const Eigen::VectorXd& time,
                const std::vector<const Eigen::VectorXd*>& columns) {
  constexpr std::size_t kTypicalField = 12;  // bytes
  std::string text = Head(simulation, seed);
  text.reserve(text.size() + kTypicalField * (1 + columns.size()) * static_cast<std::size_t>(time.size()));
  const FileUnit file_unit(simulation);
  for (Eigen::Index i = 0; i < time.size(); ++i) {
    AppendNumber(time[i], text);
    for (const Eigen::VectorXd* column : columns) {
      text += ',';
      AppendNumber(file_unit((*column)[i]), text);
    }
    text += '\n';
  }
  return text;
}

}  // namespace

std::string RecordingCsv(const Simulation& simulation, const Recording& recording, std::uint64_t seed) {
  return Csv(simulation, seed, recording.time, {&recording.value});
}

Result<std::string> SimulatedCsv(const Simulation& simulation, std::uint64_t seed) {
  if (simulation.unit.sensor == SensorKind::kArc) {
    ASSIGN_OR_RETURN(const TrackedPoint point, SimulatePoint(simulation.synthetic));
    return Csv(simulation, seed, point.time, {&point.x, &point.y});
  }
  ASSIGN_OR_RETURN(const Recording recording, SimulateRecording(simulation.synthetic));
  return RecordingCsv(simulation, recording, seed);
}

std::string TruthJson(const Simulation& simulation, std::uint64_t seed) {
  nlohmann::ordered_json json;
  for (const auto& [name, value] : simulation.truth) json[name] = value;
  const std::string unit = "_" + std::string(simulation.unit.si_name);
  json["sigma" + unit] = simulation.synthetic.noise;
  if (simulation.synthetic.noise_correlation != 0) json["noise_correlation"] = simulation.synthetic.noise_correlation;
  if (simulation.synthetic.noise_freedom > 0) json["noise_freedom"] = simulation.synthetic.noise_freedom;
  if (simulation.synthetic.time_noise > 0) json["time_noise_s"] = simulation.synthetic.time_noise;
  json["resolution" + unit] = simulation.synthetic.resolution;
  if (simulation.synthetic.oversample > 1) json["oversample"] = simulation.synthetic.oversample;
  for (const auto& [time, counts] : simulation.synthetic.lost_counts) {
    json["lost_counts"].push_back({{"time_s", time}, {"counts", counts}});
  }
  json["seed"] = seed;
  constexpr int kIndent = 2;
  return json.dump(kIndent) + "\n";
}

}  // namespace pendulum
