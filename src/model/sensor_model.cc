// SPDX-License-Identifier: Apache-2.0
#include "pendulum/model/sensor_model.h"

#include <algorithm>
#include <cmath>

#include "pendulum/base/physics.h"

namespace pendulum {
namespace {

using Response = SensorModel::Response;
using State = std::array<double, SensorModel::kStates>;

/// MODEL.md eq. (14.1): k ω + c.
Response OfScaledRate(const State& state, const double* p) {
  return {p[1] * state[1] + p[0], {0, p[1], 0}, {1, state[1]}};
}

/// MODEL.md eq. (14.2): k (a_t cos ψ + a_r sin ψ) + c with a_t = r α + g sin θ and a_r = r ω² + g cos θ.
Response OfAcceleration(double gravity, const State& state, const double* p) {
  const auto [angle, rate, acceleration] = state;
  const double scale = p[1];
  const double across = std::cos(p[2]);
  const double along = std::sin(p[2]);
  const double radius = p[3];
  const double sine = gravity * std::sin(angle);
  const double cosine = gravity * std::cos(angle);
  const double tangential = radius * acceleration + sine;
  const double radial = radius * rate * rate + cosine;
  const double seen = tangential * across + radial * along;
  return {
      scale * seen + p[0],
      {scale * (cosine * across - sine * along), scale * 2 * radius * rate * along, scale * radius * across},
      {1, seen, scale * (radial * across - tangential * along), scale * (acceleration * across + rate * rate * along)}};
}

/// MODEL.md eq. (14.3): x_P + r sin(θ + z).
Response OfCoordinate(const State& state, const double* p) {
  const double sine = std::sin(state[0] + p[0]);
  const double slope = p[2] * std::cos(state[0] + p[0]);
  return {p[1] + p[2] * sine, {slope, 0, 0}, {slope, 1, sine}};
}

/// MODEL.md eq. (14.4): the direction of a point at r (sin, cos)(θ + z) from the pivot, seen from the reference.
Response OfArc(const SensorModel& sensor, const State& state, const double* p) {
  const double angle = state[0] + p[0];
  const double radius = p[3];
  const double sine = std::sin(angle);
  const double cosine = std::cos(angle);
  const double u = p[1] - sensor.pivot_x + radius * sine;
  const double v = sensor.down * (p[2] - sensor.pivot_y) + radius * cosine;
  const double square = u * u + v * v;
  const double by_u = v / square;
  const double by_v = -u / square;
  const double by_angle = by_u * radius * cosine - by_v * radius * sine;
  const double seen = std::atan2(u, v);
  const double turns = std::round((angle - seen) / (2 * kPi));
  return {seen + 2 * kPi * turns, {by_angle, 0, 0}, {by_angle, by_u, sensor.down * by_v, by_u * sine + by_v * cosine}};
}

}  // namespace

Response SensorModel::At(const State& state, const double* parameters) const {
  switch (kind) {
    case SensorKind::kDirect: break;
    case SensorKind::kScaledRate: return OfScaledRate(state, parameters);
    case SensorKind::kAcceleration: return OfAcceleration(gravity, state, parameters);
    case SensorKind::kCoordinate: return OfCoordinate(state, parameters);
    case SensorKind::kArc: return OfArc(*this, state, parameters);
  }
  return {};
}

std::vector<ParameterInfo> SensorModel::Parameters() const {
  switch (kind) {
    case SensorKind::kDirect: break;
    case SensorKind::kScaledRate: return {kRateBias, kRateScale};
    case SensorKind::kAcceleration: return {kAccelerationBias, kAccelerationScale, kAxis, kRadius};
    case SensorKind::kCoordinate: return {kZeroAngle, kPivotX, kRadius};
    case SensorKind::kArc: return {kZeroAngle, kPivotX, kPivotY, kRadius};
  }
  return {};
}

int SensorModel::size() const { return kind == SensorKind::kDirect ? 1 : static_cast<int>(Parameters().size()); }

bool IsSensorParameter(std::string_view name) {
  constexpr std::array kInfos = {kRateScale, kAccelerationBias, kAccelerationScale, kAxis, kRadius,
                                 kPivotX,    kPivotY,           kHysteresis};
  return std::ranges::find(kInfos, name, &ParameterInfo::name) != kInfos.end();
}

}  // namespace pendulum
