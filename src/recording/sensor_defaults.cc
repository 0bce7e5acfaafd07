// SPDX-License-Identifier: Apache-2.0
#include "pendulum/recording/sensor_defaults.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string_view>

#include "pendulum/base/physics.h"
#include "pendulum/recording/sensor_statement.h"

namespace pendulum {
namespace {

/// What is assumed of a kind of sensor if nobody states it. All are standard deviations about 0.
struct KindDefaults {
  std::string_view kind, with_article;
  double gain = 0;          ///< Relative.
  double cubic = 0;         ///< Relative to the amplitude of the swing.
  double eccentricity = 0;  ///< rad
  double lag = 0;           ///< s
  double backlash = 0;      ///< rad
  double drift = 0;         ///< Over the recording, in the unit of the readings: rad, rad/s, m/s^2.
};

/// - Potentiometer: data sheets of single-turn potentiometers give an independent linearity of ±1 to ±2 % (Bourns 6639,
///   Vishay 357) and a mechanical backlash of 0.1 deg; a gain from the nominal angle of travel is as good as that. A
///   shaft that is 0.1 mm off the axis of a coupling of 20 mm turns up to 0.25 deg too far. An RC filter or a sum of
///   conversions takes up to 20 ms.
/// - Encoder: the counts of a turn are a whole number, so the gain is exact. A disc or a magnet off the axis remains:
///   optical encoders give ±0.1 deg, magnetic ones (AS5048) ±0.05 deg when centred.
/// - Gyro: the sensitivity of a chip is within ±3 % (MPU-6050, BMI160) or ±1 % (LSM6DS3), its nonlinearity 0.2 %;
///   the usual low pass of 42 Hz delays by 4.8 ms (MPU-6050); the bias changes by 0.05 deg/s in a warm-up of 1 K.
/// - Accelerometer: sensitivity ±3 % and nonlinearity 0.5 % (MPU-6050), delay 4.9 ms at 44 Hz, 1 mg of drift.
/// - Camera: an aspect ratio or a distance to the lens's axis that is wrong by 1 %, and a distortion that grows with
///   the cube of the distance from the middle, 1 % at the edge. Turned by 10 deg at a distance of four lengths, it
///   moves the ends of a swing of 30 deg by 0.5 deg to one side. The lag is half a frame (LagOf).
/// - Any other sensor of an angle: as bad as a potentiometer.
constexpr std::array kDefaults = {
    KindDefaults{"potentiometer", "a potentiometer", 0.01, 0.01, 0.25 * kRadFromDeg, 0.012, 0.05 * kRadFromDeg,
                 0.05 * kRadFromDeg},
    KindDefaults{"encoder", "an encoder", 0, 0, 0.1 * kRadFromDeg, 0.001, 0.02 * kRadFromDeg, 0},
    KindDefaults{"gyro", "a gyro", 0.02, 0.002, 0, 0.005, 0, 0.05 * kRadFromDeg},
    KindDefaults{"accelerometer", "an accelerometer", 0.02, 0.005, 0, 0.005, 0, 0.01},
    KindDefaults{"camera", "a camera", 0.01, 0.01, 0.5 * kRadFromDeg, 0, 0, 0},
    KindDefaults{"angle sensor", "an angle sensor", 0.01, 0.01, 0.25 * kRadFromDeg, 0.012, 0.05 * kRadFromDeg,
                 0.05 * kRadFromDeg},
};

// ---- The kind -------------------------------------------------------------------------------------------------------

/// Whether the resolution of an angle is a turn divided as encoders divide it: into a power of 2 from 256, a multiple
/// of 400 (lines in quadrature) or 1440. A step of 1, 2 or 5 units of a decimal place [rad or deg] is a rounding.
bool HasStepsOfEncoder(const Recording& recording) {
  if (recording.quantity != Quantity::kAngle || recording.calibration || !(recording.resolution > 0)) return false;
  if (recording.unit != "rad" && recording.unit != "deg") return false;
  constexpr double kAlike = 1e-4, kFewest = 256, kMost = 1 << 24, kOfLines = 400, kCommon = 1440;
  const double steps = 2 * kPi / recording.resolution;
  const double whole = std::round(steps);
  if (whole < kFewest || whole > kMost || std::abs(steps - whole) > kAlike * std::min(whole, 1 / kAlike)) return false;
  const double in_unit = recording.unit == "deg" ? recording.resolution / kRadFromDeg : recording.resolution;
  const double digits = in_unit / std::pow(10, std::floor(std::log10(in_unit * (1 + kAlike))));
  const auto is_rounding = [&](double digit) { return std::abs(digits - digit) < kAlike * digit; };
  if (std::ranges::any_of(std::array{1.0, 2.0, 5.0}, is_rounding)) return false;
  const double power = std::log2(whole);
  return power == std::round(power) || std::fmod(whole, kOfLines) == 0 || whole == kCommon;
}

bool IsRaw(const Recording& recording) { return recording.unit == "counts" || recording.unit == "volts"; }

// ---- What is assumed ------------------------------------------------------------------------------------------------

/// Half the range of the readings from `from` to `to`, in their unit.
double AmplitudeOf(const Recording& recording, double from, double to) {
  double low = 0, high = 0;
  bool is_first = true;
  for (Eigen::Index i = 0; i < recording.size(); ++i) {
    if (recording.time[i] < from || recording.time[i] > to) continue;
    low = is_first ? recording.value[i] : std::min<double>(low, recording.value[i]);
    high = is_first ? recording.value[i] : std::max<double>(high, recording.value[i]);
    is_first = false;
  }
  return (high - low) / 2;
}

/// The lag of a camera is half a frame, the time for which a frame is exposed or read out.
double LagOf(const KindDefaults& defaults, const Recording& recording) {
  if (defaults.kind != "camera" || recording.size() < 2) return defaults.lag;
  const double span = recording.time[recording.size() - 1] - recording.time[0];
  return 0.5 * span / static_cast<double>(recording.size() - 1);
}

/// The relative error of a clock's rate:
/// - a quartz crystal, of a computer, a phone or an interface: 50 ppm;
/// - a ceramic resonator, of most Arduinos: within 0.5 %, a standard deviation of 0.3 %. It is the clock of stamps in
///   ms or us, and of counts and volts;
/// - times on an exact grid: made by a timer or an interface with a quartz crystal, or counted by a loop that waits for
///   the nominal interval and also works, which takes up to 3 % longer. As a standard deviation 1 %;
/// - a logger whose file has only a rate: such a loop more likely, 3 %;
/// - a camera's frames: a rate of 30000/1001 is often written as 30.
EffectSize ClockOf(const std::string& kind, const Recording& recording) {
  constexpr double kCrystal = 5e-5, kResonator = 3e-3, kGrid = 0.01, kLoop = 0.03, kFrames = 1e-3;
  const TimeSource source = recording.time_source;
  if (source == TimeSource::kMeasured) return {0, "stated with the clock"};
  if (source == TimeSource::kComputer) return {kCrystal, "a computer's clock", true};
  if (kind == "camera") return {kFrames, "a camera's frame rate", true};
  if (source == TimeSource::kGrid) return {kGrid, "times on an exact grid", true};
  if (source == TimeSource::kRate) return {kLoop, "times from a sample rate", true};
  if (source == TimeSource::kDevice || IsRaw(recording)) return {kResonator, "a ceramic resonator", true};
  return {kCrystal, "a quartz crystal", true};
}

/// Counts and volts without a calibration have no angle: what is one in rad is unknown, and the gain has no effect.
void SetAssumed(const KindDefaults& defaults, const Recording& recording, double amplitude, SensorErrors& errors) {
  using enum SensorEffect;
  const std::string source(defaults.with_article);
  const double known = IsRaw(recording) && !recording.is_calibrated() ? 0 : 1;
  errors.Of(kGain) = {known * defaults.gain, source, true};
  errors.Of(kCubic) = {defaults.cubic * amplitude, source, true};
  constexpr double kShareOfPosition = 0.02;  // a coordinate is no angle
  const double eccentricity =
      recording.quantity == Quantity::kPosition ? kShareOfPosition * amplitude : known * defaults.eccentricity;
  errors.Of(kEccentricSine) = errors.Of(kEccentricCosine) = {eccentricity, source, true};
  errors.Of(kLag) = {LagOf(defaults, recording), source, true};
  errors.Of(kBacklash) = {known * defaults.backlash, source, true};
  errors.Of(kDrift) = {known * defaults.drift, source, true};
  errors.Of(kClock) = ClockOf(errors.kind, recording);
}

/// The errors of a calibration's coefficients are counted by themselves. Its points do not deviate from the curve by
/// more than the residual says.
void ApplyCalibration(const Recording& recording, SensorErrors& errors) {
  using enum SensorEffect;
  if (!recording.calibration || recording.calibration->covariance.size() == 0) return;
  const Calibration& calibration = *recording.calibration;
  errors.Of(kGain) = {0, "calibration"};
  if (!calibration.residual_std_dev) return;
  const double residual = *calibration.residual_std_dev * calibration.RadFromUnit();
  for (const SensorEffect effect : {kCubic, kEccentricSine, kEccentricCosine}) {
    if (errors.Of(effect).std_dev > residual) errors.Of(effect) = {residual, "calibration"};
  }
}

/// The error of a stated clock counts already.
void ApplyStatement(const SensorStatement& statement, const Recording& recording, SensorErrors& errors) {
  for (const SensorEffect effect : kSensorEffects) {
    if (effect == SensorEffect::kClock && recording.time_source == TimeSource::kMeasured) continue;
    const auto& stated = statement.std_devs[static_cast<std::size_t>(effect)];
    if (stated) errors.Of(effect) = {*stated, statement.source};
  }
}

}  // namespace

std::string SensorKindOf(const Recording& recording) {
  if (recording.edge || HasStepsOfEncoder(recording)) return "encoder";
  if (recording.quantity == Quantity::kRate) return "gyro";
  if (recording.quantity == Quantity::kAcceleration) return "accelerometer";
  if (recording.quantity == Quantity::kPosition || recording.arc) return "camera";
  return IsRaw(recording) ? "potentiometer" : "angle sensor";
}

SensorErrors SensorErrorsOf(const Recording& recording, double from, double to,
                            const std::optional<SensorStatement>& given) {
  const std::optional<SensorStatement>& statement = given ? given : recording.stated_sensor;
  SensorErrors errors;
  errors.is_kind_assumed = !statement || statement->kind.empty();
  errors.kind = errors.is_kind_assumed ? SensorKindOf(recording) : statement->kind;
  const auto* const defaults = std::ranges::find(kDefaults, errors.kind, &KindDefaults::kind);
  if (defaults != kDefaults.end()) {
    SetAssumed(*defaults, recording, AmplitudeOf(recording, from, to), errors);
    ApplyCalibration(recording, errors);
  } else {  // ideal
    for (EffectSize& size : errors.sizes) size.source = statement->source;
  }
  if (statement) ApplyStatement(*statement, recording, errors);
  return errors;
}

}  // namespace pendulum
