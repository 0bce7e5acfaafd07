// SPDX-License-Identifier: Apache-2.0
// Recordings as strangers have them, in which the swing is only a part: each kind is simulated with a dozen or more
// random parameters. Without a flag the swing is found and fitted, and the estimates are right within their errors.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <iostream>
#include <map>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/fitting/swing/choose_swings.h"
#include "pendulum/fitting/swing/fit_swing.h"
#include "tests/fitting/fit_support.h"

namespace pendulum::window_kinds_test {
namespace {

using testing::Ge;
using testing::Le;

/// Random parameters of a run.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : generator_(seed) {}
  double operator()(double low, double high) {
    return low + (high - low) * static_cast<double>(generator_() >> 11) * 0x1p-53;
  }

 private:
  std::mt19937_64 generator_;
};

/// A run, and the physical parameters that a fit should find, by name.
struct KindRun {
  Recording recording;
  std::string model;
  std::map<std::string, double> truth;
};

/// How the fits of one kind ended.
struct Tally {
  int right = 0;    ///< Converged, and all parameters within 4 standard errors.
  int refused = 0;  ///< With an error, or not converged.
  int warned = 0;   ///< Converged, and a parameter is further away, but a warning says that the fit is not good.
  int wrong = 0;    ///< Converged, and a parameter is further away without such a warning.
  std::vector<FitReport> fits;
  std::vector<FreeSwing> swings;
};

/// The largest deviation in standard errors.
double LargestDeviation(const KindRun& run, const FitReport& fit) {
  double largest = 0;
  for (const auto& [name, value] : run.truth) {
    const ParameterEstimate* parameter = fit.Find(name);
    if (parameter == nullptr) {
      ADD_FAILURE() << name << " is no parameter";
      continue;
    }
    if (!parameter->std_error) return fit.HasWarning("at_bound") ? 0 : kUnbounded;
    largest = std::max(largest, std::abs(parameter->estimate - value) / *parameter->std_error);
  }
  return largest;
}

Tally FitAll(int count, const std::function<KindRun(Draw&)>& make) {
  constexpr double kRight = 4;
  Tally tally;
  for (int k = 1; k <= count; ++k) {
    SCOPED_TRACE("run " + std::to_string(k));
    Draw draw(static_cast<std::uint64_t>(100 + k));
    const KindRun run = make(draw);
    const Result<ChosenSwings> swings = ChooseSwings(run.recording, {});
    const Result<SwingFit> result =
        swings ? FitSwing(run.recording, swings->found[static_cast<std::size_t>(swings->chosen.at(0) - 1)],
                          ModelOptions(run.model))
               : Result<SwingFit>(tl::unexpected(swings.error()));
    if (!result || result->fit.termination != Termination::kConverged) {
      ++tally.refused;
      std::cout << "run " << k << ": " << (result ? result->fit.reason : result.error().message()) << "\n";
      continue;
    }
    const double deviation = LargestDeviation(run, result->fit);
    if (deviation > kRight) {
      std::cout << "run " << k << ": " << deviation << " standard errors; " << result->swing.from << " s to "
                << result->swing.to << " s, " << Sentence(result->swing.begins) << "\n";
    }
    const bool warns = result->fit.HasWarning("lack_of_fit") || result->fit.HasWarning("correlated_residuals") ||
                       result->fit.HasWarning("larger_motion_outside");
    ++(deviation <= kRight ? tally.right : warns ? tally.warned : tally.wrong);
    tally.fits.push_back(result->fit);
    tally.swings.push_back(result->swing);
  }
  return tally;
}

/// A pendulum with random inertia and friction, held for `hold` s, then released at `amplitude` rad.
SyntheticOptions RandomPendulum(Draw& draw, const std::string& model, double hold, double amplitude) {
  SyntheticOptions options;
  options.model = Must(FindMotionModel(model));
  const double gravity = draw(14, 32);  // G / I
  options.parameters = {1 / gravity, draw(0.01, 0.06) / gravity};
  if (model != "viscous" && model != "linear") options.parameters.push_back(draw(0.05, 0.13) / gravity);
  options.release_angle = amplitude;
  options.release_time = hold;
  options.seed = static_cast<std::uint64_t>(draw(1, 1e6));
  return options;
}

KindRun RunOf(const SyntheticOptions& options, Recording recording) {
  KindRun run{std::move(recording), std::string(options.model.name), {}};
  const auto infos = PhysicalParameters(options.model);
  for (std::size_t i = 0; i < infos.size(); ++i) run.truth.emplace(infos[i].name, options.parameters[i]);
  return run;
}

/// The noise of a recording without its swing.
Recording NoiseOf(SyntheticOptions options) {
  Recording recording = Must(SimulateRecording(options));
  options.noise = 0;
  recording.value -= Must(SimulateRecording(options)).value;
  return recording;
}

/// Adds `motion`(seconds since `from`) to the readings from there on.
void Add(double from, const std::function<double(double)>& motion, Recording& recording) {
  for (Eigen::Index i = 0; i < recording.size(); ++i) {
    if (recording.time[i] >= from) recording.value[i] += motion(recording.time[i] - from);
  }
}

// ---- A vibration faster than the swing ----------------------------------------------------------------------------

/// A phone hung on strings: they wobble after the release, and a hand ends the swing.
KindRun StringWobble(Draw& draw) {
  SyntheticOptions options = RandomPendulum(draw, "coulomb", draw(0.3, 0.6), draw(0.4, 0.6));
  options.quantity = Quantity::kRate;
  options.sample_rate = draw(45, 100);
  options.duration = draw(9, 13);
  options.noise = 0.01;
  Recording recording = Must(SimulateRecording(options));
  const double peak = options.release_angle / std::sqrt(options.parameters[0]);
  const double size = draw(0.8, 2) * peak, frequency = draw(4.5, 8), decay = draw(0.3, 0.6), phase = draw(0, 6);
  Add(
      options.release_time,
      [=](double t) { return size * std::exp(-t / decay) * std::sin(2 * kPi * frequency * t + phase); }, recording);
  const double grab = options.duration - draw(0.6, 1);
  for (Eigen::Index i = 0; i < recording.size(); ++i) {
    const double t = recording.time[i] - grab;
    if (t > 0) recording.value[i] *= 0.2 * std::exp(-4 * t) * std::cos(20 * t);
  }
  return RunOf(options, std::move(recording));
}

TEST(FitSwing, FindsTheSwingAfterAStringWobble) {
  const Tally tally = FitAll(20, StringWobble);
  EXPECT_THAT(tally.right, Ge(12));
  EXPECT_EQ(tally.wrong, 0);
}

/// A building hums, or a motor, all the time.
KindRun Hum(Draw& draw) {
  SyntheticOptions options = RandomPendulum(draw, "viscous", draw(1, 2), draw(0.2, 0.5));
  options.duration = 25;
  options.noise = 0.001;
  Recording recording = Must(SimulateRecording(options));
  const double size = draw(0.06, 0.15) * options.release_angle, frequency = draw(5, 14);
  Add(
      0, [=](double t) { return size * std::sin(2 * kPi * frequency * t); }, recording);
  return RunOf(options, std::move(recording));
}

TEST(FitSwing, FindsTheSwingUnderAVibrationThatStays) {
  const Tally tally = FitAll(20, Hum);
  EXPECT_THAT(tally.right, Ge(12));
  EXPECT_THAT(tally.wrong, Le(1));
  EXPECT_THAT(std::ranges::count_if(tally.fits, [](const FitReport& fit) { return fit.HasWarning("vibration"); }),
              Ge(10));
}

// ---- Handling before the swing ------------------------------------------------------------------------------------

/// Someone handles the pendulum: many fast half swings of small size, then the swing.
KindRun Handling(Draw& draw) {
  SyntheticOptions options = RandomPendulum(draw, "viscous", 0, draw(0.15, 0.4));
  options.start = StartKind::kMoving;
  options.initial_angle = options.release_angle;
  options.duration = draw(20, 36);
  options.noise = 5e-4;
  const Recording swing = Must(SimulateRecording(options));
  const double seconds = draw(2, 6), size = draw(0.03, 0.08) * options.initial_angle, frequency = draw(3, 9);
  const double decay = draw(0, 1) < 0.5 ? 0 : draw(0.05, 0.2);  // 1/s
  SyntheticOptions noisy = options;
  noisy.duration = seconds;
  ++noisy.seed;
  Recording recording = NoiseOf(noisy);
  Add(
      0, [=](double t) { return size * std::exp(-decay * t) * std::sin(2 * kPi * frequency * t); }, recording);
  Eigen::VectorXd value(recording.size() + swing.size());
  value << recording.value, swing.value;
  recording.value = value;
  recording.time = Eigen::ArrayXd::LinSpaced(value.size(), 0, static_cast<double>(value.size() - 1)) / 100;
  return RunOf(options, std::move(recording));
}

TEST(FitSwing, WeighsHalfSwingsInsteadOfCountingThem) {
  const Tally tally = FitAll(20, Handling);
  EXPECT_THAT(tally.right, Ge(19));
  EXPECT_EQ(tally.wrong, 0);
}

// ---- A hold with slow noise ---------------------------------------------------------------------------------------

KindRun NoisyHold(Draw& draw) {
  SyntheticOptions options = RandomPendulum(draw, "coulomb", draw(1, 3), draw(0.3, 0.6));
  options.duration = 20;
  options.noise = draw(0.03, 0.15) * kRadFromDeg;
  options.noise_correlation = draw(0.7, 0.95);
  KindRun run = RunOf(options, Must(SimulateRecording(options)));
  run.truth.emplace("release_angle", options.release_angle);
  run.truth.emplace("release_time", options.release_time);
  return run;
}

TEST(FitSwing, UsesAHoldWithSlowNoise) {
  const Tally tally = FitAll(30, NoisyHold);
  EXPECT_THAT(tally.right, Ge(29));
  EXPECT_EQ(std::ranges::count(tally.fits, StartKind::kRelease, &FitReport::start), 30);
}

// ---- Presliding ---------------------------------------------------------------------------------------------------

/// A pendulum whose dry friction is Dahl's: it acts like a spring before it slides (P. R. Dahl, AIAA J. 14:1675, 1976,
/// with exponent 1). Classical Runge-Kutta steps of 1 ms.
KindRun Presliding(Draw& draw) {
  const double gravity = draw(16, 26), viscous = draw(0.01, 0.06), coulomb = draw(0.08, 0.16);  // over I
  const double break_away = draw(0.006, 0.02);                                                  // rad
  const bool is_rate = draw(0, 1) < 0.5;
  const auto slope = [&](const Eigen::Array3d& x) {
    const double slide = 1 - (x[1] > 0 ? 1 : -1) * x[2];
    return Eigen::Array3d(x[1], -gravity * std::sin(x[0]) - viscous * x[1] - coulomb * x[2], x[1] / break_away * slide);
  };
  SyntheticOptions noise = NoisyRun("viscous", static_cast<std::uint64_t>(draw(1, 1e6)));
  noise.duration = 14;
  noise.noise = is_rate ? 0.003 : 0.0006;
  Recording recording = NoiseOf(noise);
  recording.quantity = is_rate ? Quantity::kRate : Quantity::kAngle;
  recording.unit = is_rate ? "rad/s" : "rad";
  Eigen::Array3d x(draw(0.2, 0.3), 0, 0);
  constexpr double h = 1e-3;
  for (double& value : recording.value) {
    value += x[is_rate ? 1 : 0];
    for (int step = 0; step < 10; ++step) {
      const Eigen::Array3d k1 = slope(x), k2 = slope(x + 0.5 * h * k1), k3 = slope(x + 0.5 * h * k2);
      x += h / 6 * (k1 + 2 * k2 + 2 * k3 + slope(x + h * k3));
    }
  }
  return {std::move(recording), "coulomb", {{"inertia", 1 / gravity}}};
}

TEST(FitSwing, NamesPreslidingAndKeepsTheLargeSwings) {
  const Tally tally = FitAll(20, Presliding);
  EXPECT_THAT(tally.refused, Le(1));
  EXPECT_THAT(tally.wrong, Le(1));
  int named = 0;
  for (std::size_t i = 0; i < tally.fits.size(); ++i) {
    if (!tally.fits[i].HasWarning("presliding")) continue;
    ++named;
    EXPECT_THAT(tally.swings[i].from, Le(0.8)) << i;  // the first half swing is kept
  }
  EXPECT_THAT(named, Ge(9));
}

// ---- Slow oscillators ---------------------------------------------------------------------------------------------

/// A torsion balance read from a scale in millimetres.
KindRun TorsionBalance(Draw& draw) {
  SyntheticOptions options;
  options.model = Must(FindMotionModel("linear"));
  const double period = draw(60, 2000), frequency = 2 * kPi / period;
  options.parameters = {1 / (frequency * frequency), 2 * draw(0.01, 0.05) / frequency};
  options.start = StartKind::kMoving;
  options.initial_angle = draw(-20, 20);
  options.initial_rate = draw(10, 25) * frequency;
  options.duration = draw(5, 10) * period;
  options.sample_rate = draw(12, 60) / period;
  options.noise = 0.5;
  options.zero = 545;
  options.seed = static_cast<std::uint64_t>(draw(1, 1e6));
  Recording recording = Must(SimulateRecording(options));
  recording.quantity = Quantity::kPosition;
  recording.unit = "m";
  return RunOf(options, std::move(recording));
}

TEST(FitSwing, FitsATorsionBalanceOfAnyPeriod) {
  const Tally tally = FitAll(20, TorsionBalance);
  EXPECT_EQ(tally.right, 20);
}

TEST(FitSwing, AsksAboutTheUnitOfTimeIfAPendulumIsTooSlow) {
  Draw draw(1);
  const KindRun run = TorsionBalance(draw);
  const ChosenSwings swings = Must(ChooseSwings(run.recording, {}));
  const auto refused = FitSwing(run.recording, swings.found.front(), ModelOptions("coulomb"));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, StatusCode::kFailedPrecondition);
  EXPECT_THAT(refused.error().message(), testing::HasSubstr("--time_column NAME:ms"));
  EXPECT_THAT(refused.error().message(), testing::HasSubstr("--gravity linear"));
}

}  // namespace
}  // namespace pendulum::window_kinds_test
