// SPDX-License-Identifier: Apache-2.0
#include "fitting/swing/steady_hold.h"

#include <algorithm>
#include <cmath>

#include <Eigen/QR>

#include "pendulum/recording/window.h"

namespace pendulum {
namespace {

using Eigen::Index;

/// Whether the readings scatter by less than twice the noise, and drift by less than three times the noise.
bool IsSteady(const Eigen::VectorXd& value, double sigma) {
  const Index count = value.size();
  Eigen::MatrixX2d basis(count, 2);
  basis << Eigen::ArrayXd::Ones(count), Eigen::ArrayXd::LinSpaced(count, 0, 1);
  const Eigen::Vector2d line = basis.colPivHouseholderQr().solve(value);
  const double scatter = (value - basis * line).norm() / std::sqrt(static_cast<double>(count));
  return std::abs(line[1]) < 3 * sigma && scatter < 2 * sigma;
}

}  // namespace

std::optional<FreeSwing> WithSteadyHold(const Recording& recording, const FreeSwing& swing, double sigma) {
  if (!(swing.hold_from < swing.hold_to)) return std::nullopt;
  const Result<Recording> held = SelectWindow(recording, swing.hold_from, swing.hold_to);
  if (!held) return std::nullopt;
  for (Index first = 0; held->size() - first >= kMinimumSamples; first += (held->size() - first + 1) / 2) {
    if (!IsSteady(held->value.tail(held->size() - first), sigma)) continue;
    FreeSwing with_hold = swing;
    with_hold.from = held->time[first];
    with_hold.begins = {WindowBegin::Reason::kHeld};
    return with_hold;
  }
  return std::nullopt;
}

}  // namespace pendulum
