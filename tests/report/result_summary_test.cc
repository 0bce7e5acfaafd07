// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/result_summary.h"

#include <algorithm>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/report/layout.h"
#include "tests/identify/example_joint_identification.h"

namespace pendulum::result_summary_test {
namespace {

using testing::AllOf;
using testing::Each;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;
using testing::StartsWith;

const SummaryQuantity& Find(const std::vector<SummaryQuantity>& quantities, const std::string& name) {
  const auto found = std::ranges::find(quantities, name, &SummaryQuantity::name);
  EXPECT_NE(found, quantities.end()) << name;
  return *found;
}

std::vector<std::string> Messages(const FitSummary& summary) {
  std::vector<std::string> messages;
  for (const Warning& warning : summary.warnings) messages.push_back(ShortText(warning));
  return messages;
}

std::vector<std::string> Lines(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

// ---- Numbers -------------------------------------------------------------------------------------------------------

// 0.00025 and 0.001 add up to 0.00103 in quadrature; the rule of the PDG keeps two digits of an error that begins with
// 103.
TEST(SummarizeFit, QuotesTheTotalErrorAndItsSource) {
  Identification identification = ExampleIdentification();
  identification.rig->source = {{"bob_mass", 0.38}, {"rod_mass", 0.095}, {"rod_length", 0.43}, {"gravity", 9.81}};
  const FitSummary summary = SummarizeFit(identification, 0);
  const SummaryQuantity& inertia = Find(summary.parameters, "inertia");
  EXPECT_EQ(inertia.symbol, "I_O");
  EXPECT_EQ(inertia.value, "0.0790");
  EXPECT_EQ(inertia.error, "0.0010");
  EXPECT_EQ(inertia.unit, "kg m^2");
  EXPECT_EQ(inertia.source, "masses and length");
  EXPECT_EQ(Find(summary.parameters, "viscous").source, "noise");
  EXPECT_TRUE(summary.has_systematic);
}

// Variances of 9 and 16: neither is four fifths of the whole.
TEST(SummarizeFit, NamesTwoSourcesIfNeitherIsMost) {
  Identification identification = ExampleIdentification();
  ParameterEstimate& viscous = identification.fits[0].parameters[1];
  viscous.std_error = 3e-5;
  viscous.systematic.Add(ErrorSource::kClock, 4e-5);
  EXPECT_EQ(Find(SummarizeFit(identification, 0).parameters, "viscous").source, "clock, noise");
}

TEST(SummarizeFit, SaysWhatTheWindowLeavesOut) {
  Identification identification = ExampleIdentification();
  identification.recordings.front().data.left_out = LeftOut{12, 47, true, 1.8};
  EXPECT_THAT(SummarizeResult(identification).data,
              HasSubstr(" Left out: 12 of 47 half swings, also the largest: the period's error × 1.8."));
}

TEST(SummarizeFit, SaysWhyThereIsNoError) {
  const FitSummary summary = SummarizeFit(ExampleIdentification(), 0);
  EXPECT_EQ(Find(summary.parameters, "coulomb").source, "at its bound");
  EXPECT_EQ(Find(summary.parameters, "zero_angle").source, "fixed");
  EXPECT_EQ(Find(summary.parameters, "zero_angle").error, "");
}

// The fitted inertia is 0.079 ± 0.00025 kg m² with the error of the torque, 1 %.
TEST(SummarizeFit, SaysThatTheRigDisagrees) {
  Identification identification = ExampleIdentification();
  identification.fits[0].warnings.clear();
  identification.recordings.front().warnings = {
      {"inertia_differs_from_rig", "the fitted inertia is 13 % larger than the rig's"}};
  identification.rig = ParseRig(R"({"gravity_torque": {"value": 1.8, "std_dev": 0.018},
                                    "inertia": {"value": 0.070, "std_dev": 0.0005}})",
                                "rig")
                           .value();
  const FitSummary summary = SummarizeFit(identification, 0);
  EXPECT_THAT(summary.verdict, HasSubstr("The rig disagrees: inertia 13 % larger (z 9.3): mass, "));
  EXPECT_EQ(summary.emphasis, Emphasis::kCaution);
  EXPECT_THAT(summary.warnings, IsEmpty());  // the verdict says it
}

TEST(SummarizeFit, SaysThatAShortRecordingIsNotTestedForConstancy) {
  Identification identification = ExampleIdentification();
  identification.recordings.front().constancy = {Constancy{}};
  EXPECT_THAT(SummarizeFit(identification, 0).remarks, Not(HasSubstr("Constancy")));
  identification.recordings.front().constancy[0].half_swings = 12;
  EXPECT_THAT(SummarizeFit(identification, 0).remarks, Not(HasSubstr("Constancy")));
  identification.recordings.front().constancy[0].half_swings = 9;
  EXPECT_THAT(SummarizeFit(identification, 0).remarks,
              HasSubstr("Constancy is not tested (9 half swings are too few): another recording may differ by more"));
  identification.fits[0].parameters[0].systematic.Add(ErrorSource::kFrictionLaw, 1e-3);
  EXPECT_THAT(SummarizeFit(identification, 0).remarks,
              HasSubstr("(9 half swings are too few); the errors allow for another friction law."));
}

// 95 % of the decay time: 148 s less sqrt(48² + 196²) s.
TEST(SummarizeFit, OmitsAnIntervalThatContains0) {
  for (const auto& [systematic, is_shown] : {std::pair(10.0, true), {100.0, false}}) {
    Identification identification = ExampleIdentification();
    DerivedQuantity decay{"decay_time", "s", 148, 10, 100, 700};
    decay.systematic.Add(ErrorSource::kSensor, systematic);
    identification.fits[0].derived = {decay};
    EXPECT_EQ(SummarizeFit(identification, 0).derived.size(), is_shown ? 1 : 0) << systematic;
  }
}

/// A share of the energy that was lost, with its standard error.
DerivedQuantity Share(std::string name, double share, std::optional<double> std_error) {
  return {std::move(name), "1", share, std_error};
}

TEST(SummarizeFit, SaysWhatTookTheEnergy) {
  Identification identification = ExampleIdentification();
  FitReport& fit = identification.fits[0];
  fit.derived = {Share("viscous_loss_share", 0.6213, 0.031), Share("dry_loss_share", 0.3787, 0.031)};
  fit.derived[1].systematic.Add(ErrorSource::kSensor, 0.05);
  EXPECT_EQ(WithBlanks(SummarizeFit(identification, 0).losses),
            "Viscous friction took 62.1 ± 3.1 % of the energy lost, dry friction 38 ± 6 %.");
  fit.derived.push_back(Share("viscous_loss_share_first_half_swing", 0.7112, 0.02));
  fit.derived.push_back(Share("dry_loss_share_first_half_swing", 0.2888, 0.02));
  EXPECT_THAT(WithBlanks(SummarizeFit(identification, 0).losses),
              EndsWith("6 % (first half swing: 71.1 ± 2.0 %, 28.9 ± 2.0 %)."));
}

TEST(SummarizeFit, SaysNothingOfLossesAtABoundOrOfOneLoss) {
  Identification identification = ExampleIdentification();
  EXPECT_EQ(SummarizeFit(identification, 0).losses, "");
  identification.fits[0].derived = {Share("viscous_loss_share", 1, {}), Share("dry_loss_share", 0, {})};
  EXPECT_EQ(SummarizeFit(identification, 0).losses, "");
  identification.fits[0].derived = {Share("viscous_loss_share", 1, 1e-9), Share("dry_loss_share", 0, 1e-9)};
  EXPECT_EQ(SummarizeFit(identification, 0).losses, "");
}

TEST(SummarizeFit, SaysThatTheReadingsDoNotTellTheLosses) {
  Identification identification = ExampleIdentification();
  identification.fits[0].derived = {Share("viscous_loss_share", 0.65, 0.26), Share("dry_loss_share", 0.35, 0.26)};
  EXPECT_EQ(SummarizeFit(identification, 0).losses,
            "The readings do not tell which friction took how much of the energy.");
}

TEST(SummarizeFit, GivesAnglesInDegrees) {
  const SummaryQuantity angle = Find(SummarizeFit(ExampleIdentification(), 0).parameters, "release_angle");
  EXPECT_EQ(angle.unit, "deg");
  EXPECT_EQ(angle.value, "24.236");  // 0.423 · 180 / π
  EXPECT_EQ(angle.error, "0.011");   // 0.0002 · 180 / π
}

// ---- Verdict -------------------------------------------------------------------------------------------------------

TEST(SummarizeFit, SaysWhetherTheLawDescribesTheReadings) {
  Identification identification = ExampleIdentification();
  identification.rig.reset();  // its inertia disagrees
  EXPECT_THAT(SummarizeFit(identification, 0).verdict, StartsWith("The law coulomb does not describe all readings"));
  EXPECT_EQ(SummarizeFit(identification, 0).emphasis, Emphasis::kCaution);
  identification.fits[0].warnings.clear();
  identification.recordings.front().constancy.clear();
  EXPECT_THAT(SummarizeFit(identification, 0).verdict, HasSubstr("autocorrelated noise of"));
  identification.fits[0].noise.autocorrelation = {};
  EXPECT_THAT(SummarizeFit(identification, 0).verdict,
              AllOf(StartsWith("The law coulomb describes"), HasSubstr("; noise of")));
  EXPECT_EQ(SummarizeFit(identification, 0).emphasis, Emphasis::kNone);
  identification.fits[0].termination = Termination::kNotConverged;
  EXPECT_THAT(SummarizeFit(identification, 0).verdict, StartsWith("No result with coulomb (not_converged)"));
  EXPECT_EQ(SummarizeFit(identification, 0).emphasis, Emphasis::kAlarm);
}

TEST(SummarizeFit, ShowsNoNumbersWithoutAResult) {
  Identification identification = ExampleIdentification();
  for (const Termination termination : {Termination::kFailed, Termination::kNotConverged}) {
    identification.fits[0].termination = termination;
    const FitSummary summary = SummarizeFit(identification, 0);
    EXPECT_THAT(summary.parameters, IsEmpty());
    EXPECT_EQ(summary.equation, "");
  }
}

TEST(SummarizeFit, OmitsTermsThatAreZero) {
  EXPECT_THAT(SummarizeFit(ExampleIdentification(), 0).equation, Not(HasSubstr("sgn")));  // coulomb is at its bound 0
}

// ---- Remarks -------------------------------------------------------------------------------------------------------

/// The remarks of the example with another error and interval of viscous friction, 0.003 N m s/rad.
std::string RemarksWithViscous(double std_error, double lower, double upper) {
  Identification identification = ExampleIdentification();
  ParameterEstimate& viscous = identification.fits[0].parameters[1];
  viscous.estimate = 0.003;
  viscous.std_error = std_error;
  viscous.lower95 = lower;
  viscous.upper95 = upper;
  return SummarizeFit(identification, 0).remarks;
}

// With few independent samples Student's t makes the interval much wider than two errors.
TEST(SummarizeFit, GivesIntervalsThatAreMuchWiderThanTwoErrors) {
  EXPECT_THAT(SummarizeFit(ExampleIdentification(), 0).remarks, Not(HasSubstr("95 %")));
  EXPECT_THAT(RemarksWithViscous(0.0004, 0.001, 0.008),
              HasSubstr("Quote as a 95 % interval: viscous 0.0010 to 0.0080"));
}

// A bound of another parameter lets an estimate move to one side only.
TEST(SummarizeFit, GivesIntervalsWithOneMuchLongerSide) {
  EXPECT_THAT(RemarksWithViscous(0.0005, 0.002, 0.0031),
              HasSubstr("Quote as a 95 % interval: viscous 0.0020 to 0.0031"));
}

TEST(SummarizeFit, NamesTermsThatMayBeZero) {
  Identification identification = ExampleIdentification();
  ParameterEstimate& viscous = identification.fits[0].parameters[1];
  viscous.std_error = 0.6 * viscous.estimate;
  viscous.lower95 = 0;
  viscous.upper95 = 2.2 * viscous.estimate;
  EXPECT_THAT(SummarizeFit(identification, 0).remarks, HasSubstr("Not distinguishable from 0: viscous."));
}

TEST(SummarizeFit, NamesWeaklyIdentifiableParameters) {
  Identification identification = ExampleIdentification();
  identification.fits[0].identifiability = {{"inertia", Identifiability::Verdict::kWeakly, {}, "measure longer"}};
  EXPECT_EQ(SummarizeFit(identification, 0).remarks, "Weakly identifiable: inertia.");
}

// ---- Several recordings --------------------------------------------------------------------------------------------

TEST(SummarizeFit, DoubtsRecordingsThatAreNotCompared) {
  Identification identification = ExampleJointIdentification();
  identification.fits[0].warnings.clear();
  Homogeneity& homogeneity = *identification.across[0].homogeneity;
  homogeneity.p = 0.5;
  homogeneity.disagreeing.clear();
  for (IdentifiedRecording& recording : identification.recordings) recording.own_fits[0].warnings.clear();
  identification.across[0].lacks_fit = false;
  EXPECT_EQ(SummarizeFit(identification, 0).emphasis, Emphasis::kNone);
  homogeneity.p.reset();
  EXPECT_EQ(SummarizeFit(identification, 0).emphasis, Emphasis::kCaution);
}

TEST(SummarizeFit, JudgesADisagreementByWhatItDoesToTheErrors) {
  Identification identification = ExampleJointIdentification();
  identification.fits[0].warnings.clear();
  for (IdentifiedRecording& recording : identification.recordings) recording.own_fits[0].warnings.clear();
  identification.across[0].lacks_fit = false;
  Homogeneity& homogeneity = *identification.across[0].homogeneity;
  homogeneity.p = 1e-4;
  homogeneity.disagreeing.clear();
  EXPECT_EQ(SummarizeFit(identification, 0).emphasis, Emphasis::kNone);  // less than the other errors
  homogeneity.matters = true;
  const FitSummary scatter = SummarizeFit(identification, 0);
  EXPECT_EQ(scatter.emphasis, Emphasis::kCaution);
  EXPECT_THAT(scatter.verdict, StartsWith("The law "));
  identification.fits[0].warnings = {{"recordings_disagree", "do not quote them"}};
  homogeneity.disagreeing = {1};
  const FitSummary odd = SummarizeFit(identification, 0);
  EXPECT_EQ(odd.emphasis, Emphasis::kAlarm);
  EXPECT_THAT(odd.verdict, StartsWith("Do not quote them."));
  EXPECT_FALSE(HasWarning(odd.warnings, "recordings_disagree"));
}

// Recording 1 of the example has the warning.
TEST(SummarizeFit, NamesTheRecordingThatTheLawDoesNotDescribe) {
  Identification identification = ExampleJointIdentification();
  identification.fits[0].warnings.clear();
  identification.across[0].homogeneity->p = 0.5;
  EXPECT_THAT(SummarizeFit(identification, 0).verdict, HasSubstr("does not describe recording 1: "));
}

TEST(SummarizeFit, GivesResidualsInTheCommonUnit) {
  Identification identification = ExampleJointIdentification();
  identification.fits[0].reading_unit = "volts";
  EXPECT_THAT(SummarizeFit(identification, 0).verdict, HasSubstr(" volts (rms)"));
  identification.fits[0].reading_unit = "";
  EXPECT_THAT(SummarizeFit(identification, 0).verdict, Not(HasSubstr("(rms)")));
}

// 0.0802 / 0.079 is 1.52 % more.
TEST(SummarizeFit, ComparesWithTheTextbook) {
  Identification identification = ExampleIdentification();
  identification.recordings.front().checks[0].rows[0].cause = DifferenceCause::kAmplitude;
  const std::string text = SummarizeFit(identification, 0).textbook;
  EXPECT_THAT(text, HasSubstr("I_O 0.08020 (1.5 % more: it assumes small angles)"));
  EXPECT_THAT(text, HasSubstr("(agrees)"));
}

// ---- Warnings of the law that is shown -----------------------------------------------------------------------------

TEST(SummarizeFit, OmitsWarningsOfOtherLaws) {
  Identification identification = ExampleComparedIdentification();
  for (FitReport& fit : identification.fits) fit.warnings.clear();
  identification.recordings.front().warnings = {{"gaps", "the recording has 3 gaps", "the longest takes 2 s"}};
  identification.fits[0].warnings = {{"at_bound", "coulomb is at its bound 0"}};
  identification.fits[1].warnings = {{"lack_of_fit", "the residuals are not white"}};
  EXPECT_THAT(Messages(SummarizeFit(identification, 0)),
              ElementsAre("coulomb is at its bound 0", "the recording has 3 gaps"));
  EXPECT_THAT(Messages(SummarizeFit(identification, 1)),
              ElementsAre("the residuals are not white", "the recording has 3 gaps"));
}

// The flag that helps belongs to a warning.
TEST(SummarizeFit, KeepsTheFlagOfAWarning) {
  Identification identification = ExampleIdentification();
  identification.fits[0].warnings.clear();
  identification.recordings.front().warnings = {{.code = "unit_questioned",
                                                 .finding = "the unit is odd (its period; its size)",
                                                 .explanation = "others are not",
                                                 .advice = "or give --unit rad",
                                                 .flags = {"unit"}}};
  EXPECT_THAT(Messages(SummarizeFit(identification, 0)),
              ElementsAre("the unit is odd (its period; its size). Or give --unit rad"));
}

// The title is the path.
TEST(SummarizeFit, OmitsThePathOfTheRecording) {
  Identification identification = ExampleIdentification();
  identification.recordings.front().data.path = "run.csv";
  identification.fits[0].warnings.clear();
  identification.recordings.front().warnings = {
      {.code = "empty_cells", .finding = "rows were left out", .about = {.file = "run.csv"}},
      {.code = "time_wrapped", .finding = "the counter restarts", .about = {.file = "run.csv", .line = 118}}};
  EXPECT_THAT(Messages(SummarizeFit(identification, 0)),
              ElementsAre("rows were left out", "line 118: the counter restarts"));
}

// ---- Assumptions ---------------------------------------------------------------------------------------------------

TEST(SummarizeFit, ListsAssumptionsApartFromWarnings) {
  Identification identification = ExampleIdentification();
  identification.fits[0].warnings.clear();
  identification.recordings.front().warnings = {
      {.code = "time_unit_assumed", .finding = "a sentence", .assumed = "times in s (--time_column t:ms)"},
      {.code = "gaps", .finding = "the recording has 3 gaps"}};
  identification.recordings.front().data.sensor.kind = "encoder";
  EXPECT_THAT(SummarizeFit(identification, 0).assumptions, ElementsAre("times in s (--time_column t:ms)"));
  EXPECT_THAT(Messages(SummarizeFit(identification, 0)), ElementsAre("the recording has 3 gaps"));
  identification.recordings.front().data.sensor.is_kind_assumed = true;
  EXPECT_THAT(SummarizeFit(identification, 0).assumptions,
              ElementsAre("times in s (--time_column t:ms)", "an encoder (--sensor)"));
}

// What was assumed of each recording is said once, with the recordings' names only if they differ.
TEST(SummarizeFit, SaysACommonAssumptionOfSeveralRecordingsOnce) {
  Identification identification = ExampleJointIdentification();
  for (IdentifiedRecording& run : identification.recordings)
    run.warnings = {{.code = "time_unit_assumed",
                     .finding = "a sentence",
                     .assumed = "times in s",
                     .about = {.file = run.data.path}}};
  EXPECT_THAT(SummarizeFit(identification, 0).assumptions, ElementsAre("times in s"));
  identification.recordings[1].warnings[0].assumed = "times in ms";
  EXPECT_THAT(SummarizeFit(identification, 0).assumptions,
              ElementsAre(AllOf(StartsWith("recording 1"), HasSubstr(": times in s")),
                          AllOf(StartsWith("recording 2"), HasSubstr(": times in ms"))));
}

TEST(QuietText, HasALinePerParameter) {
  const std::vector<std::string> lines = Lines(QuietText(ExampleIdentification()));
  ASSERT_THAT(lines, SizeIs(5));
  EXPECT_EQ(lines[0], "inertia 0.079 0.00103 kg m^2");
  EXPECT_EQ(lines[2], "coulomb 0 - N m");
}

TEST(FitSummaryJson, HasTheLevelOfTheVerdict) {
  const nlohmann::ordered_json json = FitSummaryJson(SummarizeFit(ExampleIdentification(), 0));
  EXPECT_EQ(json["level"], "caution");
  EXPECT_EQ(json["parameters"][0]["error"], "0.0010");
}

}  // namespace
}  // namespace pendulum::result_summary_test
