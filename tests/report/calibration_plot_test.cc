// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/calibration_plot.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/recording/calibration_examples.h"

namespace pendulum::calibration_plot_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

std::string PlotOf(const CalibrationTable& table) {
  const auto fit = CalibrateSensor(table, 1);
  EXPECT_TRUE(fit) << fit.error().message();
  return fit ? CalibrationPlot(table, *fit) : "";
}

TEST(CalibrationPlot, ContainsPointsResidualsAndTheCurve) {
  const std::string script = PlotOf(TableOf("counts,angle_deg\n100,-10\n200,11\n300,29\n"));  // -29 + 0.195 x
  EXPECT_THAT(script, StartsWith("$points << EndOfData\n100 -10 -0.5"));
  EXPECT_THAT(script, AllOf(HasSubstr("$curve << EndOfData\n100 -9.5"), HasSubstr("set terminal svg"),
                            HasSubstr("set ylabel 'angle [deg]'"), HasSubstr("set xlabel 'reading [counts]'"),
                            HasSubstr("plot -0.0975"), HasSubstr(", 0.0975")));
}

TEST(CalibrationPlot, HasNoCountLinesForVolts) {
  EXPECT_THAT(PlotOf(TableOf("volts,angle_rad\n1,-1\n2,1.1\n3,2.9\n")),
              AllOf(HasSubstr("set ylabel 'residual [rad]'\nplot 0 with lines"), Not(HasSubstr("dt 2"))));
}

TEST(CalibrationPlot, ContainsNoTextFromTheFile) {
  CalibrationTable table = TableOf(kReferenceTable);
  table.path = "'; system('false'); '";
  EXPECT_THAT(PlotOf(table), AllOf(Not(HasSubstr("system")), Not(HasSubstr("set output"))));
}

}  // namespace
}  // namespace pendulum::calibration_plot_test
