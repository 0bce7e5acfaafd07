// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/prediction.h"

#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/analysis/fitted_motion.h"
#include "pendulum/fitting/likelihood/fit_parameters.h"
#include "pendulum/recording/window.h"
#include "tests/analysis/fitted_run.h"

namespace pendulum::prediction_test {
namespace {

using testing::AllOf;
using testing::DoubleNear;
using testing::Ge;
using testing::Gt;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Le;
using testing::Lt;

constexpr double kSigma = 0.002;  // rad

// The rms of 1700 independent residuals scatters by 1.7 %, of 700 by 2.7 %; errors of extrapolated parameters add to
// that.
const auto kAboutOne = AllOf(Ge(0.9), Le(1.1));

SyntheticOptions Noisy(SyntheticOptions run, double noise = kSigma) {
  run.noise = noise;
  return run;
}

struct Predictions {
  FitOfRun run;
  Prediction across, forward;
};

Predictions PredictFrom(const Recording& recording, const FitOptions& options) {
  FitOfRun run = FitTo(recording, options);
  Prediction across = CrossValidate(run.recording, run.fit, options);
  Prediction forward = PredictForward(run.recording, run.fit, options);
  return {std::move(run), std::move(across), std::move(forward)};
}

Predictions Predict(const SyntheticOptions& run, const FitOptions& options) {
  return PredictFrom(Must(SimulateRecording(run)), options);
}

Predictions Predict(const SyntheticOptions& run, std::string_view model) { return Predict(run, ModelOptions(model)); }

/// Means over seeds 1 to `count`; each cross-validation alone must be about 1.
struct Means {
  double across = 0, forward = 0;  // standardized rms
  double across_rms = 0, forward_rms = 0;
};

Means MeansOver(int count, SyntheticOptions run, const FitOptions& options) {
  Means means;
  for (int seed = 1; seed <= count; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    run.seed = static_cast<std::uint64_t>(seed);
    const Predictions predictions = Predict(run, options);
    EXPECT_THAT(predictions.across.reason, IsEmpty());
    EXPECT_THAT(predictions.forward.reason, IsEmpty());
    EXPECT_THAT(predictions.across.standardized, kAboutOne);
    means.across += predictions.across.standardized / count;
    means.forward += predictions.forward.standardized / count;
    means.across_rms += predictions.across.rms / count;
    means.forward_rms += predictions.forward.rms / count;
  }
  return means;
}

/// `noise`: standard deviation of a reading about the trajectory. The trajectory's own error is up to 10 % of that.
void ExpectErrorsAsPredicted(const SyntheticOptions& run, const FitOptions& options, double noise) {
  constexpr int kSeeds = 8;
  const Means means = MeansOver(kSeeds, run, options);
  EXPECT_THAT(means.across, AllOf(Ge(0.97), Le(1.03)));
  EXPECT_THAT(means.forward, kAboutOne);
  EXPECT_THAT(means.across_rms / noise, AllOf(Ge(0.97), Le(1.04)));
  EXPECT_THAT(means.forward_rms / noise, AllOf(Ge(0.97), Le(1.12)));
}

double WithRounding(double sigma, double resolution) { return std::sqrt(sigma * sigma + resolution * resolution / 12); }

// ---- The right model -----------------------------------------------------------------------------------------------

TEST(Prediction, HasErrorsOfTheNoiseForTheRightModel) {
  for (const SyntheticOptions& run : {TextbookRun("coulomb"), MovingRun("coulomb")}) {
    SCOPED_TRACE(run.start == StartKind::kRelease ? "release" : "moving");
    ExpectErrorsAsPredicted(Noisy(run), ModelOptions("coulomb"), kSigma);
  }
}

TEST(Prediction, HasErrorsOfTheNoiseForAGyro) {
  for (SyntheticOptions run : {TextbookRun("coulomb"), MovingRun("coulomb")}) {
    SCOPED_TRACE(run.start == StartKind::kRelease ? "release" : "moving");
    run.quantity = Quantity::kRate;
    run.zero = 0.07;
    ExpectErrorsAsPredicted(Noisy(run, 0.01), ModelOptions("coulomb"), 0.01);
  }
}

// A quantized σ does not include the rounding; a Gaussian σ does.
TEST(Prediction, CountsTheRoundingOnceForBothFamilies) {
  for (const auto& [counts, family] :
       {std::pair(0.3, NoiseFamily::kQuantized), std::pair(2.0, NoiseFamily::kGaussian)}) {
    SyntheticOptions run = Noisy(TextbookRun("coulomb"), counts * kCount);
    run.resolution = kCount;
    ASSERT_EQ(Predict(run, "coulomb").run.fit.noise.family, family);
    ExpectErrorsAsPredicted(run, ModelOptions("coulomb"), WithRounding(run.noise, kCount));
  }
}

// Requests Gaussian noise for 0.3 counts, where rounding is half of the variance, and quantized noise for 1.5 counts,
// where it is small. σ includes the rounding only for Gaussian noise.
TEST(Prediction, InterpretsSigmaByTheRequestedFamily) {
  for (const auto& [counts, noise] :
       {std::pair(0.3, NoiseFamily::kGaussian), std::pair(1.5, NoiseFamily::kQuantized)}) {
    SyntheticOptions run = Noisy(TextbookRun("coulomb"), counts * kCount);
    run.resolution = kCount;
    FitOptions options = ModelOptions("coulomb");
    options.noise = noise;
    EXPECT_THAT(Predict(run, options).across.standardized, kAboutOne) << counts;
  }
}

// If residuals are about one count, fits of some parts alone would choose another noise family than the whole fit.
TEST(Prediction, KeepsTheNoiseFamilyOfTheFit) {
  SyntheticOptions run = Noisy(TextbookRun("coulomb"), 0.957 * kCount);
  run.resolution = kCount;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    run.seed = seed;
    const Predictions chosen = Predict(run, "coulomb");
    FitOptions options = ModelOptions("coulomb");
    const bool quantized = chosen.run.fit.noise.family == NoiseFamily::kQuantized;
    options.noise = quantized ? NoiseFamily::kQuantized : NoiseFamily::kGaussian;
    EXPECT_THAT(chosen.across.rms, DoubleNear(Predict(run, options).across.rms, 1e-10)) << seed;
  }
}

// Student's t with 4 degrees of freedom has the variance 2 (times its scale squared).
TEST(Prediction, UsesTheFullScatterOfARobustFamily) {
  SyntheticOptions run = Noisy(TextbookRun("coulomb"));
  run.noise_freedom = 4;
  for (const NoiseFamily family : {NoiseFamily::kStudent, NoiseFamily::kHuber}) {
    FitOptions options = ModelOptions("coulomb");
    options.noise = family;
    const Predictions predictions = Predict(run, options);
    EXPECT_THAT(predictions.across.standardized, kAboutOne);
    EXPECT_THAT(predictions.across.rms / (kSigma * std::sqrt(2.0)), kAboutOne);
  }
}

// About 40 readings at 11 per period determine the parameters so badly that the trajectory adds more than a quarter to
// the variance. With σ² from 34 degrees of freedom the mean square of t is 34/32. The errors of few parameters scatter,
// too.
TEST(PredictForward, IncludesTheErrorsOfParameters) {
  constexpr int kSeeds = 100;
  SyntheticOptions run = Noisy(MovingRun("coulomb"));
  run.sample_rate = 8;
  run.duration = 8;
  double standardized = 0, excess = 0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    run.seed = static_cast<std::uint64_t>(seed);
    const Prediction forward = Predict(run, "coulomb").forward;
    ASSERT_THAT(forward.reason, IsEmpty());
    standardized += forward.standardized * forward.standardized / kSeeds;
    excess += forward.rms * forward.rms / (kSigma * kSigma) / kSeeds;
  }
  EXPECT_GT(excess, 1.25);
  EXPECT_THAT(standardized, AllOf(Ge(0.85), Le(1.25)));
}

// ---- Left-out readings ---------------------------------------------------------------------------------------------

// Cross-validation covers the time from one period after the release to the end. Forward prediction covers the last 40
// % of the time after the release.
TEST(Prediction, CoversTheTimeAfterTheFirstPeriodOrAfterThreeFifths) {
  const Predictions released = Predict(Noisy(TextbookRun("coulomb")), "coulomb");
  const double period = 2 * kPi * std::sqrt(0.079 / kTextbookTorque);
  EXPECT_THAT(static_cast<double>(released.across.samples), DoubleNear(100 * (20 - 1.9 - period), 2));
  EXPECT_THAT(static_cast<double>(released.forward.samples), DoubleNear(0.4 * 100 * (20 - 1.9), 2));
  const Predictions moving = Predict(Noisy(MovingRun("coulomb")), "coulomb");
  EXPECT_THAT(static_cast<double>(moving.across.samples), DoubleNear(100 * (20 - period), 2));
  EXPECT_THAT(static_cast<double>(moving.forward.samples), DoubleNear(0.4 * 100 * 20, 2));
}

TEST(PredictForward, IsTheTrajectoryOfAFitToTheFirstPart) {
  const Predictions predictions = Predict(Noisy(TextbookRun("coulomb")), "coulomb");
  const Recording& used = predictions.run.recording;
  const double from = 1.9 + 0.6 * (used.time[used.size() - 1] - 1.9);
  const FitOfRun part = FitTo(Must(SelectWindow(used, 0, from)), ModelOptions("coulomb"));
  const FittedMotion motion(part.recording, part.fit, {});
  const Eigen::VectorXd residual = used.value - motion.Readings(used.time).value();
  const Eigen::Index rest = used.size() - part.recording.size();
  const double rms = std::sqrt(residual.tail(rest).squaredNorm() / static_cast<double>(rest));
  // The fitted release differs from 1.9 s by less than a sampling interval: one sample more or less.
  EXPECT_THAT(predictions.forward.rms, DoubleNear(rms, 2e-3 * rms));
}

// With every parameter fixed at the true value the predictions are exact, and the errors are the noise.
TEST(CrossValidate, KeepsFixedParametersFixed) {
  const SyntheticOptions run = Noisy(TextbookRun("coulomb"));
  FitOptions options = ModelOptions("coulomb");
  const std::vector<ParameterInfo> infos = FitParameters(run.model, run.start, run.quantity);
  const std::vector<double> truth = Truth(run);
  for (std::size_t i = 0; i < infos.size(); ++i) options.fixed[std::string(infos[i].name)] = truth[i];
  const Predictions predictions = Predict(run, options);
  const Recording clean = Must(SimulateRecording(TextbookRun("coulomb")));
  const auto count = predictions.across.samples;
  const Eigen::VectorXd noise = (predictions.run.recording.value - clean.value).tail(count);
  const double rms = std::sqrt(noise.squaredNorm() / static_cast<double>(count));
  EXPECT_THAT(predictions.across.rms, DoubleNear(rms, 1e-5 * rms));  // trajectory accurate to 1e-8 rad
  EXPECT_THAT(predictions.across.standardized, kAboutOne);
}

// Coulomb friction held at 0 is the viscous model.
TEST(Prediction, KeepsParametersFixedByTheOptions) {
  const SyntheticOptions run = Noisy(TextbookRun("coulomb"));
  FitOptions options = ModelOptions("coulomb");
  options.fixed["coulomb"] = 0;
  const Predictions held = Predict(run, options);
  const Predictions viscous = Predict(run, "viscous");
  EXPECT_THAT(held.across.rms, DoubleNear(viscous.across.rms, 1e-3 * viscous.across.rms));
  EXPECT_THAT(held.forward.rms, DoubleNear(viscous.forward.rms, 1e-3 * viscous.forward.rms));
}

TEST(Prediction, SkipsGaps) {
  const Recording whole = Must(SimulateRecording(Noisy(TextbookRun("coulomb"))));
  Recording recording = whole;
  const Eigen::Index before = 900, after = 500;  // no samples from 9 to 15 s: longer than a block
  recording.time.resize(before + after);
  recording.value.resize(before + after);
  recording.time << whole.time.head(before), whole.time.tail(after);
  recording.value << whole.value.head(before), whole.value.tail(after);
  const FitOfRun fitted = FitTo(whole, ModelOptions("coulomb"));
  const Prediction across = CrossValidate(recording, fitted.fit, ModelOptions("coulomb"));
  EXPECT_THAT(across.standardized, kAboutOne);
  EXPECT_THAT(static_cast<double>(across.samples), DoubleNear(1678 - 600, 2));
}

TEST(Prediction, ExcludesReadingsAtTheEndOfTheRange) {
  SyntheticOptions run = Noisy(TextbookRun("coulomb"));
  run.range = SensorRange{-0.3, 0.3};
  const Predictions predictions = Predict(run, "coulomb");
  const Recording& used = predictions.run.recording;
  const double begin = 1.9 + 2 * kPi * std::sqrt(0.079 / kTextbookTorque);
  int inside = 0;
  for (Eigen::Index i = 0; i < used.size(); ++i) inside += used.time[i] > begin && std::abs(used.value[i]) < 0.3;
  ASSERT_THAT(inside, AllOf(Gt(1000), Lt(1600)));
  EXPECT_THAT(static_cast<double>(predictions.across.samples), DoubleNear(inside, 2));
  EXPECT_THAT(predictions.across.standardized, kAboutOne);
}

// ---- Units, clocks and drifts --------------------------------------------------------------------------------------

TEST(Prediction, DoesNotDependOnTheUnitsOfTheReport) {
  const SyntheticOptions run = Noisy(MovingRun("coulomb"));
  FitOptions options = ModelOptions("coulomb");
  const Predictions without = Predict(run, options);
  options.rig = TextbookRig();
  const Predictions with = Predict(run, options);
  EXPECT_THAT(with.forward.standardized, DoubleNear(without.forward.standardized, 1e-4));
  EXPECT_THAT(with.across.rms, DoubleNear(without.across.rms, 1e-4 * without.across.rms));
}

// The same motion on a clock that starts at 1000 s and is 2 % slow.
TEST(Prediction, DoesNotDependOnTheClock) {
  const Recording right = Must(SimulateRecording(Noisy(TextbookRun("coulomb"))));
  Recording slow = right;
  slow.clock_scale = 1.02;
  slow.time = 1000 + right.time.array() / 1.02;
  const Predictions expected = PredictFrom(right, ModelOptions("coulomb"));
  const Predictions predictions = PredictFrom(slow, ModelOptions("coulomb"));
  EXPECT_THAT(predictions.across.rms, DoubleNear(expected.across.rms, 1e-4 * expected.across.rms));
  EXPECT_THAT(predictions.forward.standardized, DoubleNear(expected.forward.standardized, 1e-3));
  EXPECT_EQ(predictions.across.samples, expected.across.samples);
}

TEST(Prediction, FollowsADriftingZero) {
  Recording recording = Must(SimulateRecording(Noisy(TextbookRun("coulomb"))));
  recording.value.array() += 0.003 * recording.time.array();
  FitOptions options = ModelOptions("coulomb");
  options.bounds["zero_drift"] = {-1, 1};
  const Predictions predictions = PredictFrom(recording, options);
  EXPECT_THAT(predictions.across.standardized, kAboutOne);
  EXPECT_THAT(predictions.forward.standardized, AllOf(Ge(0.8), Le(1.2)));
}

// A recording without dry friction: coulomb is at its bound, or near it, in every fit.
TEST(Prediction, IsPossibleWithAParameterAtItsBound) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    SyntheticOptions run = Noisy(TextbookRun("viscous"));
    run.seed = seed;
    const Predictions predictions = Predict(run, "coulomb");
    EXPECT_THAT(predictions.across.standardized, kAboutOne) << seed;
    EXPECT_THAT(predictions.forward.standardized, AllOf(Ge(0.8), Le(1.2))) << seed;
  }
}

// ---- Wrong models and no predictions -------------------------------------------------------------------------------

// Viscous friction alone cannot follow an envelope that falls linearly.
TEST(Prediction, HasMuchLargerErrorsForTheWrongModel) {
  for (SyntheticOptions run : {Noisy(TextbookRun("coulomb")), Noisy(MovingRun("coulomb"))}) {
    for (const Quantity quantity : {Quantity::kAngle, Quantity::kRate}) {
      run.quantity = quantity;
      run.noise = quantity == Quantity::kAngle ? kSigma : 0.01;
      const Predictions right = Predict(run, "coulomb");
      const Predictions wrong = Predict(run, "viscous");
      EXPECT_GT(wrong.forward.standardized, 2.5);
      EXPECT_GT(wrong.forward.rms, 2.5 * right.forward.rms);
      EXPECT_GT(wrong.across.standardized, 1.2);
      EXPECT_GT(wrong.across.rms, 1.5 * right.across.rms);
    }
  }
}

void ExpectNothing(const Prediction& prediction, const std::string& reason) {
  EXPECT_THAT(prediction.reason, HasSubstr(reason));
  EXPECT_EQ(prediction.samples, 0);
  EXPECT_EQ(prediction.standardized, 0);
  EXPECT_EQ(prediction.rms, 0);
}

TEST(Prediction, NeedsThreePeriods) {
  SyntheticOptions run = Noisy(TextbookRun("coulomb"));
  run.duration = 5;  // 3.1 s of swing, with a period of 1.315 s
  const Predictions predictions = Predict(run, "coulomb");
  const std::string reason = "swings for 2.3 periods; at least 3";
  ExpectNothing(predictions.across, reason);
  ExpectNothing(predictions.forward, reason);
}

// Less than one sample per period: the fit follows an aliased swing.
TEST(Prediction, ReportsSamplesThatAreTooFarApart) {
  SyntheticOptions run = Noisy(MovingRun("coulomb"));
  run.sample_rate = 0.9;
  run.duration = 60;
  const Predictions predictions = Predict(run, "coulomb");
  ExpectNothing(predictions.across, "too far apart");
  ExpectNothing(predictions.forward, "too far apart");
}

// At 160 degrees the small-angle model leaves most of the variance: its fits do not converge and have no errors.
TEST(Prediction, HasNoStandardDeviationsWithoutErrors) {
  SyntheticOptions run = Noisy(TextbookRun("coulomb"));
  run.release_angle = 2.8;
  const Predictions predictions = Predict(run, "linear");
  for (const Prediction& prediction : {predictions.across, predictions.forward}) {
    EXPECT_THAT(prediction.reason, HasSubstr("has no errors"));
    EXPECT_EQ(prediction.samples, 0);
    EXPECT_EQ(prediction.standardized, 0);
    EXPECT_THAT(prediction.rms, AllOf(Gt(0.1), Lt(100)));
  }
}

// Start values without a possible trajectory, as after a failed fit.
TEST(Prediction, ReportsAFailedFit) {
  FitOfRun run = FitTo(Noisy(TextbookRun("coulomb")), "coulomb", {});
  FitOptions options = ModelOptions("coulomb");
  options.fixed["coulomb"] = run.fit.parameters[2].estimate = 1;  // holds the pendulum forever
  ExpectNothing(CrossValidate(run.recording, run.fit, options), "cannot be made");
  ExpectNothing(PredictForward(run.recording, run.fit, options), "cannot be made");
}

// Noise-free readings: both prediction errors are the trajectory's numerical error.
TEST(Prediction, IsFiniteWithoutNoise) {
  const Predictions predictions = Predict(TextbookRun("coulomb"), "coulomb");
  EXPECT_THAT(predictions.across.rms, Lt(1e-7));
  EXPECT_TRUE(std::isfinite(predictions.across.standardized));
  EXPECT_TRUE(std::isfinite(predictions.forward.standardized));
}

}  // namespace
}  // namespace pendulum::prediction_test
