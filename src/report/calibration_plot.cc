// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/calibration_plot.h"

#include <string_view>

#include "pendulum/base/format.h"

namespace pendulum {
namespace {

using Eigen::Index;

constexpr std::string_view kLayout =
    R"(set terminal svg size 900,640 dynamic background rgb 'white' font 'sans-serif,14'
set key top left
set multiplot
set lmargin at screen 0.11
set rmargin at screen 0.97
set grid lc rgb '#dddddd'
set offsets graph 0, graph 0, graph 0.05, graph 0.05
set tmargin at screen 0.96
set bmargin at screen 0.45
set format x ''
)";

constexpr std::string_view kUpper = R"(plot $curve using 1:2 with lines lw 1.5 lc rgb '#c0392b' title 'curve', \
     $points using 1:2 with points pt 7 ps 0.6 lc rgb '#2c3e50' title 'measured'
set tmargin at screen 0.41
set bmargin at screen 0.11
set format x '%g'
unset key
)";

constexpr std::string_view kLower = R"(, \
     $points using 1:3 with impulses lc rgb '#888888', \
     $points using 1:3 with points pt 7 ps 0.6 lc rgb '#2c3e50'
unset multiplot
)";

/// A named data block of a script.
std::string PlotData(std::string_view name, const std::string& lines) {
  return std::string(name) + " << EndOfData\n" + lines + "EndOfData\n";
}

std::string Points(const CalibrationTable& table, const CalibrationFit& fit) {
  std::string lines;
  for (Index i = 0; i < table.size(); ++i) {
    lines += NumberText(table.reading[i]) + " " + NumberText(table.angle[i]) + " " + NumberText(fit.residual[i]) + "\n";
  }
  return lines;
}

std::string Curve(const CalibrationTable& table, const CalibrationFit& fit) {
  constexpr int kSteps = 200;
  const double low = table.reading.minCoeff(), high = table.reading.maxCoeff();
  std::string lines;
  for (int i = 0; i <= kSteps; ++i) {
    const double share = static_cast<double>(i) / kSteps;
    const double reading = (1 - share) * low + share * high;
    lines +=
        NumberText(reading) + " " + NumberText(fit.calibration.Angle(reading) / fit.calibration.RadFromUnit()) + "\n";
  }
  return lines;
}

}  // namespace

std::string CalibrationPlot(const CalibrationTable& table, const CalibrationFit& fit) {
  std::string script = PlotData("$points", Points(table, fit)) + PlotData("$curve", Curve(table, fit));
  script += kLayout;
  script += "set ylabel 'angle [" + table.angle_unit + "]' offset -1\n";
  script += kUpper;
  script += "set xlabel 'reading [" + table.input + "]'\nset ylabel 'residual [" + table.angle_unit + "]'\nplot ";
  for (const double level : {-fit.resolution / 2, fit.resolution / 2}) {
    if (level != 0) script += NumberText(level) + " with lines dt 2 lc rgb '#c0392b', ";
  }
  return (script += "0 with lines lc rgb '#c0392b'") += kLower;
}

}  // namespace pendulum
