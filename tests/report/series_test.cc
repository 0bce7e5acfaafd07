// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/series.h"

#include <gtest/gtest.h>

#include "tests/report/example_report.h"

namespace pendulum {
namespace {

Recording ThreeSamples() {
  Recording used;
  used.time = Eigen::Vector3d(0, 0.1, 0.2);
  used.value = Eigen::Vector3d(0.5, -1e-7, 1.0 / 3.0);
  return used;
}

FitReport FitOfThreeSamples() {
  FitReport fit;
  fit.fitted = Eigen::Vector3d(0.25, 0, 0.5);
  fit.residual = Eigen::Vector3d(0.25, -1e-7, -0.125);
  return fit;
}

TEST(ToResidualCsv, GivesEveryDigitInSi) {
  EXPECT_EQ(ToResidualCsv(ThreeSamples(), FitOfThreeSamples()),
            "time_s,measured_rad,fitted_rad,residual_rad\n"
            "0,0.5,0.25,0.25\n"
            "0.1,-1e-07,0,-1e-07\n"
            "0.2,0.3333333333333333,0.5,-0.125\n");
}

TEST(ToResidualCsv, NamesTheUnitOfARate) {
  Recording used = ThreeSamples();
  used.quantity = Quantity::kRate;
  const std::string csv = ToResidualCsv(used, FitOfThreeSamples());
  EXPECT_EQ(csv.substr(0, csv.find('\n')), "time_s,measured_rad_s,fitted_rad_s,residual_rad_s");
}

TEST(ToResidualCsv, LeavesFieldsEmptyThatAFailedFitDoesNotHave) {
  EXPECT_EQ(ToResidualCsv(ThreeSamples(), FitReport()),
            "time_s,measured_rad,fitted_rad,residual_rad\n"
            "0,0.5,,\n"
            "0.1,-1e-07,,\n"
            "0.2,0.3333333333333333,,\n");
  FitReport fit = FitOfThreeSamples();
  fit.fitted[1] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(ToResidualCsv(ThreeSamples(), fit).find("\n0.1,-1e-07,,-1e-07\n"), std::string::npos);
}

}  // namespace
}  // namespace pendulum
