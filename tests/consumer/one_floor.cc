// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <vector>

#include <pendulum/model/motion_model.h>
#include <pendulum/trajectory/trajectory.h>

// A small swing without friction, I = 1 s²: half a period, π s, after the release it is on the other side.
int main() {
  const auto model = pendulum::FindMotionModel("linear");
  if (!model) return 1;
  const std::vector<double> frictionless = {1.0, 0.0};
  const pendulum::Start<double> start{pendulum::StartKind::kRelease, 0.0, 0.1, 0.0};
  pendulum::TraceOptions options;
  options.end = 4.0;
  const auto trajectory = pendulum::MakeTrajectory(*model, frictionless, start, options);
  return trajectory && std::abs(trajectory->Angle(std::acos(-1.0)) + 0.1) < 1e-9 ? 0 : 1;
}
