// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/fit/order_violation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/fitting/fit_support.h"

namespace pendulum::order_violation_test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

FitProblem StribeckProblem() {
  return Must(MakeFitProblem(Must(SimulateRecording(NoisyRun())), ModelOptions("stribeck")));
}

// Order of the parameters: inertia, viscous, coulomb, stiction, stribeck_rate, ...
TEST(OrderViolation, ReportsAStictionBelowCoulomb) {
  const FitProblem problem = StribeckProblem();
  EXPECT_THAT(OrderViolation(problem, {0.04, 0.001, 0.002, 0.003, 1, 0, 0, 0}), IsEmpty());
  EXPECT_THAT(OrderViolation(problem, {0.04, 0.001, 0.002, 0.002, 1, 0, 0, 0}), IsEmpty());
  EXPECT_THAT(OrderViolation(problem, {0.04, 0.001, 0.002, 0.001, 1, 0, 0, 0}),
              HasSubstr("stiction 0.001, below coulomb 0.002"));
}

TEST(OrderViolation, IsEmptyForOtherLaws) {
  const FitProblem problem = Must(MakeFitProblem(Must(SimulateRecording(NoisyRun())), ModelOptions("coulomb")));
  EXPECT_THAT(OrderViolation(problem, {0.04, 0.001, -1, 0, 0, 0}), IsEmpty());
}

// With dry and viscous friction only, many recordings would estimate a stiction below coulomb; a fit never reports one.
TEST(FitRecording, NeverReportsAStictionBelowCoulomb) {
  int tied = 0;
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Recording recording = Must(SimulateRecording(NoisyRun("coulomb", seed)));
    const FitReport fit = Fit(recording, ModelOptions("stribeck"));
    EXPECT_GE(fit.Find("stiction")->estimate, fit.Find("coulomb")->estimate) << seed;
    if (fit.Find("stiction")->estimate > fit.Find("coulomb")->estimate) continue;
    ++tied;
    EXPECT_EQ(fit.termination, Termination::kNotIdentifiable) << seed;
    EXPECT_THAT(fit.reason, HasSubstr("which is impossible"));
    EXPECT_EQ(KeptAttempts(fit).back(), "simpler_law") << seed;
    EXPECT_EQ(fit.statistics.rms_residual, Fit(recording, ModelOptions("coulomb")).statistics.rms_residual) << seed;
  }
  EXPECT_GT(tied, 0);
}

TEST(ReportSimplerLaw, GivesTheRicherLawsParametersWithoutErrors) {
  const Recording recording = Must(SimulateRecording(NoisyRun()));
  FitOptions options = ModelOptions("stribeck");
  options.fixed = {{"stribeck_rate", 0.5}};
  const FitReport report =
      Must(ReportSimplerLaw(recording, options, Must(MakeFitProblem(recording, options)), "so it is"));
  EXPECT_EQ(report.model.name, "stribeck");
  EXPECT_EQ(report.reason, "so it is");
  ASSERT_NE(report.Find("stribeck_rate"), nullptr);
  EXPECT_EQ(report.Find("stribeck_rate")->estimate, 0.5);
  for (const ParameterEstimate& parameter : report.parameters) {
    EXPECT_FALSE(parameter.std_error) << parameter.info.name;
    EXPECT_FALSE(parameter.reason.empty()) << parameter.info.name;
  }
}

}  // namespace
}  // namespace pendulum::order_violation_test
