// SPDX-License-Identifier: Apache-2.0
#include "pendulum/base/try.h"

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "pendulum/base/status.h"

namespace pendulum::try_test {
namespace {

Result<void> Check(bool is_right) {
  if (is_right) return {};
  return WithTry(Error(StatusCode::kNotFound, "wrong"), {"--right"});
}

Result<std::vector<int>> Pair(bool is_right) {
  RETURN_IF_ERROR(Check(is_right));
  return std::vector{1, 2};
}

Result<std::string> Text(bool first, bool second) {
  ASSIGN_OR_RETURN(const std::vector<int> numbers, Pair(first));
  ASSIGN_OR_RETURN(auto owned, Result<std::unique_ptr<int>>(std::make_unique<int>(numbers[1])));
  if (*owned == 2) {
    RETURN_IF_ERROR(Check(second));
  }
  return std::to_string(numbers[0]) + std::to_string(*owned);
}

TEST(ReturnIfError, PassesTheWholeErrorOn) {
  const auto failed = Pair(false);
  ASSERT_FALSE(failed);
  EXPECT_EQ(failed.error().code, StatusCode::kNotFound);
  EXPECT_EQ(failed.error().message(), "wrong");
  EXPECT_EQ(failed.error().try_flags, std::vector<std::string>{"--right"});
  EXPECT_TRUE(Pair(true));
}

TEST(AssignOrReturn, GivesTheValueOrPassesTheErrorOn) {
  EXPECT_EQ(Text(true, true).value(), "12");
  EXPECT_EQ(Text(false, true).error().message(), "wrong");
  EXPECT_EQ(Text(true, false).error().message(), "wrong");
}

TEST(AssignOrReturn, EvaluatesItsExpressionOnce) {
  int calls = 0;
  const auto count = [&]() -> Result<int> { return ++calls; };
  const auto twice = [&]() -> Result<int> {
    ASSIGN_OR_RETURN(const int first, count());
    RETURN_IF_ERROR(count());
    return first;
  };
  EXPECT_EQ(twice().value(), 1);
  EXPECT_EQ(calls, 2);
}

}  // namespace
}  // namespace pendulum::try_test
