// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/fit/plausibility.h"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/fitting/likelihood/edge_noise.h"
#include "tests/fitting/fit_support.h"

namespace pendulum::plausibility_test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

/// A problem with the solution that has the given parameters.
struct Solved {
  FitProblem problem;
  Solution solution;
};

Solved SolvedAt(const SyntheticOptions& run, const FitOptions& options, const std::vector<double>& parameters) {
  Solved solved{Must(MakeFitProblem(Must(SimulateRecording(run)), options)), {}};
  solved.solution.parameters = parameters;
  solved.solution.noise = solved.problem.noise;
  const auto cost = MakeTrajectoryCost(solved.problem.model, solved.problem.start.start, solved.problem.data);
  EXPECT_TRUE(cost->Readings(parameters, &solved.solution.readings, nullptr));
  return solved;
}

std::string ReasonAt(const SyntheticOptions& run, const std::vector<double>& parameters) {
  const Solved solved = SolvedAt(run, ModelOptions(run.model.name), parameters);
  return ImplausibleReason(solved.problem, solved.solution, true);
}

TEST(ImplausibleReason, IsEmptyAtTheTruth) {
  for (const char* const model : {"viscous", "coulomb", "drag"}) {
    EXPECT_THAT(ReasonAt(NoisyRun(model), Truth(NoisyRun(model))), IsEmpty()) << model;
    EXPECT_THAT(ReasonAt(MovingRun(model), Truth(MovingRun(model))), IsEmpty()) << model;
  }
}

// The readings reach from -0.41 to 0.435 rad, so a quarter of their range is 0.21 rad: the limit is at 0.65 rad.
TEST(ImplausibleReason, NamesAZeroOutsideTheReadings) {
  std::vector<double> parameters = Truth(NoisyRun());
  parameters.back() = 0.6;
  EXPECT_THAT(ReasonAt(NoisyRun(), parameters), testing::Not(HasSubstr("zero_angle")));
  parameters.back() = 0.7;
  EXPECT_THAT(
      ReasonAt(NoisyRun(), parameters),
      HasSubstr("does not describe the readings: the fitted zero_angle of 0.7 is outside the readings; choose"));
}

TEST(ImplausibleReason, DoesNotJudgeAFixedZero) {
  std::vector<double> parameters = Truth(NoisyRun());
  parameters.back() = 0.7;
  FitOptions options = ModelOptions("coulomb");
  options.fixed["zero_angle"] = 0.7;
  const Solved solved = SolvedAt(NoisyRun(), options, parameters);
  EXPECT_THAT(ImplausibleReason(solved.problem, solved.solution, false), IsEmpty());
}

// A start at two thirds of the true angle: the readings swing 1.5 times as far. Uncorrelated residuals are noise.
TEST(ImplausibleReason, NamesAStartThatMissesTheReadings) {
  std::vector<double> parameters = Truth(NoisyRun());
  parameters[3] = NoisyRun().release_angle / 1.5;
  EXPECT_THAT(ReasonAt(NoisyRun(), parameters),
              HasSubstr("misses the start: in the first half swing the readings swing 1.5 times as far"));
  const Solved solved = SolvedAt(NoisyRun(), ModelOptions("coulomb"), parameters);
  EXPECT_THAT(ImplausibleReason(solved.problem, solved.solution, false), IsEmpty());
}

TEST(ImplausibleReason, AllowsAStartThatIsATenthOff) {
  std::vector<double> parameters = Truth(NoisyRun());
  parameters[3] = NoisyRun().release_angle / 1.1;
  EXPECT_THAT(ReasonAt(NoisyRun(), parameters), IsEmpty());
}

TEST(ImplausibleReason, NamesAHysteresisOfManyCounts) {
  SyntheticOptions run = MovingRun("coulomb");
  run.resolution = 0.01;
  run.noise = 0.05 * run.resolution;
  run.rows = RowTiming::kEvents;
  Solved solved{Must(MakeFitProblem(WithEdges(Must(SimulateRecording(run)), {}), {})), {}};
  solved.solution.parameters = solved.problem.first_guess;
  solved.solution.noise = solved.problem.noise;
  solved.solution.noise.family = NoiseFamily::kEdges;
  const auto place = solved.problem.Find(kHysteresis.name);
  ASSERT_TRUE(place);
  const auto cost = MakeTrajectoryCost(solved.problem.model, solved.problem.start.start, solved.problem.data);
  for (const auto& [counts, expected] : {std::pair(0.5, ""), std::pair(4.0, ""), std::pair(-38.0, "is 38 counts")}) {
    solved.solution.parameters[*place] = counts * run.resolution;
    ASSERT_TRUE(cost->Readings(solved.solution.parameters, &solved.solution.readings, nullptr));
    const std::string reason = ImplausibleReason(solved.problem, solved.solution, false);
    EXPECT_EQ(reason.empty(), std::string(expected).empty()) << reason;
    EXPECT_THAT(reason, HasSubstr(expected));
  }
}

TEST(TooFewEffectiveSamples, NeedsAMisfitAndFewerSamplesThanParameters) {
  EXPECT_THAT(
      TooFewEffectiveSamples(1.6, 7, 0.12),
      HasSubstr("leaves 12 % of their variance, and these residuals are worth only 1.6 independent readings for "
                "7 parameters"));
  EXPECT_THAT(TooFewEffectiveSamples(1.6, 7, 0.001), IsEmpty());  // slow noise, far below the swing
  EXPECT_THAT(TooFewEffectiveSamples(20, 7, 0.12), IsEmpty());
}

// Slow noise of a tenth of the amplitude is the hardest clean case: 100 seeded recordings of 5 s have few effective
// samples, but none is called a misfit.
TEST(MakeFitReportPlausibility, CallsNoCleanRecordingAMisfit) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    SyntheticOptions run = NoisyRun("viscous", seed);
    run.noise = seed % 2 == 0 ? 0.02 : 0.002;
    run.noise_correlation = 0.95;
    run.duration = 7;
    const FitReport fit = Must(FitRecording(Must(SimulateRecording(run)), ModelOptions("viscous")));
    EXPECT_THAT(fit.reason, testing::Not(HasSubstr("does not describe"))) << seed;
  }
}

}  // namespace
}  // namespace pendulum::plausibility_test
