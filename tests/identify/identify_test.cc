// SPDX-License-Identifier: Apache-2.0
#include "pendulum/identify/identify.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/fitting/swing/choose_swings.h"
#include "pendulum/recording/readers/read_recording.h"
#include "tests/fitting/fit_support.h"

namespace pendulum::identify_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;
using testing::StartsWith;

IdentifyOptions OptionsFor(const std::vector<std::string>& models) {
  IdentifyOptions options;
  options.models = models;
  options.fit.model = models.front();
  return options;
}

/// The textbook's rig, I_O = 0.079 kg m² (src/docs/examples.md), held until 1.9 s.
std::vector<Result<Identification>> FitTextbook(const IdentifyOptions& options) {
  auto one = PrepareFile("datasets/textbook_rig.csv", options, Must(ReadRig("datasets/textbook_rig.json")));
  return IdentifyEach(options, Must(std::move(one)));
}

// Seconds labelled as milliseconds give a frequency a thousand times higher than the rig's masses and length predict.
TEST(IdentifyEach, RefusesARigThatContradictsTheSwing) {
  const IdentifyOptions options = OptionsFor({"viscous"});
  const Rig rig = Must(ReadRig("datasets/textbook_rig.json"));
  for (const double factor : {1e-3, 1.0}) {
    Recording recording = Must(ReadRecording("datasets/textbook_rig.csv"));
    recording.time *= factor;
    const auto runs = IdentifyEach(options, Must(PrepareRecording(std::move(recording), options, rig)));
    EXPECT_EQ(runs.at(0).has_value(), factor == 1);
    if (runs[0]) continue;
    EXPECT_EQ(runs[0].error().code, StatusCode::kDataLoss);
    EXPECT_THAT(runs[0].error().message(), HasSubstr("correct the unit of the times"));
  }
}

TEST(IdentifyEach, ReportsEachStep) {
  IdentifyOptions options = OptionsFor({"viscous", "coulomb"});
  std::vector<std::string> steps;
  options.fit.progress = [&](const ProgressStep& step) {
    const std::string count = " (" + std::to_string(step.done) + " of " + std::to_string(step.total) + ")";
    steps.push_back(step.what + (step.total > 0 ? count : ""));
  };
  ASSERT_TRUE(FitTextbook(options).at(0));
  EXPECT_THAT(steps, ElementsAre("fitting coulomb (0 of 2)", "fitting viscous (1 of 2)", "comparing the laws",
                                 "testing whether the parameters are constant"));
}

Result<Identification> FitWithRig(const std::string& rig, IdentifyOptions options) {
  return IdentifyEach(options, Must(PrepareFile("datasets/coulomb.csv", options, Must(ParseRig(rig, "rig.json")))))
      .at(0);
}

// The rig of the recording is 0.43 m long; its G/I is 1.803 / 0.079 1/s² (src/docs/examples.md).
TEST(IdentifyEach, ReportsGravityAndLengthOfAStringPendulum) {
  const auto run = FitWithRig(R"({"length": 0.43, "gravity": 9.81})", OptionsFor({"coulomb"}));
  ASSERT_TRUE(run) << run.error().message();
  const FitReport& fit = run->fits[0];
  const auto value = [&](const std::string& name) {
    const auto found = std::ranges::find(fit.derived, name, &DerivedQuantity::name);
    return found == fit.derived.end() ? 0 : found->estimate;
  };
  const double ratio = 1.80332325 / 0.079;
  EXPECT_NEAR(value("gravity"), 0.43 * ratio, 1e-3 * 0.43 * ratio);
  EXPECT_NEAR(value("effective_length"), 9.81 / ratio, 1e-3 * 9.81 / ratio);
  EXPECT_EQ(fit.Find("inertia")->unit, "s^2");
  EXPECT_FALSE(run->si_rig());
  EXPECT_EQ(run->rig->source.dump(), R"({"length":0.43,"gravity":9.81})");
}

TEST(IdentifyEach, TakesALinearTorqueForARigWithAStiffness) {
  IdentifyOptions options = OptionsFor({"viscous"});
  const auto refused = FitWithRig(R"({"stiffness": 0.02})", options);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, StatusCode::kInvalidArgument);
  EXPECT_THAT(refused.error().message(), HasSubstr("give --gravity linear"));
  options.rig_chooses_gravity = true;
  const auto run = FitWithRig(R"({"stiffness": 0.02})", options);
  ASSERT_TRUE(run) << run.error().message();
  EXPECT_EQ(run->fits[0].model.name, "linear");
  EXPECT_EQ(run->fits[0].Find("inertia")->unit, "kg m^2");
  EXPECT_EQ(std::ranges::count_if(run->warnings,
                                  [](const Warning& warning) { return warning.code == "linear_restoring_torque"; }),
            1);
}

/// Two recordings at 100 Hz joined; between them a hand seems to lift the pendulum for 4 s.
Recording TwoReleases() {
  SyntheticOptions first = NoisyRun("viscous", 1), second = NoisyRun("viscous", 2);
  first.duration = 9;
  second.release_angle = 0.6;
  Recording both = Must(SimulateRecording(first));
  const Recording other = Must(SimulateRecording(second));
  constexpr Eigen::Index kMove = 400;
  const Eigen::ArrayXd share = Eigen::ArrayXd::LinSpaced(kMove, 1, kMove) / (kMove + 1);
  const double from = both.value[both.size() - 1];
  const Eigen::ArrayXd move = from + (other.value[0] - from) * share.square() * (3 - 2 * share);
  Eigen::VectorXd value(both.size() + kMove + other.size());
  value << both.value, move.matrix(), other.value;
  both.value = value;
  both.time = Eigen::ArrayXd::LinSpaced(value.size(), 0, static_cast<double>(value.size() - 1)) / 100;
  both.path = "two.csv";
  return both;
}

std::vector<Result<Identification>> FitTwoReleases(const IdentifyOptions& options) {
  return IdentifyEach(options, Must(PrepareRecording(TwoReleases(), options, std::nullopt)));
}

TEST(IdentifyEach, AddsAllConclusionsToTheFit) {
  const auto runs = FitTextbook(OptionsFor({"viscous"}));
  ASSERT_THAT(runs, SizeIs(1));
  ASSERT_TRUE(runs[0]) << runs[0].error().message();
  const Identification& report = *runs[0];
  ASSERT_THAT(report.fits, SizeIs(1));
  const ParameterEstimate& inertia = *report.fits[0].Find("inertia");
  EXPECT_NEAR(inertia.estimate, 0.079, 4 * inertia.std_error.value());
  EXPECT_THAT(report.recordings.front().checks, SizeIs(1));
  EXPECT_THAT(report.recordings.front().constancy, SizeIs(1));
  EXPECT_TRUE(report.recordings.front().closed_forms && report.recordings.front().sampling && report.rig);
  EXPECT_FALSE(report.comparison);
  EXPECT_EQ(report.recordings.front().data.path, "datasets/textbook_rig.csv");
  EXPECT_EQ(report.recordings.front().data.samples, 2000);  // 20 s at 100 Hz
  EXPECT_EQ(runs[0]->recordings.front().used.size(), report.recordings.front().data.used_samples);
  ASSERT_THAT(report.across, SizeIs(1));
  EXPECT_THAT(report.across[0].shared, testing::ElementsAre("inertia", "viscous"));
  EXPECT_THAT(report.across[0].separate, testing::ElementsAre("converged"));
  EXPECT_FALSE(report.across[0].homogeneity);
  ASSERT_THAT(report.across[0].amplitudes, SizeIs(1));  // less than that of the release, by friction and by the mean
  const double released = std::abs(report.fits[0].Find("release_angle")->estimate);
  EXPECT_GT(report.across[0].amplitudes[0], 0.5 * released);
  EXPECT_LT(report.across[0].amplitudes[0], released);
  EXPECT_EQ(ExitCode(*runs[0]), 0);
}

TEST(IdentifyEach, ComparesSeveralModelsInTheOrderAskedFor) {
  const auto runs = FitTextbook(OptionsFor({"coulomb", "viscous"}));
  ASSERT_TRUE(runs.at(0)) << runs[0].error().message();
  const Identification& report = *runs[0];
  ASSERT_THAT(report.fits, SizeIs(2));
  EXPECT_EQ(report.fits[0].model.name, "coulomb");
  EXPECT_EQ(report.fits[1].model.name, "viscous");
  ASSERT_TRUE(report.comparison);
  EXPECT_EQ(report.recordings.front().closed_forms_model, report.fits[report.MainFit()].model.name);
}

TEST(IdentifyEach, ChecksTheMainFitOrAllFitsOrNoFit) {
  for (const auto& [checks, tested, compared] :
       {std::tuple(Checks::kNone, 0, 0), std::tuple(Checks::kStandard, 1, 1), std::tuple(Checks::kFull, 2, 2)}) {
    IdentifyOptions options = OptionsFor({"coulomb", "viscous"});
    options.checks = checks;
    const auto runs = FitTextbook(options);
    ASSERT_TRUE(runs.at(0)) << runs[0].error().message();
    const Identification& one = *runs[0];
    const auto is_tested = [](const Constancy& constancy) { return constancy.halves_p.has_value(); };
    const auto is_compared = [](const ClosedFormCheck& check) { return !check.rows.empty(); };
    EXPECT_EQ(std::ranges::count_if(one.recordings.front().constancy, is_tested), tested);
    EXPECT_EQ(std::ranges::count_if(one.recordings.front().checks, is_compared), compared);
    EXPECT_EQ(one.recordings.front().closed_forms.has_value(), checks != Checks::kNone);
    if (checks == Checks::kStandard) {
      EXPECT_TRUE(is_tested(one.recordings.front().constancy[one.MainFit()]));
    }
  }
}

TEST(IdentifyEach, MakesClosedFormsWithoutAFit) {
  IdentifyOptions options = OptionsFor({"viscous"});
  options.closed_form_only = true;
  const auto runs = FitTextbook(options);
  ASSERT_TRUE(runs.at(0)) << runs[0].error().message();
  EXPECT_THAT(runs[0]->fits, IsEmpty());
  EXPECT_TRUE(runs[0]->recordings.front().closed_forms);
  EXPECT_EQ(runs[0]->recordings.front().closed_forms_model, "viscous");
  EXPECT_EQ(ExitCode(*runs[0]), 0);
}

TEST(IdentifyEach, UsesSmallAngleFormulasForAnUnknownUnit) {
  IdentifyOptions options = OptionsFor({"viscous"});
  options.closed_form_only = true;
  Recording counts = Must(SimulateRecording(NoisyRun("viscous")));
  counts.value = counts.value.array() * 300 + 512;
  counts.unit = "counts";
  const auto runs = IdentifyEach(options, Must(PrepareRecording(counts, options, std::nullopt)));
  ASSERT_TRUE(runs.at(0)) << runs[0].error().message();
  EXPECT_EQ(runs[0]->recordings.front().closed_forms_model, "linear");
  ASSERT_THAT(runs[0]->recordings.front().warnings, Not(IsEmpty()));
  EXPECT_EQ(runs[0]->recordings.front().warnings.back().code, "uncalibrated");
  EXPECT_THAT(MessageText(runs[0]->recordings.front().warnings.back()),
              StartsWith("the readings are in counts, not in a unit of angle"));
}

// A window between two chosen ends has no measured half swing, from which the size of a gyro's swing would follow.
TEST(IdentifyEach, QuestionsTheUnitOfSmallSwingsOnly) {
  SyntheticOptions run = NoisyRun();
  run.quantity = Quantity::kRate;
  run.zero = 0;
  IdentifyOptions options = OptionsFor({"coulomb"});
  for (const double to : {std::numeric_limits<double>::quiet_NaN(), 9.0}) {
    options.swing.from = std::isnan(to) ? to : 0.0;
    options.swing.to = to;
    for (const double scale : {1.0, 0.01}) {
      Recording recording = Must(SimulateRecording(run));
      recording.value *= scale;
      recording.unit = "deg/s";
      const auto fitted = IdentifyEach(options, Must(PrepareRecording(std::move(recording), options, std::nullopt)));
      ASSERT_TRUE(fitted.at(0)) << fitted[0].error().message();
      const bool is_questioned = HasWarning(fitted[0]->recordings.front().warnings, "unit_questioned");
      EXPECT_EQ(is_questioned, scale < 1 && std::isnan(to)) << scale << " to " << to;
    }
  }
}

TEST(IdentifyEach, FitsEachChosenRelease) {
  IdentifyOptions options = OptionsFor({"viscous"});
  options.swing.release = SwingChoice::kAll;
  const auto runs = FitTwoReleases(options);
  ASSERT_THAT(runs, SizeIs(2));
  for (std::size_t i = 0; i < 2; ++i) {
    ASSERT_TRUE(runs[i]) << runs[i].error().message();
    EXPECT_EQ(runs[i]->recordings.front().data.release, i + 1);
    EXPECT_EQ(runs[i]->recordings.front().data.path, "two.csv");
    EXPECT_EQ(runs[i]->recordings.front().data.samples, 900 + 400 + 1000);
    EXPECT_EQ(ExitCode(*runs[i]), 0);
  }
  EXPECT_LT(runs[0]->recordings.front().data.to, runs[1]->recordings.front().data.from);
}

TEST(IdentifyEach, NamesTheFailedSwingAmongSeveral) {
  IdentifyOptions options = OptionsFor({"magic"});
  options.swing.release = SwingChoice::kAll;
  const auto runs = FitTwoReleases(options);
  ASSERT_THAT(runs, SizeIs(2));
  for (std::size_t i = 0; i < 2; ++i) {
    ASSERT_FALSE(runs[i]);
    EXPECT_EQ(runs[i].error().code, StatusCode::kInvalidArgument);
    EXPECT_THAT(runs[i].error().message(),
                StartsWith("two.csv: free swing " + std::to_string(i + 1) + ": there is no model 'magic'"));
  }
}

TEST(IdentifyEach, GivesTheErrorOfASingleFailedSwingWithoutAPrefix) {
  const auto runs = FitTextbook(OptionsFor({"magic"}));
  ASSERT_FALSE(runs.at(0));
  EXPECT_EQ(runs[0].error().code, StatusCode::kInvalidArgument);
  EXPECT_THAT(runs[0].error().message(), StartsWith("there is no model 'magic'"));
}

TEST(IdentifyEach, ExplainsMissingFitsAndClosedForms) {
  IdentifyOptions options = OptionsFor({"viscous"});
  options.closed_form_only = true;
  options.swing.from = 1.9;
  options.swing.to = 2.9;  // one turning point
  const auto runs = FitTextbook(options);
  ASSERT_FALSE(runs.at(0));
  EXPECT_EQ(runs[0].error().code, StatusCode::kFailedPrecondition);
  EXPECT_THAT(runs[0].error().message(), HasSubstr("turn"));
}

}  // namespace
}  // namespace pendulum::identify_test
