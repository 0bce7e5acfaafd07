// SPDX-License-Identifier: Apache-2.0
#include "recording/readers/mat/mat_table.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pendulum::mat_table_test {
namespace {

MatTable Example() {
  MatTable table;
  table.columns.push_back({{"ts.Time", "time_s", "ts"}, {0, 0.5}, true});
  table.columns.push_back({{"x", "", ""}, {}, false});
  table.skipped = {{"a", "text", false}, {"b", "an object", true}};
  table.complaint = "none";
  return table;
}

TEST(UnpackMatTable, RestoresThePackedTable) {
  const MatTable table = UnpackMatTable(Pack(Example()));
  ASSERT_EQ(table.columns.size(), 2);
  EXPECT_EQ(table.columns[0].name.written, "ts.Time");
  EXPECT_EQ(table.columns[0].name.meaning, "time_s");
  EXPECT_EQ(table.columns[0].name.run, "ts");
  EXPECT_THAT(table.columns[0].values, testing::ElementsAre(0, 0.5));
  EXPECT_TRUE(table.columns[0].is_unit_known);
  EXPECT_FALSE(table.columns[1].is_unit_known);
  ASSERT_EQ(table.skipped.size(), 2);
  EXPECT_FALSE(table.skipped[0].is_object);
  EXPECT_EQ(table.skipped[1].name, "b");
  EXPECT_EQ(table.skipped[1].kind, "an object");
  EXPECT_TRUE(table.skipped[1].is_object);
  EXPECT_EQ(table.complaint, "none");
}

TEST(UnpackMatTable, GivesATableForTruncatedBytes) {
  const std::string whole = Pack(Example());
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_LE(UnpackMatTable(whole.substr(0, size)).columns.size(), 2);
  }
}

}  // namespace
}  // namespace pendulum::mat_table_test
