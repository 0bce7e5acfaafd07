// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/comparison_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/report/section_text.h"
#include "tests/identify/example_identification.h"

namespace pendulum::comparison_text_test {
namespace {

using testing::HasSubstr;
using testing::Not;

std::string ComparisonText(const Identification& report) { return ToText(ComparisonSections(report)); }
std::string ConstancyText(const Identification& report) {
  return ToText(ConstancySections(report.recordings.front().ConstancyOf(0)));
}

// Expected values: 0.00349 rad = 0.19996 deg, 0.0035 rad = 0.20054 deg, 0.004 rad = 0.22918 deg, 0.5 rad = 28.648 deg.
TEST(ComparisonSections, StartWithTheRecommendation) {
  EXPECT_EQ(ComparisonText(ExampleComparedIdentification()), R"([[Comparison]]
    Recommended: coulomb.
    The only one that converged.
    model    parameters  rms [deg]  ΔBIC  AICc weight  lag 1
    coulomb           4      0.200   0.0            1   0.12
    drag              -          -     -            -      -  lack of fit
    BIC of independent residuals.
    Prediction of samples that were left out of the fit: block by block, and of
    the last part from the first part. rms: of measured - predicted;
    standardized: rms of this difference over its predicted standard deviation,
    which is 1 if model and errors are right.
    model    blocks [deg]  standardized  last part [deg]  standardized
    coulomb         0.201          1.01            0.229          1.12
    drag                -             -                -             -
    drag is not compared: 100 iterations were not enough.
[[Likelihood-ratio tests]] (small p: the simpler law lacks the added term)
    law                   adds     2 Δ log L  p      null distribution
    coulomb over viscous  coulomb        812  1e-10  half χ²(0), half χ²(1)
    drag over coulomb     drag             0  -
    drag over coulomb: no p: drag did not converge.
)");
}

TEST(ComparisonSections, WarnIfNothingIsRecommended) {
  Identification report = ExampleComparedIdentification();
  report.comparison->recommended.clear();
  report.comparison->reason = "None converged.";
  report.comparison->tests.clear();
  const std::string text = ToText(ComparisonSections(report), {.colour = true});
  EXPECT_THAT(text, HasSubstr("\x1B[33mNo model is recommended.\x1B[0m\n    None converged.\n"));
  EXPECT_THAT(text, HasSubstr("\x1B[33mlack of fit\x1B[0m"));
  EXPECT_THAT(text, Not(HasSubstr("Likelihood-ratio")));
}

TEST(ComparisonSections, ExplainMissingPredictions) {
  Identification report = ExampleComparedIdentification();
  ComparisonRow& row = report.comparison->rows[0];
  row.cross_validation = row.forward = {0, 0, 0, "shorter than three periods"};
  const std::string text = ComparisonText(report);
  EXPECT_THAT(text, Not(HasSubstr("standardized")));
  EXPECT_THAT(text, HasSubstr("    coulomb, left-out blocks: shorter than three periods.\n"
                              "    coulomb, last part: for the same reason.\n    drag is not compared"));
  row.forward.reason = "it ends early";
  EXPECT_THAT(ComparisonText(report), HasSubstr("    coulomb, last part: it ends early.\n"));
}

TEST(ComparisonSections, UseTheUnitOfTheReadings) {
  Identification report = ExampleComparedIdentification();
  report.unit = "counts";
  EXPECT_THAT(ComparisonText(report), HasSubstr("rms [counts]"));
  EXPECT_THAT(ComparisonText(report), HasSubstr("  0.00349  "));
}

TEST(ComparisonSections, AreEmptyForOneModel) { EXPECT_EQ(ComparisonText(ExampleIdentification()), ""); }

TEST(ConstancySections, AreOneSentenceIfNothingChanges) {
  EXPECT_EQ(ConstancyText(ExampleIdentification()),
            "[[Constancy]]\n    inertia and friction are constants of the recording.\n");
}

// 0.4 rad = 22.918 deg, 0.3 rad = 17.189 deg, 0.2 rad = 11.459 deg.
TEST(ConstancySections, ShowTheWindowsOfATrend) {
  EXPECT_EQ(ConstancyText(ExampleComparedIdentification()), R"([[Constancy]]
    inertia falls by 1.9 % from the largest to the smallest swings (p = 1e-09).
    from [s]  to [s]  amplitude [deg]  inertia [kg m^2] ± error
        1.50    7.50            22.92           0.07950 ± 0.00013
        7.50   13.50            17.19           0.07900 ± 0.00013
       13.50   19.50            11.46           0.07850 ± 0.00013
)");
}

TEST(ConstancySections, ShowDifferingHalves) {
  Identification report = ExampleIdentification();
  report.recordings.front().constancy[0].halves_p = 1e-6;
  report.recordings.front().constancy[0].verdict = "viscous differs between the halves";
  EXPECT_EQ(ToText(ConstancySections(report.recordings.front().ConstancyOf(0)), {.colour = true}),
            "\x1B[1m[[Constancy]]\x1B[0m\n"
            "    \x1B[33mviscous differs between the halves.\x1B[0m\n"
            "    name     first half ± error    second half ± error   unit          z\n"
            "    inertia     0.07900 ± 0.00025       0.0791 ± 0.0004  kg m^2      0.2\n"
            "    viscous      0.0030 ± 0.0005        0.0025 ± 0.0008  N m s/rad  -0.5\n");
}

TEST(ConstancySections, ReportMissingTests) {
  Identification report = ExampleIdentification();
  report.recordings.front().constancy[0] = Constancy();
  EXPECT_EQ(ConstancyText(report), "");
  report.recordings.front().constancy[0].reason = "the recording is shorter than six periods";
  EXPECT_EQ(ConstancyText(report), "[[Constancy]]\n    Not tested: the recording is shorter than six periods.\n");
  report.recordings.front().constancy.clear();
  EXPECT_EQ(ConstancyText(report), "");
}

}  // namespace
}  // namespace pendulum::comparison_text_test
