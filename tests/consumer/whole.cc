// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <iostream>
#include <optional>
#include <utility>

#include <pendulum/base/version.h>
#include <pendulum/identify/identify.h>
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
  auto recording = pendulum::SimulateRecording(truth);
  if (!recording) return 1;

  pendulum::IdentifyOptions options;
  options.models = {"coulomb"};
  options.fit.model = "coulomb";
  auto prepared = pendulum::PrepareRecording(*std::move(recording), options, std::nullopt);
  if (!prepared) return 1;
  const auto results = pendulum::IdentifyEach(options, *std::move(prepared));
  if (!results.front()) return 1;
  const pendulum::Identification& result = *results.front();
  const pendulum::FitReport& fit = result.fits.front();
  if (fit.termination != pendulum::Termination::kConverged) return 1;
  std::cout << pendulum::ToText(result);
  return std::abs(fit.Find("inertia")->estimate / 0.05 - 1.0) < 1e-3 ? 0 : 1;
}
