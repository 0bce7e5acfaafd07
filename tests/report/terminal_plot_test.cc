// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/terminal_plot.h"

#include <algorithm>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/base/physics.h"
#include "tests/report/gnuplot_output.h"

namespace pendulum::terminal_plot_test {
namespace {

using testing::Each;
using testing::HasSubstr;
using testing::Not;
using testing::SizeIs;

/// cos(2π f t) with an amplitude of 0.4 rad, N samples over 20 s, and a fit that is 0.01 rad higher.
struct Drawn {
  Recording used;
  FitReport fit;
};

Drawn Swing(double frequency, int samples) {
  Drawn drawn;
  drawn.used.time = Eigen::VectorXd::LinSpaced(samples, 2, 22);
  drawn.used.value = 0.4 * (2 * kPi * frequency * drawn.used.time.array()).cos();
  drawn.fit.model = {"coulomb", "coulomb", Gravity::kSine};
  drawn.fit.fitted = drawn.used.value.array() + 0.01;
  drawn.fit.residual = drawn.used.value - drawn.fit.fitted;
  return drawn;
}

/// gnuplot's output for the script, line by line.
std::vector<std::string> Draw(const Drawn& drawn) {
  std::vector<std::string> lines;
  std::istringstream text(PictureText(GnuplotOutput(TerminalPlot(drawn.used, drawn.fit))));
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  return lines;
}

std::string Joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

/// How often `mark` occurs inside the frame of the upper plot.
long CountAbove(const std::vector<std::string>& lines, char mark) {
  long count = 0;
  for (std::size_t i = 2; i < 13; ++i) count += std::ranges::count(lines.at(i).substr(9), mark);
  return count;
}

TEST(TerminalPlot, IsAsciiAndFitsATerminal) {
  const std::vector<std::string> lines = Draw(Swing(0.76, 2000));
  EXPECT_THAT(lines, SizeIs(testing::Le(24)));
  EXPECT_THAT(lines, Each(SizeIs(testing::Le(79))));
  for (const char c : Joined(lines)) EXPECT_TRUE(c == '\n' || (c >= ' ' && c <= '~'));
}

TEST(PictureText, HasNoFormFeedsOrTrailingBlanks) {
  EXPECT_EQ(PictureText("\f   \n a b  \n\n c\fd\n"), " a b\n c\nd\n");
  EXPECT_EQ(PictureText(""), "");
}

TEST(TerminalPlot, HasMeasuredDotsFittedStarsAndResidualsInDegrees) {
  const std::string text = Joined(Draw(Swing(0.76, 2000)));
  EXPECT_THAT(text, HasSubstr("coulomb: measured .  fitted *  [deg]"));
  EXPECT_THAT(text, HasSubstr("residual [deg]"));
  EXPECT_THAT(text, HasSubstr("time [s]"));
  EXPECT_GT(CountAbove(Draw(Swing(0.76, 2000)), '.'), 67);
  EXPECT_GT(CountAbove(Draw(Swing(0.76, 2000)), '*'), 67);
}

// 100 swings per second; every column has hundreds of samples, which must fill it from end to end.
TEST(TerminalPlot, ShowsEverySwing) {
  const std::vector<std::string> lines = Draw(Swing(100, 200'000));
  EXPECT_GT(CountAbove(lines, '.'), 67 * 7);
  EXPECT_LT(TerminalPlot(Swing(100, 200'000).used, Swing(100, 200'000).fit).size(), 40'000);
}

TEST(TerminalPlot, KeepsASingleOutlierAmongManySamples) {
  Drawn drawn = Swing(0.76, 200'000);
  drawn.used.value[77'777] = 3;  // rad = 171.9 deg
  EXPECT_THAT(TerminalPlot(drawn.used, drawn.fit), HasSubstr(" 171.887\n"));
}

TEST(TerminalPlot, WorksWithoutAFit) {
  Drawn drawn = Swing(0.76, 50);
  drawn.fit.fitted.resize(0);
  drawn.fit.residual.resize(0);
  drawn.used.value[7] = std::numeric_limits<double>::quiet_NaN();
  const std::vector<std::string> lines = Draw(drawn);
  EXPECT_THAT(Joined(lines), HasSubstr("measured"));
  EXPECT_EQ(CountAbove(lines, '*'), 0);
  EXPECT_THAT(TerminalPlot(drawn.used, drawn.fit), Not(HasSubstr("nan")));
}

TEST(TerminalPlot, DrawsAConstantReading) {
  Drawn drawn = Swing(0, 50);
  drawn.used.value.setZero();
  drawn.fit.fitted = drawn.fit.residual = Eigen::VectorXd::Zero(50);
  EXPECT_THAT(Joined(Draw(drawn)), HasSubstr("time [s]"));
}

TEST(TerminalPlot, UsesTheReadingsUnitForNonAngles) {
  Drawn drawn = Swing(0.76, 500);
  drawn.used.unit = "counts";
  EXPECT_THAT(TerminalPlot(drawn.used, drawn.fit), HasSubstr("[counts]"));
}

}  // namespace
}  // namespace pendulum::terminal_plot_test
