// SPDX-License-Identifier: Apache-2.0
#include <iostream>

#include <pendulum/fitting/fit_swing.h>
#include <pendulum/recording/read_recording.h>

int main() {
  const auto recording = pendulum::ReadRecording("datasets/recorded.csv").value();
  const auto rig = pendulum::ReadRig("datasets/recorded_rig.json").value();
  const auto swings = pendulum::ChooseSwings(recording, {}).value();
  const auto longest = swings.found.at(swings.chosen.front() - 1);
  const auto fitted = pendulum::FitSwing(recording, longest, {.rig = rig}).value();
  for (const auto& one : fitted.fit.parameters)
    std::cout << one.info.name << ' ' << one.estimate << ' ' << one.unit << '\n';
}
