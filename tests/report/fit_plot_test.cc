// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/fit_plot.h"

#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pendulum/base/physics.h"
#include "tests/report/gnuplot_output.h"

namespace pendulum::fit_plot_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

/// cos(2π 0.76 t) with an amplitude of 0.4 rad, N samples over 20 s, and a fit that is 0.01 rad higher.
Identification Swing(int samples) {
  Identification identification;
  identification.recordings.emplace_back();
  Recording& used = identification.recordings[0].used;
  used.time = Eigen::VectorXd::LinSpaced(samples, 2, 22);
  used.value = 0.4 * (2 * kPi * 0.76 * used.time.array()).cos();
  identification.recordings[0].data.path = "swing.csv";
  FitReport fit;
  fit.model = {"coulomb", "coulomb", Gravity::kSine};
  fit.termination = Termination::kConverged;
  fit.fitted = used.value.array() + 0.01;
  fit.residual = used.value - fit.fitted;
  fit.statistics.rms_residual = 0.01;
  identification.fits = {fit};
  identification.across.resize(1);
  return identification;
}

std::string Svg(const Identification& identification) {
  return GnuplotOutput(FitPlot(identification, 0, 0, PictureFormat::kSvg));
}

TEST(PictureFormatOf, IsSaidByTheEndOfTheName) {
  EXPECT_EQ(PictureFormatOf("a/fit.svg"), PictureFormat::kSvg);
  EXPECT_EQ(PictureFormatOf("fit.png"), PictureFormat::kPng);
  EXPECT_EQ(PictureFormatOf("fit.pdf"), PictureFormat::kPdf);
  for (const char* other : {"-", "", "fit.jpg", "svg", "fit.svg.gz"}) EXPECT_FALSE(PictureFormatOf(other)) << other;
}

TEST(FitPlot, HasTitleLegendAxesAndUnitsAsText) {
  const std::string svg = Svg(Swing(500));
  for (const char* text :
       {"measured", "fit: coulomb", "angle [deg]", "residual [deg]", "time [s]", "± 0.573 deg (rms)"}) {
    EXPECT_THAT(svg, HasSubstr(std::string(text) + "</text>")) << text;
  }
  EXPECT_THAT(svg, HasSubstr("swing.csv</text>"));
  EXPECT_THAT(svg, HasSubstr("fill=\"#ffffff\""));
}

TEST(FitPlot, IsAPictureOfTheFormat) {
  EXPECT_THAT(GnuplotOutput(FitPlot(Swing(500), 0, 0, PictureFormat::kPng)), StartsWith("\x89PNG"));
  EXPECT_THAT(GnuplotOutput(FitPlot(Swing(500), 0, 0, PictureFormat::kPdf)), StartsWith("%PDF"));
  EXPECT_THAT(Svg(Swing(500)), HasSubstr("<svg"));
}

TEST(FitPlot, HasTheUnitOfTheReadings) {
  Identification identification = Swing(500);
  identification.recordings[0].used.quantity = Quantity::kRate;
  EXPECT_THAT(FitPlot(identification, 0, 0, PictureFormat::kSvg), HasSubstr("'rate [deg/s]'"));
  identification.recordings[0].used.quantity = Quantity::kAngle;
  identification.recordings[0].used.unit = "counts";
  EXPECT_THAT(FitPlot(identification, 0, 0, PictureFormat::kSvg),
              AllOf(HasSubstr("[counts]'"), HasSubstr("'± 0.01 counts (rms)'"), HasSubstr("-0.01 with lines")));
  EXPECT_THAT(Svg(identification), HasSubstr("± 0.01 counts (rms)"));
}

TEST(FitPlot, CountsLargeTimesFromTheFirstSample) {
  Identification identification = Swing(500);
  identification.recordings[0].used.time.array() += 1'700'000'000 - 2;
  EXPECT_THAT(Svg(identification), HasSubstr("time [s] after 1700000000 s"));
  EXPECT_THAT(FitPlot(identification, 0, 0, PictureFormat::kSvg), HasSubstr("set xrange [0:20]"));
}

TEST(FitPlot, ShortensALongNameInItsMiddle) {
  Identification identification = Swing(50);
  identification.recordings[0].data.path = "/some/folder/" + std::string(40, 'a') + std::string(60, 'b') + ".csv";
  EXPECT_THAT(Svg(identification), HasSubstr(">" + std::string(28, 'a') + "…" + std::string(16, 'b') + ".csv<"));
}

TEST(FitPlot, KeepsASingleOutlierAmongManySamplesAndStaysSmall) {
  Identification identification = Swing(200'000);
  identification.recordings[0].used.value[77'777] = 3;  // rad = 171.8873 deg
  const std::string script = FitPlot(identification, 0, 0, PictureFormat::kSvg);
  EXPECT_THAT(script, HasSubstr(" 171.8873\n"));
  EXPECT_LT(script.size(), 1'000'000);
}

TEST(FitPlot, DrawsReadingsWithoutAFit) {
  Identification identification = Swing(50);
  identification.fits[0].fitted.resize(0);
  identification.fits[0].residual.resize(0);
  EXPECT_THAT(Svg(identification), AllOf(HasSubstr("measured"), HasSubstr("time [s]"), Not(HasSubstr("fit:"))));
}

TEST(FitPlot, DrawsNothingForAMissingNumber) {
  Identification identification = Swing(50);
  identification.fits[0].fitted[7] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(Svg(identification), HasSubstr("fit: coulomb"));
}

TEST(FitPlot, ShowsAnyNameAsItIs) {
  Identification identification = Swing(50);
  identification.recordings[0].data.path = "it's {a}_^b \n$(date).csv";
  EXPECT_THAT(Svg(identification), HasSubstr("it's {a}_^b ?$(date).csv"));
}

}  // namespace
}  // namespace pendulum::fit_plot_test
