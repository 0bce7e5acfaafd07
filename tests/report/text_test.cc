// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/text.h"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/report/example_report.h"

namespace pendulum {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

// Degrees: 0.423 rad = 24.2361 deg, 0.0002 rad = 0.01146 deg. The rest is rounding by hand; closed forms:
// closed_form_text_test.cc.
TEST(ToText, GivesTheWholeFit) {
  RunReport report = ExampleReport();
  report.sampling.reset();
  report.closed_forms.reset();
  EXPECT_EQ(ToText(report), R"([[Data]]
    file        swing.csv
    samples     1801 used of 2000
    window      1.5 s to 19.5 s, 100 Hz on average
    begins      held, then released
    ends        the end of the recording
    resolution  0.00436 rad (0.25 deg), found in the values
[[Fit]]
    model  coulomb:  I_O th'' + b th' + τ_c sgn(th') + G sin th = 0
    start  held at an angle, then released
    status  converged: the last step changed no parameter by more than 0.001 standard errors
[[Parameters]]
    name           symbol     value ± std error  unit       95 % interval       ± systematic
    inertia        I_O      0.07900 ± 0.00025    kg m^2     [0.07850, 0.07950]  ± 0.0010
    viscous        b         0.0030 ± 0.0005     N m s/rad  [0.0020, 0.0040]
    coulomb        τ_c            0              N m        [0, 0.000125]                     at its bound
    release_angle  θ_r      0.42300 ± 0.00020    rad        [0.42260, 0.42340]
                             24.236 ± 0.011      deg        [24.213, 24.259]
    zero_angle     z           0.01              rad                                          fixed
                           0.572958              deg
    No standard error of coulomb: the estimate is at its lower bound 0.
    Standard errors: sandwich, as the residuals are AR(2).
    Intervals: profile likelihood.
    viscous is weakly identifiable (traded for coulomb): let it swing for longer.
    coulomb is weakly identifiable: let it come to rest.
[[Derived quantities]]
    natural_frequency  4.778 ± 0.008  rad/s  [4.763, 4.793]
    damping_ratio      0.004          1
[[Correlations]] (those below 0.1 in size are not listed)
    inertia, viscous  0.500
[[Noise and statistics]]
    noise              quantized, sigma 0.00350 ± 0.00010 rad (0.201 deg, 0.802 resolutions)
    because            the residuals are 0.8 resolutions
    rms residual       0.00349 rad (0.2 deg)
    lag-1 correlation  0.125
    Durbin-Watson      1.750
    Ljung-Box, runs    p 0.04, 0.25
    memory             AR(2); of a constant the samples tell as much as 1200 independent ones
    log-likelihood     1234.50
    AIC, AICc, BIC     -2457.00, -2456.88, -2437.50
    solver             7 iterations, 15 trajectories, accurate to 2e-10 rad
[[Equation of motion]]
    0.07900 th'' + 0.0030 th' + 0 sgn(th') + 1.800 sin th = 0
    th in rad from hanging straight down, torques in N m.
[[Warnings]]
  - there is a gap of 0.5 s after 7 s
  - the residuals are not white; friction may be of another kind
)");
}

TEST(ToText, HasTheClosedFormsAfterTheFit) {
  const std::string text = ToText(ExampleReport());
  std::vector<std::string> sections;
  for (std::size_t at = text.find("[["); at != std::string::npos; at = text.find("[[", at + 1)) {
    sections.push_back(text.substr(at + 2, text.find("]]", at) - at - 2));
  }
  EXPECT_THAT(sections, ElementsAre("Data", "Sampling", "Fit", "Parameters", "Derived quantities", "Correlations",
                                    "Noise and statistics", "Equation of motion", "Closed forms",
                                    "Closed forms against the fit", "Turning points", "Warnings"));
}

TEST(ToText, TellsWithoutARigWhatToMeasure) {
  const std::string text = ToText(ExampleRateReport());
  EXPECT_THAT(text, HasSubstr("    0.04390 th'' + 0.001700 th' + 0.0005000 sgn(th') + sin th = 0\n"));
  EXPECT_THAT(text, HasSubstr("torques are in units of the gravity torque G"));
  EXPECT_THAT(text, HasSubstr("give --rig."));
  EXPECT_THAT(text, Not(HasSubstr("rig file")));
  EXPECT_THAT(text, Not(HasSubstr("systematic")));
}

TEST(ToText, GivesARateInDegreesPerSecondToo) {
  const std::string text = ToText(ExampleRateReport());
  EXPECT_THAT(text, HasSubstr("    rate_bias  z          0.25  rad/s\n                       14.3239  deg/s\n"));
  EXPECT_THAT(text, HasSubstr("sigma 0.0035 rad/s (0.201 deg/s)"));
}

TEST(ToText, SaysWhichIntervalIsOpen) {
  RunReport report = ExampleReport();
  ParameterEstimate& viscous = report.fits[0].parameters[1];
  viscous.lower95.reset();
  viscous.open_interval = "its likelihood does not fall";
  const std::string text = ToText(report);
  EXPECT_THAT(text, HasSubstr("    Intervals: profile likelihood. That of viscous is open: its likelihood does not "
                              "fall.\n"));
  EXPECT_THAT(text, HasSubstr(" N m s/rad  [?, 0.0040]\n"));
}

TEST(ToText, SaysWhoTellsTheResolution) {
  RunReport report = ExampleReport();
  report.data.resolution_source = "file";
  EXPECT_THAT(ToText(report), HasSubstr("0.00436 rad (0.25 deg), from the file\n"));
  report.data.resolution_source = "given";
  EXPECT_THAT(ToText(report), HasSubstr("0.00436 rad (0.25 deg), as given\n"));
}

TEST(ToText, LeavesOutTheErrorOfADerivedQuantityThatExceedsIt) {
  RunReport report = ExampleReport();
  report.fits[0].derived = {{"quality_factor", "1", 123.456, 200, 40, std::nullopt},
                            {"natural_frequency", "rad/s", 4.7781234}};
  EXPECT_THAT(ToText(report), HasSubstr("    quality_factor       123.5  1      [40, ?]\n"
                                        "    natural_frequency  4.77812  rad/s\n"));
}

TEST(ToText, SaysAReasonOnceForAllParametersItConcerns) {
  const std::string text = ToText(ExampleRateReport());
  EXPECT_THAT(text, HasSubstr("    status  not_converged: 100 iterations were not enough\n"));
  EXPECT_THAT(text,
              HasSubstr("No standard error of inertia, viscous, coulomb, rate_bias: the fit did not converge.\n"));
  EXPECT_THAT(text, Not(HasSubstr("Standard errors:")));
}

TEST(ToText, ShowsNeitherStatisticsNorAnEquationOfAFailedFit) {
  RunReport report = ExampleRateReport();
  report.fits[0].termination = Termination::kFailed;
  const std::string text = ToText(report);
  EXPECT_THAT(text, HasSubstr("These are no estimates: nothing was fitted."));
  EXPECT_THAT(text, Not(HasSubstr("[[Noise")));
  EXPECT_THAT(text, Not(HasSubstr("[[Equation")));
}

TEST(ToText, SortsCorrelationsBySizeAndLeavesOutSmallOnes) {
  RunReport report = ExampleReport();
  report.fits[0].covariance = Eigen::Matrix3d{{1, 0.25, -0.75}, {0.25, 1, 0.0625}, {-0.75, 0.0625, 1}};
  EXPECT_THAT(ToText(report), HasSubstr("[[Correlations]] (those below 0.1 in size are not listed)\n"
                                        "    inertia, release_angle  -0.750\n"
                                        "    inertia, viscous         0.250\n"
                                        "[[Noise"));
}

TEST(ToText, KeepsColumnsAlignedAroundPowersOfTen) {
  RunReport report = ExampleReport();
  ParameterEstimate& viscous = report.fits[0].parameters[1];
  viscous = ExampleParameter(kViscous, "N m s/rad", 3e-6, 1.2e-7);
  viscous.systematic_std_error = 4e-8;
  EXPECT_THAT(
      ToText(report),
      HasSubstr("    inertia        I_O      0.07900 ± 0.00025    kg m^2     [0.07850, 0.07950]    ± 0.0010\n"
                "    viscous        b          (3.00 ± 0.12)e-06  N m s/rad  [2.76e-06, 3.24e-06]  ± 0.04e-06\n"));
}

// 0.079 / 0.076 = 1.039, 0.079 / 0.088 = 0.898.
TEST(ToText, SaysHowTheFittedInertiaDiffersFromTheRigsUnlessACheckDoes) {
  RunReport report = ExampleReport();
  EXPECT_THAT(ToText(report), Not(HasSubstr("The rig file")));
  report.checks.clear();
  EXPECT_THAT(ToText(report),
              HasSubstr("The rig file gives I_O = 0.0760 ± 0.0005 kg m^2; the fitted I_O is 3.9 % larger.\n"));
  report.rig->inertia = RigValue{0.088, 0};
  EXPECT_THAT(ToText(report), HasSubstr("The rig file gives I_O = 0.088 kg m^2; the fitted I_O is 10 % smaller.\n"));
  report.rig->inertia.reset();
  EXPECT_THAT(ToText(report), Not(HasSubstr("The rig file")));
}

TEST(ToText, GoesWithoutAFit) {
  RunReport report = ExampleReport();
  report.fits.clear();
  report.checks.clear();
  const std::string text = ToText(report);
  for (const char* section : {"[[Data]]", "[[Sampling]]", "[[Closed forms]]", "[[Turning points]]", "[[Warnings]]"}) {
    EXPECT_THAT(text, HasSubstr(section));
  }
  for (const char* section : {"[[Fit]]", "[[Parameters]]", "against the fit"}) {
    EXPECT_THAT(text, Not(HasSubstr(section)));
  }
}

TEST(ToText, HasNoWarningsSectionWithoutWarnings) {
  RunReport report = ExampleReport();
  report.warnings.clear();
  report.fits[0].warnings.clear();
  EXPECT_THAT(ToText(report), Not(HasSubstr("[[Warnings]]")));
}

}  // namespace
}  // namespace pendulum
