// SPDX-License-Identifier: Apache-2.0
// Fits the recordings in datasets/ as a user would, and compares with the true values stored beside each recording.
#include <cmath>
#include <fstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "pendulum/fitting/swing/choose_swings.h"
#include "pendulum/fitting/swing/fit_swing.h"
#include "pendulum/recording/readers/read_recording.h"
#include "tests/fitting/fit_support.h"

namespace pendulum::datasets_test {
namespace {

struct Dataset {
  std::string name;
  std::string model;
};

void PrintTo(const Dataset& dataset, std::ostream* out) { *out << dataset.name << '_' << dataset.model; }

class Datasets : public testing::TestWithParam<Dataset> {};

TEST_P(Datasets, TruthIsRecoveredWithinFourStandardErrors) {
  FitOptions options = ModelOptions(GetParam().model);
  options.rig = Must(ReadRig("datasets/textbook_rig.json"));
  const FitReport report = Fit(Must(ReadRecording("datasets/" + GetParam().name + ".csv")), options);
  ASSERT_EQ(report.termination, Termination::kConverged) << report.reason;
  const nlohmann::json truth = nlohmann::json::parse(std::ifstream("datasets/" + GetParam().name + "_truth.json"));
  for (const ParameterEstimate& parameter : report.parameters) {
    const double expected = truth.value(std::string(parameter.info.name), 0.0);
    const double tolerance =
        parameter.at_bound ? parameter.upper95.value() - parameter.estimate : 4 * parameter.std_error.value();
    EXPECT_THAT(parameter.estimate, testing::DoubleNear(expected, tolerance)) << parameter.info.name;
  }
  // Rounding adds q²/12 to the variance.
  EXPECT_THAT(report.noise.sigma / truth.at("sigma_rad").get<double>(), testing::DoubleNear(1.04, 0.06));
}

/// This recording comes from the logger. Calibration, clock and rig have limited accuracy, so the test combines
/// statistical and systematic errors.
TEST(RecordedRun, TruthIsRecoveredWithinFourStandardErrors) {
  const Recording recording = Must(ReadRecording("datasets/recorded.csv"));
  FitOptions options = ModelOptions("coulomb");
  options.rig = Must(ReadRig("datasets/recorded_rig.json"));
  const FitReport report = Fit(recording, options);
  ASSERT_EQ(report.termination, Termination::kConverged) << report.reason;
  nlohmann::json truth = nlohmann::json::parse(std::ifstream("datasets/recorded_truth.json"));
  const double clock_scale = truth.at("clock_scale").get<double>();
  EXPECT_THAT(recording.clock_scale, testing::DoubleNear(clock_scale, 4 * recording.clock_scale_std_dev));
  truth["release_time"] = truth.at("release_time").get<double>() / clock_scale;  // on the logger's clock
  for (const ParameterEstimate& parameter : report.parameters) {
    const double error = std::hypot(parameter.std_error.value(), parameter.systematic.Total().value());
    const double expected = truth.at(std::string(parameter.info.name)).get<double>();
    EXPECT_THAT(parameter.estimate, testing::DoubleNear(expected, 4 * error)) << parameter.info.name;
  }
}

/// The recording ends five seconds after the pendulum comes to rest. The last turning points are a few counts high.
TEST(RecordedRun, EndsAtRest) {
  const ChosenSwings swings = Must(ChooseSwings(Must(ReadRecording("datasets/recorded.csv")), {}));
  ASSERT_THAT(swings.found, testing::SizeIs(1));
  EXPECT_THAT(Sentence(swings.found.front().ends), testing::StartsWith("at rest from about 4"));
}

INSTANTIATE_TEST_SUITE_P(All, Datasets,
                         testing::Values(Dataset{"textbook_rig", "viscous"}, Dataset{"textbook_rig", "coulomb"},
                                         Dataset{"coulomb", "coulomb"}, Dataset{"to_rest", "coulomb"}),
                         testing::PrintToStringParamName());

}  // namespace
}  // namespace pendulum::datasets_test
