// SPDX-License-Identifier: Apache-2.0
#include "pendulum/analysis/part_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string_view>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/analysis/fitted_run.h"

namespace pendulum::part_fit_test {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::AllOf;
using testing::Contains;
using testing::DoubleNear;
using testing::ElementsAre;
using testing::Gt;
using testing::HasSubstr;
using testing::Le;
using testing::Lt;
using testing::Not;

auto RelativelyNear(double expected, double tolerance) { return DoubleNear(expected, std::abs(tolerance * expected)); }

double EstimateOf(const PartFit& part, std::string_view name) { return part.fit.Find(name)->estimate; }

/// Noise of a millionth of the swing: the tolerances below are some hundred times its effect.
SyntheticOptions QuietRun(std::string_view model) {
  SyntheticOptions run = TextbookRun(model);
  run.noise = 4e-7;
  return run;
}

Trajectory MotionOf(const SyntheticOptions& run) {
  TraceOptions trace;
  trace.end = run.duration;
  return Must(MakeTrajectory(run.model, run.parameters, {StartKind::kRelease, run.release_time, run.release_angle, 0.0},
                             trace));
}

/// Independent standard normal numbers, of a fixed seed.
MatrixXd Normal(Index rows, Index columns, unsigned seed) {
  std::mt19937_64 generator(seed);
  std::normal_distribution<double> normal;
  return MatrixXd::NullaryExpr(rows, columns, [&] { return normal(generator); });
}

/// AR(1) noise of variance 1 with this correlation.
VectorXd Remembering(Index size, double correlation, unsigned seed) {
  VectorXd z = Normal(size, 1, seed);
  for (Index i = 1; i < size; ++i) z[i] = correlation * z[i - 1] + std::sqrt(1 - correlation * correlation) * z[i];
  return z;
}

Autocorrelation FirstOrder(double correlation) {
  Autocorrelation memory;
  memory.kind = Autocorrelation::Kind::kAutoregressive;
  memory.autoregressive = {correlation};
  memory.innovation_variance = 1 - correlation * correlation;
  memory.interval = 1;
  return memory;
}

VectorXd Seconds(Index count) { return VectorXd::LinSpaced(count, 0, static_cast<double>(count - 1)); }

// ---- Parts ---------------------------------------------------------------------------------------------------------

TEST(Parts, RecoverTheTruthFromANoiseFreePart) {
  const SyntheticOptions run = QuietRun("coulomb");
  const FittedRun whole = FitTo(run, "coulomb", {});
  const PartFit part = Parts(whole.recording, whole.fit, ModelOptions("coulomb")).Fit(7.125, 14, {});
  ASSERT_TRUE(part.converged()) << part.reason;
  const std::vector<double> truth = TextbookParameters(run.model);
  for (std::size_t i = 0; i < truth.size(); ++i)
    EXPECT_THAT(part.fit.parameters[i].estimate, RelativelyNear(truth[i], 1e-4)) << part.fit.parameters[i].info.name;
  // 7.13 s is the first sample inside the part, at 100 Hz.
  EXPECT_EQ(part.first, 713);
  EXPECT_EQ(part.part.size(), 688);
  EXPECT_THAT(EstimateOf(part, "initial_angle"), DoubleNear(MotionOf(run).Angle(7.13), 1e-6));
  EXPECT_THAT(EstimateOf(part, "initial_rate"), DoubleNear(MotionOf(run).Rate(7.13), 1e-5));
}

TEST(Parts, HoldWhatTheyAreToldAndWhatTheWholeFitHeld) {
  FitOptions options = ModelOptions("coulomb");
  options.fixed = {{"viscous", 0.0016}};
  const FittedRun whole = FitTo(Must(SimulateRecording(NoisyRun())), options);
  const PartFit part = Parts(whole.recording, whole.fit, options).Fit(3, 9, {"coulomb", "zero_angle"});
  for (const char* name : {"viscous", "coulomb", "zero_angle"}) {
    EXPECT_TRUE(part.fit.Find(name)->fixed) << name;
    EXPECT_THAT(EstimateOf(part, name), RelativelyNear(whole.fit.Find(name)->estimate, 1e-12)) << name;
  }
  EXPECT_FALSE(part.fit.Find("inertia")->fixed);
}

// The zero is 0.012 rad and drifts by 0.001 rad/s: at 8 s it is 0.020 rad.
TEST(Parts, TakeADriftingZeroFromWhereItIsAtTheirBegin) {
  Recording recording = Must(SimulateRecording(QuietRun("viscous")));
  recording.value += 0.001 * recording.time;
  FitOptions options = ModelOptions("viscous");
  options.initial = {{"zero_drift", 0.0}};
  const FittedRun whole = FitTo(recording, options);
  const Parts parts(whole.recording, whole.fit, options);
  EXPECT_THAT(EstimateOf(parts.Fit(8, 16, {}), "zero_angle"), DoubleNear(0.020, 1e-6));
  EXPECT_THAT(EstimateOf(parts.Fit(8, 16, {"zero_angle", "zero_drift"}), "zero_angle"), DoubleNear(0.020, 1e-6));
}

TEST(Parts, SayWhyOneIsNotFitted) {
  SyntheticOptions run = NoisyRun();
  run.duration = 60;  // at rest after 41 s
  const FittedRun whole = FitTo(run, "coulomb", {});
  const Parts parts(whole.recording, whole.fit, ModelOptions("coulomb"));
  EXPECT_FALSE(parts.Fit(3, 3.02, {}).converged());
  EXPECT_THAT(parts.Fit(3, 3.02, {}).reason, HasSubstr("samples"));
  EXPECT_THAT(parts.Fit(45, 60, {}).reason, HasSubstr("swing"));
}

// A pendulum without friction keeps its amplitude A under either gravity, because energy is conserved.
TEST(Parts, SeeTheAmplitudeOfAnUndampedSwing) {
  for (const char* model : {"linear", "viscous"}) {
    SyntheticOptions run = QuietRun(model);
    run.parameters[1] = 0;
    run.release_angle = 1.2;
    FitOptions options = ModelOptions(model);
    options.fixed = {{"viscous", 0.0}};
    const FittedRun whole = FitTo(Must(SimulateRecording(run)), options);
    const Parts parts(whole.recording, whole.fit, options);
    for (const double time : {1.0, 2.0, 2.2, 7.77, 19.5}) EXPECT_THAT(parts.Amplitude(time), DoubleNear(1.2, 1e-5));
  }
}

TEST(Parts, HaveNoAmplitudeWithoutAMotion) {
  FittedRun whole = FitTo(NoisyRun(), "coulomb", {});
  whole.fit.parameters[0].estimate = -1;
  EXPECT_EQ(Parts(whole.recording, whole.fit, ModelOptions("coulomb")).Amplitude(3), 0);
}

TEST(Parts, KnowTheSensorsRangeWhereItCutsReadingsOff) {
  SyntheticOptions run = NoisyRun();
  const FittedRun free = FitTo(run, "coulomb", {});
  EXPECT_EQ(Parts(free.recording, free.fit, ModelOptions("coulomb")).NoiseOf(free.fit).high, kInfinity);
  run.range = SensorRange{-0.3, 0.3};
  const FittedRun cut = FitTo(run, "coulomb", {});
  const NoiseModel noise = Parts(cut.recording, cut.fit, ModelOptions("coulomb")).NoiseOf(cut.fit);
  // Inside the range by a millionth of it, so that rounding does not hide a clipped reading.
  EXPECT_THAT(noise.low, DoubleNear(-0.3, 2e-6));
  EXPECT_THAT(noise.high, DoubleNear(0.3, 2e-6));
  EXPECT_EQ(noise.sigma, cut.fit.noise.sigma);
}

// ---- CutEvenly -----------------------------------------------------------------------------------------------------

/// Linear gravity with viscous friction: A = A_0 exp(-t / τ), t after the release, τ = 2 I / b.
struct ExponentialDecay {
  explicit ExponentialDecay(double decay_time) {
    SyntheticOptions run = QuietRun("linear");
    run.parameters[1] = 2 * run.parameters[0] / decay_time;
    run.release_time = 0.5;
    whole = FitTo(run, "linear", {});
    half_swing = kPi / std::sqrt(1 / run.parameters[0] - 1 / (decay_time * decay_time));
    for (double end = 0.5; end < 19.9; end += half_swing) ends.push_back(end);
  }

  FittedRun whole;
  double half_swing;
  std::vector<double> ends;
};

// ∫ A^(2/3) dt up to t is 1.5 τ (1 - exp(-t / (1.5 τ))). The test computes where it reaches thirds of the whole. Cuts
// are at ends of half swings.
TEST(CutEvenly, MakesEqualIntegralsOfAKnownDecay) {
  const double decay = 12;
  const ExponentialDecay swing(decay);
  const Parts parts(swing.whole.recording, swing.whole.fit, ModelOptions("linear"));
  const std::vector<std::size_t> cuts = CutEvenly(swing.ends, 3, parts);
  ASSERT_EQ(cuts.size(), 4u);
  const double told = 1 - std::exp((swing.ends.front() - swing.ends.back()) / (1.5 * decay));
  for (const std::size_t k : {1u, 2u}) {
    const double wanted = 0.5 - 1.5 * decay * std::log(1 - told * static_cast<double>(k) / 3);
    EXPECT_THAT(swing.ends[cuts[k]], DoubleNear(wanted, 0.55 * swing.half_swing)) << k;
  }
  EXPECT_EQ(cuts.front(), 0u);
  EXPECT_EQ(cuts.back(), swing.ends.size() - 1);
}

// In a decay within two periods, half of the integral is reached after one period. A part must still have three
// periods.
TEST(CutEvenly, LeavesThreePeriodsToEachPart) {
  const ExponentialDecay swing(2.6);
  const Parts parts(swing.whole.recording, swing.whole.fit, ModelOptions("linear"));
  EXPECT_THAT(CutEvenly(swing.ends, 4, parts), ElementsAre(0, 6, 12, 18, swing.ends.size() - 1));
  const std::vector<double> fewest(swing.ends.begin(), swing.ends.begin() + 13);
  EXPECT_THAT(CutEvenly(fewest, 2, parts), ElementsAre(0, 6, 12));
}

// ---- Scores --------------------------------------------------------------------------------------------------------

// Normal: l = -(y - m)² / 2σ², so ∂l/∂m = (y - m) / σ² and -∂²l/∂m² = 1 / σ².
TEST(TermsOf, AreThoseOfANormalDensity) {
  NoiseModel noise;
  noise.sigma = 0.5;
  const ReadingTerms terms = TermsOf(noise, Eigen::Vector2d(1.0, 2.0), Eigen::Vector2d(0.9, 2.3));
  EXPECT_THAT(terms.score, ElementsAre(DoubleNear(0.4, 1e-12), DoubleNear(-1.2, 1e-12)));
  EXPECT_THAT(terms.information, ElementsAre(DoubleNear(4, 1e-12), DoubleNear(4, 1e-12)));
}

ReadingTerms TermsOfDraws(const NoiseModel& noise, const VectorXd& value) {
  return TermsOf(noise, value, VectorXd::Zero(value.size()));
}

TEST(ScoreCovariance, OfWhiteNormalNoiseIsThatOfIndependentScores) {
  NoiseModel noise;
  noise.sigma = 0.02;
  const VectorXd value = noise.sigma * Normal(50, 1, 1);
  const MatrixXd weights = Normal(50, 3, 2);
  const MatrixXd covariance = ScoreCovariance(noise, {}, TermsOfDraws(noise, value), Seconds(50), weights);
  const MatrixXd expected = weights.transpose() * weights / (0.02 * 0.02);
  EXPECT_THAT((covariance - expected).norm(), Lt(1e-12 * expected.norm()));
}

// Σ_ij w_i ρ^|i-j| w_j / σ², term by term.
TEST(ScoreCovariance, OfNoiseThatRemembersHasItsCorrelations) {
  NoiseModel noise;
  noise.sigma = 0.5;
  const VectorXd value = noise.sigma * Remembering(30, 0.8, 1);
  const VectorXd weights = Normal(30, 1, 2);
  double expected = 0;
  for (Index i = 0; i < 30; ++i)
    for (Index j = 0; j < 30; ++j) expected += weights[i] * std::pow(0.8, std::abs(i - j)) * weights[j] / 0.25;
  const MatrixXd covariance = ScoreCovariance(noise, FirstOrder(0.8), TermsOfDraws(noise, value), Seconds(30), weights);
  EXPECT_THAT(covariance(0, 0), RelativelyNear(expected, 1e-9));
}

// Fisher's information of the location of Student's t is (ν + 1) / (ν + 3) / scale²; 20000 draws reproduce it to 1 %.
TEST(ScoreCovariance, OfStudentsNoiseIsItsInformation) {
  NoiseModel noise;
  noise.family = NoiseFamily::kStudent;
  noise.sigma = 0.5;
  std::mt19937_64 generator(3);
  std::student_t_distribution<double> student(4);
  const VectorXd value = VectorXd::NullaryExpr(20000, [&] { return 0.5 * student(generator); });
  const MatrixXd ones = MatrixXd::Ones(20000, 1);
  const MatrixXd covariance = ScoreCovariance(noise, {}, TermsOfDraws(noise, value), Seconds(20000), ones);
  EXPECT_THAT(covariance(0, 0) / 20000, RelativelyNear(5.0 / 7 / 0.25, 0.03));
}

// Levels 2 σ apart: information Σ (φ(a) - φ(b))² / (Φ(b) - Φ(a)) of the intervals [a, b], in units of 1 / σ².
TEST(ScoreCovariance, OfCoarseLevelsIsTheInformationThatTheyLeave) {
  NoiseModel noise;
  noise.family = NoiseFamily::kQuantized;
  noise.sigma = 0.5;
  noise.resolution = 1;
  const VectorXd value = (0.5 * Normal(20000, 1, 4)).array().round();
  double expected = 0;
  for (int level = -3; level <= 3; ++level) {
    const double a = 2 * level - 1, b = 2 * level + 1;
    const double density = (std::exp(-0.5 * a * a) - std::exp(-0.5 * b * b)) / std::sqrt(2 * kPi);
    expected += density * density / (0.5 * (std::erfc(a / std::sqrt(2.0)) - std::erfc(b / std::sqrt(2.0))));
  }
  const MatrixXd ones = MatrixXd::Ones(20000, 1);
  const MatrixXd covariance = ScoreCovariance(noise, {}, TermsOfDraws(noise, value), Seconds(20000), ones);
  EXPECT_THAT(covariance(0, 0) / 20000, RelativelyNear(expected / 0.25, 0.02));
}

// Residuals about the mean of N correlated values, 4000 times: their corrected variance is 1 within 3 %.
TEST(Inflation, MendsTheVarianceOfResidualsAboutAMean) {
  constexpr Index kCount = 50;
  double lost = 0;  // the mean's variance over that of independent values
  for (Index i = 0; i < kCount; ++i)
    for (Index j = 0; j < kCount; ++j) lost += std::pow(0.9, std::abs(i - j)) / kCount;
  double variance = 0;
  for (unsigned seed = 0; seed < 4000; ++seed) {
    const VectorXd z = Remembering(kCount, 0.9, seed);
    variance += (z.array() - z.mean()).square().sum() / (kCount - 1) / 4000;
  }
  EXPECT_THAT(variance, Lt(0.8));
  EXPECT_THAT(variance * Inflation({}, kCount, 1, lost), DoubleNear(1, 0.03));
}

// A likelihood's σ² is RSS / N; for independent residuals it is too small by (N - k) / N.
TEST(Inflation, CountsParametersOnce) {
  EXPECT_DOUBLE_EQ(Inflation({}, 100, 5, 5), 1);
  NoiseModel quantized;
  quantized.family = NoiseFamily::kQuantized;
  EXPECT_DOUBLE_EQ(Inflation(quantized, 100, 5, 5), 100.0 / 95);
}

TEST(MemoryOf, IsThatOfTheNoise) {
  NoiseModel noise;
  noise.sigma = 0.5;
  const VectorXd zero = VectorXd::Zero(2000);
  const MatrixXd none(2000, 0);
  const auto memory = [&](const VectorXd& z) { return MemoryOf(Seconds(2000), noise.sigma * z, noise, zero, none); };
  EXPECT_EQ(memory(Normal(2000, 1, 1)).Name(), "white");
  const Autocorrelation remembered = memory(Remembering(2000, 0.9, 1));
  ASSERT_EQ(remembered.Name(), "AR(1)");
  // Its standard error is sqrt((1 - φ²) / N) = 0.01.
  EXPECT_THAT(remembered.autoregressive[0], DoubleNear(0.9, 0.04));
}

// ---- Linearize -----------------------------------------------------------------------------------------------------

LinearFit LinearOf(const FittedRun& run, bool with_bounds, const ParameterPriors& priors = {}) {
  const NoiseModel noise{run.fit.noise.family, run.fit.noise.sigma, 0};
  return Linearize(run.recording, run.fit, {}, TermsOf(noise, run.recording.value, run.fit.fitted), priors, with_bounds)
      .value();
}

TEST(Linearize, PredictsTheRefitAfterASmallChange) {
  const FittedRun before = FitTo(NoisyRun(), "coulomb", {});
  const LinearFit linear = LinearOf(before, true);
  const VectorXd change = 1e-3 * Normal(before.recording.size(), 1, 5);  // half the noise
  Recording changed = before.recording;
  changed.value += change;
  const FittedRun after = FitTo(changed, ModelOptions("coulomb"));
  const double variance = before.fit.noise.sigma * before.fit.noise.sigma;
  const VectorXd predicted = linear.influence.transpose() * change / variance;
  for (std::size_t i = 0; i < linear.free.size(); ++i) {
    const ParameterEstimate& old = before.fit.parameters[static_cast<std::size_t>(linear.free[i])];
    const double moved = after.fit.Find(old.info.name)->estimate - old.estimate;
    EXPECT_THAT(predicted[static_cast<Index>(i)], DoubleNear(moved, 0.02 * *old.std_error)) << old.info.name;
  }
  EXPECT_THAT(predicted[0], Not(DoubleNear(0, 0.05 * *before.fit.parameters[0].std_error)));
}

// The fit's reported errors come from another implementation.
TEST(Linearize, HasTheErrorsOfTheFitOnItsDiagonal) {
  const FittedRun run = FitTo(NoisyRun(), "coulomb", {});
  const LinearFit linear = LinearOf(run, true);
  ASSERT_EQ(linear.free.size(), run.fit.parameters.size());
  for (std::size_t i = 0; i < linear.free.size(); ++i) {
    const auto k = static_cast<Index>(i);
    EXPECT_THAT(std::sqrt(linear.inverse(k, k)), RelativelyNear(*run.fit.parameters[i].std_error, 1e-3));
  }
}

// A prior as accurate as the data: two independent values with errors s have a mean with error s / √2.
TEST(Linearize, CountsPriors) {
  const FittedRun run = FitTo(NoisyRun(), "coulomb", {});
  const double alone = std::sqrt(LinearOf(run, true).inverse(0, 0));
  const ParameterPriors priors = {{"inertia", {run.fit.parameters[0].estimate, alone}}};
  EXPECT_THAT(std::sqrt(LinearOf(run, true, priors).inverse(0, 0)), RelativelyNear(alone / std::sqrt(2.0), 1e-6));
}

// Dry friction fitted to a recording without it is at 0 in about half of the recordings.
TEST(Linearize, FreesWhatABoundHoldsWhenAsked) {
  SyntheticOptions run = NoisyRun("viscous");
  FittedRun fitted;
  do {
    fitted = FitTo(run, "coulomb", {});
  } while (!fitted.fit.parameters[2].at_bound && ++run.seed < 20);
  ASSERT_TRUE(fitted.fit.parameters[2].at_bound);
  EXPECT_THAT(LinearOf(fitted, true).free, Not(Contains(2)));
  EXPECT_THAT(LinearOf(fitted, false).free, Contains(2));
}

TEST(Linearize, IsNothingWithoutAMotion) {
  FittedRun run = FitTo(NoisyRun(), "coulomb", {});
  const ReadingTerms terms = TermsOf({}, run.recording.value, run.fit.fitted);
  run.fit.parameters[0].estimate = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(Linearize(run.recording, run.fit, {}, terms, {}, true));
}

// ---- Sentences and numbers -----------------------------------------------------------------------------------------

// Values from tables of the normal distribution.
TEST(TwoSidedP, IsThatOfTheNormalDistribution) {
  EXPECT_THAT(TwoSidedP(1.959963985), DoubleNear(0.05, 1e-9));
  EXPECT_THAT(TwoSidedP(-3.290526731), DoubleNear(0.001, 1e-10));
  EXPECT_EQ(TwoSidedP(0), 1);
}

TEST(After, IsTheNextInstant) {
  for (const double time : {0.0, 1.5, -3.0, 1e6}) {
    EXPECT_THAT(After(time), AllOf(Gt(time), Le(time + std::max(1e-9, std::abs(time) * 1e-15))));
    const double between = 0.5 * (time + After(time));
    EXPECT_TRUE(between == time || between == After(time));
  }
}

TEST(IsDrift, NamesThoseOfAnglesAndRates) {
  EXPECT_TRUE(IsDrift("zero_drift"));
  EXPECT_TRUE(IsDrift("bias_drift"));
  EXPECT_FALSE(IsDrift("zero_angle"));
}

TEST(TooShort, CountsHalfSwingsNotTheirEnds) {
  EXPECT_EQ(TooShort({0, 1, 2, 3}, "halves", 12), "3 half swings are too few for halves; 12 are needed");
}

}  // namespace
}  // namespace pendulum::part_fit_test
