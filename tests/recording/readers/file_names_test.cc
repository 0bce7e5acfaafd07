// SPDX-License-Identifier: Apache-2.0
#include "pendulum/recording/readers/file_names.h"

#include <string>

#include <gtest/gtest.h>

namespace pendulum::file_names_test {
namespace {

TEST(HasRecordingName, LooksAtTheEndingInEitherCase) {
  for (const std::string name : {"a.csv", "b.TXT", "x.y/z.Xlsx", ".csv", "a.b.mat"}) {
    EXPECT_TRUE(HasRecordingName(name)) << name;
  }
  for (const std::string name : {"", "csv", "a.", "a.csv.bak", "rig.json", "a.csv2", "page.html"}) {
    EXPECT_FALSE(HasRecordingName(name)) << name;
  }
}

TEST(RecordingNames, AreAllTakenAndEndWithAnAnd) {
  const std::string names = RecordingNames();
  EXPECT_TRUE(names.starts_with("*.csv, *.dat, "));
  EXPECT_TRUE(names.ends_with(", *.xlsx and *.zip"));
}

}  // namespace
}  // namespace pendulum::file_names_test
