// SPDX-License-Identifier: Apache-2.0
// Every kind of sensor, at sampling rates from 3 to 100 samples a period, with every kind of start, for every law: no
// recording leads to a message about a bug, and a converged fit is right or warns. The test takes every 131st recording
// of the grid, another one on each line. PENDULUM_SENSOR_GRID=1 takes them all, which takes some minutes.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/identify/identify.h"
#include "pendulum/report/json.h"
#include "pendulum/report/text.h"
#include "tests/fitting/fit_support.h"

namespace pendulum::sensor_grid_test {
namespace {

constexpr double kAmplitude = 0.4;  // rad
constexpr double kPeriods = 25;

/// A sensor that a stranger may have. With linear gravity every sensor is proportional to the angle or the rate.
struct GridSensor {
  std::string name;
  Quantity quantity;
  SensorKind kind;
  std::vector<double> parameters;
  double gravity = 0;     // m/s^2, in the readings of an accelerometer
  std::string unit = {};  // if it is not that of the simulation
  double scale = 1;       // readings per rad of a sensor without parameters
  double resolution = 0;
};

const std::vector<GridSensor>& Sensors() {
  using enum SensorKind;
  static const std::vector<GridSensor> sensors = {
      {"angle", Quantity::kAngle, kDirect, {}},
      {"rate", Quantity::kRate, kDirect, {}},
      {"gyro_volts", Quantity::kRate, kScaledRate, {1.65, 0.115}, 0, "volts", 0.115},
      {"volts", Quantity::kAngle, kDirect, {}, 0, "volts", 0.8},
      {"counts", Quantity::kAngle, kDirect, {}, 0, "counts", 650, 1},
      {"px", Quantity::kPosition, kCoordinate, {0.01, 320, 210}, 0, "px", 210},
      {"acceleration", Quantity::kAcceleration, kAcceleration, {0.05, 1.005, 0.02, 0.2}, kStandardGravity, "m/s^2", 5},
      {"linear acceleration", Quantity::kAcceleration, kAcceleration, {0.02, 1.0, 0.02, 0.35}, 0, "m/s^2", 9},
      {"acceleration along", Quantity::kAcceleration, kAcceleration, {0.05, 1, kPi / 2, 0.2}, kStandardGravity},
      {"linear acceleration along", Quantity::kAcceleration, kAcceleration, {0.02, 1, kPi / 2, 0.35}, 0},
      {"x and y", Quantity::kAngle, kArc, {0.01, 0.3, 0.2, 0.4}},
  };
  return sensors;
}

constexpr std::array kSamplesPerPeriod = {3.0, 4.0, 5.0, 5.5, 6.0, 6.6, 8.0, 12.0, 30.0, 100.0};

enum class GridStart { kHeld, kInMotion, kTurningPoint, kPushed };
constexpr std::array kStarts = {GridStart::kHeld, GridStart::kInMotion, GridStart::kTurningPoint, GridStart::kPushed};
constexpr std::array kStartNames = {"held", "in motion", "turning point", "pushed"};

/// One recording of the grid.
struct Case {
  const GridSensor& sensor;
  double per_period;
  GridStart start;
  MotionModel model;
  std::uint64_t seed;

  std::string Name() const {
    return sensor.name + ", " + std::to_string(per_period).substr(0, 4) + " samples a period, " +
           kStartNames[static_cast<std::size_t>(start)] + ", " + std::string(model.name);
  }
  /// Whether the readings are simulated as proportional to angle or rate.
  bool IsDirect() const { return sensor.kind == SensorKind::kDirect || (model.gravity.is_linear() && !IsArc()); }
  bool IsArc() const { return sensor.kind == SensorKind::kArc; }
};

SyntheticOptions Simulation(const Case& c) {
  SyntheticOptions run;
  run.model = c.model;
  run.parameters = TextbookParameters(c.model);
  const double frequency = 1 / std::sqrt(run.parameters[0]);
  const double period = 2 * kPi / frequency;
  run.sample_rate = c.per_period / period;
  run.duration = kPeriods * period;
  run.seed = c.seed;
  run.start = c.start == GridStart::kHeld ? StartKind::kRelease : StartKind::kMoving;
  run.release_angle = kAmplitude;
  run.release_time = 2.3 * period;
  if (c.start == GridStart::kInMotion)
    run.initial_angle = 0.5 * kAmplitude, run.initial_rate = 0.8 * kAmplitude * frequency;
  if (c.start == GridStart::kTurningPoint) run.initial_angle = kAmplitude;
  if (c.start == GridStart::kPushed) run.initial_rate = kAmplitude * frequency;
  run.quantity = c.sensor.quantity;
  double size = c.sensor.quantity == Quantity::kRate ? frequency * kAmplitude : kAmplitude;
  if (!c.IsDirect()) {
    run.sensor.kind = c.sensor.kind;
    run.sensor.gravity = c.sensor.gravity;
    run.sensor_parameters = c.sensor.parameters;
    if (c.sensor.kind == SensorKind::kAcceleration) size = 3;
    if (c.sensor.kind == SensorKind::kCoordinate || c.IsArc()) size = kAmplitude * c.sensor.parameters.back();
    if (c.sensor.kind == SensorKind::kScaledRate) size *= c.sensor.scale;
  } else if (c.sensor.quantity != Quantity::kRate) {
    run.quantity = Quantity::kAngle;
  }
  run.zero = c.sensor.quantity == Quantity::kRate ? 0.02 : 0.012;
  run.noise = 0.004 * size;
  return run;
}

/// The readings before a push: those at rest.
void PrependRest(const Case& c, const SyntheticOptions& run, Recording& recording) {
  SyntheticOptions rest = run;
  rest.model = Must(FindMotionModel("coulomb"));
  rest.parameters = {run.parameters[0], 0, 0.5};  // friction holds it
  rest.initial_angle = 0;
  rest.initial_rate = 1e-6;  // it stops at once
  rest.duration = 2 * c.per_period / run.sample_rate + 9 / run.sample_rate;
  rest.seed = c.seed + 1000;
  if (c.IsArc()) {  // Points at rest determine no circle; angles need none.
    rest.sensor = {};
    rest.sensor_parameters.clear();
    rest.zero = run.sensor_parameters.front();
    rest.noise = run.noise / run.sensor_parameters.back();
  }
  const Recording still = Must(SimulateRecording(rest));
  Eigen::VectorXd value(still.size() + recording.size());
  value << still.value, recording.value;
  recording.value = value;
  recording.time = Eigen::ArrayXd::LinSpaced(value.size(), 0, static_cast<double>(value.size() - 1)) / run.sample_rate;
}

/// The recording of a case, or why there is none: noisy points on a short arc do not determine their pivot.
Result<Recording> Simulated(const Case& c) {
  const SyntheticOptions run = Simulation(c);
  Result<Recording> simulated = SimulateRecording(run);
  if (!simulated) return simulated;
  Recording recording = *std::move(simulated);
  if (c.start == GridStart::kPushed) PrependRest(c, run, recording);
  if (c.IsDirect()) recording.value *= c.sensor.scale;
  if (c.sensor.resolution > 0) recording.value = recording.value.array().round() + 512;
  if (c.IsDirect() && c.sensor.kind == SensorKind::kAcceleration) recording.shows_gravity = c.sensor.gravity > 0;
  recording.quantity = c.sensor.quantity;
  recording.resolution = c.sensor.resolution;
  if (!c.sensor.unit.empty()) recording.unit = c.sensor.unit;
  recording.path = "run.csv";
  return MakeRecording(std::move(recording));
}

// ---- The outcome --------------------------------------------------------------------------------------------------

enum class Outcome { kRight, kWarned, kNotConverged, kRefused };

/// Words of which each refusal has one: what to do.
bool SaysWhatToDo(const std::string& message) {
  constexpr std::array kAdvice = {"--", "choose", "check", "record", "sample faster", "calibrate", "give", "use "};
  return std::ranges::any_of(kAdvice, [&](const char* word) { return message.find(word) != std::string::npos; });
}

Outcome CheckRefusal(const Status& status) {
  EXPECT_TRUE(status.code == StatusCode::kFailedPrecondition || status.code == StatusCode::kDataLoss)
      << status.message();
  EXPECT_THAT(status.message(), testing::Not(testing::HasSubstr("start values")));
  EXPECT_TRUE(SaysWhatToDo(status.message())) << status.message();
  return Outcome::kRefused;
}

bool HasCounting(const std::vector<Warning>& warnings) {
  constexpr std::array<WarningCode, 10> kCounting = {
      "another_minimum", "ambiguous_frequency", "at_bound",   "correlated_residuals",  "lack_of_fit",
      "not_a_pendulum",  "uncertain_stop",      "zero_drift", "larger_motion_outside", "noise_below_resolution"};
  return std::ranges::any_of(
      warnings, [&](const Warning& warning) { return std::ranges::find(kCounting, warning.code) != kCounting.end(); });
}

/// Whether a torque is known in the unit of the restoring torque. Dry friction and drag have the unit of the readings
/// if these are proportional to an unknown angle.
bool IsComparable(const Case& c, const ParameterEstimate& parameter) {
  return parameter.info.name == kInertia.name || parameter.info.name == "viscous" ||
         (parameter.info.name == "coulomb" && (!c.IsDirect() || c.sensor.unit.empty()));
}

/// The largest deviation of inertia and friction from the truth in standard errors.
double LargestDeviation(const Case& c, const FitReport& fit) {
  const SyntheticOptions run = Simulation(c);
  const auto infos = PhysicalParameters(c.model);
  double largest = 0;
  for (std::size_t i = 0; i < infos.size(); ++i) {
    const ParameterEstimate* parameter = fit.Find(infos[i].name);
    if (parameter == nullptr || !IsComparable(c, *parameter) || !parameter->std_error) continue;
    EXPECT_TRUE(std::isfinite(parameter->estimate) && std::isfinite(*parameter->std_error)) << infos[i].name;
    largest = std::max(largest, std::abs(parameter->estimate - run.parameters[i]) / *parameter->std_error);
  }
  return largest;
}

Outcome CheckFit(const Case& c, const Identification& identification) {
  EXPECT_THAT(ToJsonText(identification), testing::Not(testing::ContainsRegex("[^a-z](nan|inf)[^a-z]")));
  EXPECT_THAT(ToText(identification), testing::Not(testing::ContainsRegex("[^a-z](nan|inf)[^a-z]")));
  const FitReport& fit = identification.fits.at(0);
  EXPECT_FALSE(fit.reason.empty());
  if (fit.termination != Termination::kConverged) return Outcome::kNotConverged;
  const double deviation = LargestDeviation(c, fit);
  if (deviation < 5) return Outcome::kRight;
  const bool warns = HasCounting(fit.warnings) || HasCounting(identification.warnings);
  EXPECT_TRUE(warns) << "wrong by " << deviation << " standard errors";
  return Outcome::kWarned;
}

Outcome OutcomeOf(const Case& c) {
  IdentifyOptions options;
  options.models = {std::string(c.model.name)};
  options.fit.model = options.models.front();
  options.fit.threads = 1;
  Result<Recording> recording = Simulated(c);
  if (!recording) return CheckRefusal(recording.error());
  auto prepared = PrepareRecording(*std::move(recording), options, std::nullopt);
  if (!prepared) return CheckRefusal(prepared.error());
  const std::vector<Result<Identification>> runs = IdentifyEach(options, *std::move(prepared));
  return runs.at(0) ? CheckFit(c, *runs[0]) : CheckRefusal(runs[0].error());
}

std::vector<Case> Grid() {
  std::vector<Case> cases;
  for (const GridSensor& sensor : Sensors()) {
    for (const double per_period : kSamplesPerPeriod) {
      for (const GridStart start : kStarts) {
        for (const MotionModel& model : MotionModels()) {
          cases.push_back({sensor, per_period, start, model, 1 + cases.size()});
        }
      }
    }
  }
  return cases;
}

TEST(IdentifyEach, IsRightOrSaysWhatIsWrongForAnySensorRateStartAndLaw) {
  const bool all = std::getenv("PENDULUM_SENSOR_GRID") != nullptr;
  constexpr std::size_t kStride = 131;  // shares no factor with the sizes of the grid
  const std::vector<Case> cases = Grid();
  std::map<Outcome, int> counts;
  for (std::size_t i = 0; i < cases.size(); i += all ? 1 : kStride) {
    SCOPED_TRACE(cases[i].Name());
    const Outcome outcome = OutcomeOf(cases[i]);
    ++counts[outcome];
    if (all) std::cout << cases[i].Name() << ": " << static_cast<int>(outcome) << "\n";
  }
  const int total =
      counts[Outcome::kRight] + counts[Outcome::kWarned] + counts[Outcome::kNotConverged] + counts[Outcome::kRefused];
  RecordProperty("right", counts[Outcome::kRight]);
  RecordProperty("total", total);
  EXPECT_GE(counts[Outcome::kRight], 0.5 * total);  // Of every 131st, 21 of 41 are right, and 8 are refused.
}

}  // namespace
}  // namespace pendulum::sensor_grid_test
