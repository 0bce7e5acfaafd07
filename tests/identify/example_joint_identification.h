// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>

#include "tests/identify/example_identification.h"

namespace pendulum {

/// Inertia from two separate recordings, 0.0789 ± 0.0003 and 0.0791 ± 0.0004 kg m². Expected values: the difference is
/// 0.0002 ± 0.0005, z = 0.4, χ² = 0.16; the mean is 0.0789 + 0.0002 · 9 / 25; its error 0.0003 · 0.0004 / 0.0005; p =
/// erfc(0.4 / √2).
inline SharedParameter ExampleSharedInertia() {
  SharedParameter inertia;
  inertia.name = "inertia";
  inertia.unit = "kg m^2";
  inertia.runs = {{0.0789, 0.0003, -0.4}, {0.0791, 0.0004, 0.4}};
  inertia.mean = 0.078972;
  inertia.std_error = 0.00024;
  inertia.statistic = 0.16;
  inertia.dof = 1;
  inertia.p = 0.6892;
  inertia.scatter = {0.078972, 0.00024, 0.0759, 0.0820, 0, 0, 0.005};
  return inertia;
}

/// All numbers except those of inertia are invented.
inline Homogeneity ExampleHomogeneity() {
  SharedParameter viscous = ExampleSharedInertia();
  viscous.name = "viscous";
  viscous.unit = "N m s/rad";
  viscous.runs = {{0.0025, 0.00025, -4.0}, {0.0045, 0.0005, 4.0}};
  viscous.mean = 0.0029;
  viscous.std_error = 0.000225;
  viscous.statistic = 12.75;
  viscous.p = 0.0003125;
  viscous.scatter = {0.0034, 0.001, -0.0093, 0.0161, 0.00125, 0.0005, 0.0425};
  Homogeneity homogeneity;
  homogeneity.statistic = 1.25;
  homogeneity.dof = 2;
  homogeneity.p = 0.535;
  homogeneity.parameters = {ExampleSharedInertia(), std::move(viscous)};
  homogeneity.amplitudes = {0.25, 0.125};
  homogeneity.amplitude_dependence = {{"inertia", "kg m^2", 0.0125, 0.005, 0.25, 0.0078125, 0.75}};
  homogeneity.verdict = "the recordings agree on inertia, viscous";
  return homogeneity;
}

/// The shared part of a joint fit: the example's fit without its start, zero and samples.
inline FitReport ExampleSharedFit() {
  FitReport whole = ExampleFit();
  whole.reason = "the estimates are within 0.1 standard errors";
  whole.parameters.resize(3);
  whole.covariance_names.resize(2);
  whole.covariance = Eigen::MatrixXd(whole.covariance.topLeftCorner(2, 2));
  whole.identifiability.resize(3);
  whole.warnings.clear();
  return whole;
}

/// The example's recording as run.csv, and a second recording "b c.csv", which begins in motion and has neither closed
/// forms nor constancy.
inline Identification ExampleJointIdentification() {
  Identification report = ExampleIdentification();
  IdentifiedRecording& first = report.recordings.front();
  first.data.path = "run.csv";
  first.own_fits = std::move(report.fits);
  report.fits = {ExampleSharedFit()};
  report.across = {{{"inertia", "viscous", "coulomb"},
                    {0.25, 0.125},
                    {"converged", "not_converged: too few iterations"},
                    ExampleHomogeneity(),
                    false}};
  IdentifiedRecording second = first;
  second.data.path = "b c.csv";
  second.data.used_samples = 901;
  second.data.from = 10.5;
  second.calibration = {{"schema_version", 1}};
  second.warnings.clear();
  second.closed_forms.reset();
  second.no_closed_forms = "only 2 turning points can be located";
  second.checks.clear();
  second.constancy.clear();
  FitReport& fit = second.own_fits.front();
  fit.start = StartKind::kMoving;
  fit.parameters[3] = ExampleParameter(kInitialAngle, "rad", 0.25, 0.0125);
  fit.covariance_names[2] = "initial_angle";
  fit.identifiability[3].parameter = "initial_angle";
  fit.warnings.clear();
  report.recordings.push_back(std::move(second));
  return report;
}

/// Adds the law drag, which did not converge, with the comparison of ExampleComparedIdentification.
inline Identification ExampleComparedJointIdentification() {
  Identification report = ExampleJointIdentification();
  const FitReport drag = ExampleComparedIdentification().fits[1];
  report.fits.push_back(drag);
  report.across.push_back(report.across.front());
  report.across.back().shared = {"inertia", "viscous", "coulomb", "drag"};
  report.comparison = ExampleComparison();
  for (IdentifiedRecording& recording : report.recordings) {
    recording.own_fits.push_back(drag);
    if (!recording.checks.empty()) recording.checks.emplace_back();
    if (!recording.constancy.empty()) recording.constancy.emplace_back();
  }
  return report;
}

/// The example with failed fits, because no joint motion can be computed: it has only the estimates of the separate
/// fits.
inline Identification ExampleFailedJointIdentification() {
  Identification report = ExampleJointIdentification();
  const auto fail = [](FitReport& fit) {
    fit.termination = Termination::kFailed;
    fit.reason = "no joint motion can be computed";
    for (ParameterEstimate& parameter : fit.parameters) {
      parameter.std_error.reset();
      parameter.lower95.reset();
      parameter.upper95.reset();
      parameter.reason = "the fit failed";
    }
    fit.derived.clear();
    fit.covariance_names.clear();
    fit.covariance.resize(0, 0);
    fit.systematic_names.clear();
    fit.systematic_covariance.resize(0, 0);
    fit.std_error_method.clear();
    fit.interval_method.clear();
    fit.noise = {};
    fit.statistics = {};
  };
  fail(report.fits.front());
  for (IdentifiedRecording& recording : report.recordings) fail(recording.own_fits.front());
  return report;
}

}  // namespace pendulum
