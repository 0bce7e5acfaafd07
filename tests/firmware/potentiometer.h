// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>

#include "pendulum/base/physics.h"
#include "pendulum/recording/calibration/adc.h"

namespace pendulum {

/// A potentiometer connected to a non-ideal converter.
struct PotentiometerOptions {
  AdcSensor sensor{};
  double noise = 0;            ///< Standard deviation at the converter's input, counts.
  double nonlinearity = 0;     ///< Integral nonlinearity: the maximum of a bow, at half scale, in counts.
  double supply_ripple = 0;    ///< Of the supply, relative, at 50 Hz.
  bool is_ratiometric = true;  ///< The reference is the supply, so its ripple cancels.
  std::uint64_t seed = 1;
};

/// The converter's reading of an angle: the sensor's own formula with noise, nonlinearity and ripple before rounding.
class Potentiometer {
 public:
  explicit Potentiometer(const PotentiometerOptions& options) : options_(options), random_(options.seed) {}

  /// Restarts the noise.
  void Reseed(std::uint64_t seed) {
    random_.seed(seed);
    normal_.reset();
  }

  /// angle: rad; time: s.
  int Counts(double angle, double time) {
    constexpr double kMainsHz = 50;
    const AdcSensor& sensor = options_.sensor;
    const double supply = 1 + options_.supply_ripple * std::sin(2 * kPi * kMainsHz * time);
    const double reference = sensor.reference_voltage * (options_.is_ratiometric ? supply : 1);
    const double steps = sensor.FullScale() + 1;
    const double ideal = sensor.Volts(angle / kRadFromDeg) * supply / reference * steps;
    const double share = ideal / steps;
    const double bow = 4 * options_.nonlinearity * share * (1 - share);
    const double noise = options_.noise > 0 ? options_.noise * normal_(random_) : 0;
    return static_cast<int>(std::clamp(std::floor(ideal + bow + noise), 0.0, sensor.FullScale()));
  }

 private:
  PotentiometerOptions options_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
};

}  // namespace pendulum
