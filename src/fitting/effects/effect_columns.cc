// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/effects/effect_columns.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>

#include "pendulum/base/physics.h"
#include "pendulum/fitting/effects/torque_response.h"
#include "pendulum/model/friction/registry.h"
#include "pendulum/model/parameter.h"

namespace pendulum {
namespace {

using Eigen::Index, Eigen::VectorXd;

/// The parts of the motion that effects are made of.
struct FittedSwing {
  VectorXd time;            // N, s from the first sample
  VectorXd reading, slope;  // N, the motion as the sensor shows it, without its zero, and its derivative
  VectorXd by_motion;       // N, derivative of the reading with respect to the angle, or to the rate if it shows that
  double release = 0;       // s; 0 for a start in motion
  double stop = 0;          // s
  bool is_held = false;     // the recording begins with a hold
};

bool ShowsRate(const FitProblem& problem) { return problem.data.quantity == Quantity::kRate; }

/// Sets what a sensor shows that is none of the angle or the rate itself: a point seen by a camera, whose reading is an
/// angle or a length, or an accelerometer, of which slope and by_motion are not used.
void SetShown(const FitProblem& problem, const Solution& solution, const MotionStates& states, FittedSwing& swing) {
  const double* const parameters = &solution.parameters[problem.zero()];
  const SensorModel& sensor = problem.data.sensor;
  const double at_rest = sensor.At({0, 0, 0}, parameters).reading;
  for (Index i = 0; i < swing.time.size(); ++i) {
    const SensorModel::Response seen =
        sensor.At({states.value[0][i], states.value[1][i], states.value[2][i]}, parameters);
    swing.reading[i] = seen.reading - at_rest;
    swing.by_motion[i] = seen.by_state[0];
  }
  swing.slope = swing.by_motion.cwiseProduct(states.value[1]);
}

FittedSwing MakeSwing(const FitProblem& problem, const Solution& solution, const MotionStates& states, double stop,
                      const std::vector<Index>& at) {
  FittedSwing swing;
  swing.time = problem.data.times()(at);
  swing.reading = states.value[ShowsRate(problem) ? 1 : 0];
  swing.slope = states.value[ShowsRate(problem) ? 2 : 1];
  swing.by_motion = VectorXd::Ones(swing.time.size());
  swing.stop = stop;
  if (problem.data.sensor.kind != SensorKind::kDirect) SetShown(problem, solution, states, swing);
  return swing;
}

/// Legendre polynomials 0..6 of x, |x| <= 1.
std::array<double, 7> LegendreAt(double x) {
  std::array<double, 7> p{1, x};
  for (std::size_t n = 1; n + 1 < p.size(); ++n) {
    const auto order = static_cast<double>(n);
    p[n + 1] = ((2 * order + 1) * x * p[n] - order * p[n - 1]) / (order + 1);
  }
  return p;
}

/// Appends columns one by one. Which ones does not depend on the samples: a column may be 0 at all of them.
class ColumnWriter {
 public:
  ColumnWriter(Index samples, EffectColumns& to) : to_(to) { to_.columns.resize(samples, 0); }

  void Add(Effect effect, const VectorXd& column) {
    to_.effects.push_back(effect);
    to_.columns.conservativeResize(Eigen::NoChange, to_.columns.cols() + 1);
    to_.columns.rightCols(1) = column;
  }

  /// Of the sensor, if its plausible size is not 0.
  void AddPlausible(Cause cause, double std_dev, const VectorXd& column) {
    if (std_dev > 0) Add({cause, std_dev}, column);
  }

 private:
  EffectColumns& to_;
};

/// A bent curve: the deviation from a line is a sum of Legendre polynomials within the swing. The even ones are those
/// of an eccentric sensor. Of an arc that a turned camera sees, the fitted pivot takes up the bend, which moves the
/// zero by far more than the ends of the swing.
void AddNonlinearity(const SensorErrors& sensor, bool is_arc, const FittedSwing& swing, ColumnWriter& writer) {
  using enum SensorEffect;
  constexpr double kZeroOfArc = 5;  // at a turn of 10 deg and a distance of four radii
  constexpr std::array kOrders = {0, 2, 3, 4, 5, 6};
  constexpr std::array kSizes = {kEccentricCosine, kEccentricCosine, kCubic,
                                 kEccentricSine,   kEccentricSine,   kEccentricSine};
  const double largest = swing.reading.cwiseAbs().maxCoeff();
  Eigen::MatrixXd bends(swing.reading.size(), static_cast<Index>(kSizes.size()));
  for (Index i = 0; i < swing.reading.size(); ++i) {
    const std::array<double, 7> p = LegendreAt(swing.reading[i] / largest);
    for (Index k = 0; k < bends.cols(); ++k) {
      bends(i, k) = p[static_cast<std::size_t>(kOrders[static_cast<std::size_t>(k)])];
    }
  }
  for (std::size_t k = 0; k < kSizes.size(); ++k) {
    const double larger = is_arc && kOrders[k] == 0 ? kZeroOfArc : 1;
    writer.AddPlausible(Cause::kNonlinearity, larger * sensor.Of(kSizes[k]).std_dev, bends.col(static_cast<Index>(k)));
  }
}

/// A linear drift, and one that decays with a fifth of the duration, as of a sensor that becomes warm.
void AddDrift(const SensorErrors& sensor, const FittedSwing& swing, ColumnWriter& writer) {
  constexpr double kWarming = 5;
  const double size = sensor.Of(SensorEffect::kDrift).std_dev;
  const VectorXd share = swing.time / swing.time[swing.time.size() - 1];
  writer.AddPlausible(Cause::kDrift, size, share);
  writer.AddPlausible(Cause::kDrift, size, 1 - (-kWarming * share.array()).exp());
}

/// 1 before the release, 0 after it.
VectorXd Held(const FittedSwing& swing) { return (swing.time.array() < swing.release).cast<double>(); }

/// What a play of this width changes in the readings, over the width: the sensor stays until the pendulum has crossed
/// the gap (the play operator of M. A. Krasnosel'skii and A. V. Pokrovskii, Systems with Hysteresis, 1989). A hold is
/// taken to be in the middle of the gap, a motion at its end. The turning point between two samples is that of a
/// parabola.
VectorXd PlayColumn(const FittedSwing& swing, double width) {
  const double half = width / 2;
  const VectorXd &reading = swing.reading, &slope = swing.slope;
  double shown = reading[0] - (slope[0] > 0 ? half : slope[0] < 0 ? -half : 0);
  const auto follow = [&](double to) { shown = std::clamp(shown, to - half, to + half); };
  VectorXd column(reading.size());
  for (Index i = 0; i < reading.size(); ++i) {
    if (i > 0 && slope[i - 1] * slope[i] < 0) {
      const double share = slope[i - 1] / (slope[i - 1] - slope[i]);  // of the interval, before the turning point
      follow(reading[i - 1] + 0.5 * slope[i - 1] * share * (swing.time[i] - swing.time[i - 1]));
    }
    follow(reading[i]);
    column[i] = (shown - reading[i]) / width;
  }
  return column;
}

void AddSensorEffects(const SensorErrors& sensor, const FitProblem& problem, const FittedSwing& swing, double play,
                      ColumnWriter& writer) {
  writer.AddPlausible(Cause::kGain, sensor.Of(SensorEffect::kGain).std_dev, swing.reading);
  AddNonlinearity(sensor, problem.data.sensor.kind == SensorKind::kArc, swing, writer);
  writer.AddPlausible(Cause::kLag, sensor.Of(SensorEffect::kLag).std_dev, -swing.slope);
  if (!ShowsRate(problem) && problem.zero_motion != ZeroMotion::kLags) {
    const double size = sensor.Of(SensorEffect::kBacklash).std_dev;
    if (size > 0) {
      writer.Add({Cause::kBacklash, size}, PlayColumn(swing, play > 0 ? play : size));
      if (swing.is_held) writer.Add({Cause::kBacklash, size / std::sqrt(12.0)}, Held(swing));
    }
  }
  if (problem.zero_motion != ZeroMotion::kDrifts) AddDrift(sensor, swing, writer);
}

/// The hold at another angle than that of the release, and a hold that creeps.
void AddHold(const FitProblem& problem, const FittedSwing& swing, ColumnWriter& writer) {
  if (ShowsRate(problem) || !swing.is_held || !(swing.release > 0)) return;
  const VectorXd held = Held(swing);
  writer.Add({Cause::kHold}, held);
  writer.Add({Cause::kHold}, held.array() * (swing.time.array() / swing.release - 1));
}

Cause CauseOf(Disturbance disturbance) {
  switch (disturbance) {
    case Disturbance::kDry:
    case Disturbance::kSquare:
    case Disturbance::kNarrowStick:
    case Disturbance::kWideStick:
    case Disturbance::kConstant: return Cause::kFrictionLaw;
    case Disturbance::kSlopedDry:
    case Disturbance::kCurvedDry: return Cause::kPositionFriction;
    case Disturbance::kShortBristle:
    case Disturbance::kLongBristle: return Cause::kPresliding;
    case Disturbance::kPush: return Cause::kPush;
  }
  return Cause::kFrictionLaw;
}

/// Whether the law has a free parameter for the disturbance.
bool HasParameterFor(Disturbance disturbance, const FitProblem& problem) {
  const auto has = [&](const ParameterInfo& info) {
    const std::optional<std::size_t> place = problem.Find(info.name);
    return place && !problem.solve.fixed[*place];
  };
  switch (disturbance) {
    case Disturbance::kDry: return has(kCoulomb);
    case Disturbance::kSquare: return has(kDrag);
    case Disturbance::kNarrowStick:
    case Disturbance::kWideStick: return has(kStiction);
    case Disturbance::kConstant: return has(kAsymmetry) || problem.model.gravity.is_linear();
    case Disturbance::kShortBristle:
    case Disturbance::kLongBristle: return has(kPreslidingAngle);
    default: return false;
  }
}

/// The friction torque of the fitted law at its largest rate, in units of the restoring torque G.
double LargestFriction(const MotionModel& model, std::span<const double> physical, double rate) {
  double torque = 0;
  FrictionModels::Visit(model.friction,
                        [&]<typename F>() { torque = F::template Torque<double>(rate, 1.0, physical.data() + 1); });
  return std::abs(torque);
}

/// Whether the samples show the motion between them: RespondToDisturbances interpolates it.
bool ShowsMotion(const FitProblem& problem, const VectorXd& time) {
  constexpr double kLongest = 0.25;  // periods
  const double period = 2 * kPi / problem.data.natural_frequency;
  return (time.tail(time.size() - 1) - time.head(time.size() - 1)).maxCoeff() <= kLongest * period;
}

void AddDisturbances(const FitProblem& problem, const FittedSwing& swing, const MotionStates& states,
                     std::span<const double> physical, ColumnWriter& writer) {
  constexpr double kUnseenShare = 0.3;
  constexpr double kUnseenPresliding = 1;  // all dry friction builds up after a reversal, from -1 to 1
  if (!ShowsMotion(problem, swing.time)) return;
  const DisturbedMotion disturbed =
      RespondToDisturbances(swing.time, states, swing.release, swing.stop, problem.model, physical);
  const Eigen::MatrixXd& columns = ShowsRate(problem) ? disturbed.rate : disturbed.angle;
  const double friction = LargestFriction(problem.model, physical, states.value[1].cwiseAbs().maxCoeff());
  for (int k = 0; k < kDisturbances; ++k) {
    const auto disturbance = static_cast<Disturbance>(k);
    const bool is_push = disturbance == Disturbance::kPush;
    if ((is_push && !swing.is_held) || HasParameterFor(disturbance, problem)) continue;
    const Cause cause = CauseOf(disturbance);
    const double share = is_push ? 0 : cause == Cause::kPresliding ? kUnseenPresliding : kUnseenShare;
    writer.Add({cause, 0, share * friction}, swing.by_motion.cwiseProduct(columns.col(k)));
  }
}

}  // namespace

EffectColumns EffectColumnsAt(const SensorErrors& sensor, const FitProblem& problem, const TrajectoryCost& cost,
                              const Solution& solution, const std::vector<Index>& at, double play) {
  EffectColumns effects;
  MotionStates states;
  if (problem.data.sensor.kind == SensorKind::kScaledRate) return effects;  // its gain is fitted
  if (!cost.Motion(solution.parameters, false, &states)) return effects;
  for (VectorXd& value : states.value) value = VectorXd(value(at));
  FittedSwing swing = MakeSwing(problem, solution, states, cost.Trace(solution.parameters).stop_time, at);
  if (const std::optional<std::size_t> release = problem.Find(kReleaseTime.name)) {
    swing.release = solution.parameters[*release];
    swing.is_held = true;
  }
  ColumnWriter writer(swing.time.size(), effects);
  if (problem.data.sensor.kind == SensorKind::kAcceleration) {  // an unknown gain changes its radius
    writer.AddPlausible(Cause::kGain, sensor.Of(SensorEffect::kGain).std_dev, swing.reading);
    return effects;
  }
  AddSensorEffects(sensor, problem, swing, play, writer);
  AddHold(problem, swing, writer);
  const auto physical = std::span(solution.parameters).first(static_cast<std::size_t>(problem.solve.last_friction) + 1);
  AddDisturbances(problem, swing, states, physical, writer);
  return effects;
}

}  // namespace pendulum
