// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <iostream>

#include <pendulum/base/version.h>
#include <pendulum/fitting/swing/choose_swings.h>
#include <pendulum/fitting/swing/fit_swing.h>
#include <pendulum/model/motion_model.h>
#include <pendulum/report/text.h>
#include <pendulum/trajectory/synthetic.h>

// Simulates a swing with known parameters, fits it and prints the report. Uses every floor and every library.
int main() {
  const auto model = pendulum::FindMotionModel("coulomb");
  if (!model || pendulum::kVersion != PENDULUM_VERSION) return 1;

  pendulum::SyntheticOptions truth;
  truth.model = *model;
  truth.parameters = {0.05, 0.001, 0.002};
  truth.release_angle = 0.5;
  truth.release_time = 1.0;
  truth.noise = 1e-3;
  const auto recording = pendulum::SimulateRecording(truth);
  if (!recording) return 1;

  const auto swings = pendulum::ChooseSwings(*recording, {});
  if (!swings) return 1;
  const auto result = pendulum::FitSwing(*recording, swings->found.front(), {});
  if (!result || result->fit.termination != pendulum::Termination::kConverged) return 1;
  pendulum::Identification report;
  report.data.samples = recording->size();
  pendulum::SummarizeUsed(result->used, result->swing, report.data);
  report.fits = {result->fit};
  std::cout << pendulum::ToText(report);
  return std::abs(result->fit.Find("inertia")->estimate / 0.05 - 1.0) < 1e-3 ? 0 : 1;
}
