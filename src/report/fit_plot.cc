// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/fit_plot.h"

#include <algorithm>
#include <array>
#include <vector>

#include <Eigen/Core>

#include "pendulum/base/format.h"
#include "pendulum/report/result_summary.h"
#include "pendulum/report/shown_motion.h"
#include "pendulum/report/text_parts.h"

namespace pendulum {
namespace {

using Eigen::Index;

/// The terminal of gnuplot. A letter is a thirtieth of the width high, so 2.7 mm with its line in print 8 cm wide.
std::string_view Terminal(PictureFormat format) {
  switch (format) {
    case PictureFormat::kSvg: return "svg size 640,540 background rgb 'white' font 'sans-serif,20'";
    case PictureFormat::kPng: return "pngcairo size 1280,1080 background rgb 'white' font 'sans,30'";
    case PictureFormat::kPdf: return "pdfcairo size 16cm,13.5cm background rgb 'white' font 'sans,14'";
  }
  return "";
}

/// A text in single quotes for a script.
std::string InQuotes(std::string_view text) {
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? "''" : std::string(1, c);
  return quoted + "'";
}

/// The samples to draw: all of some thousand, otherwise the first of each interval and those with its smallest and its
/// largest value.
std::vector<Index> SamplesToDraw(const Eigen::VectorXd& values) {
  constexpr Index kAll = 10'000, kIntervals = 2500;
  const Index size = values.size(), intervals = size > kAll ? kIntervals : size;
  std::vector<Index> samples;
  for (Index i = 0; i < intervals; ++i) {
    const Index first = i * size / intervals, count = (i + 1) * size / intervals - first;
    Index low = 0, high = 0;
    values.segment(first, count).minCoeff(&low);
    values.segment(first, count).maxCoeff(&high);
    std::array<Index, 3> chosen = {0, low, high};
    std::ranges::sort(chosen);
    const auto end = std::ranges::unique(chosen).begin();
    for (auto each = chosen.begin(); each != end; ++each) samples.push_back(first + *each);
  }
  return samples;
}

/// A named data block of a script with two columns.
template <typename TimeAt>
std::string Points(const std::string& name, const TimeAt& time, const Eigen::VectorXd& values, double factor) {
  constexpr int kTimeDigits = 12, kDigits = 7;
  std::string lines;
  for (const Index i : SamplesToDraw(values)) {
    lines += NumberText(time(i), kTimeDigits) + " " + NumberText(factor * values[i], kDigits) + "\n";
  }
  return name + " << EndOfData\n" + lines + "EndOfData\n";
}

constexpr std::string_view kLayout = R"(
set encoding utf8
set minussign
set lmargin at screen 0.16
set rmargin at screen 0.975
set grid lc rgb '#dddddd'
set key at graph 1, 1.01 right bottom horizontal samplen 1.5
set tics nomirror
)";

constexpr std::string_view kDots = " with points pt 7 ps 0.3 lc rgb '#777777' notitle";

/// The dots of the readings, and the curve of the fit: its samples if they are dense, otherwise the motion itself.
std::string UpperData(const IdentifiedRecording& recording, const FitReport& fit, const std::optional<Rig>& rig,
                      double factor) {
  constexpr double kMostSteps = 2e4;
  const Recording& used = recording.used;
  const auto at_sample = [&](Index i) { return used.time[i]; };
  std::string data = Points("$measured", at_sample, used.value, factor);
  const std::optional<ShownMotion> motion =
      HidesMotion(recording) ? MotionToShow(used, fit, rig, kMostSteps) : std::nullopt;
  if (!motion || motion->reading.size() == 0) return data + Points("$fitted", at_sample, fit.fitted, factor);
  const auto at_step = [&](Index i) { return motion->start + static_cast<double>(i) * motion->interval; };
  return data + Points("$fitted", at_step, motion->reading, factor);
}

std::string RangeOf(const Recording& used) {
  constexpr int kDigits = 12;
  return "set xrange [" + NumberText(used.time[0], kDigits) + ":" + NumberText(used.time[used.size() - 1], kDigits) +
         "]\n";
}

}  // namespace

std::optional<PictureFormat> PictureFormatOf(std::string_view path) {
  if (path.ends_with(".svg")) return PictureFormat::kSvg;
  if (path.ends_with(".png")) return PictureFormat::kPng;
  if (path.ends_with(".pdf")) return PictureFormat::kPdf;
  return std::nullopt;
}

std::string FitPlot(const Identification& identification, std::size_t k, std::size_t fit, PictureFormat format) {
  constexpr int kDigits = 3;
  const IdentifiedRecording& recording = identification.recordings[k];
  const Recording& used = recording.used;
  const FitReport& report = identification.FitOf(k, fit);
  const bool has_curve = report.fitted.size() == used.size();
  const Conversion shown = Degrees(used.value_unit()).value_or(Conversion{used.value_unit()});
  const std::string unit = " [" + std::string(shown.unit) + "]'";
  const std::string title =
      identification.is_joint() ? Printable(RecordingLabel(identification, k)) : TitleOf(identification, "Recording");
  const std::string reading = used.quantity == Quantity::kAngle  ? "angle"
                              : used.quantity == Quantity::kRate ? "rate"
                                                                 : "reading";
  std::string script = has_curve ? UpperData(recording, report, identification.si_rig(), shown.factor)
                                 : Points(
                                       "$measured", [&](Index i) { return used.time[i]; }, used.value, shown.factor);
  script += "set terminal ";
  script += Terminal(format);
  script += kLayout;
  script += RangeOf(used) + "set multiplot title " + InQuotes(title) + " noenhanced\n";
  script += "set tmargin at screen 0.86\nset bmargin at screen ";
  script += has_curve ? "0.46\nset format x ''\n" : "0.14\nset xlabel 'time [s]'\n";
  script += "set ylabel '" + reading + unit + "\nplot $measured" + std::string(kDots) +
            ", keyentry with points pt 7 ps 0.7 lc rgb '#777777' title 'measured'";
  if (!has_curve) return script + "\nunset multiplot\n";
  script += ", $fitted with lines lw 1.5 lc rgb '#c0392b' title 'fit: " + std::string(report.model.name) + "'\n";
  const double noise = shown.factor * report.statistics.rms_residual;
  script += Points(
                "$residual", [&](Index i) { return used.time[i]; }, report.residual, shown.factor) +
            "set tmargin at screen 0.38\nset bmargin at screen 0.14\nset format x '%g'\nset xlabel 'time [s]'\n" +
            "set ylabel 'residual" + unit + "\nplot $residual" + std::string(kDots) + ", " +
            NumberText(noise, kDigits) + " with lines dt 2 lc rgb '#c0392b' title '± " + NumberText(noise, kDigits) +
            " " + std::string(shown.unit) + " (rms)', -" + NumberText(noise, kDigits) +
            " with lines dt 2 lc rgb '#c0392b' notitle\nunset multiplot\n";
  return script;
}

}  // namespace pendulum
