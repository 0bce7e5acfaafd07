// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <limits>
#include <optional>

#include "pendulum/base/physics.h"
#include "pendulum/identify/identification.h"
#include "pendulum/model/friction/registry.h"

namespace pendulum {

/// A parameter in the form of a fit, with numbers in `unit`.
inline ParameterEstimate ExampleParameter(const ParameterInfo& info, std::string_view unit, double estimate,
                                          double std_error) {
  ParameterEstimate parameter;
  parameter.info = info;
  parameter.unit = unit;
  parameter.estimate = estimate;
  parameter.std_error = std_error;
  parameter.lower95 = estimate - 2 * std_error;
  parameter.upper95 = estimate + 2 * std_error;
  return parameter;
}

/// A converged fit of the textbook rig with invented numbers: inertia, viscous friction and release angle are free,
/// coulomb is at its bound, and the zero is fixed. Inertia and viscous friction have a correlation of 0.5.
inline FitReport ExampleFit() {
  FitReport fit;
  fit.model = {"coulomb", "coulomb", Gravity::kSine};
  fit.termination = Termination::kConverged;
  fit.reason = "the last step changed no parameter by more than 0.001 standard errors";
  fit.start = StartKind::kRelease;
  fit.parameters = {ExampleParameter(kInertia, "kg m^2", 0.079, 0.00025),
                    ExampleParameter(kViscous, "N m s/rad", 0.003, 0.0005), ExampleParameter(kCoulomb, "N m", 0, 0),
                    ExampleParameter(kReleaseAngle, "rad", 0.423, 0.0002)};
  fit.parameters[0].systematic.Add(ErrorSource::kRig, 0.001);
  fit.budget = {{ErrorSource::kRig, EvaluationType::kB, "gravity_torque", "stated with the rig", false, 0.01, "N m",
                 (Eigen::VectorXd(5) << 0.001, 0, 0, 0, 0).finished()}};
  ParameterEstimate& coulomb = fit.parameters[2];
  coulomb.std_error.reset();
  coulomb.lower95 = 0;
  coulomb.upper95 = 0.000125;
  coulomb.at_bound = true;
  coulomb.reason = "the estimate is at its lower bound 0";
  ParameterEstimate zero = ExampleParameter(kZeroAngle, "rad", 0.01, 0);
  zero.std_error.reset();
  zero.lower95.reset();
  zero.upper95.reset();
  zero.fixed = true;
  zero.reason = "fixed";
  fit.parameters.push_back(zero);
  fit.derived = {{"natural_frequency", "rad/s", 4.778, 0.0075, 4.763, 4.793}, {"damping_ratio", "1", 0.004}};
  fit.covariance_names = {"inertia", "viscous", "release_angle"};
  fit.covariance = Eigen::Matrix3d{{6.25e-8, 6.25e-8, 0}, {6.25e-8, 2.5e-7, 0}, {0, 0, 4e-8}};
  fit.std_error_method = "sandwich, as the residuals are AR(2)";
  fit.interval_method = "profile likelihood";
  fit.systematic_names = {"inertia"};
  fit.systematic_covariance = Eigen::MatrixXd::Constant(1, 1, 1e-6);
  fit.identifiability = {
      {"inertia", Identifiability::Verdict::kIdentifiable, {}, ""},
      {"viscous", Identifiability::Verdict::kWeakly, {"viscous", "coulomb"}, "let it swing for longer"},
      {"coulomb", Identifiability::Verdict::kWeakly, {}, "let it come to rest"},
      {"release_angle", Identifiability::Verdict::kIdentifiable, {}, ""}};
  fit.noise = {NoiseFamily::kQuantized,
               0.0035,
               0.0001,
               kRadFromDeg / 4,
               12,
               "the residuals are 0.8 resolutions",
               0.125,
               {Autocorrelation::Kind::kAutoregressive, {0.5, 0.1}}};
  fit.statistics = {0.00349, 1234.5, -2457, -2456.875, -2437.5, 1.75, 0.04, 0.25, 1200.25};
  fit.solver = {7, 15, "Convergence. (made up)", {}};
  fit.trace_error = 2e-10;
  fit.warnings = {{"lack_of_fit", "the residuals are not white", "friction may be of another kind"}};
  return fit;
}

/// Five turning points with errors of 0.001 s and 0.002 rad.
inline TurningPointTable ExampleTurningPoints() {
  TurningPointTable table;
  table.noise = 0.0035;
  table.half_period = 0.65;
  table.zero = {0.01, 0.0001};
  const double values[] = {0.4, -0.375, 0.39, -0.365, 0.38};
  for (int i = 0; i < 5; ++i) {
    TurningPoint point;
    point.time = 2.5 + 0.65 * i;
    point.value = values[i];
    point.covariance = Eigen::Vector2d(1e-6, 4e-6).asDiagonal();
    point.continues = i > 0;
    table.points.push_back(point);
  }
  return table;
}

/// Closed forms of these turning points in units of the restoring torque G, with invented numbers.
inline ClosedForms ExampleClosedForms() {
  ClosedForms forms;
  forms.table = ExampleTurningPoints();
  forms.decay = {{0, Estimate{0.0041, 0.0008}, std::nullopt, 0},
                 {1, Estimate{0.0039, 0.0008}, std::nullopt, 0},
                 {2, Estimate{0.0042, 0.0008}, Estimate{0.0041, 0.0008}, 1},
                 {3, std::nullopt, Estimate{0.0039, 0.0008}, 1},
                 {4, std::nullopt, Estimate{0.00415, 0.0004}, 2}};
  LogDecrement linear;
  linear.first = 0;
  linear.periods = 2;
  linear.damped_frequency = {4.75, 0.0025};
  linear.log_decrement = {0.0265, 0.0025};
  linear.damping_ratio = {0.00425, 0.0004};
  linear.natural_frequency = {4.7501, 0.0025};
  linear.inertia = {0.0445, 0.000125};
  linear.viscous = {0.00175, 0.00025};
  linear.corrected_inertia = {0.044, 0.000125};
  forms.linear = linear;
  TurningPointFit decrement;
  decrement.model = {"coulomb", "coulomb", Gravity::kSine};
  decrement.table = forms.table;
  decrement.zero = forms.table.zero;
  decrement.inertia = {0.04375, 0.000125};
  decrement.friction = {{0.0015, 0.00025}, {0.005, 0.0005}};
  decrement.chi_square = 4;
  decrement.freedom = 2;
  forms.decrement = decrement;
  forms.envelopes = {{"viscous", "exponential", 6.5, 4, 0.25}, {"coulomb", "straight line", 40.5, 4, 1e-6}};
  forms.envelope =
      "as exponential (viscous friction alone, p 0.25); not as straight line (coulomb friction alone, p 1e-06)";
  return forms;
}

/// Three rows: one differs, one agrees, and one has no error. Of the overlay only the summary is set.
inline ClosedFormCheck ExampleCheck() {
  ClosedFormCheck check;
  check.rows = {{"inertia_small_angle", "1 / ω_n² of the linear formulas", "kg m^2", 0.0802, 0.0002, 0.079, 0.0001,
                 6.25, false, "finite amplitude: of the fitted model's own trajectory the formula makes 0.0801"},
                {"viscous_log_decrement", "2 ζ / ω_n", "N m s/rad", 0.00306, 0.0005, 0.003, 0.00004, -0.04, true, ""},
                {"inertia_point_mass", "all mass in the bob", "kg m^2", 0.0703, std::nullopt, 0.079, 0.0001,
                 std::nullopt, std::nullopt, "the rig file gives no errors"}};
  check.overlay.summary = "the nonlinear model with the textbook's numbers is further off: 0.02 rad";
  check.summary = "1 of 2 quantities agree";
  return check;
}

/// Halves that agree, and an inertia that depends on amplitude; the windows have no friction. Invented numbers.
inline Constancy ExampleConstancy() {
  Constancy constancy;
  constancy.halves = {{"inertia", "kg m^2", 0.079, 0.0791, 0.00025, 0.0004, 0.25},
                      {"viscous", "N m s/rad", 0.003, 0.0025, 0.0005, 0.00075, -0.5}};
  constancy.halves_statistic = 0.3125;
  constancy.halves_dof = 2;
  constancy.halves_p = 0.875;
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  constancy.windows = {{1.5, 7.5, 0.4, 0.0795, 0.000125, kNone, kNone},
                       {7.5, 13.5, 0.3, 0.079, 0.000125, kNone, kNone},
                       {13.5, 19.5, 0.2, 0.0785, 0.000125, kNone, kNone}};
  constancy.trends = {{"inertia", "kg m^2", 0.0125, 0.0005, 0.0195, 1e-9}};
  constancy.verdict = "inertia falls by 1.9 % from the largest to the smallest swings (p = 1e-09)";
  return constancy;
}

/// The same with a trend that is not significant.
inline Constancy ExampleConstant() {
  Constancy constancy = ExampleConstancy();
  constancy.trends[0].p = 0.5;
  constancy.verdict = "inertia and friction are constants of the recording";
  return constancy;
}

/// The example's fit compared with one that did not converge; invented numbers.
inline Comparison ExampleComparison() {
  Comparison comparison;
  comparison.recommended = "coulomb";
  comparison.reason = "the only one that converged";
  comparison.criterion = "BIC of independent residuals";
  comparison.effective_samples = 1801;
  ComparisonRow coulomb;
  coulomb.model = "coulomb";
  coulomb.judged = true;
  coulomb.parameters = 4;
  coulomb.rms = 0.00349;
  coulomb.log_likelihood = 1234.5;
  coulomb.aic = -2461;
  coulomb.aicc = -2460.75;
  coulomb.bic = -2439;
  coulomb.delta_bic = 0;
  coulomb.akaike_weight = 1;
  coulomb.cross_validation = {0.0035, 1.0125, 1600, ""};
  coulomb.forward = {0.004, 1.125, 720, ""};
  coulomb.lag1_correlation = 0.125;
  coulomb.ljung_box_p = 0.25;
  ComparisonRow drag = coulomb;
  drag.model = "drag";
  drag.judged = false;
  drag.parameters = 5;
  drag.rms = 0.5;
  drag.log_likelihood = drag.aic = drag.aicc = drag.bic = drag.delta_bic = drag.akaike_weight = std::nullopt;
  drag.cross_validation = drag.forward = {0, 0, 0, "the fit did not converge"};
  drag.lack_of_fit = true;
  drag.reason = "100 iterations were not enough";
  comparison.rows = {coulomb, drag};
  comparison.tests = {{"viscous", "coulomb", {"coulomb"}, 812.125, "half χ²(0), half χ²(1)", 1e-10, ""},
                      {"coulomb", "drag", {"drag"}, 0, "", std::nullopt, "drag did not converge"}};
  return comparison;
}

/// A run with a rig whose values have errors, and one warning of the recording.
inline Identification ExampleIdentification() {
  Identification report;
  IdentifiedRecording& recording = report.recordings.emplace_back();
  recording.data.path = "swing.csv";
  recording.data.sha256 = std::string(64, 'a');
  recording.data.samples = 2000;
  recording.data.used_samples = 1801;
  recording.data.from = 1.5;
  recording.data.to = 19.5;
  recording.data.resolution = kRadFromDeg / 4;
  recording.data.resolution_source = "found";
  recording.data.sensor.kind = "potentiometer";
  recording.data.sensor.Of(SensorEffect::kGain) = {0.0078125, "calibration"};
  recording.data.sensor.Of(SensorEffect::kLag) = {0.001, "a potentiometer", true};
  recording.data.begins = "held, then released";
  recording.data.ends = "the end of the recording";
  recording.data.releases = {{1.5, 19.5}};
  recording.data.release = 1;
  report.rig = Rig{{1.8, 0.01}, RigValue{0.076, 0.0005}, {}};
  report.rig->source = {{"gravity_torque", {{"value", 1.8}, {"std_dev", 0.01}}},
                        {"inertia", {{"value", 0.076}, {"std_dev", 0.0005}}}};
  report.fits = {ExampleFit()};
  report.across = {{{"inertia", "viscous", "coulomb"}, {0.25}, {"converged"}, {}, false}};
  recording.sampling = Sampling{100, 0.0002, 1, 0.5, 0.8, 125, 62.5, 194, 20, 12, 0.8, 0.775};
  recording.closed_forms = ExampleClosedForms();
  recording.closed_forms_model = "coulomb";
  recording.checks = {ExampleCheck()};
  recording.constancy = {ExampleConstant()};
  recording.warnings = {{"gaps", "there is a gap of 0.5 s after 7 s"}};
  return report;
}

/// The same for a gyro without a rig, not converged: no standard errors and no closed forms.
inline Identification ExampleRateIdentification() {
  Identification report = ExampleIdentification();
  report.rig.reset();
  report.unit = "rad/s";
  IdentifiedRecording& recording = report.recordings.front();
  recording.sampling.reset();
  recording.closed_forms.reset();
  recording.no_closed_forms = "only 2 turning points can be located";
  recording.checks.clear();
  recording.constancy.clear();
  recording.data.unit = "rad/s";
  recording.data.resolution = 0;
  recording.data.resolution_source.clear();
  FitReport& fit = report.fits.front();
  fit.quantity = Quantity::kRate;
  fit.reading_unit = "rad/s";
  fit.termination = Termination::kNotConverged;
  fit.reason = "100 iterations were not enough";
  fit.start = StartKind::kMoving;
  fit.parameters = {ExampleParameter(kInertia, "s^2", 0.0439, 0), ExampleParameter(kViscous, "s", 0.0017, 0),
                    ExampleParameter(kCoulomb, "1", 0.0005, 0), ExampleParameter(kRateBias, "rad/s", 0.25, 0)};
  for (ParameterEstimate& parameter : fit.parameters) {
    parameter.std_error.reset();
    parameter.lower95.reset();
    parameter.upper95.reset();
    parameter.reason = "the fit did not converge";
  }
  fit.derived.clear();
  fit.covariance_names.clear();
  fit.covariance.resize(0, 0);
  fit.std_error_method.clear();
  fit.interval_method.clear();
  fit.systematic_names.clear();
  fit.systematic_covariance.resize(0, 0);
  fit.identifiability.clear();
  fit.noise = {NoiseFamily::kGaussian, 0.0035, std::nullopt, 0, 0, "the readings show no discrete levels", 0.125, {}};
  return report;
}

/// The example compared with a fit that did not converge; inertia depends on amplitude.
inline Identification ExampleComparedIdentification() {
  Identification report = ExampleIdentification();
  FitReport drag = ExampleRateIdentification().fits.front();
  drag.model = {"drag", "drag", Gravity::kSine};
  drag.quantity = Quantity::kAngle;
  drag.reading_unit = "rad";
  drag.parameters.resize(1);
  drag.parameters[0].unit = "kg m^2";
  drag.parameters[0].estimate = 0.075;
  report.fits.push_back(drag);
  report.across.push_back({{"inertia", "viscous", "coulomb", "drag"},
                           {0.25},
                           {"not_converged: 100 iterations were not enough"},
                           {},
                           false});
  IdentifiedRecording& recording = report.recordings.front();
  recording.checks.emplace_back();
  recording.constancy = {ExampleConstancy(), Constancy()};
  report.comparison = ExampleComparison();
  return report;
}

}  // namespace pendulum
