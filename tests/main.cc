// SPDX-License-Identifier: Apache-2.0
// Runs a floor's tests: all, or those of the source file whose path ends with the argument.

#include <iostream>
#include <string>
#include <string_view>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace {

/// The tests of a file as a pattern for --gtest_filter; empty if the file has none.
std::string TestsIn(std::string_view file) {
  const testing::UnitTest& all = *testing::UnitTest::GetInstance();
  std::string filter;
  for (int i = 0; i < all.total_test_suite_count(); ++i) {
    const testing::TestSuite& suite = *all.GetTestSuite(i);
    for (int k = 0; k < suite.total_test_count(); ++k) {
      const testing::TestInfo& test = *suite.GetTestInfo(k);
      if (!std::string_view(test.file()).ends_with(file)) continue;
      filter.append(":").append(suite.name()).append(".").append(test.name());
    }
  }
  return filter;
}

}  // namespace

int main(int argc, char** argv) {
  testing::InitGoogleMock(&argc, argv);
  if (argc > 2) {
    std::cerr << argv[0] << ": name one file, or none for all\n";
    return 1;
  }
  if (argc == 2) {
    const std::string_view file = argv[1];
    const std::string filter = file.ends_with(".cc") ? TestsIn(file) : "";
    if (filter.empty()) {
      std::cerr << argv[0] << ": no test in this build is in a file whose path ends in '" << file
                << "'; a file is named like /fitting/fit/fit_test.cc\n";
      return 1;
    }
    GTEST_FLAG_SET(filter, filter);
  }
  return RUN_ALL_TESTS();
}
