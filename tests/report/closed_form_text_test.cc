// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/closed_form_text.h"

#include <algorithm>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/report/section_text.h"
#include "tests/identify/example_identification.h"

namespace pendulum::closed_form_text_test {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

std::string ClosedFormText(const Identification& report) {
  return ToText(ClosedFormSections(report, 0, FitsInFull::kMain));
}
std::string SamplingText(const Identification& report) {
  return ToText(SamplingSections(report.recordings.front().sampling));
}

/// The example with more turning points, each 0.65 s after the previous one.
Identification ReportWithTurningPoints(int count) {
  Identification report = ExampleIdentification();
  ClosedForms& forms = *report.recordings.front().closed_forms;
  for (int i = static_cast<int>(forms.table.points.size()); i < count; ++i) {
    forms.table.points.push_back(forms.table.points.back());
    forms.table.points.back().time += 0.65;
    forms.decay.push_back({static_cast<std::size_t>(i), std::nullopt, Estimate{0.004, 0.0004}, i / 2});
  }
  return report;
}

/// Lines of the table of turning points, without its headers.
std::vector<std::string> TurningPointLines(const Identification& report) {
  const std::string text = ClosedFormText(report);
  std::vector<std::string> lines;
  std::size_t at = text.find('\n', text.find("    number")) + 1;
  for (std::size_t end = 0; at < text.size(); at = end + 1) {
    end = text.find('\n', at);
    lines.push_back(text.substr(at, end - at));
  }
  return lines;
}

// Expected values rounded by hand; G = 1.8 N m, and 1 rad = 57.2958 deg.
TEST(ClosedFormText, ReportsSiUnits) {
  EXPECT_THAT(ClosedFormText(ExampleIdentification()), StartsWith(R"([[Closed forms]]
    Formulas of the linear pendulum, over 2 periods from turning point 1 on;
    corrected_inertia: each period divided by the elliptic integral's ratio.
    name               symbol    value ± std error  unit
    damped_frequency   ω_d      4.7500 ± 0.0025     rad/s
    log_decrement      δ        0.0265 ± 0.0025     1
    damping_ratio      ζ        0.0043 ± 0.0004     1
    natural_frequency  ω_n      4.7501 ± 0.0025     rad/s
    inertia            I_O     0.08010 ± 0.00023    kg m^2
    viscous            b        0.0032 ± 0.0005     N m s/rad
    corrected_inertia  I_O     0.07920 ± 0.00023    kg m^2
    Fitted to all 5 turning points, exact at any amplitude, with the friction of
    model coulomb: chi-square 4 for 2 degrees of freedom, p 0.14.
    name            symbol    value ± std error  unit
    zero_angle      z       0.01000 ± 0.00010    rad
                              0.573 ± 0.006      deg
    inertia         I_O     0.07875 ± 0.00023    kg m^2
    viscous         b        0.0027 ± 0.0005     N m s/rad
    coulomb         τ_c      0.0090 ± 0.0009     N m
    sticking_angle  θ_s      0.0050 ± 0.0005     rad
                              0.286 ± 0.029      deg
    envelope  as exponential (viscous friction alone, p 0.25); not as straight
              line (coulomb friction alone, p 1e-06)
[[Closed forms against the fit]]
)"));
}

TEST(ClosedFormText, UsesUnitsOfGravityWithoutARig) {
  Identification report = ExampleIdentification();
  report.rig.reset();
  const std::string text = ClosedFormText(report);
  EXPECT_THAT(text, HasSubstr("    inertia            I_O     0.04450 ± 0.00013    s^2\n"));
  EXPECT_THAT(text, HasSubstr("    coulomb         τ_c      0.0050 ± 0.0005     1\n"));
}

TEST(ClosedFormText, RoundsFitAndClosedFormAlikeAndExplainsDifferences) {
  EXPECT_THAT(ClosedFormText(ExampleIdentification()), HasSubstr(R"([[Closed forms against the fit]]
    quantity               formula ± error        fit    z  agrees
    inertia_small_angle    0.08020 ± 0.00020  0.07900  6.2  NO
    viscous_log_decrement   0.0031 ± 0.0005   0.00300  0.0  yes
    inertia_point_mass      0.0703            0.07900    -  -
    inertia_small_angle: finite amplitude: of the fitted model's own trajectory
    the formula makes 0.0801.
    inertia_point_mass: the rig file gives no errors.
    the nonlinear model with the textbook's numbers is further off: 0.02 rad.
    1 of 2 quantities agree.
[[Turning points]] (ζ: damping ratio of a pair, and over n periods)
)"));
}

TEST(ClosedFormText, HidesANonFiniteZ) {
  Identification report = ExampleIdentification();
  report.recordings.front().checks[0].rows[0].z = std::numeric_limits<double>::infinity();
  EXPECT_THAT(ClosedFormText(report), HasSubstr("0.08020 ± 0.00020  0.07900    -  NO\n"));
}

TEST(ClosedFormText, NamesTheModelOfEachOfSeveralChecks) {
  Identification report = ExampleIdentification();
  report.fits.push_back(report.fits.front());
  report.fits.back().model = {"viscous", "viscous", Gravity::kSine};
  report.recordings.front().checks.push_back(report.recordings.front().checks.front());
  const std::string text = ClosedFormText(report);
  EXPECT_THAT(text, HasSubstr("[[Closed forms against the fit of coulomb]]\n"));
  EXPECT_THAT(text, HasSubstr("[[Closed forms against the fit of viscous]]\n"));
}

TEST(ClosedFormText, ChecksOnlyTheMainFitOfAComparison) {
  Identification report = ExampleComparedIdentification();
  report.recordings.front().checks[1] = ExampleCheck();
  const std::string text = ClosedFormText(report);
  EXPECT_THAT(text, HasSubstr("[[Closed forms against the fit of coulomb]]\n"));
  EXPECT_THAT(text, Not(HasSubstr("drag")));
}

TEST(ClosedFormText, ListsTurningPointsInDegrees) {
  EXPECT_THAT(ClosedFormText(ExampleIdentification()),
              HasSubstr(R"([[Turning points]] (ζ: damping ratio of a pair, and over n periods)
    number   t [s]  angle [deg]  ζ (pair) ± error   ζ over n ± error   n
         1  2.5000        22.92    0.0041 ± 0.0008
         2  3.1500       -21.49    0.0039 ± 0.0008
         3  3.8000        22.35    0.0042 ± 0.0008    0.0041 ± 0.0008  1
         4  4.4500       -20.91                       0.0039 ± 0.0008  1
         5  5.1000        21.77                       0.0042 ± 0.0004  2
)"));
}

TEST(ClosedFormText, OmitsTheMiddleOfManyTurningPoints) {
  EXPECT_EQ(TurningPointLines(ReportWithTurningPoints(12)).size(), 12);
  const std::vector<std::string> lines = TurningPointLines(ReportWithTurningPoints(20));
  ASSERT_EQ(lines.size(), 13);
  EXPECT_THAT(lines[9], StartsWith("        10 "));
  EXPECT_EQ(lines[10], "    ... 8 more turning points; write all of them with --series");
  EXPECT_THAT(lines[11], StartsWith("        19 "));
  EXPECT_THAT(lines[12], StartsWith("        20 "));
}

TEST(ClosedFormText, ListsSixtyTurningPointsWithoutAFit) {
  Identification report = ReportWithTurningPoints(60);
  report.fits.clear();
  report.recordings.front().checks.clear();
  EXPECT_EQ(TurningPointLines(report).size(), 60);
  EXPECT_THAT(ClosedFormText(report), Not(HasSubstr("against the fit")));
  Identification longer = ReportWithTurningPoints(61);
  longer.fits.clear();
  const std::vector<std::string> lines = TurningPointLines(longer);
  ASSERT_EQ(lines.size(), 61);
  EXPECT_EQ(lines[58], "    ... 1 more turning point; write all of them with --series");
  EXPECT_THAT(lines[60], StartsWith("        61 "));
}

TEST(ClosedFormText, UsesRateUnitsForARate) {
  Identification report = ExampleIdentification();
  report.recordings.front().data.unit = "rad/s";
  report.recordings.front().closed_forms->table.quantity = Quantity::kRate;
  report.recordings.front().closed_forms->decrement->table.quantity = Quantity::kRate;
  const std::string text = ClosedFormText(report);
  EXPECT_THAT(text, HasSubstr("    number   t [s]  rate [deg/s]  "));
  EXPECT_THAT(text, HasSubstr("    rate_bias       z       0.01000 ± 0.00010    rad/s\n"
                              "                              0.573 ± 0.006      deg/s\n"));
}

TEST(ClosedFormText, ShowsCountsUnconverted) {
  Identification report = ExampleIdentification();
  report.recordings.front().data.unit = "counts";
  const std::string text = ClosedFormText(report);
  EXPECT_THAT(text, HasSubstr("    number   t [s]  angle [counts]  "));
  EXPECT_THAT(text, HasSubstr("         1  2.5000          0.4000  "));
  EXPECT_THAT(text, HasSubstr("    zero_angle      z       0.01000 ± 0.00010    counts\n    inertia "));
}

TEST(ClosedFormText, ReportsMissingParts) {
  Identification report = ExampleIdentification();
  report.recordings.front().closed_forms->linear.reset();
  report.recordings.front().closed_forms->decrement.reset();
  report.recordings.front().closed_forms->no_decrement = "too few turning points for 4 unknowns";
  EXPECT_THAT(ClosedFormText(report), StartsWith(R"([[Closed forms]]
    There is no log decrement, because no two successive turning points are a
    whole period apart.
    No law was fitted to the turning points: too few turning points for 4
    unknowns.
    envelope  as )"));
  EXPECT_EQ(ClosedFormText(ExampleRateIdentification()),
            "[[Closed forms]]\n    There are none: only 2 turning points can be located.\n");
  report.recordings.front().closed_forms.reset();
  EXPECT_EQ(ClosedFormText(report), "");
}

TEST(SamplingText, DescribesTheSampling) {
  EXPECT_EQ(SamplingText(ExampleIdentification()), R"([[Sampling]]
    rate       100 Hz, intervals scatter by 0.2 ms
    gaps       1, of 0.5 s at most
    swing      0.8 Hz: 125 samples a period, Nyquist margin 62.5; 0.775 Hz
               expected from the rig
    levels     194 peak to peak at the start, 20 at the end
    saturated  12 readings at an end of the sensor's range
)");
}

TEST(SamplingText, OmitsUnknownFacts) {
  Identification report;
  report.recordings.emplace_back();
  EXPECT_EQ(SamplingText(report), "");
  report.recordings.front().sampling = Sampling();
  report.recordings.front().sampling->rate_hz = 12.5;
  EXPECT_EQ(SamplingText(report), "[[Sampling]]\n    rate  12.5 Hz, even\n    gaps  none\n");
}

}  // namespace
}  // namespace pendulum::closed_form_text_test
