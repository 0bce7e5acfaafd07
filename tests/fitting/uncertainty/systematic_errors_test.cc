// SPDX-License-Identifier: Apache-2.0
#include "pendulum/fitting/uncertainty/systematic_errors.h"

#include <gtest/gtest.h>

namespace pendulum::systematic_errors_test {
namespace {

TEST(SystematicErrors, HaveNoTotalWithoutASource) {
  EXPECT_FALSE(SystematicErrors{}.Total());
  SystematicErrors errors;
  errors.Add(ErrorSource::kRig, 0);
  EXPECT_FALSE(errors.Total());
}

TEST(SystematicErrors, AddInQuadrature) {
  SystematicErrors errors;
  errors.Add(ErrorSource::kClock, 3);
  errors.Add(ErrorSource::kClock, 4);
  errors.Add(ErrorSource::kRig, 12);
  EXPECT_DOUBLE_EQ(errors.Of(ErrorSource::kClock), 5);
  EXPECT_EQ(errors.Of(ErrorSource::kCalibration), 0);
  EXPECT_DOUBLE_EQ(errors.Total().value(), 13);
  EXPECT_DOUBLE_EQ(errors.Scaled(-2).Total().value(), 26);
}

TEST(TotalStdError, NeedsTheStatisticalError) {
  SystematicErrors errors;
  EXPECT_EQ(TotalStdError(2.0, errors), 2.0);
  errors.Add(ErrorSource::kCalibration, 1.5);
  EXPECT_DOUBLE_EQ(TotalStdError(2.0, errors).value(), 2.5);
  EXPECT_FALSE(TotalStdError(std::nullopt, errors));
}

TEST(TotalIntervalEnd, WidensEachSide) {
  SystematicErrors errors;
  EXPECT_EQ(TotalIntervalEnd(IntervalEnd::kLower, 10, 7.0, errors), 7.0);
  errors.Add(ErrorSource::kRig, 4 / 1.959963984540054);
  EXPECT_DOUBLE_EQ(TotalIntervalEnd(IntervalEnd::kLower, 10, 7.0, errors).value(), 5);    // 3 and 4 below
  EXPECT_DOUBLE_EQ(TotalIntervalEnd(IntervalEnd::kUpper, 10, 13.0, errors).value(), 15);  // 3 and 4 above
  EXPECT_FALSE(TotalIntervalEnd(IntervalEnd::kUpper, 10, std::nullopt, errors));
}

// At a bound the estimate is an end of the interval.
TEST(TotalIntervalEnd, WidensAnEndAtTheEstimate) {
  SystematicErrors errors;
  errors.Add(ErrorSource::kRig, 4 / 1.959963984540054);
  EXPECT_DOUBLE_EQ(TotalIntervalEnd(IntervalEnd::kLower, 10, 10.0, errors).value(), 6);
  EXPECT_DOUBLE_EQ(TotalIntervalEnd(IntervalEnd::kUpper, 10, 10.0, errors).value(), 14);
}

}  // namespace
}  // namespace pendulum::systematic_errors_test
