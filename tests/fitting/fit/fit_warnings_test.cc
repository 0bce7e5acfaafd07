// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/fit/fit_warnings.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/recording/window.h"
#include "tests/fitting/fit_support.h"

namespace pendulum::fit_warnings_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::vector<std::string> Codes(const FitReport& report) {
  std::vector<std::string> codes;
  for (const Warning& warning : report.warnings) codes.emplace_back(warning.code.text());
  return codes;
}

double NumberAfter(const std::string& words, const std::string& message) {
  const std::size_t found = message.find(words);
  EXPECT_NE(found, std::string::npos) << message;
  return found == std::string::npos ? 0 : std::stod(message.substr(found + words.size()));
}

TEST(FitWarnings, AreEmptyForAGoodFit) {
  for (const std::string model : {"linear", "viscous", "coulomb", "drag"}) {
    SyntheticOptions run = NoisyRun(model);
    run.duration = 60;
    run.parameters.back() *= 3;  // away from its bound
    EXPECT_THAT(Codes(FitOwnModel(run)), IsEmpty()) << model;
  }
}

TEST(FitWarnings, CountSaturatedReadingsWithinTheWindow) {
  SyntheticOptions run = TextbookRun("coulomb");
  run.range = SensorRange{-0.42, 0.42};  // held at 0.435 until 1.9 s; the next turning points are -0.40 and 0.40
  const Recording recording = Must(SimulateRecording(run));
  const FitReport whole = Fit(recording, ModelOptions("coulomb"));
  ASSERT_THAT(Codes(whole), testing::Contains("saturated"));
  const auto warning = std::find_if(whole.warnings.begin(), whole.warnings.end(),
                                    [](const Warning& w) { return w.code == "saturated"; });
  EXPECT_THAT(std::stoi(MessageText(*warning)), testing::AllOf(testing::Ge(190), testing::Le(200)));
  EXPECT_THAT(Codes(Fit(Must(SelectWindow(recording, 2.3, 20)), ModelOptions("coulomb"))),
              testing::Not(testing::Contains("saturated")));
}

TEST(FitWarnings, ReportAModelThatDoesNotDescribeTheData) {
  SyntheticOptions run = TextbookRun("drag");
  run.release_angle = 1.5;
  run.noise = 0.002;
  const Recording recording = Must(SimulateRecording(run));
  const FitReport poor = Fit(recording, ModelOptions("viscous"));
  EXPECT_THAT(Codes(poor), ElementsAre("lack_of_fit", "suspected_friction_law"));
  const std::string message = MessageText(poor.warnings[0]);
  EXPECT_THAT(message, HasSubstr("the error bars may be wrong"));
  // The message gives the residuals relative to the noise, and the misfit without the noise, with two digits.
  const double rms = poor.statistics.rms_residual;
  EXPECT_THAT(NumberAfter("the residuals are autocorrelated and ", message) / (rms / 0.002),
              testing::DoubleNear(1, 0.05));
  EXPECT_THAT(NumberAfter("the misfit is ", message) / std::sqrt(rms * rms - 0.002 * 0.002),
              testing::DoubleNear(1, 0.05));
}

TEST(FitWarnings, ReportAutocorrelatedResiduals) {
  SyntheticOptions run = NoisyRun();
  run.duration = 30;
  Recording recording = Must(SimulateRecording(run));
  SyntheticOptions silent = run;
  silent.noise = 0;
  const Eigen::VectorXd noise = recording.value - Must(SimulateRecording(silent)).value;
  double previous = 0;  // AR(1), ρ = 0.3: neighbours differ nearly as much as independent samples do
  for (Eigen::Index i = 0; i < recording.size(); ++i) {
    const double next = 0.3 * previous + noise[i];
    recording.value[i] += next - noise[i];
    previous = next;
  }
  EXPECT_THAT(Codes(Fit(recording, ModelOptions("coulomb"))), ElementsAre("correlated_residuals"));
}

TEST(FitWarnings, ReportASensorWithLessNoiseThanItsResolution) {
  for (const double counts : {0.0, 0.1, 0.25, 0.5, 1.0}) {
    SyntheticOptions run = TextbookRun("coulomb");
    run.resolution = kCount;
    run.noise = counts * kCount;
    FitOptions options = ModelOptions("coulomb");
    options.noise = NoiseFamily::kGaussian;
    const std::vector<std::string> codes = Codes(Fit(Must(SimulateRecording(run)), options));
    const bool warned = std::find(codes.begin(), codes.end(), "noise_below_resolution") != codes.end();
    // Rounding adds a twelfth to the variance: an rms of half a count corresponds to noise of 0.41 counts.
    EXPECT_EQ(warned, counts < 0.4) << counts;
    // By default the fit treats the readings as quantized.
    EXPECT_THAT(Codes(FitOwnModel(run)), testing::Not(testing::Contains("noise_below_resolution"))) << counts;
  }
}

TEST(FitWarnings, ReportATrajectoryTooInaccurateForTheNoise) {
  const Recording recording = Must(SimulateRecording(NoisyRun()));
  const FitProblem problem = Must(MakeFitProblem(recording, ModelOptions("coulomb")));
  FitReport report = Fit(recording, ModelOptions("coulomb"));
  for (const double share : {0.001, 0.1}) {
    report.trace_error = share * report.noise.sigma;
    const std::vector<Warning> warnings =
        FitWarnings(recording, problem, Solution{}, {report, report.residual, {}, false});
    ASSERT_EQ(warnings.size(), share > 0.01 ? 1 : 0);
    for (const Warning& warning : warnings) EXPECT_EQ(warning.code, "trajectory_accuracy");
  }
}

TEST(FitWarnings, ReportAFrictionAtItsBound) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const FitReport report = Fit(Must(SimulateRecording(NoisyRun("viscous", seed))), ModelOptions("coulomb"));
    if (!report.Find("coulomb")->at_bound) {
      EXPECT_THAT(Codes(report), IsEmpty()) << seed;
      continue;
    }
    EXPECT_THAT(Codes(report), ElementsAre("at_bound")) << seed;
    EXPECT_THAT(MessageText(report.warnings[0]), HasSubstr("coulomb is at its bound 0;"));
  }
}

TEST(FitWarnings, ReportAReleaseAtAnEndOfTheHold) {
  const Recording recording = Must(SimulateRecording(NoisyRun()));
  const FitProblem problem = Must(MakeFitProblem(recording, ModelOptions("coulomb")));
  FitReport report = Fit(recording, ModelOptions("coulomb"));
  report.parameters[4].at_bound = true;
  report.parameters[1].at_bound = true;
  report.parameters[1].estimate = 0;
  Solution solution;
  solution.parameters = Truth(NoisyRun());
  const std::vector<Warning> warnings = FitWarnings(recording, problem, solution, {report, report.residual, {}, false});
  ASSERT_EQ(warnings.size(), 2);
  EXPECT_THAT(MessageText(warnings[0]), HasSubstr("release_time is at an end of the hold"));
  EXPECT_THAT(MessageText(warnings[1]), HasSubstr("viscous is at its bound 0;"));
}

TEST(FitWarnings, ReportAnotherMinimumAndAStopOnAKink) {
  const Recording recording = Must(SimulateRecording(NoisyRun()));
  const FitProblem problem = Must(MakeFitProblem(recording, ModelOptions("coulomb")));
  const FitReport report = [&] {
    FitReport fit = Fit(recording, ModelOptions("coulomb"));
    fit.warnings.clear();
    return fit;
  }();
  const double error = *report.Find("coulomb")->std_error;
  Solution solution;
  solution.parameters = Truth(NoisyRun());
  solution.sum = 1000;
  Minimum other{solution.parameters, 1005};  // 5 in -2 log L
  other.parameters[2] += 2 * error;
  solution.other_minima = {other};
  TraceSummary trace;
  trace.stop_time = 8;
  trace.smallest_reversal_margin = 2 * error;
  const auto codes = [&] {
    std::vector<std::string> found;
    for (const Warning& w : FitWarnings(recording, problem, solution, {report, report.residual, trace, false}))
      found.emplace_back(w.code.text());
    return found;
  };
  EXPECT_THAT(codes(), ElementsAre("another_minimum", "uncertain_stop"));
  trace.smallest_reversal_margin = 4 * error;
  EXPECT_THAT(codes(), ElementsAre("another_minimum"));
  solution.other_minima[0].sum = 1010;
  EXPECT_THAT(codes(), IsEmpty());
}

TEST(FitWarnings, ReportSizeAndDirectionOfADriftingZero) {
  for (const double drift : {0.001, -0.001}) {  // rad/s or rad/s²
    for (const Quantity quantity : {Quantity::kAngle, Quantity::kRate}) {
      SCOPED_TRACE(std::to_string(drift) + (quantity == Quantity::kAngle ? " of an angle" : " of a rate"));
      SyntheticOptions run = NoisyRun();
      run.duration = 30;
      run.quantity = quantity;
      Recording recording = Must(SimulateRecording(run));
      recording.value += drift * recording.time;
      const FitReport report = Fit(recording, ModelOptions("coulomb"));
      const Warning* const warning = FindWarning(report.warnings, "zero_drift");
      ASSERT_NE(warning, nullptr);
      const std::string message = MessageText(*warning);
      const bool angle = quantity == Quantity::kAngle;
      const std::string before = "the zero of the readings drifts by about ";
      ASSERT_THAT(message, testing::StartsWith(before));
      // The middle of the last whole period is 28 s after the middle of the first; the hold covers a part of the first.
      EXPECT_THAT(std::stod(message.substr(before.size())) / drift, testing::DoubleNear(28, 4.2));
      EXPECT_THAT(message,
                  testing::EndsWith(
                      angle ? " rad over the window; --init zero_drift=0 makes the drift a parameter of the fit"
                            : " rad/s over the window; --init bias_drift=0 makes the drift a parameter of the fit"));
    }
  }
}

TEST(FitWarnings, OmitADriftThatIsFitted) {
  SyntheticOptions run = NoisyRun();
  run.duration = 30;
  Recording recording = Must(SimulateRecording(run));
  recording.value += 0.001 * recording.time;
  FitOptions options = ModelOptions("coulomb");
  options.initial = {{"zero_drift", 0.0}};
  EXPECT_THAT(Codes(Fit(recording, options)), IsEmpty());
}

}  // namespace
}  // namespace pendulum::fit_warnings_test
