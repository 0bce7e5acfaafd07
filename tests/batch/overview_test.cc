// SPDX-License-Identifier: Apache-2.0
#include "pendulum/batch/overview.h"

#include <cstddef>
#include <optional>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/batch/made_outcomes.h"
#include "tests/batch/made_store.h"

namespace pendulum::overview_test {
namespace {

using made_outcomes::FailureOf;
using made_outcomes::FitOf;
using made_outcomes::OutcomeOf;
using made_store::PlainManifest;
using testing::ElementsAre;
using testing::SizeIs;

class OverviewTest : public made_store::MadeStoreTest {};

std::vector<FailureCount> FailuresOf(Store& store) {
  const auto overview = Overview(store);
  if (overview) return overview->failures;
  ADD_FAILURE() << overview.error().message();
  return {};
}

TEST_F(OverviewTest, GroupsFailuresByReasonWithoutNamesAndNumbers) {
  Store store = StoreOf(PlainManifest(15), [](std::size_t i) -> std::optional<RunOutcome> {
    const std::string path = "run" + std::to_string(i) + ".csv";
    const std::string line = std::to_string(3 + i);
    if (i < 12) return FailureOf({path + ":" + line + ":7", "time " + line + ".25 s does not follow 9 s"}, 4);
    return FailureOf({i == 14 ? "rig.json" : path, "there is no such file; check the path"}, 3);
  });
  const std::vector<FailureCount> failures = FailuresOf(store);
  ASSERT_THAT(failures, SizeIs(3));
  EXPECT_EQ(failures[0].fits, 12);
  EXPECT_EQ(failures[0].status, "failed");
  EXPECT_EQ(failures[0].exit_code, 4);
  EXPECT_EQ(failures[0].reason, "time # s does not follow # s");
  EXPECT_THAT(failures[0].laws, ElementsAre("viscous"));
  EXPECT_THAT(failures[0].examples, SizeIs(10));
  EXPECT_EQ(failures[0].examples[0], "run0.csv");
  EXPECT_EQ(failures[1].fits, 2);
  EXPECT_EQ(failures[1].exit_code, 3);
  EXPECT_EQ(failures[1].reason, "there is no such file; check the path");
  EXPECT_THAT(failures[1].examples, ElementsAre("run12.csv", "run13.csv"));
  EXPECT_EQ(failures[2].reason, "rig.json: there is no such file; check the path");
}

TEST_F(OverviewTest, KeepsNumbersOfAReasonThatAllRunsShare) {
  Store store = StoreOf(PlainManifest(2), [](std::size_t i) {
    return FailureOf({"run" + std::to_string(i) + ".csv", "the window [100, 200] s leaves 0 samples"}, 5);
  });
  EXPECT_EQ(FailuresOf(store).at(0).reason, "the window [100, 200] s leaves 0 samples");
}

}  // namespace
}  // namespace pendulum::overview_test
