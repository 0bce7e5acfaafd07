// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/terminal_plot.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "pendulum/base/format.h"
#include "pendulum/report/text_parts.h"

namespace pendulum {
namespace {

using Eigen::Index;

constexpr int kWidth = 79, kUpperLines = 14, kLowerLines = 10;  // size of the plots on the terminal
constexpr int kColumns = 67, kUpperRows = 11, kLowerRows = 5;   // inside their frames

/// The smallest and the largest reading in a column of the plot.
struct Span {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;

  bool is_empty() const { return low > high; }
  void Add(double value) {
    if (!std::isfinite(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

/// The span of each column; the columns divide the recording into parts of equal duration.
std::vector<Span> SpansOf(const Recording& used, const Eigen::VectorXd& values, double factor) {
  std::vector<Span> spans(kColumns);
  if (values.size() != used.size()) return spans;
  const double from = used.time[0];
  const double scale = (kColumns - 1) / (used.time[used.size() - 1] - from);
  for (Index i = 0; i < used.size(); ++i) {
    const auto column = static_cast<std::size_t>(std::lround(scale * (used.time[i] - from)));
    spans[column].Add(factor * values[i]);
  }
  return spans;
}

double LargestOf(const std::vector<Span>& spans) {
  double largest = 0;
  for (const Span& span : spans) {
    if (!span.is_empty()) largest = std::max({largest, std::abs(span.low), std::abs(span.high)});
  }
  return largest;
}

/// Points of a column as lines of a script: both ends and, if `filled`, the values between them, one per row.
std::string PointsOf(double time, const Span& span, double row, bool filled) {
  if (span.is_empty()) return "";
  const int steps = !filled ? 1 : row > 0 ? static_cast<int>(std::ceil((span.high - span.low) / row)) : 0;
  std::string points;
  for (int i = 0; i <= steps; ++i) {
    const double value = steps == 0 ? span.low : span.low + (span.high - span.low) * i / steps;
    points += NumberText(time, 15) + " " + NumberText(value, 6) + "\n";
  }
  return points;
}

/// A named data block of a script. gnuplot refuses a block without points, so a point outside the plot is always added.
std::string DataBlock(const std::string& name, const Recording& used, const std::vector<Span>& spans, double row,
                      bool filled) {
  const double from = used.time[0];
  const double step = (used.time[used.size() - 1] - from) / (kColumns - 1);
  std::string lines;
  for (std::size_t i = 0; i < spans.size(); ++i) {
    lines += PointsOf(from + static_cast<double>(i) * step, spans[i], row, filled);
  }
  return name + " << EndOfData\n" + (lines.empty() ? "-1e9 0\n" : lines) + "EndOfData\n";
}

/// The y range of a plot of `rows` rows: the largest value does not touch the frame, and 0 gives a range, too.
std::string RangeOf(double largest, int rows) {
  const double shown = largest > 0 ? largest : 1.0;
  const std::string end = NumberText(shown * (1 + 2.0 / rows), 6);
  const std::string tic = NumberText(shown, 2);
  return "set yrange [-" + end + ":" + end + "]\nset ytics (-" + tic + ", 0, " + tic + ")\n";
}

std::string TerminalOf(int lines) {
  return "set terminal dumb nofeed noenhanced mono size " + std::to_string(kWidth) + "," + std::to_string(lines) + "\n";
}

std::string Layout(const Recording& used) {
  return "set encoding utf8\nunset key\nset lmargin 9\nset rmargin 1\nset tics out nomirror\nset xrange [" +
         NumberText(used.time[0], 15) + ":" + NumberText(used.time[used.size() - 1], 15) + "]\n";
}

}  // namespace

std::string TerminalPlot(const Recording& used, const FitReport& fit) {
  const std::string own = used.value_unit();
  const Conversion shown = Degrees(own).value_or(Conversion{own});
  const std::string unit = " [" + std::string(shown.unit) + "]";
  const std::vector<Span> measured = SpansOf(used, used.value, shown.factor);
  const std::vector<Span> fitted = SpansOf(used, fit.fitted, shown.factor);
  const std::vector<Span> residual = SpansOf(used, fit.residual, shown.factor);
  const double largest = std::max(LargestOf(measured), LargestOf(fitted));
  const double upper_row = 2 * largest / kUpperRows, lower_row = 2 * LargestOf(residual) / kLowerRows;
  return DataBlock("$measured", used, measured, upper_row, true) +
         DataBlock("$fitted", used, fitted, upper_row, false) +
         DataBlock("$residual", used, residual, lower_row, true) + Layout(used) + TerminalOf(kUpperLines) +
         RangeOf(largest, kUpperRows) + "set tmargin 1\nset bmargin 1\nset format x ''\nset title '" +
         std::string(fit.model.name) + ": measured .  fitted *  " + unit.substr(1) + "'\n" +
         "plot $measured with points pt '.', $fitted with points pt '*'\n" + TerminalOf(kLowerLines) +
         RangeOf(LargestOf(residual), kLowerRows) +
         "set bmargin 2\nset format x '%g'\nset xlabel 'time [s]'\nset title 'residual" + unit +
         "'\nplot 0 with points pt '-', $residual with points pt '.'\n";
}

std::string PictureText(const std::string& drawn) {
  std::string text;
  for (std::size_t begin = 0; begin < drawn.size();) {
    const std::size_t end = std::min(drawn.find_first_of("\n\f", begin), drawn.size());
    std::string line = drawn.substr(begin, end - begin);
    line.erase(line.find_last_not_of(' ') + 1);
    if (!line.empty()) text += line + "\n";
    begin = end + 1;
  }
  return text;
}

}  // namespace pendulum
