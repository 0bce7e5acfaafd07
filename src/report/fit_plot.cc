// SPDX-License-Identifier: Apache-2.0
#include "pendulum/report/fit_plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
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
    const auto repeated = std::ranges::unique(chosen);
    for (const Index each : std::span(chosen.begin(), repeated.begin())) samples.push_back(first + each);
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
set termoption noenhanced
set lmargin at screen 0.17
set rmargin at screen 0.95
set grid lt 1 lc rgb '#dddddd'
set key at graph 1, 1.01 right bottom horizontal samplen 1.5
set tics nomirror
)";

constexpr std::string_view kDots = " with points pt 7 ps 0.3 lc rgb '#777777' notitle";

/// The curve of the fit: its samples if they are dense, otherwise the motion itself. origin: the time that is 0, s.
std::string Curve(const IdentifiedRecording& recording, const FitReport& fit, const std::optional<Rig>& rig,
                  double origin, double factor) {
  constexpr double kMostSteps = 2e4;
  const Recording& used = recording.used;
  const std::optional<ShownMotion> motion =
      HidesMotion(recording) ? MotionToShow(used, fit, rig, kMostSteps) : std::nullopt;
  if (!motion || motion->reading.size() == 0) {
    return Points(
        "$fitted", [&](Index i) { return used.time[i] - origin; }, fit.fitted, factor);
  }
  const auto at_step = [&](Index i) { return motion->start + static_cast<double>(i) * motion->interval - origin; };
  return Points("$fitted", at_step, motion->reading, factor);
}

/// The title: the name of the file without its folders, or which of several recordings it is. A long one is shortened
/// in its middle.
std::string Title(const Identification& identification, std::size_t k) {
  constexpr std::size_t kLongest = 48, kEnd = 20;
  if (identification.is_joint()) return Printable(RecordingLabel(identification, k));
  std::string title = TitleOf(identification, "Recording");
  title.erase(0, title.find_last_of('/') + 1);  // npos + 1 is 0
  if (title.size() <= kLongest) return title;
  const auto is_inside = [&](std::size_t at) { return (static_cast<unsigned char>(title[at]) & 0xC0U) == 0x80U; };
  std::size_t cut = kLongest - kEnd, resume = title.size() - kEnd;  // at the begins of characters of UTF-8
  while (is_inside(cut)) --cut;
  while (is_inside(resume)) ++resume;
  return title.substr(0, cut) + "…" + title.substr(resume);
}

/// The time of the file that is 0 on the axis: its first sample's, if the numbers would be too long to be read.
double OriginOf(const Recording& used) {
  constexpr double kLong = 1e4;
  const double from = used.time[0], duration = used.time[used.size() - 1] - from;
  return std::abs(from) > std::max(kLong, duration) ? from : 0;
}

/// The range and four or five marks of an axis for values up to ± `largest`.
std::string SymmetricAxis(double largest) {
  constexpr int kDigits = 6;
  constexpr double kMargin = 1.08;
  if (!(largest > 0) || !std::isfinite(largest)) return "";
  const double power = std::pow(10, std::floor(std::log10(largest / 2)));
  const double ratio = largest / 2 / power;
  const double step = (ratio >= 5 ? 5 : ratio >= 2 ? 2 : 1) * power;
  const std::string end = NumberText(kMargin * largest, kDigits);
  return "set yrange [-" + end + ":" + end + "]\nset ytics " + NumberText(step, kDigits) + "\n";
}

}  // namespace

std::optional<PictureFormat> PictureFormatOf(std::string_view path) {
  if (path.ends_with(".svg")) return PictureFormat::kSvg;
  if (path.ends_with(".png")) return PictureFormat::kPng;
  if (path.ends_with(".pdf")) return PictureFormat::kPdf;
  return std::nullopt;
}

std::string FitPlot(const Identification& identification, std::size_t k, std::size_t fit, PictureFormat format) {
  constexpr int kDigits = 3, kTimeDigits = 12;
  const IdentifiedRecording& recording = identification.recordings[k];
  const Recording& used = recording.used;
  const FitReport& report = identification.FitOf(k, fit);
  const bool has_curve = report.fitted.size() == used.size();
  const std::string own = used.value_unit();
  const Conversion shown = Degrees(own).value_or(Conversion{own});
  const std::string unit = " [" + std::string(shown.unit) + "]";
  const std::string reading = used.quantity == Quantity::kAngle  ? "angle"
                              : used.quantity == Quantity::kRate ? "rate"
                                                                 : "reading";
  const double origin = OriginOf(used);
  const auto at_sample = [&](Index i) { return used.time[i] - origin; };
  const std::string times =
      "set xlabel " + InQuotes("time [s]" + (origin == 0 ? "" : " after " + NumberText(origin, kTimeDigits) + " s")) +
      "\n";
  std::string script = Points("$measured", at_sample, used.value, shown.factor);
  if (has_curve) script += Curve(recording, report, identification.si_rig(), origin, shown.factor);
  script += "set terminal ";
  script += Terminal(format);
  script += kLayout;
  script += "set xrange [" + NumberText(at_sample(0), kTimeDigits) + ":" +
            NumberText(at_sample(used.size() - 1), kTimeDigits) + "]\nset multiplot title " +
            InQuotes(Title(identification, k)) + " noenhanced\nset tmargin at screen 0.86\nset bmargin at screen ";
  script += has_curve ? "0.46\nset format x ''\n" : "0.14\n" + times;
  script += "set ylabel " + InQuotes(reading + unit) + "\nplot $measured" + std::string(kDots) +
            ", keyentry with points pt 7 ps 0.7 lc rgb '#777777' title 'measured'";
  if (!has_curve) return script + "\nunset multiplot\n";
  script += ", $fitted with lines lw 1.5 lc rgb '#c0392b' title 'fit: " + std::string(report.model.name) + "'\n";
  const std::string noise = NumberText(shown.factor * report.statistics.rms_residual, kDigits);
  const std::string dashed = " with lines dt 2 lc rgb '#c0392b' ";
  return script + Points("$residual", at_sample, report.residual, shown.factor) +
         "set tmargin at screen 0.38\nset bmargin at screen 0.14\nset format x '%g'\n" + times +
         SymmetricAxis(shown.factor * report.residual.cwiseAbs().maxCoeff()) + "set ylabel " +
         InQuotes("residual" + unit) + "\nplot $residual" + std::string(kDots) + ", " + noise + dashed + "title " +
         InQuotes("± " + noise + " " + std::string(shown.unit) + " (rms)") + ", -" + noise + dashed +
         "notitle\nunset multiplot\n";
}

}  // namespace pendulum
