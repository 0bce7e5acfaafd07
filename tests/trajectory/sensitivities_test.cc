// SPDX-License-Identifier: Apache-2.0
// Compares derivatives from dual numbers with central differences, closed forms and the theory of reversals.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <ceres/jet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/base/physics.h"
#include "pendulum/model/friction/registry.h"
#include "pendulum/model/motion_model.h"
#include "pendulum/trajectory/trajectory.h"
#include "tests/model/typical_friction.h"
#include "tests/model/undamped_pendulum.h"

namespace pendulum::sensitivities_test {
namespace {

using testing::DoubleNear;
using testing::Each;
using testing::Ge;
using testing::Le;
using testing::SizeIs;

/// A traced motion: its segments and the instants of its reversals and its stop.
template <typename T>
struct Curve {
  std::vector<Segment<T>> segments;
  std::vector<double> reversals;  ///< s
  TraceSummary summary;

  /// θ, θ', θ'' at a time.
  std::array<T, 3> At(double time) const {
    const auto after = std::upper_bound(segments.begin(), segments.end(), time,
                                        [](double t, const Segment<T>& segment) { return t < segment.start; });
    return Motion(*(after - 1), time);
  }

  static T Coefficient(const Segment<T>& segment, int k) {
    if constexpr (DualNumber<T>) {
      return T(segment.angle[k], PartialsAtFixedTime(segment, k));
    } else {
      return segment.angle[k];
    }
  }

  static std::array<T, 3> Motion(const Segment<T>& segment, double time) {
    std::array<T, 3> motion{T(0.0), T(0.0), T(0.0)};
    const double tau = time - segment.start;
    for (int k = segment.order; k >= 0; --k) {  // Horner's rule, differentiated twice
      motion[2] = motion[2] * tau + 2.0 * motion[1];
      motion[1] = motion[1] * tau + motion[0];
      motion[0] = motion[0] * tau + Coefficient(segment, k);
    }
    return motion;
  }
};

template <FrictionModel F, typename T>
Curve<T> Trace(const Pendulum<F, T>& pendulum, const Start<T>& start, double end, double tolerance = 1e-14,
               InstructionSet instruction_set = kInstructionSet) {
  TraceOptions options;
  options.instruction_set = instruction_set;
  options.end = end;
  options.tolerance = tolerance;
  Curve<T> curve;
  double direction = 0;
  curve.summary = TraceTrajectory(pendulum, start, options, [&](const Segment<T>& segment) {
    const double before = direction;
    direction = segment.order == 0 ? 0 : Value(Curve<T>::Motion(segment, 0.5 * (segment.start + segment.end))[1]);
    if (before != 0 && before * direction <= 0) curve.reversals.push_back(segment.start);
    curve.segments.push_back(segment);
  });
  return curve;
}

/// A motion of any law with typical parameters. The parameters are in the order of a fit: inertia, friction, then
/// release angle and time or initial angle and rate.
template <FrictionModel F>
struct Experiment {
  static constexpr int kFriction = kFrictionParameters<F>;
  static constexpr int kParameters = kFriction + 3;
  using Dual = pendulum::Dual<kParameters>;

  Gravity gravity;
  StartKind kind;
  double end = 60;  // s
  InstructionSet instruction_set = kInstructionSet;
  std::array<double, kParameters> p{};

  Experiment(Gravity gravity_law, StartKind start) : gravity(gravity_law), kind(start) {
    const auto friction = TypicalFriction<F>(0.003);
    p[0] = kReferenceInertia;
    std::copy(friction.begin(), friction.end(), p.begin() + 1);
    p[kFriction + 1] = kind == StartKind::kRelease ? 1.1 : 0.7;
    p[kFriction + 2] = kind == StartKind::kRelease ? 0.83 : -3.2;
  }

  template <typename T>
  Curve<T> TraceWith(const std::array<T, kParameters>& q) const {
    Pendulum<F, T> pendulum{gravity, q[0], {}};
    std::copy_n(q.begin() + 1, kFriction, pendulum.friction.begin());
    const bool released = kind == StartKind::kRelease;
    return Trace(pendulum,
                 Start<T>{kind, released ? Value(q[kFriction + 2]) : 0.0, q[kFriction + 1],
                          released ? T(0.0) : q[kFriction + 2]},
                 end, 1e-14, instruction_set);
  }

  Curve<Dual> TraceDual() const {
    std::array<Dual, kParameters> q;
    for (int i = 0; i < kParameters; ++i) q[i] = Dual(p[i], i);
    return TraceWith(q);
  }

  Curve<double> TraceShifted(int parameter, double shift) const {
    std::array<double, kParameters> q = p;
    q[parameter] += shift;
    return TraceWith(q);
  }
};

/// Whether `time` lies in an interval through which a reversal, the release or the stop moves when a parameter is
/// shifted.
bool IsPassed(double time, const std::array<std::vector<double>, 3>& instants) {
  constexpr double kRounding = 1e-9;  // s
  for (std::size_t i = 0; i < instants[0].size(); ++i) {
    const auto [first, last] = std::minmax({instants[0][i], instants[1][i], instants[2][i]});
    if (time >= first - kRounding && time <= last + kRounding) return true;
  }
  return false;
}

struct ColumnError {
  double error = 0;  ///< Largest |derivative - difference|.
  double scale = 0;  ///< Largest |derivative|.

  void Add(double derivative, double difference) {
    error = std::max(error, std::abs(derivative - difference));
    scale = std::max(scale, std::abs(derivative));
  }
};

/// Compares one column of derivatives of angle and rate with central differences.
template <FrictionModel F>
void ExpectColumn(const Experiment<F>& experiment, const Curve<typename Experiment<F>::Dual>& dual, int parameter) {
  const bool is_release_time = experiment.kind == StartKind::kRelease && parameter + 1 == experiment.kParameters;
  const bool is_share =
      parameter > 0 && parameter <= kFrictionParameters<F> && std::isfinite(F::kParameters[parameter - 1].upper);
  const double step = (is_share ? 1e-4 : 1e-6) * std::abs(experiment.p[parameter]);  // a share has a small effect
  const Curve<double> plus = experiment.TraceShifted(parameter, step);
  const Curve<double> minus = experiment.TraceShifted(parameter, -step);
  std::array<std::vector<double>, 3> instants = {dual.reversals, plus.reversals, minus.reversals};
  ASSERT_THAT(instants, Each(SizeIs(dual.reversals.size())));
  if (is_release_time) {
    const double release = experiment.p[parameter];
    instants[0].push_back(release);
    instants[1].push_back(release + step);
    instants[2].push_back(release - step);
  }
  std::array<ColumnError, 2> columns;
  for (double time = 0.005; time < experiment.end; time += 0.05) {
    if (IsPassed(time, instants)) continue;
    const auto motion = dual.At(time);
    const std::array<double, 3> above = plus.At(time), below = minus.At(time);
    for (int quantity = 0; quantity < 2; ++quantity) {
      columns[quantity].Add(is_release_time ? -motion[quantity + 1].a : motion[quantity].v[parameter],
                            (above[quantity] - below[quantity]) / (2 * step));
    }
  }
  for (const ColumnError& column : columns) {
    EXPECT_GT(column.scale, 0);
    EXPECT_THAT(column.error, Le(1e-6 * column.scale));
  }
}

template <FrictionModel F>
void ExpectDerivatives(const MotionModel& model, StartKind start) {
  const Experiment<F> experiment(model.gravity, start);
  const auto dual = experiment.TraceDual();
  EXPECT_THAT(dual.reversals.size(), Ge(30));
  EXPECT_EQ(dual.summary.stop_time < experiment.end, HasDryFriction<F>());
  for (int i = 0; i < experiment.kParameters; ++i) {
    SCOPED_TRACE(std::string(model.name) + (start == StartKind::kRelease ? ", released" : ", moving") + ", parameter " +
                 std::to_string(i));
    ExpectColumn(experiment, dual, i);
  }
}

TEST(Derivatives, MatchCentralDifferencesThroughReversalsAndStop) {
  for (const MotionModel& model : MotionModels()) {
    FrictionModels::Visit(model.friction, [&]<typename F>() {
      for (const StartKind start : {StartKind::kRelease, StartKind::kMoving}) ExpectDerivatives<F>(model, start);
    });
  }
}

// Linear gravity and dry friction alone, in half swing n = 0, 1, ...:
// θ = (-1)^n τ_c + (A - (2 n + 1) τ_c) cos(ω0 t); at rest after N half swings θ = (-1)^N (A - 2 N τ_c).
TEST(Derivatives, MatchTheStaircaseThroughTheStop) {
  using Dual = pendulum::Dual<4>;  // of a release; the derivative with respect to viscous friction is not tested here
  constexpr double kOmega = 5, kInertia = 0.04, kDry = 0.007, kAngle = 0.5;
  constexpr int kHalfSwings = 36;  // the last turning point is at 0.5 - 72 · 0.007 = -0.004; friction holds up to 0.007
  const Pendulum<CoulombFriction, Dual> pendulum{Gravity::kLinear, Dual(kInertia, 0), {Dual(0), Dual(kDry, 1)}};
  const auto curve = Trace(pendulum, Start<Dual>{StartKind::kRelease, 0, Dual(kAngle, 2), Dual(0)}, 30, 1e-17);
  ASSERT_THAT(curve.reversals, SizeIs(kHalfSwings));
  for (double time = 0.0037; time < 30; time += 0.01) {
    const int n = std::min(static_cast<int>(kOmega * time / kPi), kHalfSwings);
    const double sign = n % 2 == 0 ? 1 : -1, c = std::cos(kOmega * time), s = std::sin(kOmega * time);
    const double slope = (kAngle - (2 * n + 1) * kDry) * s * kOmega * time / (2 * kInertia);
    const std::array<double, 3> expected =
        n < kHalfSwings ? std::array{slope, sign - (2 * n + 1) * c, c} : std::array{0.0, -2 * sign * n, sign};
    const Dual angle = curve.At(time)[0];
    for (int i = 0; i < 3; ++i) {
      ASSERT_THAT(angle.v[i], DoubleNear(expected[i], 1e-9)) << "parameter " << i << " at " << time;
    }
  }
}

// Galán, Feehery & Barton, Applied Numerical Mathematics 31:17 (1999): where the rate passes 0 and the acceleration
// jumps from α- to α+, the sensitivity of the rate is multiplied by α+ / α-. Where the motion stops it becomes 0.
template <FrictionModel F>
void ExpectJumpsAtReversals() {
  const Experiment<F> experiment(Gravity::kSine, StartKind::kMoving);
  const auto curve = experiment.TraceDual();
  ASSERT_THAT(curve.reversals.size(), Ge(30));
  for (std::size_t i = 1; i < curve.segments.size(); ++i) {
    const auto before = curve.Motion(curve.segments[i - 1], curve.segments[i].start);
    const auto after = curve.Motion(curve.segments[i], curve.segments[i].start);
    const bool is_reversal =
        std::binary_search(curve.reversals.begin(), curve.reversals.end(), curve.segments[i].start);
    const double ratio = is_reversal ? after[2].a / before[2].a : 1;
    double scale = 0;
    for (int parameter = 0; parameter < experiment.kParameters; ++parameter) {
      scale = std::max(scale, std::abs(before[1].v[parameter]));
    }
    for (int parameter = 0; parameter < experiment.kParameters; ++parameter) {
      EXPECT_THAT(after[1].v[parameter], DoubleNear(ratio * before[1].v[parameter], 1e-8 * scale)) << F::kName;
      EXPECT_THAT(after[0].v[parameter], DoubleNear(before[0].v[parameter], 1e-9 * scale)) << F::kName;
    }
  }
}

TEST(Derivatives, JumpByTheAccelerationRatioAtAReversal) {
  FrictionModels::ForEach([]<typename F>() { ExpectJumpsAtReversals<F>(); });
}

// ---- The sine of a dual series -----------------------------------------------------------------------------------

TEST(SineSeries, MatchesPlainDualArithmetic) {
  using Jet = ceres::Jet<double, 3>;
  std::mt19937_64 generator(20260804);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  Series<Jet> angle, rate;
  Series<double> rate_values{};
  Series<Partials<3>> angle_partials;
  for (int n = 0; n <= kMaxOrder; ++n) {
    angle[n] = Jet(std::pow(0.8, n) * uniform(generator));
    for (int i = 0; i < 3; ++i) {
      angle[n].v[i] = std::pow(0.8, n) * uniform(generator);
      angle_partials[n].set(i, angle[n].v[i]);
    }
    if (n > 0) {
      rate[n - 1] = double(n) * angle[n];
      rate_values[n - 1] = rate[n - 1].a;
    }
  }
  std::vector<Jet> sine = {sin(angle[0])}, cosine = {cos(angle[0])};
  for (int n = 1; n <= kMaxOrder; ++n) {
    Jet sine_sum(0.0), cosine_sum(0.0);
    for (int j = 0; j < n; ++j) {
      sine_sum += rate[j] * cosine[n - 1 - j];
      cosine_sum += rate[j] * sine[n - 1 - j];
    }
    sine.push_back(sine_sum / double(n));
    cosine.push_back(-cosine_sum / double(n));
  }
  SineSeries series;
  Partials<3> next;
  const auto compare = [&]<int n>() {
    EXPECT_THAT(series.Next<n>(angle[0].a, rate_values), DoubleNear(sine[n].a, 1e-14)) << "coefficient " << n;
    const Partials<3> partials = series.PartialsOf<n>(angle_partials, next);
    for (int i = 0; i < 3; ++i) EXPECT_THAT(partials[i], DoubleNear(sine[n].v[i], 1e-13)) << "coefficient " << n;
  };
  [&]<int... n>(std::integer_sequence<int, n...>) { (compare.template operator()<n>(), ...); }
  (std::make_integer_sequence<int, kMaxOrder + 1>());
}

// ---- Instruction sets --------------------------------------------------------------------------------------------

template <FrictionModel F>
void ExpectTheSameMotion(InstructionSet set) {
  Experiment<F> experiment(Gravity::kSine, StartKind::kRelease);
  experiment.instruction_set = InstructionSet::kBaseline;
  const auto plain = experiment.TraceDual();
  experiment.instruction_set = set;
  const auto wide = experiment.TraceDual();
  EXPECT_EQ(wide.summary.reversals, plain.summary.reversals) << F::kName;
  for (double time = 0.9; time < experiment.end; time += 0.1) {
    const auto expected = plain.At(time)[0];
    const auto actual = wide.At(time)[0];
    ASSERT_THAT(actual.a, DoubleNear(expected.a, 1e-12)) << F::kName << " at " << time;
    for (int i = 0; i < experiment.kParameters; ++i) {
      const double near = 1e-10 * std::max(1.0, std::abs(expected.v[i]));
      ASSERT_THAT(actual.v[i], DoubleNear(expected.v[i], near)) << F::kName << " at " << time << ", parameter " << i;
    }
  }
}

class Instructions : public testing::TestWithParam<InstructionSet> {};

TEST_P(Instructions, GiveTheSameMotionUpToRounding) {
  if (kInstructionSet < GetParam()) GTEST_SKIP() << "this processor has no such instructions";
  FrictionModels::ForEach([&]<typename F>() { ExpectTheSameMotion<F>(GetParam()); });
}

INSTANTIATE_TEST_SUITE_P(Each, Instructions, testing::Values(InstructionSet::kAvx2, InstructionSet::kAvx512));

}  // namespace
}  // namespace pendulum::sensitivities_test
