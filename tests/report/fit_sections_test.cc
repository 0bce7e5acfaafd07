// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/fit_sections.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/report/section_text.h"
#include "tests/identify/example_identification.h"

namespace pendulum::fit_sections_test {
namespace {

using testing::HasSubstr;

TEST(WithUnbrokenTerms, KeepsBlanksOnlyBeforeSigns) {
  EXPECT_EQ(WithUnbrokenTerms("a th' + b sin th = 0"), "a\u00A0th' +\u00A0b\u00A0sin\u00A0th =\u00A00");
}

// Errors of noise 0.00025 and of the rig 0.001 in quadrature, and half the interval as hypot(0.0005, 1.96 · 0.001).
TEST(ParameterSection, HasOnlyTheTableOfEstimates) {
  EXPECT_EQ(ToText(Sections{ParameterSection(ExampleFit(), true)}), R"([[Parameters of coulomb]]
    name              value ± total error  unit       95 % interval
    inertia          0.0790 ± 0.0010       kg m^2     [0.0770, 0.0810]
    viscous          0.0030 ± 0.0005       N m s/rad  [0.0020, 0.0040]
    coulomb               0 (at bound)     N m        [0, 0.000125]
    release_angle   0.42300 ± 0.00020      rad        [0.42260, 0.42340]
                     24.236 ± 0.011        deg        [24.213, 24.259]
    zero_angle         0.01 (fixed)        rad
                   0.572958                deg
)");
}

TEST(ParameterSection, StartsWithTheReasonForAMissingResult) {
  FitReport fit = ExampleFit();
  fit.termination = Termination::kNotConverged;
  fit.reason = "100 iterations were not enough";
  EXPECT_THAT(
      ToText(Sections{ParameterSection(fit, false)}, {.colour = true}),
      HasSubstr("[[Parameters]]\x1B[0m\n    \x1B[1;31mnot_converged: 100 iterations were not enough.\x1B[0m\n"));
}

// Numbers are rounded to the decimal of the error of noise, 0.00025.
TEST(FitSections, ListErrorsOfNoiseAndClosedFormsSeparately) {
  Identification report = ExampleIdentification();
  report.recordings.front().checks.clear();
  report.fits[0].parameters[0].closed_form = 0.0795;
  report.fits[0].parameters[3].closed_form = 1.01 * 0.423;
  EXPECT_THAT(ToText(FitSections(report, 0)), HasSubstr(R"(
    name           symbol  ± by noise  interval by noise   closed form
    inertia        I_O     ± 0.00025   [0.07850, 0.07950]      0.07950
    viscous        b
    coulomb        τ_c
    release_angle  θ_r                                         0.42723
    zero_angle     z
)"));
}

}  // namespace
}  // namespace pendulum::fit_sections_test
