// SPDX-License-Identifier: Apache-2.0
// Options of a fit besides the model: priors, bounds, start values, a drift, a clock's scale, uncalibrated readings.
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/fitting/solve/fit_problem.h"
#include "tests/base/warning_matchers.h"
#include "tests/fitting/fit_support.h"

namespace pendulum::fit_options_test {
namespace {

using testing::DoubleNear;
using testing::HasSubstr;
using testing::Le;

Rig RigOf(const std::string& gravity_torque) {
  return Must(ParseRig("{\"gravity_torque\": " + gravity_torque + "}", "rig.json"));
}

Status RefusalOf(const FitOptions& options) {
  const auto fit = FitRecording(Must(SimulateRecording(NoisyRun("viscous"))), options);
  return fit ? Status{StatusCode::kInternal, "accepted"} : fit.error();
}

// ---- Priors --------------------------------------------------------------------------------------------------------

/// A prior on viscous friction: its offset and its width, in standard errors of the fit without it.
struct Prior {
  double off;
  double width;
};

/// Combination of two independent estimates by their variances (Gauss).
void ExpectCombined(const Recording& recording, FitOptions options, const Prior& prior, double tolerance) {
  SCOPED_TRACE("prior of " + std::to_string(prior.width) + " standard errors");
  const FitReport data = Fit(recording, options);
  const double value = data.Find("viscous")->estimate;
  const double error = *data.Find("viscous")->std_error;
  const ParameterPrior known{value + prior.off * error, prior.width * error};
  options.priors = {{"viscous", known}};
  const FitReport both = Fit(recording, options);
  ASSERT_EQ(both.termination, Termination::kConverged) << both.reason;
  const double information = 1 / (error * error) + 1 / (known.std_dev * known.std_dev);
  const double mean = (value / (error * error) + known.mean / (known.std_dev * known.std_dev)) / information;
  const double expected_error = 1 / std::sqrt(information);
  EXPECT_THAT(*both.Find("viscous")->std_error, DoubleNear(expected_error, tolerance * expected_error));
  EXPECT_THAT(both.Find("viscous")->estimate, DoubleNear(mean, tolerance * expected_error));
}

TEST(Prior, CombinesWithTheDataByItsVariance) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    for (const Prior prior : {Prior{1, 0.3}, Prior{1, 1}, Prior{-2, 1}, Prior{2, 3}}) {
      SCOPED_TRACE(seed);
      ExpectCombined(Must(SimulateRecording(NoisyRun("viscous", seed))), ModelOptions("viscous"), prior, 0.03);
    }
  }
}

TEST(Prior, IsInSiWithARig) {
  FitOptions options = ModelOptions("viscous");
  options.rig = RigOf("2.5");
  ExpectCombined(Must(SimulateRecording(NoisyRun("viscous"))), options, {1, 1}, 0.03);
}

TEST(Prior, DominatesIfPreciseAndHasNoEffectIfImprecise) {
  const Recording recording = Must(SimulateRecording(NoisyRun("viscous")));
  ExpectCombined(recording, ModelOptions("viscous"), {1, 0.01}, 0.03);
  ExpectCombined(recording, ModelOptions("viscous"), {10, 1000}, 0.03);
}

TEST(Prior, IsNotCountedAsASample) {
  const Recording recording = Must(SimulateRecording(NoisyRun("viscous")));
  FitOptions options = ModelOptions("viscous");
  options.priors = {{"viscous", {0.0016, 1e-5}}};
  const FitReport fit = Fit(recording, options);
  // Five parameters and sigma; BIC adds ln N for each, AIC adds 2.
  EXPECT_THAT(fit.statistics.bic - fit.statistics.aic, DoubleNear(6 * (std::log(1000) - 2), 1e-9));
  EXPECT_EQ(fit.residual.size(), 1000);
  EXPECT_THAT(fit.statistics.rms_residual, DoubleNear(std::sqrt(fit.residual.squaredNorm() / 1000), 1e-15));
}

TEST(Prior, UsesTheFilesClockForAReleaseTime) {
  SyntheticOptions run = NoisyRun("viscous");
  run.start_time = 1000;
  run.release_time = 1001.9;
  FitOptions options = ModelOptions("viscous");
  options.priors = {{"release_time", {1001.9, 1e-6}}};
  EXPECT_THAT(Fit(Must(SimulateRecording(run)), options).Find("release_time")->estimate, DoubleNear(1001.9, 1e-6));
}

TEST(Prior, IsRefusedForAParameterTheModelLacks) {
  FitOptions options = ModelOptions("viscous");
  options.priors = {{"drag", {0.1, 0.1}}};
  const Status status = RefusalOf(options);
  EXPECT_EQ(status.code, StatusCode::kInvalidArgument);
  EXPECT_EQ(status.message(),
            "model viscous has no parameter 'drag' to give a prior with this start; it has inertia, viscous, "
            "release_angle, release_time, zero_angle");
}

// ---- Bounds and start values ---------------------------------------------------------------------------------------

TEST(Bounds, AreRespected) {
  const Recording recording = Must(SimulateRecording(NoisyRun("viscous")));
  const double truth = NoisyRun("viscous").parameters[1];
  FitOptions options = ModelOptions("viscous");
  for (const auto& [range, kept] : {std::pair(ParameterRange{0, 0.5 * truth}, 0.5 * truth),
                                    std::pair(ParameterRange{1.5 * truth, kUnbounded}, 1.5 * truth)}) {
    SCOPED_TRACE(kept);
    options.bounds = {{"viscous", range}};
    const FitReport fit = Fit(recording, options);
    EXPECT_DOUBLE_EQ(fit.Find("viscous")->estimate, kept);
    EXPECT_TRUE(fit.Find("viscous")->at_bound);
  }
  options.bounds = {{"viscous", {0.5 * truth, 1.5 * truth}}, {"inertia", {0.04, 0.05}}};
  const FitReport wide = Fit(recording, options);
  EXPECT_THAT(wide.Find("viscous")->estimate,
              DoubleNear(Fit(recording, ModelOptions("viscous")).Find("viscous")->estimate, 1e-8));
  EXPECT_FALSE(wide.Find("viscous")->at_bound);
}

TEST(Bounds, AreNamedInTheWarningAboutAParameterAtABound) {
  FitOptions options = ModelOptions("viscous");
  options.bounds = {{"viscous", {0, 0.0015}}};
  const FitReport fit = Fit(Must(SimulateRecording(NoisyRun("viscous"))), options);
  ASSERT_THAT(fit.warnings, testing::Contains(CodeIs("at_bound")));
  for (const Warning& warning : fit.warnings) {
    if (warning.code != "at_bound") continue;
    EXPECT_EQ(MessageText(warning),
              "viscous is at its given bound; the standard errors of the others assume that this value is exact, the "
              "intervals by "
              "profile likelihood do not; widen --bounds");
  }
}

TEST(Bounds, AreInSiWithARig) {
  FitOptions options = ModelOptions("viscous");
  options.rig = RigOf("2.5");
  options.bounds = {{"viscous", {0, 0.002}}};
  EXPECT_DOUBLE_EQ(Fit(Must(SimulateRecording(NoisyRun("viscous"))), options).Find("viscous")->estimate, 0.002);
}

TEST(Bounds, AreRefusedIfTheyLeaveNoValue) {
  const std::pair<ParameterRange, std::string> refused[] = {
      {{-5, -1}, "the bounds of viscous allow no value; it must be at least 0, and may be fixed with --fix"},
      {{0.2, 0.1}, "the bounds of viscous allow no value; it must be at least 0, and may be fixed with --fix"}};
  for (const auto& [range, message] : refused) {
    FitOptions options = ModelOptions("viscous");
    options.bounds = {{"viscous", range}};
    EXPECT_EQ(RefusalOf(options).code, StatusCode::kInvalidArgument);
    EXPECT_EQ(RefusalOf(options).message(), message);
  }
  FitOptions options = ModelOptions("viscous");
  options.bounds = {{"inertia", {-2, -1}}};
  EXPECT_EQ(RefusalOf(options).message(),
            "the bounds of inertia allow no value; it must be greater than 1e-30, and may be fixed with --fix");
  options.bounds = {{"coulomb", {0, 1}}};
  EXPECT_THAT(RefusalOf(options).message(), HasSubstr("model viscous has no parameter 'coulomb' to bound"));
}

TEST(Init, SetsTheStartOfTheSearch) {
  const Recording recording = Must(SimulateRecording(NoisyRun("viscous")));
  FitOptions options = ModelOptions("viscous");
  options.rig = RigOf("2.5");
  options.initial = {{"inertia", 0.11}, {"viscous", 0.02}};
  const FitProblem problem = Must(MakeFitProblem(recording, options));
  EXPECT_DOUBLE_EQ(problem.first_guess[0], 0.11 / 2.5);
  EXPECT_DOUBLE_EQ(problem.first_guess[1], 0.02 / 2.5);
  EXPECT_FALSE(problem.solve.fixed[0] || problem.solve.fixed[1]);
  const FitReport from_there = Fit(recording, options);
  options.initial.clear();
  const FitReport from_data = Fit(recording, options);
  for (const ParameterEstimate& parameter : from_data.parameters) {
    EXPECT_THAT(from_there.Find(parameter.info.name)->estimate,
                DoubleNear(parameter.estimate, 0.01 * *parameter.std_error));
  }
}

TEST(Init, IsRefusedOutsideTheBounds) {
  FitOptions options = ModelOptions("viscous");
  options.initial = {{"viscous", -1.0}};
  EXPECT_EQ(RefusalOf(options).code, StatusCode::kInvalidArgument);
  EXPECT_EQ(RefusalOf(options).message(), "viscous cannot be started at -1; it must be at least 0");
  options.initial = {{"viscous", 0.5}};
  options.bounds = {{"viscous", {0.001, 0.25}}};
  EXPECT_EQ(RefusalOf(options).message(),
            "viscous cannot be started at 0.5; it must be at least 0.001 and at most 0.25");
  options.initial = {{"drag", 0.5}};
  EXPECT_THAT(RefusalOf(options).message(),
              HasSubstr("has no parameter 'drag' to give an initial value with this start"));
}

// ---- A zero that drifts --------------------------------------------------------------------------------------------

Recording Drifting(const SyntheticOptions& run, double drift) {
  Recording recording = Must(SimulateRecording(run));
  recording.value += drift * (recording.time.array() - recording.time[0]).matrix();
  return recording;
}

TEST(Drift, IsRecoveredWithTheOtherParameters) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    for (const bool released : {true, false}) {
      for (const Quantity quantity : {Quantity::kAngle, Quantity::kRate}) {
        SyntheticOptions run = released ? NoisyRun("coulomb") : MovingRun("coulomb");
        run.quantity = quantity;
        run.start_time = released ? 0 : 500;
        run.noise = quantity == Quantity::kAngle ? 0.002 : 0.01;
        run.seed = seed;
        const std::string name = quantity == Quantity::kAngle ? "zero_drift" : "bias_drift";
        FitOptions options = ModelOptions("coulomb");
        options.initial = {{name, 0.0}};
        SCOPED_TRACE(name + (released ? ", released, " : ", moving, ") + std::to_string(seed));
        const FitReport fit = Fit(Drifting(run, -0.004), options);
        ASSERT_EQ(fit.termination, Termination::kConverged) << fit.reason;
        std::vector<double> truth = Truth(run);
        truth.push_back(-0.004);
        EXPECT_EQ(fit.parameters.back().info.name, name);
        for (const double deviation : Deviations(fit, truth)) EXPECT_THAT(std::abs(deviation), Le(4.0));
      }
    }
  }
}

TEST(Drift, IsAParameterOnlyIfNamed) {
  const Recording recording = Must(SimulateRecording(NoisyRun()));
  EXPECT_EQ(Fit(recording, ModelOptions("coulomb")).Find("zero_drift"), nullptr);
  FitOptions options = ModelOptions("coulomb");
  options.fixed = {{"zero_drift", 0.0}};
  EXPECT_EQ(Fit(recording, options).Find("zero_drift")->estimate, 0);
  options.fixed.clear();
  options.bounds = {{"zero_drift", {-1, 1}}};
  EXPECT_NE(Fit(recording, options).Find("zero_drift"), nullptr);
  options.bounds.clear();
  options.priors = {{"zero_drift", {0, 1e-7}}};
  EXPECT_THAT(Fit(recording, options).Find("zero_drift")->estimate, DoubleNear(0, 4e-7));
  options.priors = {{"bias_drift", {0, 1e-7}}};  // the drift parameter of a rate sensor
  EXPECT_EQ(FitRecording(recording, options).error().code, StatusCode::kInvalidArgument);
}

// ---- A clock that is fast or slow ----------------------------------------------------------------------------------

/// Time stamps of a clock whose second lasts `scale` seconds; the first stamp is unchanged.
Recording Stretched(Recording recording, double scale) {
  recording.time = recording.time[0] + (recording.time.array() - recording.time[0]) / scale;
  recording.clock_scale = scale;
  return recording;
}

SyntheticOptions DragRun() {
  SyntheticOptions run = NoisyRun("drag");
  run.parameters[3] *= 10;
  run.release_angle = 1;
  run.start_time = 100;
  run.release_time = 101.9;
  run.noise = 5e-4;
  return run;
}

TEST(ClockScale, CorrectsAWrongClock) {
  const Recording recording = Must(SimulateRecording(DragRun()));
  const FitReport straight = Fit(recording, ModelOptions("drag"));
  for (const double scale : {0.9, 1.002, 1.1}) {
    SCOPED_TRACE(scale);
    const FitReport fit = Fit(Stretched(recording, scale), ModelOptions("drag"));
    for (const ParameterEstimate& parameter : straight.parameters) {
      const bool release = parameter.info.name == "release_time";
      const double expected = release ? 100 + (parameter.estimate - 100) / scale : parameter.estimate;
      EXPECT_THAT(fit.Find(parameter.info.name)->estimate, DoubleNear(expected, 1e-6 * std::abs(expected)))
          << parameter.info.name;
      const double error = release ? *parameter.std_error / scale : *parameter.std_error;
      EXPECT_THAT(*fit.Find(parameter.info.name)->std_error, DoubleNear(error, 1e-4 * error)) << parameter.info.name;
    }
  }
}

TEST(ClockScale, ScalesEachParameterByItsPowerOfTime) {
  // I / G is s², b / G is s, τ_c / G is 1, c / G is s².
  const Recording recording = Must(SimulateRecording(DragRun()));
  const FitReport without = Fit(recording, ModelOptions("drag"));
  Recording slow = recording;
  slow.clock_scale = 1.1;
  const FitReport with = Fit(slow, ModelOptions("drag"));
  const double factors[] = {1.21, 1.1, 1, 1.21, 1};
  for (std::size_t i = 0; i < std::size(factors); ++i) {
    const double expected = factors[i] * without.parameters[i].estimate;
    EXPECT_THAT(with.parameters[i].estimate, DoubleNear(expected, 1e-5 * std::abs(expected))) << i;
  }
  EXPECT_THAT(with.Find("release_time")->estimate, DoubleNear(without.Find("release_time")->estimate, 1e-6));
}

TEST(ClockScale, HasASystematicError) {
  Recording recording = Must(SimulateRecording(DragRun()));
  recording.clock_scale_std_dev = 3e-4;
  FitOptions options = ModelOptions("drag");
  const FitReport clock = Fit(recording, options);
  options.rig = RigOf(R"({"value": 2, "std_dev": 0.0016})");  // 8e-4
  const FitReport both = Fit(recording, options);
  const std::pair<const char*, std::pair<double, double>> relative[] = {// dI/I = 2 dT/T, with the rig's in quadrature
                                                                        {"inertia", {6e-4, 1e-3}},
                                                                        {"viscous", {3e-4, std::hypot(3e-4, 8e-4)}},
                                                                        {"drag", {6e-4, 1e-3}}};
  for (const auto& [name, expected] : relative) {
    SCOPED_TRACE(name);
    EXPECT_THAT(*clock.Find(name)->systematic.Total() / clock.Find(name)->estimate, DoubleNear(expected.first, 1e-9));
    EXPECT_THAT(*both.Find(name)->systematic.Total() / both.Find(name)->estimate, DoubleNear(expected.second, 1e-9));
  }
  EXPECT_FALSE(clock.Find("coulomb")->systematic.Total());
  EXPECT_THAT(*both.Find("coulomb")->systematic.Total() / both.Find("coulomb")->estimate, DoubleNear(8e-4, 1e-9));
  EXPECT_FALSE(clock.Find("release_angle")->systematic.Total() || clock.Find("zero_angle")->systematic.Total());
}

TEST(ClockScale, ContributesItsErrorToRatesOfAnAngle) {
  Recording recording = Drifting(MovingRun("coulomb"), 0.01);
  recording.clock_scale_std_dev = 3e-4;
  FitOptions options = ModelOptions("coulomb");
  options.initial = {{"zero_drift", 0.0}};
  const FitReport fit = Fit(recording, options);
  for (const char* const name : {"initial_rate", "zero_drift"}) {
    ASSERT_TRUE(fit.Find(name)->systematic.Total()) << name;
    EXPECT_THAT(*fit.Find(name)->systematic.Total() / fit.Find(name)->estimate, DoubleNear(3e-4, 1e-9)) << name;
  }
}

// ---- Counts without a calibration ----------------------------------------------------------------------------------

Recording InCounts(Recording recording) {
  recording.value = 512 + recording.value.array() / kCount;
  recording.unit = "counts";
  return recording;
}

TEST(Counts, AreRefusedForAModelThatNeedsAnAngle) {
  Recording counts = InCounts(Must(SimulateRecording(NoisyRun("viscous"))));
  for (const std::string path : {"", "run.csv"}) {
    counts.path = path;
    const auto refused = FitRecording(counts, ModelOptions("coulomb"));
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, StatusCode::kDataLoss);
    EXPECT_EQ(
        refused.error().message(),
        (path.empty() ? "" : "run.csv: ") +
            std::string(
                "the readings are in counts, but model coulomb needs an angle: give readings at known angles with "
                "--calibration (a table such as counts,angle_deg), or fit --model linear, whose period "
                "and damping need no angle"));
  }
}

TEST(Counts, GiveThePeriodAndDampingOfTheLinearModel) {
  const Recording angles = Must(SimulateRecording(NoisyRun("linear")));
  const FitReport calibrated = Fit(angles, ModelOptions("linear"));
  const FitReport counts = Fit(InCounts(angles), ModelOptions("linear"));
  EXPECT_EQ(counts.termination, Termination::kConverged) << counts.reason;
  ASSERT_EQ(counts.derived.size(), calibrated.derived.size());
  for (std::size_t i = 0; i < counts.derived.size(); ++i) {
    SCOPED_TRACE(counts.derived[i].name);
    EXPECT_THAT(counts.derived[i].estimate / calibrated.derived[i].estimate, DoubleNear(1, 1e-6));
    EXPECT_THAT(*counts.derived[i].std_error / *calibrated.derived[i].std_error, DoubleNear(1, 1e-4));
  }
  EXPECT_EQ(counts.reading_unit, "counts");
  EXPECT_EQ(counts.Find("release_angle")->unit, "counts");
  EXPECT_EQ(counts.Find("zero_angle")->unit, "counts");
  EXPECT_EQ(counts.Find("inertia")->unit, "s^2");
  EXPECT_THAT(counts.Find("zero_angle")->estimate, DoubleNear(512 + 0.012 / kCount, 0.2));
}

// ---- Priors that contradict the data --------------------------------------------------------------------------------

std::vector<std::string> CodesWithPrior(double off, double width) {
  const Recording recording = Must(SimulateRecording(NoisyRun("viscous")));
  const ParameterEstimate viscous = *Fit(recording, ModelOptions("viscous")).Find("viscous");
  FitOptions options = ModelOptions("viscous");
  options.priors = {{"viscous", {viscous.estimate + off * *viscous.std_error, width * *viscous.std_error}}};
  std::vector<std::string> codes;
  for (const Warning& warning : Fit(recording, options).warnings) codes.emplace_back(warning.code.text());
  return codes;
}

TEST(Prior, CausesAWarningIfTheRecordingContradictsIt) {
  using testing::Contains;
  using testing::Not;
  // Differences of 6 / sqrt(2), 6 and 2 standard deviations; a narrow prior decides the estimate in any case.
  EXPECT_THAT(CodesWithPrior(6, 1), Contains("prior_conflict"));
  EXPECT_THAT(CodesWithPrior(6, 0.01), Contains("prior_conflict"));
  EXPECT_THAT(CodesWithPrior(2, 0.01), Not(Contains("prior_conflict")));
  EXPECT_THAT(CodesWithPrior(2, 1), Not(Contains("prior_conflict")));
}

}  // namespace
}  // namespace pendulum::fit_options_test
