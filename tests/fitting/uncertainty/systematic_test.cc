// SPDX-License-Identifier: Apache-2.0
// Compares systematic errors with fits of the readings for another calibration, clock or rig.
#include "pendulum/fitting/uncertainty/systematic.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <string_view>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/fitting/fitted.h"

namespace pendulum::systematic_test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// The estimates for a recording that depends on a number.
using EstimatesAt = std::function<Eigen::VectorXd(double)>;

Eigen::VectorXd Estimates(const FitReport& report) {
  Eigen::VectorXd estimates(static_cast<Eigen::Index>(report.parameters.size()));
  for (Eigen::Index i = 0; i < estimates.size(); ++i) {
    estimates[i] = report.parameters[static_cast<std::size_t>(i)].estimate;
  }
  return estimates;
}

Eigen::VectorXd Slope(const EstimatesAt& estimates, double at, double step) {
  return (estimates(at + step) - estimates(at - step)) / (2 * step);
}

/// Compares a report's systematic covariance with an expected one over all P parameters, relative to its size.
void ExpectSystematic(const FitReport& report, const Eigen::MatrixXd& expected, double allowed) {
  std::size_t row = 0;
  for (Eigen::Index i = 0; i < expected.rows(); ++i) {
    const ParameterEstimate& parameter = report.parameters[static_cast<std::size_t>(i)];
    SCOPED_TRACE(std::string(parameter.info.name));
    if (expected(i, i) == 0) {
      EXPECT_FALSE(parameter.systematic.Total());
      continue;
    }
    ASSERT_TRUE(parameter.systematic.Total());
    EXPECT_NEAR(*parameter.systematic.Total() / std::sqrt(expected(i, i)), 1, allowed);
    ASSERT_LT(row, report.systematic_names.size());
    EXPECT_EQ(report.systematic_names[row], parameter.info.name);
    std::size_t column = 0;
    for (Eigen::Index j = 0; j < expected.rows(); ++j) {
      if (expected(j, j) == 0) continue;
      const double size = std::sqrt(expected(i, i) * expected(j, j));
      EXPECT_NEAR(report.systematic_covariance(row, column) / size, expected(i, j) / size, allowed) << j;
      ++column;
    }
    ++row;
  }
  EXPECT_EQ(row, report.systematic_names.size());
}

// ---- Calibration ---------------------------------------------------------------------------------------------------

/// The textbook rig's straight line in degrees, or a curve near it, with its uncertainty.
Calibration TextbookCalibration(bool curved) {
  Calibration calibration;
  calibration.input = "counts";
  calibration.angle_unit = "deg";
  calibration.coefficients = {-49.6077, 0.1985};
  calibration.covariance = (Eigen::MatrixXd(2, 2) << 0.25, -8e-4, -8e-4, 4e-6).finished();
  if (!curved) return calibration;
  calibration.coefficients = {-49.6077, 0.190, 3e-5};
  calibration.covariance.conservativeResizeLike(Eigen::MatrixXd::Zero(3, 3));
  calibration.covariance(2, 2) = 1e-11;
  calibration.covariance(1, 2) = calibration.covariance(2, 1) = -4e-9;
  return calibration;
}

/// The short swing in counts for the sensor of that calibration: whole counts, or all digits.
Eigen::VectorXd Counts(const Calibration& calibration, double noise, bool whole) {
  SyntheticOptions run = ShortSwing();
  run.release_angle = 0.7;
  run.noise = noise;
  const Recording recording = Must(SimulateRecording(run));
  Eigen::VectorXd counts = recording.value.unaryExpr([&](double angle) { return calibration.Reading(angle, 250); });
  if (whole) counts = counts.array().round();
  return counts;
}

/// The recording that results from counts and a calibration.
Recording Calibrated(const Calibration& calibration, const Eigen::VectorXd& counts, bool whole) {
  Recording recording = Must(SimulateRecording(ShortSwing()));
  recording.unit = "counts";
  recording.calibration = calibration;
  recording.value = counts.unaryExpr([&](double count) { return calibration.Angle(count); });
  recording.resolution = whole ? calibration.Slope(250) : 0;
  return recording;
}

/// D C D', where D holds the derivatives of the refitted estimates with respect to the coefficients.
Eigen::MatrixXd RefittedCovariance(const Calibration& calibration, const Eigen::VectorXd& counts, bool whole,
                                   const FitOptions& options) {
  const Eigen::Index size = calibration.covariance.rows();
  Eigen::MatrixXd slopes(6, size);
  for (Eigen::Index k = 0; k < size; ++k) {
    const auto estimates = [&](double coefficient) {
      Calibration moved = calibration;
      moved.coefficients[static_cast<std::size_t>(k)] = coefficient;
      return Estimates(Fit(Calibrated(moved, counts, whole), options));
    };
    const double step = 0.3 * std::sqrt(calibration.covariance(k, k));
    slopes.col(k) = Slope(estimates, calibration.coefficients[static_cast<std::size_t>(k)], step);
  }
  return slopes * calibration.covariance * slopes.transpose();
}

TEST(SystematicCovariance, MatchesFitsWithChangedCoefficients) {
  for (const bool curved : {false, true}) {
    SCOPED_TRACE(curved ? "curve" : "line");
    const Calibration calibration = TextbookCalibration(curved);
    const Eigen::VectorXd counts = Counts(calibration, 2e-4, false);
    const FitReport report = Fit(Calibrated(calibration, counts, false), ModelOptions("coulomb"));
    ExpectSystematic(report, RefittedCovariance(calibration, counts, false, ModelOptions("coulomb")), 0.01);
  }
}

TEST(SystematicCovariance, MatchesFitsWithChangedCoefficientsForCounts) {
  const Calibration calibration = TextbookCalibration(false);
  const Eigen::VectorXd counts = Counts(calibration, 0.4 * kCount, true);
  FitOptions options = ModelOptions("coulomb");
  options.noise = NoiseFamily::kQuantized;
  const FitReport report = Fit(Calibrated(calibration, counts, true), options);
  ASSERT_EQ(report.noise.family, NoiseFamily::kQuantized);
  ExpectSystematic(report, RefittedCovariance(calibration, counts, true, options), 0.02);
}

/// For every noise family, an offset of all readings changes only the zero.
TEST(SystematicCovariance, AffectsOnlyTheZeroForAnOffset) {
  Calibration calibration = TextbookCalibration(false);
  calibration.covariance << 0.25, 0, 0, 0;
  const Eigen::VectorXd counts = Counts(calibration, 0.002, false);
  for (const auto family : {NoiseFamily::kGaussian, NoiseFamily::kHuber, NoiseFamily::kStudent}) {
    FitOptions options = ModelOptions("coulomb");
    options.noise = family;
    const FitReport report = Fit(Calibrated(calibration, counts, false), options);
    for (const ParameterEstimate& parameter : report.parameters) {
      const double expected = parameter.info.name == "zero_angle" ? 0.5 * kPi / 180 : 0;
      EXPECT_NEAR(parameter.systematic.Total().value_or(0), expected, 1e-6 * (expected + *parameter.std_error))
          << parameter.info.name;
    }
  }
}

// ---- Clock and rig -------------------------------------------------------------------------------------------------

/// A recording with an uncertain clock scale.
Recording WithClock(Recording recording, double scale) {
  recording.clock_scale = scale;
  recording.clock_scale_std_dev = 2e-3;
  return recording;
}

SyntheticOptions MovingDrag(Quantity quantity) {
  SyntheticOptions run = MovingRun("drag");
  run.quantity = quantity;
  run.initial_angle = 0.8;  // large, because estimates from rates are nearly powers of the scale in small swings
  run.noise = 1e-5;
  for (std::size_t i = 1; i < run.parameters.size(); ++i) run.parameters[i] *= 4;
  return run;
}

TEST(SystematicCovariance, MatchesFitsWithOtherClocks) {
  for (const Quantity quantity : {Quantity::kAngle, Quantity::kRate}) {
    SCOPED_TRACE(quantity == Quantity::kAngle ? "angle" : "rate");
    const Recording recording = Must(SimulateRecording(MovingDrag(quantity)));
    const FitOptions options = ModelOptions("drag");
    const auto estimates = [&](double scale) { return Estimates(Fit(WithClock(recording, scale), options)); };
    const Eigen::VectorXd moved = 2e-3 * Slope(estimates, 1.02, 1e-3);
    const FitReport report = Fit(WithClock(recording, 1.02), options);
    std::size_t row = 0;
    for (Eigen::Index i = 0; i < moved.size(); ++i) {
      const ParameterEstimate& parameter = report.parameters[static_cast<std::size_t>(i)];
      const double expected = moved[i];
      SCOPED_TRACE(std::string(parameter.info.name));
      EXPECT_NEAR(parameter.systematic.Total().value_or(0), std::abs(expected),
                  0.01 * std::abs(expected) + *parameter.std_error);
      if (!parameter.systematic.Total()) continue;
      // Sign relative to the inertia's error, which grows with the scale.
      EXPECT_EQ(std::signbit(report.systematic_covariance(0, row)), std::signbit(expected));
      ++row;
    }
    EXPECT_GE(row, 3);
  }
}

Rig TextbookRig(double std_dev) {
  Rig rig;
  rig.gravity_torque = {kTextbookTorque, std_dev};
  return rig;
}

/// MODEL.md eq. (5.3) with G = 1.803(18) N m and k = 1.02(2): 1 % in G, 2 / 1.02 % in k.
TEST(SystematicCovariance, AddsTheSharesOfRigAndClock) {
  Recording recording = Must(SimulateRecording(ShortSwing()));
  recording.clock_scale = 1.02;
  recording.clock_scale_std_dev = 0.02;
  FitOptions options = ModelOptions("coulomb");
  options.rig = TextbookRig(0.01 * kTextbookTorque);
  const FitReport report = Fit(recording, options);
  const double torque = 0.01;
  const double clock = 0.02 / 1.02;
  const Eigen::Vector3d p = Estimates(report).head(3);
  const Eigen::Vector3d powers(2, 1, 0);  // of time, in I_O, b and τ_c
  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(6, 6);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      expected(i, j) = p[i] * p[j] * (torque * torque + powers[i] * powers[j] * clock * clock);
    }
  }
  ExpectSystematic(report, expected, 1e-12);
  EXPECT_THAT(report.systematic_names, ElementsAre("inertia", "viscous", "coulomb"));
}

double SystematicOf(const FitReport& report, const std::string& name) {
  const auto found = std::ranges::find(report.derived, name, &DerivedQuantity::name);
  return found->systematic.Total().value_or(0) / found->estimate;
}

// Periods have the relative error of the clock and do not depend on G; a decay time likewise, and Q on neither.
TEST(SystematicCovariance, ReachesDerivedQuantities) {
  Recording recording = Must(SimulateRecording(ShortSwing()));
  recording.clock_scale_std_dev = 0.01;
  FitOptions options = ModelOptions("coulomb");
  options.rig = TextbookRig(0.02 * kTextbookTorque);
  const FitReport report = Fit(recording, options);
  EXPECT_NEAR(SystematicOf(report, "small_angle_period"), 0.01, 1e-9);
  EXPECT_NEAR(SystematicOf(report, "decay_time"), 0.01, 1e-9);
  EXPECT_NEAR(SystematicOf(report, "gravity_over_inertia"), 0.02, 1e-9);
  EXPECT_NEAR(SystematicOf(report, "quality_factor"), 0, 1e-9);
}

// A fixed moment of inertia leaves the error of G in the ratio.
TEST(SystematicCovariance, PassesTheErrorOfGToRatiosWithAFixedInertia) {
  FitOptions options = ModelOptions("coulomb");
  options.rig = TextbookRig(0.02 * kTextbookTorque);
  options.fixed["inertia"] = 0.079;
  const FitReport report = Fit(Must(SimulateRecording(ShortSwing())), options);
  EXPECT_NEAR(SystematicOf(report, "gravity_over_inertia"), 0.02, 1e-9);
}

TEST(SystematicCovariance, IsTheSumOfSeveralSources) {
  const Calibration calibration = TextbookCalibration(false);
  const Eigen::VectorXd counts = Counts(calibration, 1e-3, false);
  Recording recording = Calibrated(calibration, counts, false);
  FitOptions options = ModelOptions("coulomb");
  options.rig = TextbookRig(0.02);
  const FitReport calibration_and_rig = Fit(recording, options);
  recording.clock_scale_std_dev = 1e-3;
  const FitReport all = Fit(recording, options);
  recording.calibration->covariance.resize(0, 0);
  const FitReport rig_and_clock = Fit(recording, options);
  recording.clock_scale_std_dev = 0;
  const FitReport rig = Fit(recording, options);
  Eigen::MatrixXd expected = calibration_and_rig.systematic_covariance;
  expected.topLeftCorner(3, 3) += rig_and_clock.systematic_covariance - rig.systematic_covariance;
  EXPECT_LT((all.systematic_covariance - expected).norm(), 1e-12 * expected.norm());
}

TEST(SystematicCovariance, ExcludesFixedParameters) {
  const Calibration calibration = TextbookCalibration(false);
  Recording recording = Calibrated(calibration, Counts(calibration, 1e-3, false), false);
  recording.clock_scale_std_dev = 1e-3;
  FitOptions options = ModelOptions("coulomb");
  options.rig = TextbookRig(0.02);
  options.fixed["viscous"] = 0.012;
  const FitReport report = Fit(recording, options);
  EXPECT_FALSE(report.Find("viscous")->systematic.Total());
  EXPECT_THAT(report.systematic_names,
              ElementsAre("inertia", "coulomb", "release_angle", "release_time", "zero_angle"));
  EXPECT_EQ(report.systematic_covariance.rows(), 5);
}

TEST(SystematicCovariance, IsEmptyWithoutErrors) {
  FitOptions options = ModelOptions("coulomb");
  options.rig = TextbookRig(0);
  const FitReport report = Fit(Must(SimulateRecording(ShortSwing())), options);
  EXPECT_THAT(report.systematic_names, IsEmpty());
  EXPECT_EQ(report.systematic_covariance.size(), 0);
}

}  // namespace
}  // namespace pendulum::systematic_test
