// SPDX-License-Identifier: Apache-2.0
#include "tools/gnuplot.h"

#include <cstdlib>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace pendulum::gnuplot_test {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

/// Sets PATH during its lifetime, then restores it.
class WithPath {
 public:
  explicit WithPath(const char* path) : old_(std::getenv("PATH")) { ::setenv("PATH", path, 1); }
  WithPath(const WithPath&) = delete;
  WithPath& operator=(const WithPath&) = delete;
  ~WithPath() { ::setenv("PATH", old_.c_str(), 1); }

 private:
  std::string old_;
};

TEST(RunGnuplot, ReturnsTheDrawing) {
  ASSERT_TRUE(CheckGnuplot());
  const auto svg = RunGnuplot("set terminal svg\nplot '-' with lines notitle\n0 1\n1 3\ne\n");
  ASSERT_TRUE(svg) << svg.error().message();
  EXPECT_THAT(*svg, StartsWith("<?xml"));
  EXPECT_THAT(*svg, HasSubstr("</svg>"));
}

TEST(RunGnuplot, HandlesAScriptLargerThanAPipe) {
  std::string script = "set terminal svg\n$data << EndOfData\n";
  for (int i = 0; i < 20'000; ++i) script += std::to_string(i) + " " + std::to_string(i * 7919 % 1000) + "\n";
  const auto svg = RunGnuplot(script + "EndOfData\nplot $data with points\n");
  ASSERT_TRUE(svg) << svg.error().message();
  EXPECT_GT(svg->size(), 200'000);
}

TEST(RunGnuplot, ReturnsTheMessageOfAFailedScript) {
  const auto svg = RunGnuplot("plot nonsense\n");
  ASSERT_FALSE(svg);
  EXPECT_EQ(svg.error().code, StatusCode::kCannotWrite);
  EXPECT_THAT(svg.error().message(), StartsWith("plot: gnuplot failed: \""));
}

TEST(CheckGnuplot, NamesTheMissingPackage) {
  const WithPath none("/nowhere");
  const auto checked = CheckGnuplot();
  ASSERT_FALSE(checked);
  EXPECT_EQ(checked.error().code, StatusCode::kCannotWrite);
  EXPECT_EQ(checked.error().message(), "plot needs gnuplot; install gnuplot-nox");
}

}  // namespace
}  // namespace pendulum::gnuplot_test
