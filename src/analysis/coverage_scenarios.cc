// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/coverage_scenarios.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <random>
#include <span>
#include <string_view>
#include <utility>

#include <Eigen/Cholesky>
#include <boost/random/normal_distribution.hpp>
#include <boost/random/uniform_real_distribution.hpp>

#include "pendulum/base/format.h"
#include "pendulum/base/physics.h"
#include "pendulum/fitting/start/sensor_start.h"

namespace pendulum {
namespace {

// The rig of datasets/textbook_rig.json and its sensor: G = (M + m/2) g l, I_O and b as published; dry friction is
// added.
constexpr double kGravityTorque = (0.380 + 0.095 / 2) * 9.81 * 0.43;  // N m
constexpr double kInertiaTruth = 0.079;                               // kg m²
constexpr double kViscousTruth = 0.003;                               // N m s/rad
constexpr double kCoulombTruth = 0.004;                               // N m
constexpr double kCount = 0.1985 * kRadFromDeg;                       // rad

/// Held at 0.423 rad for 1.9 s, then 18 s of swing. The noise is given in counts; the sensor returns whole counts.
CoverageScenario OnCounts(std::string name, std::string description, double noise) {
  CoverageScenario scenario{std::move(name), std::move(description), {}, {}, {}};
  SyntheticOptions& run = scenario.run;
  run.parameters = {kInertiaTruth / kGravityTorque, kViscousTruth / kGravityTorque, kCoulombTruth / kGravityTorque};
  run.release_angle = 0.423;
  run.release_time = 1.9;
  run.zero = 0.012;
  run.noise = noise * kCount;
  run.resolution = kCount;
  scenario.fit.model = std::string(run.model.name);
  scenario.fit.rig = Rig{{kGravityTorque, 0}, std::nullopt, {}};
  return scenario;
}

/// The same with another law of friction, whose parameters are in units of the restoring torque G.
CoverageScenario WithLaw(std::string_view law, std::string description, std::vector<double> friction) {
  CoverageScenario scenario = OnCounts(std::string(law), std::move(description), 0.5);
  scenario.run.model = *FindMotionModel(law);
  scenario.run.parameters.resize(1);
  std::ranges::copy(friction, std::back_inserter(scenario.run.parameters));
  scenario.fit.model = std::string(law);
  return scenario;
}

/// The same with continuous readings instead of counts.
CoverageScenario WithoutCounts(std::string name, std::string description, double noise) {
  CoverageScenario scenario = OnCounts(std::move(name), std::move(description), noise);
  scenario.run.resolution = 0;
  return scenario;
}

/// Noise so small that intervals come from the posterior. They have the right coverage on average over σ, and are too
/// wide without noise.
CoverageScenario AlmostNoNoise(std::string name, std::string description, double noise) {
  CoverageScenario scenario = OnCounts(std::move(name), std::move(description), noise);
  scenario.rule.highest = 1;
  return scenario;
}

/// Rows that are the means of n readings of a converter, spread over the sampling interval. The noise is that of one
/// reading.
CoverageScenario OfMeans(int readings, double noise) {
  const std::string name = "mean_" + std::to_string(readings) + "_" + NumberText(noise);
  CoverageScenario scenario = OnCounts(
      name,
      "means of " + std::to_string(readings) + " readings in counts with noise of " + NumberText(noise) + " count",
      noise);
  scenario.run.oversample = readings;
  scenario.run.averaging_window = 1 / scenario.run.sample_rate;
  return scenario;
}

CoverageScenario ToRest() {
  CoverageScenario scenario = OnCounts("to_rest", "60 s, at rest before the end; noise of 0.25 count on counts", 0.25);
  scenario.run.duration = 60;
  return scenario;
}

/// A duration of 10 s ends before the pendulum comes to rest; the scenario to_rest covers standstill.
CoverageScenario SmallSwing() {
  CoverageScenario scenario = OnCounts("small_swing", "a swing of 5 deg, 10 s; noise of 0.25 count on counts", 0.25);
  scenario.run.release_angle = 5 * kRadFromDeg;
  scenario.run.duration = 10;
  return scenario;
}

CoverageScenario Moving() {
  CoverageScenario scenario =
      OnCounts("moving", "in motion when the recording begins; noise of 0.25 count on counts", 0.25);
  scenario.run.start = StartKind::kMoving;
  scenario.run.initial_angle = -0.2;
  scenario.run.initial_rate = 1.5;
  return scenario;
}

/// The hold at 24.9 deg is within the range. About the first five turning points on the other side are outside it.
CoverageScenario Saturated() {
  CoverageScenario scenario =
      OnCounts("saturated", "readings below -18 deg are cut off; noise of 0.25 count on counts", 0.25);
  constexpr int kLevels = 1024;
  const double low = -18 * kRadFromDeg;
  scenario.run.range = SensorRange{low, low + (kLevels - 1) * kCount};
  return scenario;
}

/// An encoder of 2400 counts per turn, in motion when the recording begins, with one row per count. Its edges have
/// errors of a twentieth of a count. At half the largest rate, the errors of its time stamps have the same effect.
CoverageScenario OnTicks(std::string name, std::string description) {
  CoverageScenario scenario = Moving();
  scenario.name = std::move(name);
  scenario.description = std::move(description);
  SyntheticOptions& run = scenario.run;
  run.rows = RowTiming::kEvents;
  run.resolution = 2 * kPi / 2400;
  run.noise = 0.05 * run.resolution;
  run.time_noise = 1.3e-4;
  run.sample_rate = 1000;
  return scenario;
}

/// A swing of so few counts (8 to either side) that one count lasts long near turning points and near standstill.
CoverageScenario OnFewTicks(std::string name, std::string description) {
  CoverageScenario scenario = OnTicks(std::move(name), std::move(description));
  scenario.run.initial_angle = 0.08;
  scenario.run.initial_rate = 0;
  scenario.run.resolution = 2 * kPi / 600;
  scenario.run.noise = 0.05 * scenario.run.resolution;
  scenario.run.duration = 8;
  return scenario;
}

/// The same encoder with play: its counts change after their edges.
CoverageScenario WithLag(CoverageScenario scenario) {
  scenario.run.hysteresis = 0.35 * scenario.run.resolution;
  return scenario;
}

/// Fixes the lag at 0, which is also assumed for readings at equal intervals.
CoverageScenario WithoutLag(CoverageScenario scenario) {
  scenario.fit.fixed = {{std::string(kHysteresis.name), 0}};
  return scenario;
}

/// The same encoder sampled at equal intervals. An edge error affects all samples of a count, so the errors of samples
/// are not independent. Therefore only the rms errors of this scenario are compared; its intervals have no rule.
CoverageScenario SampledEvenly(CoverageScenario scenario) {
  scenario.run.rows = RowTiming::kEvenFromEncoder;
  scenario.run.time_noise = 0;
  scenario.fit.interval = IntervalMethod::kCovariance;  // a posterior with so many samples takes seconds
  scenario.rule.lowest = 0;
  scenario.rule.highest = 1;
  return scenario;
}

/// A moving start, measured by another sensor with noise `noise`. ScenarioRun draws the sensor's parameters for each
/// recording, within their prior uncertainty.
CoverageScenario WithOtherSensor(std::string name, std::string description, Quantity quantity, SensorKind kind,
                                 std::vector<double> parameters, double noise) {
  CoverageScenario scenario = Moving();
  scenario.name = std::move(name);
  scenario.description = std::move(description);
  SyntheticOptions& run = scenario.run;
  run.initial_angle = 0.5;  // the fit assumes that this side is positive if a sensor does not show the sign
  run.initial_rate = -1.5;
  run.quantity = quantity;
  run.sensor.kind = kind;
  if (kind == SensorKind::kAcceleration) run.sensor.gravity = kStandardGravity;
  run.sensor_parameters = std::move(parameters);
  run.noise = noise;
  run.resolution = 0;
  return scenario;
}

/// Draws the sensor's parameters with the prior uncertainty that the fit assumes.
void DrawSensor(const CoverageScenario& scenario, std::mt19937_64& generator, SyntheticOptions& run) {
  boost::random::normal_distribution<double> draw;
  std::vector<double>& p = run.sensor_parameters;
  if (run.sensor.kind == SensorKind::kAcceleration) {
    p[0] += kAccelerometerBiasStdDev * draw(generator);
    p[1] += kAccelerometerScaleStdDev * draw(generator);
    p[2] += kAccelerometerAxisStdDev * draw(generator);
  }
  if (run.sensor.kind == SensorKind::kCoordinate) p[0] += kCameraLevelStdDev * draw(generator);
  if (run.sensor.kind == SensorKind::kArc) p[0] += kCount * draw(generator);
  if (run.sensor.kind == SensorKind::kScaledRate) p[0] += scenario.run.noise * draw(generator);
}

/// Angles from a potentiometer in degrees per count. Its straight line was fitted to 7 angles over ± 45 deg, each set
/// with an error of 0.27 deg, and is known at 512 counts to 0.1 deg; its slope to 0.3 %.
Calibration PotentiometerLine() {
  constexpr double kCenter = 512, kSlope = 0.1985, kSlopeError = 0.003 * kSlope, kCenterError = 0.1;
  Calibration line;
  line.input = "counts";
  line.angle_unit = "deg";
  line.coefficients = {-kCenter * kSlope, kSlope};
  const double variance = kSlopeError * kSlopeError;
  line.covariance = Eigen::Matrix2d{{kCenterError * kCenterError + kCenter * kCenter * variance, -kCenter * variance},
                                    {-kCenter * variance, variance}};
  return line;
}

enum class Known { kExactly, kWithErrors };

/// A scenario whose rig is known to 0.2 %, whose clock to 0.5 %, a ceramic resonator's tolerance, and whose
/// calibration is PotentiometerLine.
CoverageScenario WithErrors(CoverageScenario scenario, Known rig, Known clock, Known calibration) {
  constexpr double kRigError = 0.002, kClockError = 0.005;
  if (rig == Known::kWithErrors) scenario.fit.rig->gravity_torque.std_dev = kRigError * kGravityTorque;
  if (clock == Known::kWithErrors) scenario.clock_std_dev = kClockError;
  if (calibration == Known::kWithErrors) {
    scenario.calibration = PotentiometerLine();
    scenario.run.resolution = 0;
  }
  scenario.rule.largest_error = kUnbounded;  // the Cramér-Rao bound knows no systematic errors
  return scenario;
}

CoverageScenario WithAllErrors(CoverageScenario scenario) {
  return WithErrors(std::move(scenario), Known::kWithErrors, Known::kWithErrors, Known::kWithErrors);
}

CoverageScenario Named(std::string name, std::string description, CoverageScenario scenario) {
  scenario.name = std::move(name);
  scenario.description = std::move(description);
  return scenario;
}

/// A gyro whose readings are rates; it has no calibration.
CoverageScenario GyroWithErrors() {
  CoverageScenario scenario = WithErrors(Moving(), Known::kWithErrors, Known::kWithErrors, Known::kExactly);
  scenario.run.quantity = Quantity::kRate;
  scenario.run.resolution = 0;
  scenario.run.noise = 0.01;
  return scenario;
}

CoverageScenario Correlated(CoverageScenario scenario, double correlation, double lowest) {
  scenario.run.noise_correlation = correlation;
  scenario.rule.lowest = lowest;
  return scenario;
}

CoverageScenario HeavyTails() {
  CoverageScenario scenario = WithoutCounts(
      "student_3", "Student's t noise of 3 degrees of freedom and scale 0.5 count, without counts; robust loss", 0.5);
  scenario.run.noise_freedom = 3;
  scenario.fit.noise = NoiseFamily::kStudent;
  return scenario;
}

/// Sets `parameter` of SyntheticOptions to 0, its bound.
CoverageScenario Without(std::size_t parameter, std::string name, std::string description) {
  CoverageScenario scenario = OnCounts(std::move(name), std::move(description), 0.5);
  scenario.run.parameters[parameter] = 0;
  return scenario;
}

std::vector<CoverageScenario> ScenariosOfMeans() {
  std::vector<CoverageScenario> scenarios;
  for (const int readings : {4, 16}) {
    for (const double noise : {0.0, 0.05, 0.1, 0.25, 0.5}) scenarios.push_back(OfMeans(readings, noise));
  }
  return scenarios;
}

/// A draw from the normal distribution of mean 0 with this covariance.
Eigen::VectorXd DrawNormal(const Eigen::MatrixXd& covariance, std::mt19937_64& generator) {
  boost::random::normal_distribution<double> draw;
  const Eigen::VectorXd standard =
      Eigen::VectorXd::NullaryExpr(covariance.rows(), [&](Eigen::Index) { return draw(generator); });
  return covariance.llt().matrixL() * standard;
}

/// white_0.5 with a sensor about which only plausible sizes are known: 1 % of gain, a curve bent and eccentric by 0.25
/// deg, a drift of 0.2 deg; or some of these.
CoverageScenario WithSensor(std::string name, std::string description, std::span<const SensorEffect> effects) {
  CoverageScenario scenario = WithoutCounts(std::move(name), std::move(description), 0.5);
  scenario.sensor.kind = "angle sensor";
  for (const SensorEffect effect : effects) {
    const double size = effect == SensorEffect::kGain    ? 0.01
                        : effect == SensorEffect::kDrift ? 0.2 * kRadFromDeg
                                                         : 0.25 * kRadFromDeg;
    scenario.sensor.Of(effect) = {size, "drawn"};
  }
  scenario.count = kCount;
  scenario.rule.largest_error = kUnbounded;  // the Cramér-Rao bound knows no systematic errors
  scenario.rule.highest = 0.99;              // a drawn error that is named is corrected
  return scenario;
}

/// What a sensor makes of the angles of a recording: sizes in the order of kSensorEffects. The curve of a potentiometer
/// or of an eccentric sensor is that of its angle, not one of the fit's polynomials.
Recording ReadBy(Recording recording, const CoverageScenario& scenario, std::span<const double> sizes) {
  const auto size = [&](SensorEffect effect) { return sizes[static_cast<std::size_t>(effect)]; };
  const double amplitude = scenario.run.release_angle;
  const double begin = recording.time[0];
  const double duration = recording.time[recording.size() - 1] - begin;
  for (Eigen::Index i = 0; i < recording.size(); ++i) {
    const double angle = recording.value[i];
    const double cube = std::pow(angle / amplitude, 3);
    const double read = (1 + size(SensorEffect::kGain)) * angle + size(SensorEffect::kCubic) * cube +
                        size(SensorEffect::kEccentricSine) * std::sin(angle) +
                        size(SensorEffect::kEccentricCosine) * (std::cos(angle) - 1) +
                        size(SensorEffect::kDrift) * (recording.time[i] - begin) / duration;
    recording.value[i] = scenario.count * std::round(read / scenario.count);
  }
  recording.resolution = scenario.count;
  recording.sensor_errors = scenario.sensor;
  return recording;
}

constexpr std::array kGainAlone = {SensorEffect::kGain};
constexpr std::array kCurveAlone = {SensorEffect::kCubic, SensorEffect::kEccentricSine, SensorEffect::kEccentricCosine};
constexpr std::array kDriftAlone = {SensorEffect::kDrift};
constexpr std::array kGainCurveAndDrift = {SensorEffect::kGain, SensorEffect::kCubic, SensorEffect::kEccentricSine,
                                           SensorEffect::kEccentricCosine, SensorEffect::kDrift};

}  // namespace

std::vector<CoverageScenario> CoverageScenarios() {
  constexpr double kStrongLowest = 0.91;  // lower limit at a correlation of 0.9: few samples are independent
  std::vector<CoverageScenario> all = {
      OnCounts("white_2.5", "white noise of 2.5 counts on counts", 2.5),
      OnCounts("white_0.5", "white noise of 0.5 count on counts", 0.5),
      OnCounts("white_0.25", "white noise of 0.25 count on counts", 0.25),
      OnCounts("white_0.1", "white noise of 0.1 count on counts", 0.1),
      AlmostNoNoise("white_0.05", "white noise of 0.05 count on counts; intervals may be too wide", 0.05),
      AlmostNoNoise("white_0.02", "white noise of 0.02 count on counts; intervals may be too wide", 0.02),
      AlmostNoNoise("no_noise", "no noise at all: counts only; intervals may be too wide", 0),
      ToRest(),
      SmallSwing(),
      Moving(),
      Saturated(),
      Correlated(WithoutCounts("ar_0.5", "AR(1) noise of 0.5 count, correlation 0.5, without counts", 0.5), 0.5,
                 CoverageRule{}.lowest),
      Correlated(WithoutCounts("ar_0.9", "AR(1) noise of 0.5 count, correlation 0.9, without counts", 0.5), 0.9,
                 kStrongLowest),
      Correlated(OnCounts("ar_0.9_counts", "AR(1) noise of 0.5 count, correlation 0.9, on counts", 0.5), 0.9,
                 kStrongLowest),
      HeavyTails(),
      Without(1, "no_viscous", "b = 0, at its bound; white noise of 0.5 count on counts"),
      Without(2, "no_coulomb", "tau_c = 0, at its bound; white noise of 0.5 count on counts"),
      WithLaw("dahl", "white_0.5; dry friction builds up over 0.5 deg after a reversal",
              {kViscousTruth / kGravityTorque, kCoulombTruth / kGravityTorque, 0.5 * kRadFromDeg}),
      WithLaw("load", "white_0.5; dry friction in proportion to the load",
              {kViscousTruth / kGravityTorque, kCoulombTruth / kGravityTorque}),
      WithOtherSensor("gyro_volts", "a gyro of 0.115 V s/rad with noise of 2 mV, of unknown scale", Quantity::kRate,
                      SensorKind::kScaledRate, {1.65, 0.115}, 0.002),
      WithOtherSensor("acceleration_across",
                      "an accelerometer across the rod, 0.25 m from the pivot; noise of 0.05 m/s^2",
                      Quantity::kAcceleration, SensorKind::kAcceleration, {0, 1, 0, 0.25}, 0.05),
      WithOtherSensor("acceleration_along",
                      "an accelerometer along the rod, 0.25 m from the pivot; noise of 0.05 m/s^2",
                      Quantity::kAcceleration, SensorKind::kAcceleration, {0, 1, kPi / 2, 0.25}, 0.05),
      // In metres, the unit of simulated lengths.
      WithOtherSensor("pixels_x",
                      "the horizontal coordinate of a point, 400 pixels of 1 mm from the pivot; noise of 0.5 pixel",
                      Quantity::kPosition, SensorKind::kCoordinate, {0, 0.64, 0.4}, 0.0005),
      WithOtherSensor("pixels_xy", "both coordinates of the point of pixels_x; noise of 0.5 pixel", Quantity::kAngle,
                      SensorKind::kArc, {0, 0.64, 0.12, 0.4}, 0.0005),
      OnTicks("ticks", "one row per count of an encoder; noise of 0.05 count on edges and 0.13 ms on time stamps"),
      OnFewTicks("few_ticks", "as ticks, with a coarser encoder and a swing of 8 counts to either side"),
      WithLag(OnTicks("lagging_ticks", "the encoder of ticks whose counts change 0.35 of a count behind their edges")),
      WithoutLag(OnTicks("prompt_ticks", "the encoder of ticks, known to have no lag")),
      WithoutLag(OnFewTicks("few_prompt_ticks", "the encoder of few_ticks, known to have no lag")),
      SampledEvenly(OnTicks("ticks_1khz",
                            "the encoder of ticks read at 1 kHz; its errors are compared, its intervals have no rule")),
      SampledEvenly(
          OnFewTicks("few_ticks_1khz",
                     "the encoder of few_ticks read at 1 kHz; its errors are compared, its intervals have no rule")),
      Named("rig_error", "white_0.5; G is known to 0.2 %",
            WithErrors(OnCounts("", "", 0.5), Known::kWithErrors, Known::kExactly, Known::kExactly)),
      Named("clock_error", "white_0.5; the clock is known to 0.5 %",
            WithErrors(OnCounts("", "", 0.5), Known::kExactly, Known::kWithErrors, Known::kExactly)),
      Named("calibration_error", "white_0.5; a calibration line with a slope known to 0.3 %",
            WithErrors(OnCounts("", "", 0.5), Known::kExactly, Known::kExactly, Known::kWithErrors)),
      Named("all_errors", "white_0.5; errors of rig, clock and calibration", WithAllErrors(OnCounts("", "", 0.5))),
      Named("all_errors_to_rest", "to_rest; errors of rig, clock and calibration", WithAllErrors(ToRest())),
      Named("all_errors_moving", "moving; errors of rig, clock and calibration", WithAllErrors(Moving())),
      Named("all_errors_noisy", "white_2.5; errors of rig, clock and calibration",
            WithAllErrors(OnCounts("", "", 2.5))),
      Named("all_errors_gyro", "moving, measured by a gyro; errors of rig and clock", GyroWithErrors()),
      WithSensor("sensor_gain", "white_0.5; a sensor whose gain is wrong by 1 %", kGainAlone),
      WithSensor("sensor_bent", "white_0.5; a sensor that is bent and eccentric by 0.25 deg", kCurveAlone),
      WithSensor("sensor_drift", "white_0.5; a zero that drifts by 0.2 deg", kDriftAlone),
      WithSensor("sensor_all", "white_0.5; gain, curve and drift together", kGainCurveAndDrift),
  };
  std::ranges::move(ScenariosOfMeans(), std::back_inserter(all));
  return all;
}

Result<std::vector<CoverageScenario>> FindCoverageScenarios(const std::string& names) {
  std::vector<CoverageScenario> all = CoverageScenarios();
  if (names == "all") return all;
  std::vector<CoverageScenario> found;
  for (std::size_t begin = 0; begin <= names.size();) {
    const std::size_t end = std::min(names.find(',', begin), names.size());
    const std::string name = names.substr(begin, end - begin);
    const auto scenario = std::ranges::find(all, name, &CoverageScenario::name);
    if (scenario == all.end()) {
      return Error(StatusCode::kInvalidArgument,
                   "there is no scenario '" + name + "'; the scenarios are " + NameList(all) + ", or all");
    }
    if (std::ranges::find(found, name, &CoverageScenario::name) != found.end()) {
      return Error(StatusCode::kInvalidArgument, "scenario " + name + " is named twice");
    }
    found.push_back(*scenario);
    begin = end + 1;
  }
  return found;
}

/// Draws zero and release time uniformly about the scenario's values, so that their positions relative to counts and
/// samples vary.
SyntheticOptions ScenarioRun(const CoverageScenario& scenario, std::uint64_t seed) {
  // The noise uses the generator that starts from `seed`; this one must be independent of it.
  std::mt19937_64 generator(~seed);
  boost::random::uniform_real_distribution<double> draw(-0.5, 0.5);
  SyntheticOptions run = scenario.run;
  run.seed = seed;
  run.zero += kCount * draw(generator);
  run.release_time += draw(generator) / run.sample_rate;
  DrawSensor(scenario, generator, run);
  return run;
}

DrawnErrors DrawErrors(const CoverageScenario& scenario, std::uint64_t seed) {
  std::mt19937_64 generator(~seed ^ 0x9E3779B97F4A7C15);  // independent of the noise and of ScenarioRun
  boost::random::normal_distribution<double> draw;
  DrawnErrors drawn;
  if (const std::optional<Rig>& rig = scenario.fit.rig) {
    drawn.torque += rig->gravity_torque.std_dev / rig->gravity_torque.value * draw(generator);
  }
  drawn.clock += scenario.clock_std_dev * draw(generator);
  if (scenario.calibration) {
    drawn.calibration = scenario.calibration->coefficients;
    Eigen::Map<Eigen::VectorXd>(drawn.calibration.data(), static_cast<Eigen::Index>(drawn.calibration.size())) +=
        DrawNormal(scenario.calibration->covariance, generator);
  }
  if (!scenario.sensor.kind.empty()) {
    for (const EffectSize& size : scenario.sensor.sizes) drawn.sensor.push_back(size.std_dev * draw(generator));
  }
  return drawn;
}

Recording WithErrors(Recording recording, const CoverageScenario& scenario, const DrawnErrors& drawn) {
  recording.time /= drawn.clock;
  recording.clock_scale_std_dev = scenario.clock_std_dev;
  if (!drawn.sensor.empty()) return ReadBy(std::move(recording), scenario, drawn.sensor);
  if (!scenario.calibration) return recording;
  const Calibration& known = *scenario.calibration;
  Calibration true_one = known;
  true_one.coefficients = drawn.calibration;
  constexpr double kMiddle = 512;
  for (double& value : recording.value) value = known.Angle(std::round(true_one.Reading(value, kMiddle)));
  recording.calibration = known;
  recording.unit = known.input;
  recording.resolution = known.Slope(kMiddle);
  return recording;
}

}  // namespace pendulum
