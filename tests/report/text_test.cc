// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/text.h"

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/identify/example_joint_identification.h"

namespace pendulum::text_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

/// The text with lines joined, to search for wrapped sentences.
std::string OneLine(const std::string& text) {
  std::string line;
  for (const char c : text) {
    const bool is_blank = c == ' ' || c == '\n';
    if (!is_blank || !line.ends_with(' ')) line += is_blank ? ' ' : c;
  }
  return line;
}

/// The sections in the order of a document.
std::string AllSections(const Identification& identification) { return ToText(ReportSections(identification)); }

// Degrees: 0.423 rad = 24.2361 deg, 0.0002 rad = 0.01146 deg. The other values are rounded by hand; closed forms are in
// closed_form_text_test.cc.
constexpr const char* kWholeFit = R"([[Data]]
    file        swing.csv
    samples     1801 used of 2000
    window      1.5 s to 19.5 s, 100 Hz on average
    begins      held, then released
    ends        the end of the recording
    resolution  0.00436 rad (0.25 deg), found in the values
[[Rig]]
    name             value ± std dev  unit    std dev
    gravity_torque   1.800 ± 0.010    N m     stated
    inertia         0.0760 ± 0.0005   kg m^2  stated
[[Fit]]
    model   coulomb:  I_O th'' + b th' + τ_c sgn(th') + G sin th = 0
    start   held at an angle, then released
    status  converged: the last step changed no parameter by more than 0.001
            standard errors
    solver  7 iterations, 15 trajectories, accurate to 2e-10 rad
[[Parameters]]
    name              value ± total error  unit       95 % interval
    inertia          0.0790 ± 0.0010       kg m^2     [0.0770, 0.0810]
    viscous          0.0030 ± 0.0005       N m s/rad  [0.0020, 0.0040]
    coulomb               0 (at bound)     N m        [0, 0.000125]
    release_angle   0.42300 ± 0.00020      rad        [0.42260, 0.42340]
                     24.236 ± 0.011        deg        [24.213, 24.259]
    zero_angle         0.01 (fixed)        rad
                   0.572958                deg
    name           symbol  ± by noise  interval by noise
    inertia        I_O     ± 0.00025   [0.07850, 0.07950]
    viscous        b
    coulomb        τ_c
    release_angle  θ_r
    zero_angle     z
    No standard error of coulomb: the estimate is at its lower bound 0.
    Standard errors: sandwich, as the residuals are AR(2).
    Intervals: profile likelihood.
    These are of noise alone; the total errors and intervals contain the whole
    error budget.
    viscous is weakly identifiable (its effect can be compensated by coulomb):
    let it swing for longer.
    coulomb is weakly identifiable: let it come to rest.
[[Error budget]]
    cause           its size  type  inertia  viscous  release_angle
    noise                     A     0.00025   0.0005         0.0002
    gravity torque  0.01 N m  B       0.001
    total                             0.001   0.0005         0.0002

    cause           where the size comes from
    noise           the scatter of the readings
    gravity torque  stated with the rig
    Standard deviations, in the units of the parameters. Type A: from the
    statistics of readings; B: stated or assumed. What the readings say of the
    sensor makes its lines depend on each other; the total allows for that.
[[Derived quantities]]
    natural_frequency  4.778 ± 0.008  rad/s  [4.763, 4.793]
    damping_ratio      0.004          1
[[Correlations]] (those below 0.1 in size are not listed)
    inertia, viscous  0.500
[[Noise and statistics]]
    noise              quantized, sigma 0.00350 ± 0.00010 rad (0.201 deg, 0.802
                       resolutions)
    because            the residuals are 0.8 resolutions
    rms residual       0.00349 rad (0.2 deg)
    lag-1 correlation  0.125
    Durbin-Watson      1.750
    Ljung-Box, runs    p 0.04, 0.25
    autocorrelation    AR(2); for estimating a constant, equivalent to 1200
                       independent samples
    log-likelihood     1234.50
    AIC, AICc, BIC     -2457.00, -2456.88, -2437.50
    lack of fit        the residuals are more than noise
[[Equation of motion]]
    0.07900 th'' + 0.0030 th' + 0 sgn(th') + 1.800 sin th = 0
    th in rad from hanging straight down, torques in N m.
[[Constancy]]
    inertia and friction are constants of the recording.
[[What the residuals suggest]]
    No cause outside the law is significant.
[[What one swing cannot tell]]
    The fitted inertia is 3.9 % larger than the rig's (z 4.2), more than all
    errors allow: a wrong mass or length, a support that yields, the extent of
    the bob, or gears and a motor can cause this, and one swing cannot tell
    which; record a swing with another bob mass, and check the rig's values.
  - A support that yields (stand, table, camera arm): the fitted inertia is an
    effective one, larger than that of the pendulum. Swing another bob mass at
    the same place: the added inertia grows with the square of the mass, the
    pendulum's own with the mass. Or clamp the support, or read a second sensor
    on it.
  - A spring, cable or hose that adds torque at the axis: the fitted inertia and
    friction are too small by the spring's share of G: 1 % of G makes 1 % less.
    Swing another bob mass: G changes, the spring does not. Or compare a small
    swing with a large one, with a sensor whose gain is known: only gravity
    makes large swings slower. With this noise a swing of 90 deg beside a small
    one shows a spring from 4.4 % of G on; simulate_pendulum --plan gives the
    errors of other swings.
  - A wrong mass or length: only ratios to G follow from the swing: inertia and
    all friction torques have the relative error of G. Weigh the pendulum held
    horizontal: force times distance from the axis is G. Or add a known mass at
    a known distance and swing again.
  - Gears, a belt or a motor at the axis: the fitted inertia and friction
    include theirs: inertia and viscous friction times the square of the gear
    ratio, dry friction times the ratio. Swing without them, or with two bob
    masses: the inertia that remains for no mass is theirs.
[[Warnings]]
  - there is a gap of 0.5 s after 7 s
  - the residuals are not white; friction may be of another kind
)";

TEST(ToText, ShowsTheWholeFit) {
  Identification report = ExampleIdentification();
  report.recordings.front().sampling.reset();
  report.recordings.front().closed_forms.reset();
  EXPECT_EQ(AllSections(report), kWholeFit);
}

TEST(ToText, ShowsClosedFormsAfterTheFit) {
  const std::string text = AllSections(ExampleIdentification());
  std::vector<std::string> sections;
  for (std::size_t at = text.find("[["); at != std::string::npos; at = text.find("[[", at + 1)) {
    sections.push_back(text.substr(at + 2, text.find("]]", at) - at - 2));
  }
  EXPECT_THAT(sections, ElementsAre("Data", "Sampling", "Rig", "Fit", "Parameters", "Error budget",
                                    "Derived quantities", "Correlations", "Noise and statistics", "Equation of motion",
                                    "Constancy", "What the residuals suggest", "What one swing cannot tell",
                                    "Closed forms", "Closed forms against the fit", "Turning points", "Warnings"));
}

TEST(ToText, SuggestsWhatToMeasureWithoutARig) {
  const std::string text = AllSections(ExampleRateIdentification());
  EXPECT_THAT(text, HasSubstr("    0.04390 th'' + 0.001700 th' + 0.0005000 sgn(th') + sin th = 0\n"));
  EXPECT_THAT(OneLine(text), HasSubstr("torques are in units of the gravity torque G"));
  EXPECT_THAT(OneLine(text), HasSubstr("give --rig."));
  EXPECT_THAT(text, Not(HasSubstr("rig file")));
  EXPECT_THAT(text, Not(HasSubstr("systematic")));
}

TEST(ToText, ShowsARateInDegreesPerSecondToo) {
  const std::string text = AllSections(ExampleRateIdentification());
  EXPECT_THAT(text, HasSubstr("    rate_bias     0.25  rad/s\n               14.3239  deg/s\n"));
  EXPECT_THAT(text, HasSubstr("sigma 0.0035 rad/s (0.201 deg/s)"));
}

TEST(ToText, NamesTheOpenInterval) {
  Identification report = ExampleIdentification();
  ParameterEstimate& viscous = report.fits[0].parameters[1];
  viscous.lower95.reset();
  viscous.open_interval = OpenInterval::kNothingExcluded;
  const std::string text = AllSections(report);
  EXPECT_THAT(
      OneLine(text),
      HasSubstr("Intervals: profile likelihood. The interval of viscous is open: the data exclude none of its possible "
                "values. "));
  EXPECT_THAT(text, HasSubstr(" N m s/rad  [?, 0.0040]\n"));
}

TEST(ToText, ReportsTheSourceOfTheResolution) {
  Identification report = ExampleIdentification();
  report.recordings.front().data.resolution_source = "file";
  EXPECT_THAT(AllSections(report), HasSubstr("0.00436 rad (0.25 deg), from the file\n"));
  report.recordings.front().data.resolution_source = "given";
  EXPECT_THAT(AllSections(report), HasSubstr("0.00436 rad (0.25 deg), as given\n"));
}

TEST(ToText, OmitsADerivedErrorLargerThanTheValue) {
  Identification report = ExampleIdentification();
  report.fits[0].derived = {{"quality_factor", "1", 123.456, 200, 40, std::nullopt},
                            {"natural_frequency", "rad/s", 4.7781234}};
  EXPECT_THAT(AllSections(report), HasSubstr("    quality_factor       123.5  1      [40, ?]\n"
                                             "    natural_frequency  4.77812  rad/s\n"));
}

TEST(ToText, GivesACommonReasonOnce) {
  const std::string text = AllSections(ExampleRateIdentification());
  EXPECT_THAT(text, HasSubstr("    status  not_converged: 100 iterations were not enough\n"));
  EXPECT_THAT(OneLine(text),
              HasSubstr("No standard error of inertia, viscous, coulomb, rate_bias: the fit did not converge. "));
  EXPECT_THAT(text, Not(HasSubstr("Standard errors:")));
}

TEST(ToText, OmitsStatisticsAndEquationOfAFailedFit) {
  Identification report = ExampleRateIdentification();
  report.fits[0].termination = Termination::kFailed;
  const std::string text = AllSections(report);
  EXPECT_THAT(text, HasSubstr("These values are not estimates, because nothing was fitted."));
  EXPECT_THAT(text, Not(HasSubstr("[[Noise")));
  EXPECT_THAT(text, Not(HasSubstr("[[Equation")));
}

TEST(ToText, SortsCorrelationsAndOmitsSmallOnes) {
  Identification report = ExampleIdentification();
  report.fits[0].covariance = Eigen::Matrix3d{{1, 0.25, -0.75}, {0.25, 1, 0.0625}, {-0.75, 0.0625, 1}};
  EXPECT_THAT(AllSections(report), HasSubstr("[[Correlations]] (those below 0.1 in size are not listed)\n"
                                             "    inertia, release_angle  -0.750\n"
                                             "    inertia, viscous         0.250\n"
                                             "[[Noise"));
}

TEST(ToText, KeepsColumnsAlignedAroundPowersOfTen) {
  Identification report = ExampleIdentification();
  ParameterEstimate& viscous = report.fits[0].parameters[1];
  viscous = ExampleParameter(kViscous, "N m s/rad", 3e-6, 1.2e-7);
  viscous.systematic.Add(ErrorSource::kRig, 4e-8);
  const std::string text = AllSections(report);
  EXPECT_THAT(text, HasSubstr("    inertia          0.0790 ± 0.0010       kg m^2     [0.0770, 0.0810]\n"
                              "    viscous           (3.00 ± 0.13)e-06    N m s/rad  [2.75e-06, 3.25e-06]\n"));
  EXPECT_THAT(text, HasSubstr("    inertia        I_O     ± 0.00025   [0.07850, 0.07950]\n"
                              "    viscous        b       ± 0.12e-06  [2.76e-06, 3.24e-06]\n"));
}

// 0.079 / 0.076 = 1.039, 0.079 / 0.088 = 0.898.
TEST(ToText, ComparesTheInertiaWithTheRigFileIfThereIsNoCheck) {
  Identification report = ExampleIdentification();
  EXPECT_THAT(AllSections(report), Not(HasSubstr("The rig file")));
  report.recordings.front().checks.clear();
  EXPECT_THAT(OneLine(AllSections(report)),
              HasSubstr("The rig file gives I_O = 0.0760 ± 0.0005 kg m^2; the fitted I_O is 3.9 % larger. "));
  report.rig->inertia = RigValue{0.088, 0};
  EXPECT_THAT(OneLine(AllSections(report)),
              HasSubstr("The rig file gives I_O = 0.088 kg m^2; the fitted I_O is 10 % smaller. "));
  report.rig->inertia.reset();
  EXPECT_THAT(AllSections(report), Not(HasSubstr("The rig file")));
}

TEST(ToText, WorksWithoutAFit) {
  Identification report = ExampleIdentification();
  report.fits.clear();
  report.recordings.front().checks.clear();
  const std::string text = AllSections(report);
  for (const char* section : {"[[Data]]", "[[Sampling]]", "[[Closed forms]]", "[[Turning points]]", "[[Warnings]]"}) {
    EXPECT_THAT(text, HasSubstr(section));
  }
  for (const char* section : {"[[Fit]]", "[[Parameters]]", "against the fit"}) {
    EXPECT_THAT(text, Not(HasSubstr(section)));
  }
}

TEST(ToText, HasNoWarningsSectionWithoutWarnings) {
  Identification report = ExampleIdentification();
  report.recordings.front().warnings.clear();
  report.fits[0].warnings.clear();
  EXPECT_THAT(AllSections(report), Not(HasSubstr("[[Warnings]]")));
}

TEST(ToText, StartsWithTheComparisonAndListsOtherParameters) {
  const std::string text = AllSections(ExampleComparedIdentification());
  std::vector<std::string> sections;
  for (std::size_t at = text.find("[["); at != std::string::npos; at = text.find("[[", at + 1)) {
    sections.push_back(text.substr(at + 2, text.find("]]", at) - at - 2));
  }
  EXPECT_THAT(
      sections,
      ElementsAre("Data", "Sampling", "Rig", "Comparison", "Likelihood-ratio tests", "Fit", "Parameters",
                  "Error budget", "Derived quantities", "Correlations", "Noise and statistics", "Equation of motion",
                  "Constancy", "What the residuals suggest", "What one swing cannot tell", "Parameters of drag",
                  "Closed forms", "Closed forms against the fit of coulomb", "Turning points", "Warnings"));
}

TEST(ToText, ReplacesTerminalControlCharactersInAFileName) {
  Identification report = ExampleIdentification();
  report.recordings.front().data.path = "a\x1B[2J\n[[Fit]].csv";
  EXPECT_THAT(AllSections(report), HasSubstr("    file        a?[2J?[[Fit]].csv\n"));
}

/// The widest line of a text.
int WidestOf(const std::string& text) {
  int widest = 0;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) widest = std::max(widest, DisplayWidth(line));
  return widest;
}

/// The example with the longest possible names, units and numbers of fits.
Identification WideReport() {
  Identification report = ExampleComparedIdentification();
  FitReport& fit = report.fits[0];
  for (ParameterEstimate& parameter : fit.parameters) {
    parameter.systematic.Add(ErrorSource::kRig, 1.2e-9);
    parameter.closed_form = 1.1 * parameter.estimate;
  }
  fit.parameters[0] = ExampleParameter(kInertia, "kg m^2", 0.0789996123, 2.8e-9);
  fit.parameters[1] = ExampleParameter(kViscous, "N m s^2/rad^2", -3.2345678e-7, 1.2e-13);
  fit.parameters[1].systematic.Add(ErrorSource::kRig, 3e-9);
  fit.parameters[1].closed_form = 3.1e-7;
  fit.derived.push_back({"gravity_over_inertia", "1/s^2", 22.827012345, 8e-9, 22.8, 22.9});
  fit.noise.why = std::string(300, 'x')
                      .replace(50, 1, " ")
                      .replace(100, 1, " ")
                      .replace(150, 1, " ")
                      .replace(200, 1, " ")
                      .replace(250, 1, " ");
  ClosedFormRow& row = report.recordings.front().checks[0].rows[0];
  row = {"damping_ratio_log_decrement", "", "N m s^2/rad^2", -0.0000123456, 1.2e-9, -1.234567e-5, 1e-11, -3123.4, false,
         "by the formula's friction"};
  report.comparison->rows[1].delta_bic = 123456.7;
  report.comparison->tests[0].null = "0.25 χ²(0), 0.5 χ²(1), 0.25 χ²(2)";
  report.recordings.front().constancy[0].halves_p = 1e-5;
  report.recordings.front().constancy[0].trends.push_back({"viscous", "N m s/rad", 1, 0.1, 2, 1e-4});
  for (AmplitudeRow& window : report.recordings.front().constancy[0].windows) {
    window.friction = 0.0031234;
    window.friction_std_error = 0.0000123;
  }
  return report;
}

TEST(ToText, FitsInEightyColumns) {
  EXPECT_LE(WidestOf(AllSections(ExampleIdentification())), 80);
  EXPECT_LE(WidestOf(AllSections(ExampleRateIdentification())), 80);
  EXPECT_LE(WidestOf(AllSections(ExampleComparedIdentification())), 80);
  Identification report = WideReport();
  EXPECT_LE(WidestOf(AllSections(report)), 80) << AllSections(report);
  EXPECT_LE(WidestOf(ToText(report, {.colour = true})), 80);
  report.rig.reset();
  report.comparison.reset();
  EXPECT_LE(WidestOf(AllSections(report)), 80) << AllSections(report);
  report.fits.clear();
  report.recordings.front().checks.clear();
  EXPECT_LE(WidestOf(AllSections(report)), 80);
}

// A terminal shows the end of a text.
TEST(ToText, EndsWithTheSummary) {
  const std::string text = ToText(ExampleIdentification());
  EXPECT_LT(text.find("[[Turning points]]"), text.find("[[Parameters]]"));
  EXPECT_LT(text.find("[[Parameters]]"), text.find("[[Warnings]]"));
  EXPECT_LT(text.find("[[Warnings]]"), text.find("[[swing.csv]]"));
  for (const Section& section : ReportSections(ExampleIdentification())) {
    EXPECT_THAT(text, HasSubstr("[[" + FullTitle(section) + "]]"));
  }
}

// ---- Several recordings ---------------------------------------------------------------------------------------------

std::vector<std::string> Titles(const Sections& sections) {
  std::vector<std::string> titles;
  for (const Section& section : sections) titles.push_back(FullTitle(section));
  return titles;
}

/// The section with this title, as text.
std::string TextOf(const Identification& report, const std::string& title) {
  for (const Section& section : ReportSections(report)) {
    if (FullTitle(section) == title) return ToText(Sections{section});
  }
  return "";
}

TEST(ReportSections, AreInOrder) {
  EXPECT_THAT(Titles(ReportSections(ExampleComparedJointIdentification())),
              ElementsAre("Recordings", "Data: recording 1", "Sampling: recording 1", "Data: recording 2",
                          "Sampling: recording 2", "Rig", "Comparison", "Likelihood-ratio tests", "Fit", "Parameters",
                          "Do the recordings agree?", "Error budget", "Each recording's own", "Derived quantities",
                          "Correlations", "Noise and statistics: recording 1", "Noise and statistics: recording 2",
                          "Noise and statistics: all recordings", "Equation of motion", "Constancy: recording 1",
                          "What the residuals suggest: recording 1", "What the residuals suggest: recording 2",
                          "What one swing cannot tell", "Parameters of drag", "Closed forms: recording 1",
                          "Closed forms against the fit of coulomb: recording 1", "Turning points: recording 1",
                          "Closed forms: recording 2", "Warnings"));
}

TEST(ReportSections, AreThoseOfOneRecordingForEachOfSeveral) {
  Identification report = ExampleJointIdentification();
  report.recordings[1] = report.recordings[0];  // which has closed forms and constancy
  const std::vector<std::string> common = {"Rig",
                                           "Fit",
                                           "Parameters",
                                           "Error budget",
                                           "Derived quantities",
                                           "Correlations",
                                           "Equation of motion",
                                           "What one swing cannot tell",
                                           "Warnings"};
  std::vector<std::string> expected;
  for (const std::string& title : Titles(ReportSections(ExampleIdentification()))) {
    if (std::ranges::find(common, title) != common.end()) continue;
    for (const char* number : {"1", "2"}) expected.push_back(title + ": recording " + number);
  }
  EXPECT_THAT(expected, testing::Contains("Turning points: recording 2"));
  EXPECT_THAT(Titles(ReportSections(report)), testing::IsSupersetOf(expected));
}

TEST(ReportSections, SayWhatIsOfTheSeparateFitOfARecording) {
  const Identification report = ExampleJointIdentification();
  EXPECT_THAT(TextOf(report, "Constancy: recording 1"), HasSubstr("(of the separate fit)"));
  EXPECT_THAT(TextOf(report, "What the residuals suggest: recording 2"), HasSubstr("(of the separate fit)"));
  EXPECT_THAT(TextOf(ExampleIdentification(), "Constancy"), Not(HasSubstr("separate")));
}

TEST(ReportSections, ShowNoMotionIfThePendulumsDiffer) {
  Identification report = ExampleJointIdentification();
  report.fits[0].termination = Termination::kNotConverged;
  EXPECT_THAT(Titles(ReportSections(report)),
              ElementsAre("Recordings", "Data: recording 1", "Sampling: recording 1", "Data: recording 2",
                          "Sampling: recording 2", "Rig", "Fit", "Parameters", "Do the recordings agree?",
                          "Correlations", "Noise and statistics: recording 1", "Noise and statistics: recording 2",
                          "Noise and statistics: all recordings", "Constancy: recording 1",
                          "What the residuals suggest: recording 1", "What the residuals suggest: recording 2",
                          "Closed forms: recording 1", "Closed forms against the fit: recording 1",
                          "Turning points: recording 1", "Closed forms: recording 2", "Warnings"));
}

TEST(ReportSections, CountTheRecordingsThatShareParameters) {
  const std::string text = TextOf(ExampleJointIdentification(), "Fit");
  EXPECT_THAT(text, HasSubstr("    shared  inertia, viscous, coulomb, by 2 recordings; each recording has its\n"));
  EXPECT_THAT(text, HasSubstr("    status  converged: the estimates are within 0.1 standard errors\n"));
}

TEST(ReportSections, ShowSeparateParametersOfEachRecording) {
  EXPECT_EQ(TextOf(ExampleJointIdentification(), "Each recording's own"), R"([[Each recording's own]] (by the joint fit)
       name              value ± total error  unit  95 % interval
    1  release_angle   0.42300 ± 0.00020      rad   [0.42260, 0.42340]
                        24.236 ± 0.011        deg   [24.213, 24.259]
       zero_angle         0.01 (fixed)        rad
                      0.572958                deg
    2  initial_angle     0.250 ± 0.013        rad   [0.225, 0.275]
                          14.3 ± 0.7          deg   [12.9, 15.8]
       zero_angle         0.01 (fixed)        rad
                      0.572958                deg
)");
}

TEST(ReportSections, ShowNoiseAndSeparateStatusPerRecording) {
  const Identification report = ExampleJointIdentification();
  EXPECT_THAT(TextOf(report, "Noise and statistics: recording 1"), HasSubstr("    separate fit       converged\n"));
  EXPECT_THAT(TextOf(report, "Noise and statistics: recording 1"),
              HasSubstr("    lack of fit        the residuals are more than noise\n"));
  EXPECT_THAT(TextOf(report, "Noise and statistics: recording 2"),
              HasSubstr("    separate fit       not_converged: too few iterations\n"));
  EXPECT_EQ(TextOf(report, "Noise and statistics: all recordings"),
            "[[Noise and statistics: all recordings]]\n"
            "    log-likelihood  1234.50\n"
            "    AIC, AICc, BIC  -2457.00, -2456.88, -2437.50\n");
}

TEST(ReportSections, ShowAnEquationOnlyIfAllParametersAreShared) {
  Identification report = ExampleJointIdentification();
  report.across[0].shared = {"inertia"};
  EXPECT_EQ(TextOf(report, "Equation of motion"), "");
  EXPECT_THAT(TextOf(report, "Each recording's own"), HasSubstr("    1  viscous "));
}

TEST(ReportSections, ShowNoNumbersOfAFailedFit) {
  const std::string text = ToText(ExampleFailedJointIdentification());
  EXPECT_THAT(text, HasSubstr("status  failed: no joint motion can be computed"));
  EXPECT_THAT(text, Not(HasSubstr("[[Noise and statistics")));
  EXPECT_THAT(text, Not(HasSubstr("[[Equation of motion]]")));
  EXPECT_THAT(text, Not(testing::ContainsRegex("[^a-z](nan|inf)[^a-z]")));
}

TEST(ToText, EndsAJointFitWithTheRecordingsWarnings) {
  EXPECT_THAT(ToText(ExampleJointIdentification()),
              HasSubstr("[[Warnings]]\n  - recording 1 (run.csv): there is a gap of 0.5 s after 7 s\n"));
}

// ESC [ 2 J clears a terminal. Labels of recordings occur in verdicts and in the status that repeats them.
TEST(ToText, ReplacesTerminalControlCharactersOfAJointFit) {
  Identification report = ExampleJointIdentification();
  report.recordings[1].data.path = "a\x1B[2J\n.csv";
  report.recordings[1].warnings = {{"gaps", "a gap"}};
  report.across[0].homogeneity->verdict =
      "recording 2 (" + report.recordings[1].data.path + ") disagrees with the others";
  report.fits[0].reason = "not one pendulum; " + report.across[0].homogeneity->verdict;
  EXPECT_THAT(ToText(report), HasSubstr("    2  a?[2J?.csv\n"));
  EXPECT_THAT(ToText(report), Not(HasSubstr("\x1B")));
}

/// The example with the longest possible names, units and numbers of fits.
Identification WideJointReport() {
  Identification report = ExampleComparedJointIdentification();
  Homogeneity& homogeneity = *report.across[0].homogeneity;
  SharedParameter& wide = homogeneity.parameters[1];
  wide.name = "stribeck_coulomb";
  wide.unit = "N m s^2/rad^2";
  wide.runs = {{-3.2345678e-7, 1.2e-13, -12345.6}, {3.2345678e-7, 1.2e-9, 12345.6}};
  wide.scatter = {1.2345e-9, 3.2e-7, -4.1e-6, 4.1e-6, 4.5e-7, 2e-7, 1.4e-5};
  for (int i = 0; i < 12; ++i) homogeneity.verdict += "; recording 2 (b c.csv) disagrees with the others";
  homogeneity.parameters[0].runs[0] = {0.0789996123, 2.8e-9, -1e5};
  for (IdentifiedRecording& run : report.recordings) {
    run.own_fits[0].parameters[3] = ExampleParameter(kReleaseTime, "rad", -123.456789012, 1.2e-9);
    run.own_fits[0].noise.why = "the residuals are 0.8 resolutions, " + std::string(50, 'x') + " and so on";
    run.data.samples = run.data.used_samples = 12345678;
    run.data.from = -12345.678;
    run.data.to = 98765.4321;
  }
  report.across[0].separate[0] =
      "not_converged: 100 iterations were not enough, " + std::string(50, 'x') + " and so on";
  return report;
}

TEST(ReportSections, FitInEightyColumns) {
  for (const Identification& report :
       {ExampleJointIdentification(), ExampleComparedJointIdentification(), ExampleFailedJointIdentification()}) {
    EXPECT_LE(WidestOf(ToText(report)), 80) << ToText(report);
  }
  EXPECT_LE(WidestOf(ToText(WideJointReport())), 80) << ToText(WideJointReport());
}

}  // namespace
}  // namespace pendulum::text_test
