// SPDX-License-Identifier: Apache-2.0
#include <iostream>
#include <utility>

#include <pendulum/identify/identify.h>

int main() {
  pendulum::IdentifyOptions options;
  options.models = {"coulomb"};
  const auto rig = pendulum::ReadRig("datasets/recorded_rig.json").value();
  auto recording = pendulum::PrepareFile("datasets/recorded.csv", options, rig).value();
  const auto one = pendulum::IdentifyEach(options, std::move(recording)).front().value();
  for (const auto& parameter : one.fits.front().parameters)
    std::cout << parameter.info.name << ' ' << parameter.estimate << ' ' << parameter.unit << '\n';
}
