// SPDX-License-Identifier: Apache-2.0
// Shared by the tests of the fit: recordings with known true parameters, and fits that must succeed.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pendulum/base/physics.h"
#include "pendulum/fitting/fit/fit.h"
#include "pendulum/model/friction/registry.h"
#include "pendulum/model/nesting.h"
#include "pendulum/trajectory/synthetic.h"
#include "tests/model/typical_friction.h"

namespace pendulum {

// Rig of the activity "Modeling of a Simple Pendulum" (Control Tutorials for MATLAB and Simulink) and its sensor, as
// published: G = (M + m/2) g l, and the slope of the straight line through the calibration table.
inline constexpr double kTextbookTorque = (0.380 + 0.095 / 2) * 9.81 * 0.43;  // N m
inline constexpr double kCount = 0.1985 * kPi / 180;                          // rad

/// The value; throws with the error's message if there is none.
template <typename T>
T Must(Result<T> result) {
  if (!result) throw std::runtime_error(result.error().message());
  return *std::move(result);
}

/// Inertia and friction of the textbook rig in units of the restoring torque G, for any registered model: I_O 0.079 kg
/// m², b 0.003 N m s/rad, τ_c 0.004 N m, τ_s 0.008 N m, c 0.0005 N m s²/rad². Others are as in TypicalFriction.
inline std::vector<double> TextbookParameters(const MotionModel& model) {
  std::vector<double> parameters = {0.079 / kTextbookTorque};
  FrictionModels::Visit(model.friction, [&]<typename F>() {
    const auto typical = TypicalFriction<F>(0.002);
    for (std::size_t i = 0; i < typical.size(); ++i) {
      const std::string_view name = F::kParameters[i].name;
      const double torque = name == "viscous"    ? 0.003
                            : name == "coulomb"  ? 0.004
                            : name == "drag"     ? 0.0005
                            : name == "stiction" ? 0.008
                                                 : 0.0;
      parameters.push_back(torque > 0 ? torque / kTextbookTorque : typical[i]);
    }
  });
  return parameters;
}

/// Whether a short run hardly determines all parameters of a law. Examples are a friction that differs in slow motion
/// only, or a share by which friction differs between the directions, which acts almost like a shift of the zero. Fits
/// then end at bounds or not identifiable.
inline bool IsHardlyDetermined(const MotionModel& model) {
  return FindOrderedPair(model).larger >= 0 ||
         std::ranges::any_of(PhysicalParameters(model),
                             [](const ParameterInfo& info) { return std::isfinite(info.upper); });
}

/// The textbook rig held at 0.423 rad for 1.9 s, 20 s at 100 Hz; the sensor's zero is 0.012 rad off. No noise.
inline SyntheticOptions TextbookRun(std::string_view model) {
  SyntheticOptions options;
  options.model = Must(FindMotionModel(model));
  options.parameters = TextbookParameters(options.model);
  options.release_angle = 0.423;
  options.release_time = 1.9;
  options.zero = 0.012;
  return options;
}

/// The textbook run for 10 s with noise.
inline SyntheticOptions NoisyRun(std::string_view model = "coulomb", std::uint64_t seed = 1) {
  SyntheticOptions run = TextbookRun(model);
  run.duration = 10;
  run.noise = 0.002;
  run.seed = seed;
  return run;
}

/// A joint that sticks, with an encoder of 4096 counts: released at 1.2 rad, it rests at 20 s of 30. Its stop alone
/// tells of static friction.
inline SyntheticOptions StickingRun(double stribeck_rate, std::uint64_t seed) {
  constexpr double kTorque = 3.708;  // N m
  SyntheticOptions run = TextbookRun("stribeck");
  run.parameters = {0.12 / kTorque, 0.015 / kTorque, 0.03 / kTorque, 0.06 / kTorque, stribeck_rate};
  run.release_angle = 1.2;
  run.release_time = 1.5;
  run.duration = 30;
  run.sample_rate = 200;
  run.resolution = 2 * kPi / 4096;
  run.noise = 0.15 * run.resolution;
  run.seed = seed;
  return run;
}

/// The same pendulum as the textbook's; at the first sample it passes -0.2 rad at 1.5 rad/s.
inline SyntheticOptions MovingRun(std::string_view model) {
  SyntheticOptions options = TextbookRun(model);
  options.start = StartKind::kMoving;
  options.initial_angle = -0.2;
  options.initial_rate = 1.5;
  return options;
}

/// A swing of 0.6 rad for 30 s at 100 Hz, measured by a sensor with some noise.
inline SyntheticOptions MeasuredSwing(Quantity quantity, SensorKind kind, std::vector<double> parameters,
                                      double noise) {
  SyntheticOptions options;
  options.parameters = {1 / 22.0, 0.05 / 22, 0.05 / 22};
  options.start = StartKind::kMoving;
  options.initial_angle = 0.6;
  options.initial_rate = 0;
  options.duration = 30;
  options.quantity = quantity;
  options.sensor.kind = kind;
  if (kind == SensorKind::kAcceleration) options.sensor.gravity = kStandardGravity;
  options.sensor_parameters = std::move(parameters);
  options.noise = noise;
  return options;
}

/// The true parameters of a recording in FitParameters' order.
inline std::vector<double> Truth(const SyntheticOptions& options) {
  std::vector<double> truth = options.parameters;
  if (options.start == StartKind::kRelease) {
    truth.insert(truth.end(), {options.release_angle, options.release_time});
  } else {
    truth.insert(truth.end(), {options.initial_angle, options.initial_rate});
  }
  truth.push_back(options.zero);
  return truth;
}

inline FitOptions ModelOptions(std::string_view model) {
  FitOptions options;
  options.model = model;
  return options;
}

inline FitReport Fit(const Recording& recording, const FitOptions& options) {
  return Must(FitRecording(recording, options));
}

/// Simulates the recording and fits its own model.
inline FitReport FitOwnModel(const SyntheticOptions& options) {
  return Fit(Must(SimulateRecording(options)), ModelOptions(options.model.name));
}

/// (estimate - truth) / std_error of each parameter; NaN without a standard error.
inline std::vector<double> Deviations(const FitReport& report, const std::vector<double>& truth) {
  std::vector<double> deviations;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const ParameterEstimate& parameter = report.parameters.at(i);
    deviations.push_back((parameter.estimate - truth[i]) /
                         parameter.std_error.value_or(std::numeric_limits<double>::quiet_NaN()));
  }
  return deviations;
}

/// Expects every parameter within 4.5 standard errors of the truth. With twelve parameters, a correct fit fails this
/// once in 12 000.
inline void ExpectTruth(const SyntheticOptions& options, const FitReport& fit) {
  ASSERT_EQ(fit.termination, Termination::kConverged) << fit.reason;
  const std::vector<double> truth = TrueParameters(options);
  ASSERT_EQ(fit.parameters.size(), truth.size());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const ParameterEstimate& parameter = fit.parameters[i];
    ASSERT_TRUE(parameter.std_error) << parameter.info.name;
    EXPECT_LE(std::abs(parameter.estimate - truth[i]), 4.5 * *parameter.std_error) << parameter.info.name;
  }
}

/// The names of the attempts that led to the fit.
inline std::vector<std::string> KeptAttempts(const FitReport& fit) {
  std::vector<std::string> names;
  for (const AttemptRecord& attempt : fit.solver.attempts) {
    if (attempt.kept) names.push_back(attempt.name);
  }
  return names;
}

}  // namespace pendulum
