// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/difference_causes.h"

#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/closed_form/locate_turning_points.h"
#include "pendulum/closed_form/log_decrement.h"
#include "pendulum/closed_form/period.h"
#include "tests/analysis/fitted_run.h"

namespace pendulum::difference_causes_test {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

// ---- Parts of a difference -----------------------------------------------------------------------------------------

FormulaStages Stages(double small_angles, double drifting, double own_gravity, double own_instants, double own_levels) {
  const auto pair = [](double value) { return Eigen::VectorXd(Eigen::Vector2d(-7, value)); };
  return {pair(small_angles), pair(drifting), pair(own_gravity), pair(own_instants), pair(own_levels)};
}

// Each part is a stage minus the previous stage. The first part subtracts the fit; the last part is the recording minus
// the last stage.
TEST(SplitDifference, AssignsEachStageItsPart) {
  const DifferenceCauses causes = SplitDifference(Stages(11, 7, 10, 9, 14), 1, 1, 16, 9);
  EXPECT_EQ(causes.formula, 2);
  EXPECT_EQ(causes.drift, -4);
  EXPECT_EQ(causes.amplitude, 3);
  EXPECT_EQ(causes.sampling, -1);
  EXPECT_EQ(causes.resolution, 5);
  EXPECT_EQ(causes.recording, 2);
}

TEST(SplitDifference, ScalesTheFormulasAndNotTheValues) {
  const DifferenceCauses causes = SplitDifference(Stages(11, 7, 10, 9, 14), 1, 2, 32, 18);
  EXPECT_EQ(causes.formula, 4);
  EXPECT_EQ(causes.drift, -8);
  EXPECT_EQ(causes.amplitude, 6);
  EXPECT_EQ(causes.sampling, -2);
  EXPECT_EQ(causes.resolution, 10);
  EXPECT_EQ(causes.recording, 4);
}

TEST(SplitDifference, HasPartsThatSumToTheDifference) {
  for (const double scale : {0.3, 1.0, 1.8}) {
    for (const double closed_form : {-3.0, 0.0, 25.0}) {
      const DifferenceCauses causes = SplitDifference(Stages(1.1, 0.4, -1.4, 3.3, 0.8), 1, scale, closed_form, 0.7);
      EXPECT_THAT(causes.total(), DoubleNear(closed_form - 0.7, 1e-14));
    }
  }
}

// ---- Sentences -----------------------------------------------------------------------------------------------------

/// parts: formula, amplitude, sampling, resolution, recording.
std::string Described(const std::vector<double>& parts, double std_dev = 1e-3, const std::string& unit = "s") {
  const CauseNames names = {"a spring", "a slope", "a shadow"};
  return DescribeCauses({parts[0], 0, parts[1], parts[2], parts[3], parts[4]}, std_dev, unit, names);
}

TEST(DescribeCauses, NamesEachCause) {
  EXPECT_EQ(Described({2, 0, 0, 0, 0}), "differs by +2 s: +2 by a spring");
  EXPECT_EQ(Described({0, 2, 0, 0, 0}), "differs by +2 s: +2 by a slope");
  EXPECT_EQ(Described({0, 0, -2, 0, 0}), "differs by -2 s: -2 by too few samples around the turning points");
  EXPECT_EQ(Described({0, 0, 0, -2, 0}), "differs by -2 s: -2 by the sensor's resolution");
  EXPECT_EQ(Described({0, 0, 0, 0, 2}), "differs by +2 s: +2 by a shadow");
}

TEST(DescribeCauses, NamesTheDriftOfTheZero) {
  EXPECT_EQ(DescribeCauses({0, -2, 0, 0, 0, 0}, 1e-3, "s", {}),
            "differs by -2 s: -2 by the drift of the zero, which the formula ignores");
}

TEST(DescribeCauses, ListsTheLargestPartFirst) {
  EXPECT_EQ(Described({0, 1, 0, -3, 4}, 1e-3, "1"),
            "differs by +2: +4 by a shadow; -3 by the sensor's resolution; "
            "+1 by a slope");
}

// A fifth of 10 is 2.
TEST(DescribeCauses, OmitsPartsBelowAFifth) {
  EXPECT_THAT(Described({0, 8.1, 0, 1.9, 0}), Not(HasSubstr("resolution")));
  EXPECT_THAT(Described({0, 7.9, 0, 2.1, 0}), HasSubstr("; +2.1 by the sensor's resolution"));
  EXPECT_THAT(Described({0, 13, 0, -1.5, -1.5}), Not(HasSubstr("resolution")));
  EXPECT_THAT(Described({0, -7.9, 0, -2.1, 0}), HasSubstr("; -2.1 by the sensor's resolution"));
}

// A difference of up to three standard deviations of noise, of either sign, is called noise.
TEST(DescribeCauses, CallsASmallRemainderNoise) {
  for (const double sign : {1.0, -1.0}) {
    EXPECT_THAT(Described({0, 0, 0, 0, sign * 2.9}, 1), HasSubstr("by noise"));
    EXPECT_THAT(Described({0, 0, 0, 0, sign * 2.9}, 1), Not(HasSubstr("shadow")));
    EXPECT_THAT(Described({0, 0, 0, 0, sign * 3.1}, 1), HasSubstr("by a shadow"));
    EXPECT_THAT(Described({0, 0, 0, 0, sign * 3.1}, 1), Not(HasSubstr("noise")));
  }
}

TEST(DescribeCauses, HasThreeDigitsAndTheUnit) {
  EXPECT_THAT(Described({0, 0.00123456, 0, 0, 0}, 1, "kg m^2"), StartsWith("differs by +0.00123 kg m^2: +0.00123 by"));
  EXPECT_THAT(Described({0, 0.00123456, 0, 0, 0}, 1, "1"), StartsWith("differs by +0.00123: +0.00123 by"));
}

// ---- Stages --------------------------------------------------------------------------------------------------------

/// The recording and the gravity that a formula was applied to.
struct Applied {
  Recording recording;
  Gravity gravity;
};

/// A formula for the tests: the lowest reading of the recording.
std::optional<Eigen::VectorXd> Lowest(const Recording& recording, Gravity) {
  return Eigen::VectorXd::Constant(1, recording.value.minCoeff());
}

/// A viscous swing of 1 rad without noise, and the motion of its fit.
struct StagedRun {
  explicit StagedRun(SyntheticOptions options) : run(FitTo(options, options.model.name, {})) {}

  std::optional<FormulaStages> Apply(const FormulaValues& formulas, Gravity gravity = Gravity::kSine) const {
    return ApplyInStages(FittedMotion(run.recording, run.fit, {}), run.recording, gravity, formulas);
  }

  std::vector<Applied> Seen() const {
    std::vector<Applied> seen;
    Apply([&](const Recording& recording, Gravity gravity) -> std::optional<Eigen::VectorXd> {
      seen.push_back({recording, gravity});
      return Eigen::VectorXd::Zero(1);
    });
    return seen;
  }

  FitOfRun run;
};

SyntheticOptions WideSwing() {
  SyntheticOptions options = TextbookRun("viscous");
  options.release_angle = 1;
  options.noise = 1e-4;
  options.duration = 10;
  return options;
}

TEST(ApplyInStages, UsesLinearGravityOnlyForSmallAngles) {
  const std::vector<Applied> seen = StagedRun(WideSwing()).Seen();
  std::vector<Gravity> gravities;
  for (const Applied& applied : seen) gravities.push_back(applied.gravity);
  EXPECT_THAT(gravities, ElementsAre(Gravity::kLinear, Gravity::kSine, Gravity::kSine, Gravity::kSine));
}

// 1.3152 s at small angles: 200 samples of 6.6 ms; the recording's own samples are 10 ms apart.
TEST(ApplyInStages, UsesFineInstantsInTheFirstTwoStages) {
  const StagedRun run(WideSwing());
  const std::vector<Applied> seen = run.Seen();
  ASSERT_EQ(seen.size(), 4);
  const double fine = 2 * kPi * std::sqrt(0.079 / kTextbookTorque) / 200;
  for (const std::size_t stage : {0, 1}) {
    const Recording& recording = seen[stage].recording;
    EXPECT_THAT((recording.time[1] - recording.time[0]) / fine, DoubleNear(1, 2e-3));  // a whole number of samples
    EXPECT_THAT(recording.time[recording.size() - 1], DoubleNear(9.99, 1e-9));
  }
  for (const std::size_t stage : {2, 3}) {
    EXPECT_LT((seen[stage].recording.time - run.run.recording.time).norm(), 1e-9);
    EXPECT_LT((seen[stage].recording.value - run.run.fit.fitted).norm(), 1e-6);  // no noise, no levels
  }
}

// Levels include the recording's own readings, which are not multiples of the resolution.
TEST(ApplyInStages, RoundsReadingsToLevelsWithinTheRange) {
  SyntheticOptions options = WideSwing();
  options.resolution = 0.05;
  options.range = SensorRange{-0.83, 1.17};
  options.noise = 0.03;
  const StagedRun run(options);
  const std::vector<Applied> seen = run.Seen();
  ASSERT_EQ(seen.size(), 4);
  const Recording& levels = seen[3].recording;
  EXPECT_EQ(levels.resolution, 0.05);
  EXPECT_THAT(levels.value.minCoeff(), DoubleNear(-0.83, 1e-9));  // the swing goes to -0.98 and is cut off
  for (Eigen::Index i = 0; i < levels.size(); ++i) {
    const double steps = (levels.value[i] + 0.83) / 0.05;
    EXPECT_THAT(steps, DoubleNear(std::round(steps), 1e-6));
    const double clipped = std::max(run.run.fit.fitted[i], -0.83);
    EXPECT_THAT(levels.value[i], DoubleNear(clipped, 0.5 * 0.05 + 1e-6));
  }
}

// Error of a sparse recording at a trough of angle A: at most A (1 - cos(ω Δt / 2)).
TEST(ApplyInStages, FindsTheEffectOfSparseSamples) {
  SyntheticOptions options = WideSwing();
  options.sample_rate = 8;
  options.start_time = 0.03;
  const StagedRun run(options);
  const DifferenceCauses causes = SplitDifference(run.Apply(Lowest).value(), 0, 1, 0, 0);
  const double most = 1 - std::cos(4.78 * 0.125 / 2);
  EXPECT_GT(causes.sampling, 0);
  EXPECT_LT(causes.sampling, most);
  EXPECT_THAT(causes.sampling,
              DoubleNear(run.run.fit.fitted.minCoeff() - run.Seen()[1].recording.value.minCoeff(), 1e-6));
  EXPECT_EQ(causes.resolution, 0);
}

TEST(ApplyInStages, FindsTheEffectOfLevels) {
  SyntheticOptions options = WideSwing();
  options.resolution = 0.3;
  options.noise = 0.1;  // so that the fit averages over the levels
  const StagedRun run(options);
  const DifferenceCauses causes = SplitDifference(run.Apply(Lowest).value(), 0, 1, 0, 0);
  // The lowest reading is -0.97 and the nearest level -0.9.
  EXPECT_THAT(causes.resolution, DoubleNear(-0.9 - run.run.fit.fitted.minCoeff(), 1e-6));
  EXPECT_THAT(causes.sampling, DoubleNear(0, 1e-3));  // A (ω Δt)² / 8
}

/// The textbook's inertia over 4 periods, from the first turning point after 3 s on (the second one after the release).
std::optional<Eigen::VectorXd> SmallAngleInertia(const Recording& recording, Gravity gravity) {
  const TurningPointTable table = Must(LocateTurningPoints(recording));
  std::size_t first = 0;
  while (table.points[first].time < 3) ++first;
  const auto linear = ApplyLogDecrement(table, gravity, first, 4);
  return Eigen::VectorXd::Constant(1, linear.value().inertia.value);
}

// Over n periods the formula finds I0 times the squared mean of T(A) / T(0); here that mean is computed over half
// swings of the decay.
TEST(ApplyInStages, FindsTheFiniteAmplitudeEffectOnInertia) {
  const StagedRun run(WideSwing());
  const double inertia = run.run.fit.Find("inertia")->estimate;
  const double decay = std::exp(-kPi * run.run.fit.Find("viscous")->estimate / (2 * std::sqrt(inertia)));
  double ratio = 0;
  for (int i = 0; i < 8; ++i) ratio += SineGravity::PeriodRatio(std::pow(decay, 2.5 + i)) / 8;
  const DifferenceCauses causes = SplitDifference(run.Apply(SmallAngleInertia).value(), 0, 1, 0, inertia);
  EXPECT_THAT(causes.amplitude / (inertia * (ratio * ratio - 1)), DoubleNear(1, 0.02));
  EXPECT_LT(std::abs(causes.formula), 1e-5 * inertia);
  EXPECT_LT(std::abs(causes.sampling), 1e-4 * inertia);
}

TEST(ApplyInStages, FindsNoFiniteAmplitudeInALinearModel) {
  SyntheticOptions options = WideSwing();
  options.model = Must(FindMotionModel("linear"));
  const StagedRun run(options);
  const DifferenceCauses causes = SplitDifference(run.Apply(Lowest, Gravity::kLinear).value(), 0, 1, 0, 0);
  EXPECT_EQ(causes.amplitude, 0);
}

TEST(ApplyInStages, IsEmptyIfAFormulaCannotBeApplied) {
  const StagedRun run(WideSwing());
  for (std::size_t failing = 0; failing < 4; ++failing) {
    std::size_t stage = 0;
    EXPECT_FALSE(run.Apply([&](const Recording&, Gravity) -> std::optional<Eigen::VectorXd> {
      if (stage++ == failing) return std::nullopt;
      return Eigen::VectorXd::Zero(1);
    })) << failing;
  }
}

TEST(ApplyInStages, IsEmptyIfTheMotionCannotBeTraced) {
  FitOfRun run = FitTo(NoisyRun("coulomb"), "coulomb", {});
  run.fit.parameters[2].estimate = 1;  // friction holds the pendulum
  EXPECT_FALSE(ApplyInStages(FittedMotion(run.recording, run.fit, {}), run.recording, Gravity::kSine, Lowest));
}

}  // namespace
}  // namespace pendulum::difference_causes_test
